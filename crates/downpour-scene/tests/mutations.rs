//! Valid files with random bytes changed: nothing panics, and a file that is read keeps the invariants of a model.
//! `DOWNPOUR_MUTATIONS` sets the number of trials.

mod document;
mod exit_code;
#[allow(dead_code, reason = "where its data stands is for other tests")]
#[path = "scene/figure.rs"]
mod figure;

use document::{check, check_message, check_scene, floats, glb, modes, spoiled, triangle, with};
use downpour_math::rng::{rng_draw, seed_words};
use downpour_scene::gltf::{read_scene_from_bytes, read_triangles_from_bytes};
use downpour_scene::{Budget, SceneError};
use exit_code::ExitCode as _;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::panic::catch_unwind;

type Files = BTreeMap<String, Vec<u8>>;

/// Tokens that break careless readers.
const TOKENS: [&str; 24] = [
    "0",
    "-1",
    "1",
    "3",
    "255",
    "256",
    "65535",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e39",
    "1e400",
    "0.5",
    "null",
    "true",
    "[]",
    "{}",
    "\"\"",
    "\"VEC4\"",
    "5121",
    "5125",
    "\\u0000",
    "..",
    "%2f",
];

/// Small valid files of several kinds.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let mut sparse = floats(&[0.0; 18]);
    sparse.extend([0, 0, 1, 0, 2, 0, 0, 0, 1, 0, 2, 0]);
    let sparse = with(
        document::triangle_of(&sparse),
        &[
            ("/bufferViews/3", json!({"buffer": 0, "byteOffset": 80, "byteLength": 4})),
            (
                "/accessors/0/sparse",
                json!({
                    "count": 2,
                    "indices": {"bufferView": 3, "componentType": 5123},
                    "values": {"bufferView": 1}
                }),
            ),
        ],
    );
    let tree = spoiled(&[(
        "/nodes",
        json!([
            {"children": [1, 2], "scale": [-1, 2, 1]},
            {"mesh": 0, "translation": [0, 1, 0], "rotation": [0, 0, 0.6, 0.8]},
            {"children": [3]},
            {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}
        ]),
    )]);
    let mut plain = triangle();
    plain["buffers"][0].as_object_mut().expect("an object").remove("uri");
    vec![
        ("triangle", triangle().to_string().into_bytes()),
        ("sparse", sparse.to_string().into_bytes()),
        ("tree", tree.to_string().into_bytes()),
        ("figure", figure::figure().to_string().into_bytes()),
        ("painted", painted().to_string().into_bytes()),
        ("binary", glb(plain.to_string().as_bytes(), Some(&floats(&[0.0; 20])))),
        ("modes", modes::document().to_string().into_bytes()),
        ("bench", model("bench.gltf")),
    ]
}

/// A triangle with texture coordinates, a normal map and every extension that is read.
fn painted() -> serde_json::Value {
    let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba([128, 128, 255, 255]));
    let mut png = Vec::new();
    picture.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).expect("a PNG");
    let turned =
        json!({"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 1, "scale": [2, 3]}}});
    with(
        triangle(),
        &[
            ("/images", json!([{"uri": document::data_uri(&png)}])),
            ("/samplers", json!([{"wrapS": 33071, "minFilter": 9987}])),
            ("/textures", json!([{"source": 0, "sampler": 0}])),
            (
                "/materials",
                json!([{
                    "pbrMetallicRoughness": {"baseColorTexture": turned, "roughnessFactor": 0.5},
                    "normalTexture": {"index": 0, "scale": 2},
                    "emissiveFactor": [1, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.25,
                    "extensions": {
                        "KHR_materials_emissive_strength": {"emissiveStrength": 3},
                        "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}},
                        "KHR_materials_ior": {"ior": 1.3}
                    }
                }]),
            ),
            ("/meshes/0/primitives/0/material", json!(0)),
            ("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(3)),
            ("/accessors/3", json!({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"})),
        ],
    )
}

/// A file of the street's models.
fn model(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes/plain/models");
    fs::read(format!("{folder}/{name}")).expect("a model of the street")
}

/// The buffers that the seeds name, spoiled too.
fn files(buffers: &Files, mut dice: impl FnMut() -> u32) -> Files {
    let mut files = Files::new();
    for (name, bytes) in buffers {
        let mut bytes = bytes.clone();
        if dice().is_multiple_of(2) {
            let at = dice() as usize % bytes.len();
            bytes[at] = dice() as u8;
        }
        files.insert(name.clone(), bytes);
    }
    files
}

/// Changes up to four bytes or tokens.
fn mutate(bytes: &mut Vec<u8>, mut dice: impl FnMut() -> u32) {
    for _ in 0..=dice() % 4 {
        if bytes.is_empty() {
            return;
        }
        let at = dice() as usize % bytes.len();
        let end = (at + 1 + dice() as usize % 12).min(bytes.len());
        match dice() % 8 {
            0 => bytes[at] ^= 1 << (dice() % 8),
            1 => bytes[at] = dice() as u8,
            // A digit for a digit keeps the JSON valid and the numbers wrong.
            2 | 3 => {
                let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
                if let Some(&digit) = digits.get(dice() as usize % digits.len().max(1)) {
                    bytes[digit] = b'0' + (dice() % 10) as u8;
                }
            }
            4 => drop(bytes.drain(at..end)),
            5 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            6 => {
                let token = TOKENS[dice() as usize % TOKENS.len()];
                bytes.splice(at..end, token.bytes());
            }
            // A token for an integer.
            _ => {
                let is_number = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
                let start = (at..bytes.len()).find(|&i| is_number(bytes[i])).unwrap_or(at);
                let end = (start..bytes.len()).find(|&i| !is_number(bytes[i])).unwrap_or(bytes.len());
                let token = TOKENS[dice() as usize % TOKENS.len()];
                bytes.splice(start..end, token.bytes());
            }
        }
    }
}

fn read(bytes: &[u8], files: &Files) -> Result<(), SceneError> {
    let model = read_triangles_from_bytes("mutant", bytes, files, &mut Budget::default());
    if let Ok(model) = &model {
        check(model);
    }
    // Missing images do not matter here: the triangles may still be read.
    match read_scene_from_bytes("mutant", bytes, files, &mut Budget::default()) {
        Ok(scene) => check_scene(&scene),
        Err(error) => check_message(&error.to_string()),
    }
    model.map(drop)
}

#[test]
fn mutated_files_never_panic() {
    let seeds = seeds();
    let buffers = Files::from([
        ("hexagon.bin".to_owned(), modes::buffer()),
        ("bench.bin".to_owned(), model("bench.bin")),
    ]);
    let whole = files(&buffers, || 1);
    for (name, seed) in &seeds {
        read(seed, &whole).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    let tries = std::env::var("DOWNPOUR_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(40_000u32);
    let (mut passed, mut codes) = (0u32, [0u32; 8]);
    for id in 0..tries {
        let mut step = 0;
        let mut dice = || {
            step += 1;
            rng_draw(seed_words(0x676c_5446), id, step, 0)[0]
        };
        let (name, seed) = &seeds[dice() as usize % seeds.len()];
        let mut bytes = seed.clone();
        mutate(&mut bytes, &mut dice);
        let files =
            if matches!(*name, "modes" | "bench") { files(&buffers, &mut dice) } else { Files::new() };
        match catch_unwind(|| read(&bytes, &files)) {
            Ok(Ok(())) => passed += 1,
            Ok(Err(error)) => {
                codes[usize::from(error.exit_code())] += 1;
                check_message(&error.to_string());
            }
            Err(_) => panic!("mutation {id} of {name}: {}", String::from_utf8_lossy(&bytes)),
        }
    }
    println!(
        "{tries} mutations: {passed} read, {} bad, {} over a limit, {} unreadable",
        codes[2], codes[3], codes[5]
    );
    // Were nearly all of them refused, the reader behind the guard would not have been tried.
    assert!(passed * 100 >= tries, "only {passed} of {tries} were read");
    assert!(passed < tries, "no mutation does harm: the mutations are too tame");
}
