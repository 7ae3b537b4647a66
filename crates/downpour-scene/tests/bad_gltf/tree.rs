//! Nodes, and the remaining parts of a document: G24 to G34.

use crate::document::{triangle, with};
use crate::{Row, doc, made, text};
use serde_json::{Value, json};

pub(crate) fn nodes() -> Vec<Row> {
    let nodes =
        |nodes: Vec<Value>| with(triangle(), &[("/nodes", Value::Array(nodes))]).to_string().into_bytes();
    let chain =
        |n: u32| (1..=n).map(|i| json!({"children": [i]})).chain([json!({"mesh": 0})]).collect::<Vec<_>>();
    // Each node is twice a child of the one before: 2^28 paths down, if the walk allowed it.
    let twice = (1..=28).map(|i| json!({"children": [i, i]})).chain([json!({"mesh": 0})]).collect();
    let joined = vec![json!({"children": [2]}), json!({"children": [2]}), json!({"mesh": 0})];
    let ring = [1, 2, 3, 1, 0].map(|child| json!({"children": [child]})).to_vec();
    let node = |id, key: &str, value: Value, code, words| {
        doc(id, &[(&format!("/nodes/0/{key}"), value)], code, words)
    };
    vec![
        node("G24", "children", json!([0]), 2, "nodes[0].children[0]: 0, the node itself"),
        made(
            "G24",
            nodes(vec![
                json!({}),
                json!({"children": [2]}),
                json!({"children": [3]}),
                json!({"children": [1]}),
            ]),
            2,
            "a circle of children: nodes[1] > nodes[2] > nodes[3] > nodes[1]",
        ),
        made("G24", nodes(ring), 2, "nodes[3].children[0]: 1, which is a child of nodes[0] already"),
        node("G24", "children", json!([77]), 2, "nodes[0].children[0]: 77"),
        made("G25", nodes(chain(200_000)), 2, "nested deeper than 256"),
        made("G25", nodes(chain(256)), 2, "nodes[256]: nested deeper than 256"),
        made("G25", nodes(chain(255)), 0, ""),
        made("G26", nodes(twice), 2, "nodes[0].children[1]: 1, which is a child of nodes[0] already"),
        made("G26", nodes(joined), 2, "nodes[1].children[0]: 2, which is a child of nodes[0] already"),
        node("G27", "scale", json!([0, 0, 0]), 0, "nodes[0]: dropped: its transform has no inverse"),
        node("G27", "scale", json!([1, 0, 1]), 0, "nodes[0]: dropped: its transform has no inverse"),
        node(
            "G27",
            "translation",
            json!([1e38, 0, 0]),
            0,
            "dropped at nodes[0]: a vertex is farther than 1e9 m",
        ),
        node(
            "G27",
            "scale",
            json!([1e38, 1e38, 1e38]),
            0,
            "dropped at nodes[0]: a vertex is farther than 1e9 m",
        ),
        node("G27", "rotation", json!([0, 0, 0, 0]), 0, "nodes[0]: dropped: its transform has no inverse"),
        node("G28", "translation", json!([1e39, 0, 0]), 2, "nodes[0].translation[0]: 1e+39, not finite"),
        text(
            "G29",
            "\"mesh\":0",
            "\"mesh\":0,\"scale\":[1e400,1,1]",
            2,
            "JSON: number out of range at line 1",
        ),
        node("G29", "matrix", json!(vec![Value::Null; 16]), 2, "nodes[0].matrix[0]: null; allowed: a number"),
        text("G29", "\"mesh\":0", "\"mesh\":0,\"scale\":[NaN,1,1]", 2, "JSON: expected value at line 1"),
        node("", "matrix", json!([1, 2, 3]), 2, "nodes[0].matrix: an array of 3; allowed: 16 numbers"),
        node("", "rotation", json!({}), 2, "nodes[0].rotation: an object; allowed: an array"),
        doc("", &[("/scenes/0/nodes", json!([0, 0]))], 2, "scenes[0].nodes[1]: 0 for the second time"),
        doc("", &[("/scene", json!(1))], 2, "scene: 1; allowed: 0, the only one of scenes"),
        doc("", &[("/cameras", json!([{"type": "perspective"}]))], 2, "cameras[0]: no perspective"),
        doc(
            "",
            &[
                ("/extensions", json!({"KHR_lights_punctual": {"lights": []}})),
                ("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": 3}})),
            ],
            2,
            "KHR_lights_punctual.light: 3; allowed: no index, as there are no lights",
        ),
    ]
}

pub(crate) fn rest() -> Vec<Row> {
    let view = json!({"buffer": 0, "byteOffset": u64::MAX - 3, "byteLength": 8});
    let deep = |key: &str| {
        let open = "[".repeat(300_000);
        let close = "]".repeat(300_000);
        format!("{{\"asset\":{{\"version\":\"2.0\"}},\"{key}\":{{\"X\":{open}{close}}}}}").into_bytes()
    };
    let required = |name: &str, words| {
        doc("G34", &[("/extensionsUsed", json!([name])), ("/extensionsRequired", json!([name]))], 2, words)
    };
    vec![
        doc("G30", &[("/images", json!([{}]))], 2, "images[0]: neither uri nor bufferView"),
        doc("G30", &[("/images", json!([{"bufferView": 0}]))], 2, "images[0]: a bufferView without mimeType"),
        doc(
            "G30",
            &[("/images", json!([{"bufferView": 0, "uri": "a.png"}]))],
            2,
            "images[0]: uri and bufferView",
        ),
        doc(
            "G31",
            &[("/bufferViews/3", json!({"buffer": 0, "byteOffset": 0, "byteLength": 9999}))],
            2,
            "bufferViews[3]: byteOffset 0 and byteLength 9999",
        ),
        doc("G31", &[("/bufferViews/3", view)], 2, "bufferViews[3]: byteOffset 18446744073709551612"),
        doc(
            "G31",
            &[("/images", json!([{"bufferView": 9, "mimeType": "image/png"}]))],
            2,
            "images[0].bufferView: 9",
        ),
        doc("G32", &[("/asset/version", json!("1.0"))], 2, "asset.version: \"1.0\"; allowed: \"2.0\""),
        doc("G32", &[("/asset/version", json!("3.0"))], 2, "(convert the file to glTF 2.0)"),
        doc("G32", &[("/asset/minVersion", json!("2.1"))], 2, "asset.minVersion: \"2.1\"; allowed: \"2.0\""),
        doc("G32", &[("/asset/version", json!("2.1"))], 0, ""),
        doc("G32", &[("/asset", json!({}))], 2, "asset: no version"),
        made("G33", deep("extensions"), 2, "JSON: nested deeper than 127 at line 1"),
        made("G33", deep("extras"), 2, "JSON: nested deeper than 127 at line 1"),
        required("KHR_draco_mesh_compression", "extensionsRequired[0]: \"KHR_draco_mesh_compression\""),
        required("EXT_meshopt_compression", "(export again without mesh or texture compression)"),
        required("ACME_shape", "extensionsRequired[0]: \"ACME_shape\""),
        made("", b"{\"asset\": {\"version\": \"2.\xff\"}}".to_vec(), 2, "JSON: not UTF-8 from byte 25 on"),
        made("", b"{\"asset\":".to_vec(), 2, "JSON: EOF while parsing a value at line 1 column 9"),
        doc("", &[("/meshes/0/primitives", json!(3))], 2, "meshes[0].primitives: 3; allowed: an array"),
        doc(
            "",
            &[("/meshes/0/weights", json!(["x"]))],
            2,
            "meshes[0]: invalid type: string \"x\", expected f32",
        ),
        doc(
            "",
            &[("/materials", json!([{"normalTexture": {"index": 0}}]))],
            2,
            "materials[0].normalTexture.index: 0",
        ),
        doc("", &[("/skins", json!([{"joints": [5]}]))], 2, "skins[0].joints[0]: 5; allowed: 0"),
        doc(
            "",
            &[("/animations", json!([{"samplers": [{"input": 0, "output": 3}], "channels": []}]))],
            2,
            "animations[0].samplers[0].output: 3; allowed: 0 to 2",
        ),
    ]
}
