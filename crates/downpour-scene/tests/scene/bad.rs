//! Bad inputs that only the reader of whole scenes rejects: each has its exit code and its message.

use crate::document::broken::{self, Broken};
use crate::document::{spoiled, with};
use crate::exit_code::ExitCode as _;
use crate::figure::{TIMES, TURNS, WEIGHTS, bytes, figure, figure_of};
use crate::{png_uri, read};
use downpour_scene::sandbox::NoFiles;
use downpour_scene::{Budget, gltf::read_scene_from_bytes};
use serde_json::{Value, json};

/// A figure with a change, the exit code, and text of the message.
type Row = (&'static str, Value, u8, &'static str);

fn rows() -> Vec<Row> {
    vec![
        (
            "/animations/0/samplers/0/interpolation",
            json!("CUBIC"),
            2,
            "interpolation: \"CUBIC\"; allowed: \"STEP\"",
        ),
        (
            "/animations/0/samplers/0/input",
            json!(99),
            2,
            "animations[0].samplers[0].input: 99; allowed: 0 to 8",
        ),
        ("/animations/0/samplers/0/output", json!(9), 2, "animations[0].samplers[0].output: 9"),
        (
            "/animations/0/samplers/0/output",
            json!(6),
            2,
            "output: an accessor of another format; allowed: VEC4",
        ),
        (
            "/animations/0/samplers/0/input",
            json!(0),
            2,
            "input: an accessor of another format; allowed: SCALAR",
        ),
        (
            "/animations/0/samplers/1/interpolation",
            json!("LINEAR"),
            2,
            "output: an accessor of 9 elements; allowed: 3, 1 for each of 3 keys",
        ),
        ("/animations/0/channels/0/sampler", json!(3), 2, "animations[0].channels[0].sampler: 3"),
        ("/animations/0/channels/0/target/node", json!(5), 2, "channels[0].target.node: 5; allowed: 0 to 4"),
        (
            "/animations/0/channels/0/target/path",
            json!("color"),
            2,
            "target.path: \"color\"; allowed: \"translation\"",
        ),
        ("/animations/0/channels/0/target/node", json!(3), 0, ""),
        (
            "/animations/0/channels/0/target",
            json!({"path": "rotation"}),
            0,
            "channels[0]: ignored: it names no node",
        ),
        (
            "/animations/0/channels/2/target/node",
            json!(0),
            0,
            "channels[2]: ignored: its node has no mesh with morph",
        ),
        (
            "/nodes/1",
            json!({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1]}),
            0,
            "ignored: its node has a matrix",
        ),
        ("/skins/0/joints", json!([]), 2, "skins[0].joints: an array of 0; allowed: one joint or more"),
        ("/skins/0/joints", json!([0, 9]), 2, "skins[0].joints[1]: 9; allowed: 0 to 4"),
        ("/skins/0/joints", json!([0]), 2, "JOINTS_0: joint 1; allowed: 0 to 0, as skins[0] has 1 joints"),
        (
            "/skins/0/joints",
            json!([0, 1, 2]),
            2,
            "inverseBindMatrices: an accessor of 2 elements; allowed: 3 or more",
        ),
        (
            "/skins/0/inverseBindMatrices",
            json!(0),
            2,
            "inverseBindMatrices: an accessor of another format; allowed: MAT4",
        ),
        ("/nodes/4/skin", json!(1), 2, "nodes[4].skin: 1; allowed: 0, the only one of skins"),
        ("/accessors/1/componentType", json!(5126), 2, "accessors[1].count"),
        ("/nodes/3/camera", json!(1), 2, "nodes[3].camera: 1; allowed: 0, the only one of cameras"),
        (
            "/cameras/0/perspective/yfov",
            json!(0),
            2,
            "cameras[0].perspective.yfov: 0; allowed: a positive number",
        ),
        ("/cameras/0/perspective/yfov", json!(1e-60), 2, "yfov: 1e-60; allowed: an angle"),
        (
            "/cameras/0/perspective/yfov",
            json!(3.2),
            2,
            "yfov: 3.2; allowed: an angle in radians above 0 and below pi",
        ),
        ("/cameras/0/perspective/znear", json!(0), 2, "znear: 0; allowed: a positive number"),
        ("/cameras/0/perspective/zfar", json!(0.05), 2, "zfar: 0.05; allowed: more than znear"),
        ("/cameras/0/perspective/aspectRatio", json!(-1), 2, "aspectRatio: -1"),
        (
            "/nodes/2/extensions/KHR_lights_punctual/light",
            json!(1),
            2,
            "light: 1; allowed: 0, the only one of lights",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(-1),
            2,
            "lights[0].intensity: -1; allowed: a number from 0 on",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(null),
            2,
            "lights[0].intensity: null; allowed: a number",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(1e39),
            2,
            "lights[0].intensity: 1e+39, not finite",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            json!(2e30),
            2,
            "lights[0]: a color times an intensity of 2e30; allowed: up to 1e30",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/range",
            json!(0),
            2,
            "lights[0].range: 0; allowed: a number above 0",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/color",
            json!([1, 1]),
            2,
            "lights[0].color: an array of 2; allowed: 3 numbers",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/color",
            json!([-1, 1, 1]),
            2,
            "lights[0].color: a negative number",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/type",
            json!("area"),
            2,
            "lights[0].type: \"area\"; allowed: \"directional\"",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
            json!(2),
            2,
            "outerConeAngle: 2; allowed: above 0 and up to pi/2",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle",
            json!(-0.1),
            2,
            "innerConeAngle: -0.1",
        ),
        (
            "/materials",
            json!([{"emissiveTexture": {"index": 0}}]),
            2,
            "emissiveTexture.index: 0; allowed: no index",
        ),
        ("/materials", json!([{"emissiveTexture": {}}]), 2, "materials[0].emissiveTexture: no index"),
        (
            "/materials",
            json!([{"alphaMode": "GLASS"}]),
            2,
            "materials[0].alphaMode: \"GLASS\"; allowed: \"OPAQUE\"",
        ),
        ("/materials", json!([{"doubleSided": 1}]), 2, "materials[0].doubleSided: 1; allowed: true or false"),
        (
            "/materials",
            json!([{"emissiveFactor": [1]}]),
            2,
            "materials[0].emissiveFactor: an array of 1; allowed: 3 numbers",
        ),
        (
            "/materials",
            json!([{"extensions": {"KHR_materials_ior": {"ior": 0.5}}}]),
            2,
            "ior: 0.5; allowed: a number from 1 on, or 0",
        ),
        (
            "/materials",
            json!([{"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": -1}}}]),
            2,
            "emissiveStrength: -1",
        ),
        (
            "/materials",
            json!([{"extras": {"porosity": "wet"}}]),
            2,
            "materials[0].extras.porosity: \"wet\"; allowed: a number",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/extras",
            json!({"radius_m": "wide"}),
            2,
            "lights[0].extras.radius_m: \"wide\"; allowed: a number",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/extras",
            json!({"radius_m": 100.5}),
            2,
            "lights[0].extras.radius_m: 100.5; allowed: 0 to 100 m",
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/extras",
            json!({"radius_m": -1}),
            2,
            "lights[0].extras.radius_m: -1",
        ),
        (
            "/textures",
            json!([{"source": 0}]),
            2,
            "textures[0].source: 0; allowed: no index, as there are no images",
        ),
        (
            "/textures",
            json!([{"sampler": 0}]),
            2,
            "textures[0].sampler: 0; allowed: no index, as there are no samplers",
        ),
        ("/samplers", json!([{"wrapS": 7}]), 2, "samplers[0].wrapS: 7; allowed: 10497"),
        ("/samplers", json!([{"magFilter": 9984}]), 2, "samplers[0].magFilter: 9984; allowed: 9728"),
        ("/samplers", json!([{"minFilter": 1}]), 2, "samplers[0].minFilter: 1; allowed: 9728"),
        ("/meshes/0/primitives/0/targets/0/POSITION", json!(9), 2, "targets[0].POSITION: 9; allowed: 0 to 8"),
    ]
}

fn judge(document: &Value, code: u8, words: &str) -> Result<(), String> {
    let (found, said) = match read(document) {
        Ok(scene) => (0, scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")),
        Err(error) => (error.exit_code(), error.to_string()),
    };
    let matches = found == code && said.contains(words) && (!words.is_empty() || said.is_empty());
    if matches { Ok(()) } else { Err(format!("wanted {code} {words:?}, got {found} {said:?}")) }
}

#[test]
fn each_bad_scene_has_its_code_and_its_words() {
    let rows = rows().into_iter().map(|(at, value, code, words)| {
        judge(&with(figure(), &[(at, value)]), code, words).err().map(|why| format!("{at}: {why}"))
    });
    let wrong: Vec<String> = rows.flatten().collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Numbers in the data itself.
#[test]
fn each_bad_number_has_its_words() {
    let spoil = |at: usize, value: f32| {
        let mut bytes = bytes();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        figure_of(&bytes)
    };
    let joint = |joint: u8| {
        let mut bytes = bytes();
        bytes[44] = joint;
        figure_of(&bytes)
    };
    let rows = [
        (spoil(TIMES + 4, f32::NAN), 2, "samplers[0].input: NaN at element 1; allowed: rising times"),
        (spoil(TIMES + 8, 0.5), 2, "input: 0.5 at element 2; allowed: rising times in seconds, from 1 on"),
        (spoil(TIMES, -1.0), 2, "input: -1 at element 0"),
        (spoil(TIMES, f32::INFINITY), 2, "input: inf at element 0"),
        (spoil(TIMES + 8, 1.0), 0, "1 keys at the time of the one before"),
        (spoil(TURNS + 16, f32::NAN), 2, "samplers[0].output: NaN at element 1; allowed: finite numbers"),
        (spoil(TURNS + 12, 0.0), 2, "samplers[0].output: a rotation of length 0 at key 0"),
        (spoil(316, f32::NEG_INFINITY), 2, "samplers[1].output: -inf at element 0"),
        (spoil(424, f32::NAN), 2, "samplers[2].output: NaN at element 0"),
        (spoil(WEIGHTS, f32::NAN), 2, "attributes.WEIGHTS_0: NaN at element 0; allowed: numbers from 0 on"),
        (spoil(WEIGHTS, -0.5), 2, "attributes.WEIGHTS_0: -0.5 at element 0"),
        (spoil(WEIGHTS, 0.0), 0, "1 vertices whose weights do not add up to 1"),
        (spoil(WEIGHTS, 0.5), 0, "1 vertices whose weights do not add up to 1"),
        (joint(2), 2, "meshes[0].primitives[0].attributes.JOINTS_0: joint 2; allowed: 0 to 1"),
        (spoil(108, f32::NAN), 2, "inverseBindMatrices: not finite at element 0"),
        (spoil(108 + 60, 2.0), 0, "inverseBindMatrices: 1 last rows other than 0 0 0 1: ignored"),
        (spoil(436, f32::NAN), 0, "dropped: 1 positions, normals or other vertex data are not finite"),
        (spoil(436, 1e12), 0, "dropped: a vertex is farther than 1e9 m from the origin"),
    ];
    let wrong: Vec<String> =
        rows.iter().filter_map(|(document, code, words)| judge(document, *code, words).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A joint without weight may have any index: it moves nothing.
#[test]
fn joints_without_weight_are_not_looked_at() {
    let mut bytes = bytes();
    bytes[45] = 200;
    let scene = read(&figure_of(&bytes)).expect("valid");
    assert_eq!(scene.meshes[0].primitives[0].joints[2], [1, 0, 0, 0]);
}

/// G30 and G31 apply to whole scenes too, with an image in use.
#[test]
fn images_without_bytes_are_refused() {
    let used = |image: Value| {
        spoiled(&[
            ("/materials", json!([{"emissiveTexture": {"index": 0}}])),
            ("/textures", json!([{"source": 0}])),
            ("/images", json!([image])),
        ])
    };
    for (image, words) in [
        (json!({}), "images[0]: neither uri nor bufferView"),
        (json!({"bufferView": 0}), "images[0]: a bufferView without mimeType"),
        (json!({"bufferView": 9, "mimeType": "image/png"}), "images[0].bufferView: 9; allowed: 0 to 2"),
        (json!({"bufferView": 0, "mimeType": "image/png"}), "images[0]: a file that begins with"),
        (json!({"uri": "data:image/png;base64,"}), "images[0]: an empty file"),
        (json!({"uri": png_uri().replace("iVBOR", "AAAAA")}), "images[0]: "),
        (json!({"uri": "a.png"}), "\"a.png\" is another file"),
    ] {
        judge(&used(image), 2, words).unwrap_or_else(|why| panic!("{why}"));
    }
    let outside = with(
        used(json!({"bufferView": 3, "mimeType": "image/png"})),
        &[("/bufferViews/3", json!({"buffer": 0, "byteOffset": 76, "byteLength": 8}))],
    );
    judge(&outside, 2, "bufferViews[3]: byteOffset 76 and byteLength 8; allowed: an end within buffers[0]")
        .unwrap_or_else(|why| panic!("{why}"));
}

/// Every broken file: never a panic, and a message of one line; a file that is read keeps the invariants of a scene.
#[test]
fn no_bad_file_gets_through_unseen() {
    let (mut read, mut refused) = (0, 0);
    let all = broken::chosen().into_iter().chain(broken::replaced()).chain(broken::others());
    for Broken { name, bytes } in all {
        match read_scene_from_bytes(&name, &bytes, &NoFiles, &mut Budget::default()) {
            Ok(scene) => {
                read += 1;
                crate::document::check_scene(&scene);
            }
            Err(error) => {
                refused += 1;
                crate::check_message(&error.to_string());
                assert!(error.to_string().starts_with(&name), "{error}");
            }
        }
    }
    assert!(refused > 300 && read > 30, "{read} read, {refused} refused");
}
