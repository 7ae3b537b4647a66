//! Formats and contents of accessors: G16 to G23.

use crate::document::{floats, triangle_of, with};
use crate::{Row, doc, made};
use serde_json::{Value, json};

pub(crate) fn formats() -> Vec<Row> {
    let position = "meshes[0].primitives[0].attributes.POSITION: an accessor of";
    let indices = "meshes[0].primitives[0].indices: an accessor of";
    let byte = [("/accessors/0/componentType", json!(5121))];
    vec![
        doc(
            "G16",
            &[("/accessors/0/type", json!("VEC2"))],
            2,
            "POSITION: an accessor of VEC2 of 5126; allowed: VEC3",
        ),
        doc("G16", &byte, 2, position),
        doc(
            "G17",
            &[("/accessors/2/componentType", json!(5126))],
            2,
            "accessors[2].count: 3 elements of 4 bytes",
        ),
        doc("G17", &[("/accessors/2/type", json!("VEC3"))], 2, "accessors[2].count: 3 elements of 6 bytes"),
        doc("G17", &[("/meshes/0/primitives/0/indices", json!(0))], 2, indices),
        doc("G17", &[("/accessors/2/componentType", json!(5120))], 2, indices),
        doc(
            "G17",
            &[("/accessors/2/componentType", json!(5126)), ("/accessors/2/count", json!(2))],
            2,
            indices,
        ),
        doc("G17", &[("/accessors/2/componentType", json!(5124))], 2, "accessors[2].componentType: 5124"),
        doc(
            "G17",
            &[("/accessors/2/componentType", json!((1u64 << 32) + 5123))],
            2,
            "componentType: 4294972419",
        ),
        doc(
            "G20",
            &[("/meshes/0/primitives/0/attributes/COLOR_0", json!(2))],
            2,
            "attributes.COLOR_0: an accessor of SCALAR of 5123",
        ),
        doc(
            "G20",
            &[
                ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(3)),
                ("/accessors/3", json!({"bufferView": 0, "componentType": 5125, "count": 3, "type": "VEC2"})),
            ],
            2,
            "attributes.TEXCOORD_0: an accessor of VEC2 of 5125",
        ),
        doc(
            "",
            &[("/accessors/0/type", json!("VEC3\n\u{1b}[2J"))],
            2,
            "accessors[0].type: \"VEC3\\n\\u{1b}[2J\"",
        ),
        doc("", &[("/accessors/0/type", json!("V".repeat(5000)))], 2, "VVVV…\"; allowed: SCALAR"),
        doc("", &[("/meshes/0/primitives/0/mode", json!(7))], 2, "primitives[0].mode: 7; allowed: 0 to 6"),
        doc(
            "",
            &[("/accessors/1/count", json!(2))],
            2,
            "attributes.NORMAL: an accessor of 2 elements; allowed: 3",
        ),
        doc(
            "",
            &[("/meshes/0/primitives/0/attributes", json!({}))],
            0,
            "meshes[0].primitives[0]: no POSITION: skipped",
        ),
    ]
}

pub(crate) fn contents() -> Vec<Row> {
    let nan = |at: usize, value: f32| {
        let mut values = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        values.extend([0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        values[at] = value;
        let mut bytes = floats(&values);
        bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
        triangle_of(&bytes).to_string().into_bytes()
    };
    // The last index is 65535.
    let mut bytes = floats(&[0.0; 18]);
    bytes.extend([0, 0, 1, 0, 0xff, 0xff, 0, 0]);
    let beyond = triangle_of(&bytes).to_string().into_bytes();
    let dropped = "meshes[0].primitives[0]: dropped: 1 positions or normals are not finite";
    vec![
        made("G18", beyond, 2, "meshes[0].primitives[0].indices: index 65535 at element 2; allowed: 0 to 2"),
        made("G19", nan(4, f32::NAN), 0, dropped),
        made("G19", nan(8, f32::INFINITY), 0, dropped),
        made("G19", nan(0, f32::NEG_INFINITY), 0, dropped),
        made("G19", nan(10, f32::NAN), 0, dropped),
        made("G19", nan(4, f32::MAX), 0, "dropped at nodes[0]: a vertex is farther than 1e9 m"),
        doc(
            "G21",
            &[("/meshes/0/primitives/0/attributes/POSITION", json!(99))],
            2,
            "attributes.POSITION: 99; allowed: 0 to 2, as there are 3 accessors",
        ),
        doc(
            "G21",
            &[("/nodes/0/mesh", json!(1u64 << 32))],
            2,
            "nodes[0].mesh: 4294967296; allowed: 0, the only one",
        ),
        made(
            "",
            json!({
                "asset": {"version": "2.0"},
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}]
            })
            .to_string()
            .into_bytes(),
            0,
            "meshes[0].primitives[0]: dropped: POSITION has no data",
        ),
        doc("", &[], 0, ""),
    ]
}

pub(crate) fn sparse() -> Vec<Row> {
    let indices = |values: [u16; 2]| -> Vec<u8> {
        let mut bytes = floats(&[0.0; 18]);
        bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    };
    let replaced = |bytes: Vec<u8>, count: u64, changes: &[(&str, Value)]| {
        let mut all = vec![
            ("/bufferViews/3", json!({"buffer": 0, "byteOffset": 80, "byteLength": 4})),
            (
                "/accessors/0/sparse",
                json!({
                    "count": count,
                    "indices": {"bufferView": 3, "componentType": 5123},
                    "values": {"bufferView": 1}
                }),
            ),
        ];
        all.extend(changes.iter().cloned());
        with(triangle_of(&bytes), &all).to_string().into_bytes()
    };
    let no_base: [(&str, Value); 2] = [
        ("/accessors/0/count", json!(1_000_000_000_000_000_000u64)),
        ("/accessors/0/bufferView", Value::Null),
    ];
    let mut endless: Value =
        serde_json::from_slice(&replaced(indices([0, 2]), 2, &no_base)).expect("a document is JSON");
    endless["accessors"][0].as_object_mut().expect("an object").remove("bufferView");
    let many = with(endless.clone(), &[("/accessors/0/count", json!(4_000_000_000u64))]);
    vec![
        made("G22", replaced(indices([0, 2]), 0, &[]), 2, "accessors[0].sparse.count: 0"),
        made("G22", replaced(indices([0, 2]), 4, &[]), 2, "accessors[0].sparse.count: 4; allowed: 1 to 3"),
        made("G22", replaced(indices([0, 2]), 3, &[]), 2, "accessors[0].sparse.count: 3 elements of 2 bytes"),
        made(
            "G22",
            replaced(indices([2, 0]), 2, &[]),
            2,
            "accessors[0].sparse.indices: 0, out of range or not above",
        ),
        made(
            "G22",
            replaced(indices([1, 1]), 2, &[]),
            2,
            "accessors[0].sparse.indices: 1, out of range or not above",
        ),
        made("G22", replaced(indices([0, 3]), 2, &[]), 2, "accessors[0].sparse.indices: 3, out of range"),
        made("G22", replaced(indices([0, 2]), 2, &[]), 0, "meshes: 3 vertices without a normal"),
        made(
            "G22",
            replaced(indices([500, 600]), 2, &[]),
            2,
            "accessors[0].sparse.indices: 500, out of range",
        ),
        made(
            "",
            replaced(indices([0, 2]), 2, &[("/accessors/0/sparse/indices/componentType", json!(5126))]),
            2,
            "accessors[0].sparse.indices.componentType: 5126",
        ),
        made(
            "G23",
            endless.to_string().into_bytes(),
            3,
            "elements, over the vertex limit; allowed: at most 50000000",
        ),
        made(
            "G23",
            many.to_string().into_bytes(),
            3,
            "accessors[0].count: 4000000000 elements, over the vertex",
        ),
    ]
}
