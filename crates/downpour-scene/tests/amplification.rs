//! Small files that ask for much: under 1 MiB, none takes more than 5 s of CPU time or 1 GiB.
//!
//! Alone in its binary, so that the peak of the process's memory is that of these files.

mod effort;
mod exit_code;

use downpour_scene::gltf::{read_scene_from_bytes, read_triangles_from_bytes};
use downpour_scene::sandbox::NoFiles;
use downpour_scene::{Budget, SceneError};
use effort::measured;
use exit_code::ExitCode as _;
use std::fs;
use std::time::Duration;

const SIZE: usize = (1 << 20) - 64;
const MAX_TIME: Duration = Duration::from_secs(5);
const MAX_MEMORY_KIB: u64 = 1 << 20;

/// A document of nearly 1 MiB: a part repeated as often as fits.
fn filled(head: &str, part: &str, tail: &str) -> String {
    let head = format!("{{\"asset\":{{\"version\":\"2.0\"}},{head}");
    let times = (SIZE - head.len() - tail.len()) / (part.len() + 1);
    format!("{head}{}{tail}}}", vec![part; times].join(","))
}

/// The head of a document with one accessor of `count` positions (0 but for one), up to the list of its nodes.
fn cloud(count: u32) -> String {
    format!(
        "\"buffers\":[{{\"byteLength\":16,\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAAAAAA==\"}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":12}},{{\"buffer\":0,\"byteOffset\":12,\"byteLength\":4}}],\
         \"accessors\":[{{\"componentType\":5126,\"count\":{count},\"type\":\"VEC3\",\"sparse\":{{\"count\":1,\
         \"indices\":{{\"bufferView\":1,\"componentType\":5125}},\"values\":{{\"bufferView\":0}}}}}}],"
    )
}

/// The peak of this process's memory in KiB, where the system tells it.
fn peak_kib() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// The same as a whole scene, and one pose of it.
fn scene(name: &str, document: &str) {
    let (said, took) = measured(|| {
        match read_scene_from_bytes(name, document.as_bytes(), &NoFiles, &mut Budget::default()) {
            Ok(scene) => format!("{} instances", scene.pose(None, 0.0).instances.len()),
            Err(error) => error.to_string(),
        }
    });
    println!("{took:?} {:?} KiB at most, {name} as a scene: {said}", peak_kib());
    assert!(took < MAX_TIME, "{name}: {took:?}");
}

#[test]
fn small_files_stay_small() {
    let one = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}}]}]";
    let many = |nodes: &str, count: u32| {
        let meshes = "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]";
        filled(&format!("{}{meshes},\"nodes\":[", cloud(count)), nodes, "]")
    };
    let alone = |count: u32| filled(&format!("{}\"x\":[", cloud(count)), "0", &format!("],{one}"));
    let primitive = "{\"attributes\":{\"POSITION\":0}}";
    let ring: Vec<String> = (1..=45_000).map(|i| format!("{{\"children\":[{}]}}", i % 45_000)).collect();
    let half_nodes = vec!["{\"mesh\":0}"; 45_000].join(",");
    let cases: [(&str, String, u8); 15] = [
        ("objects", filled("\"materials\":[", "{}", "]"), 0),
        ("scenes", filled("\"scenes\":[", "{}", "]"), 0),
        ("nodes", filled("\"nodes\":[", "{}", "]"), 0),
        ("maps", filled("\"extensions\":{\"X\":{\"a\":[", "{\"\":0}", "]}}"), 0),
        ("arrays", filled("\"extensions\":{\"X\":{\"a\":[", "[[[[[[[[[]]]]]]]]]", "]}}"), 0),
        ("ring", format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}]}}", ring.join(",")), 2),
        ("a cloud over the limit", alone(50_000_000), 3),
        ("a cloud below the limit", alone(11_500_000), 0),
        ("a cloud on many nodes", many("{\"mesh\":0}", 100_000), 3),
        ("a small cloud on many nodes", many("{\"mesh\":0}", 90), 0),
        ("a cloud out of reach", many("{\"mesh\":0,\"translation\":[1e38,0,0]}", 300), 0),
        ("a cloud of no size", many("{\"mesh\":0,\"scale\":[0,0,0]}", 250), 0),
        ("primitives", filled(&format!("{}\"meshes\":[{{\"primitives\":[", cloud(9)), primitive, "]}]"), 0),
        (
            "primitives on nodes",
            filled(
                &format!("{}\"nodes\":[{half_nodes}],\"meshes\":[{{\"primitives\":[", cloud(9)),
                primitive,
                "]}]",
            ),
            3,
        ),
        (
            "lines on nodes",
            filled(
                &format!("{}\"nodes\":[{half_nodes}],\"meshes\":[{{\"primitives\":[", cloud(9)),
                "{\"mode\":1,\"attributes\":{\"POSITION\":0}}",
                "]}]",
            ),
            0,
        ),
    ];
    for (name, document, code) in cases {
        assert!(document.len() < 1 << 20, "{name}: {} bytes", document.len());
        let (result, took) = measured(|| {
            read_triangles_from_bytes(name, document.as_bytes(), &NoFiles, &mut Budget::default())
        });
        let found = result.as_ref().map_or_else(SceneError::exit_code, |_| 0);
        let said = result
            .map_or_else(|error| error.to_string(), |model| format!("{} triangles", model.indices.len()));
        println!("{took:?} {:?} KiB at most, {name}: {said}", peak_kib());
        assert_eq!(found, code, "{name}: {said}");
        assert!(took < MAX_TIME, "{name}: {took:?}");
        scene(name, &document);
    }
    // Data of whole scenes only: joints, weights and keys, each used often.
    let joints = vec!["0"; 100_000].join(",");
    let skinned = format!("\"skins\":[{{\"joints\":[{joints}]}}],");
    scene(
        "joints on nodes",
        &filled(&format!("{}{skinned}{one},\"nodes\":[", cloud(3)), "{\"mesh\":0,\"skin\":0}", "]"),
    );
    let track = "\"animations\":[{\"samplers\":[{\"input\":1,\"output\":0}],\"channels\":[";
    let channel = "{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"scale\"}}";
    let keyed = cloud(90_000).replacen("\"accessors\":[", "\"extras\":0,\"accessors\":[", 1);
    let keyed = keyed.trim_end_matches("],").to_owned()
        + ",{\"componentType\":5126,\"count\":90000,\"type\":\"SCALAR\"}],\"nodes\":[{}],";
    scene("keys of channels", &filled(&format!("{keyed}{track}"), channel, "]}]"));
    let samplers = vec!["{\"input\":1,\"output\":0}"; 15_000].join(",");
    let track = format!("\"animations\":[{{\"samplers\":[{samplers}],\"channels\":[");
    scene(
        "samplers of channels",
        &filled(&format!("{}{track}", keyed.replace("90000", "9")), channel, "]}]"),
    );
    if let Some(peak) = peak_kib() {
        assert!(peak < MAX_MEMORY_KIB, "{peak} KiB");
    }
}
