//! Reading agrees with the file: triangle modes, transforms, windings, number formats.

mod document;

use document::{check, data_uri, floats, modes, read, spoiled, triangle, with};
use downpour_scene::gltf::{TriangleModel, read_triangles, read_triangles_from_bytes};
use downpour_scene::{Budget, WarningKind};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A model of the street.
fn file(name: &str) -> TriangleModel {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes/plain/models");
    let path = std::path::Path::new(folder).join(name);
    let model = read_triangles(&path, &mut Budget::default()).unwrap_or_else(|error| panic!("{error}"));
    check(&model);
    model
}

fn corner(model: &TriangleModel, index: u32) -> [f64; 3] {
    model.positions[index as usize].map(f64::from)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Twice the area of a triangle times its normal.
fn face(model: &TriangleModel, triangle: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|index| corner(model, index));
    cross(minus(b, a), minus(c, a))
}

fn area(model: &TriangleModel) -> f64 {
    model.indices.iter().map(|&t| face(model, t)).map(|n| dot(n, n).sqrt() / 2.0).sum()
}

/// The volume inside a closed surface, positive when its faces look outwards (divergence theorem).
fn volume(model: &TriangleModel) -> f64 {
    model.indices.iter().map(|&t| dot(corner(model, t[0]), face(model, t)) / 6.0).sum()
}

/// A cube of edge 2 around the origin, counter-clockwise from outside, transformed by nodes.
fn cube(nodes: &Value) -> Value {
    let positions: Vec<f32> = (0..8)
        .flat_map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1])
        .map(|bit| if bit == 1 { 1.0 } else { -1.0 })
        .collect();
    let quads: [[u8; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut bytes = floats(&positions);
    bytes.extend(quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]));
    json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 96},
            {"buffer": 0, "byteOffset": 96, "byteLength": 36}
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(&bytes)}]
    })
}

/// A volume is multiplied by the absolute determinant, and faces look outwards after any transform.
#[test]
fn volumes_follow_the_determinant() {
    let half = 0.5f64.sqrt();
    let turned = json!([0.0, half, 0.0, half]);
    for (nodes, factor) in [
        (json!([{"mesh": 0}]), 1.0),
        (json!([{"mesh": 0, "scale": [2, 3, 0.5], "translation": [10, -5, 3], "rotation": turned}]), 3.0),
        (json!([{"mesh": 0, "scale": [-1, 1, 1]}]), 1.0),
        (json!([{"mesh": 0, "scale": [-2, -1, 1], "rotation": [0.5, 0.5, 0.5, 0.5]}]), 2.0),
        (json!([{"mesh": 0, "scale": [-1, -1, -1]}]), 1.0),
        (json!([{"children": [1], "scale": [-1, 4, 1]}, {"mesh": 0, "scale": [1, 1, -0.5]}]), 2.0),
        (json!([{"mesh": 0, "matrix": [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 3, 0, 7, 8, 9, 1]}]), 3.0),
        // Shear keeps the volume.
        (json!([{"mesh": 0, "matrix": [1, 0, 0, 0, 5, 1, 0, 0, 0, 2, 1, 0, 0, 0, 0, 1]}]), 1.0),
        (json!([{"children": [1, 2], "mesh": 0}, {"mesh": 0, "translation": [9, 0, 0]}, {"mesh": 0}]), 3.0),
        // A quaternion that is not of length 1 turns and does not scale.
        (json!([{"mesh": 0, "rotation": [0, 3, 0, 3]}]), 1.0),
    ] {
        let model = read(&cube(&nodes)).expect("valid");
        check(&model);
        let found = volume(&model);
        assert!((found - 8.0 * factor).abs() < 1e-4 * factor, "{nodes}: {found}");
    }
}

/// The world matrix is parent x local, local = translation x rotation x scale.
#[test]
fn transforms_are_in_order() {
    let half = 0.5f64.sqrt();
    let nodes = json!([
        {"children": [1], "translation": [100, 0, 0], "rotation": [0, 0, half, half]},
        {"mesh": 0, "scale": [2, 1, 1], "translation": [1, 0, 0]}
    ]);
    let document = with(triangle(), &[("/nodes", nodes)]);
    let model = read(&document).expect("valid");
    // (x, y) -> scaled (2x, y) -> moved (2x + 1, y) -> a quarter turn (-y, 2x + 1) -> moved by 100.
    for (found, wanted) in
        model.positions.iter().zip([[100.0, 1.0, 0.0], [100.0, 3.0, 0.0], [99.0, 1.0, 0.0]])
    {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-5, "{:?}", model.positions);
        }
    }
    assert!(model.normals.expect("normals").iter().all(|normal| (normal[2] - 1.0).abs() < 1e-6));
}

/// A triangle list, a strip and a fan show the same hexagon; points and lines are left out.
#[test]
fn mesh_primitive_modes() {
    let files = BTreeMap::from([("hexagon.bin".to_owned(), modes::buffer())]);
    let text = modes::document().to_string();
    let model =
        read_triangles_from_bytes("modes", text.as_bytes(), &files, &mut Budget::default()).expect("valid");
    check(&model);
    let skipped = model.warnings.iter().filter(|warning| warning.kind == WarningKind::Ignored).count();
    assert_eq!((skipped, model.warnings.len()), (4, 4), "{:?}", model.warnings);
    let hexagon = 1.5 * 3.0f64.sqrt();
    let (mut areas, mut count) = ([0.0f64; 3], 0);
    for &triangle in &model.indices {
        let normal = face(&model, triangle);
        assert!(normal[2] > 0.0, "{triangle:?} looks away");
        let x = triangle.iter().map(|&index| corner(&model, index)[0]).sum::<f64>() / 3.0;
        // They are at x = -3, 0 and 3.
        areas[((x + 4.5) / 3.0) as usize] += normal[2] / 2.0;
        count += 1;
    }
    assert_eq!(count, 6 + 4 + 6);
    for area in areas {
        assert!((area - hexagon).abs() < 2e-3 * hexagon, "{areas:?} of {hexagon}");
    }
}

/// After mirroring, faces still agree with their normals.
#[test]
fn mirrored_faces_look_the_way_of_their_normals() {
    let mirrors = [[1, 1, 1], [-1, 1, 1], [1, -2, 1], [1, 1, -1], [-1, -1, 1], [-1, -3, -1]];
    let nodes: Vec<Value> = mirrors.iter().map(|scale| json!({"mesh": 0, "scale": scale})).collect();
    let roots: Vec<usize> = (0..nodes.len()).collect();
    let changes = [("/nodes", Value::Array(nodes)), ("/scenes/0/nodes", json!(roots))];
    let model = read(&spoiled(&changes)).expect("valid");
    check(&model);
    assert!(model.warnings.is_empty() && model.indices.len() == mirrors.len(), "{:?}", model.warnings);
    let normals = model.normals.as_ref().expect("it has normals");
    let (mut with, mut against) = (0, 0);
    for &triangle in &model.indices {
        let face = face(&model, triangle);
        let mean = triangle.map(|index| normals[index as usize].map(f64::from));
        let along: f64 = mean.iter().map(|&normal| dot(normal, face)).sum();
        if along > 0.0 { with += 1 } else { against += 1 }
    }
    assert_eq!((with, against), (model.indices.len(), 0));
}

/// Two models of the street: complete, of the right size, with normals.
#[test]
fn things_of_the_street() {
    for (name, triangles, height) in [("bench", 228, 0.86), ("bollard", 252, 0.95)] {
        let model = file(&format!("{name}.gltf"));
        assert!(model.warnings.is_empty() && model.normals.is_some());
        assert_eq!(model.indices.len(), triangles);
        let (low, high) = model.bounds().expect("it is not empty");
        assert!(low[1].abs() < 1e-6 && (high[1] - height).abs() < 1e-4, "{name}: {low:?} {high:?}");
        assert!(area(&model) > 0.01);
    }
}

/// Quantized positions give the cube of their floats: integers scaled by the node, and normalized integers.
#[test]
fn quantized_positions() {
    let plain = read(&cube(&json!([{"mesh": 0}]))).expect("valid");
    let signs: Vec<i32> =
        (0..8).flat_map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1]).map(|bit| bit * 2 - 1).collect();
    type Encode = fn(i32) -> Vec<u8>;
    let formats: [(u32, bool, f64, Encode); 5] = [
        (5120, true, 1.0, |sign| vec![(sign * 127) as i8 as u8]),
        (5120, false, 0.01, |sign| vec![(sign * 100) as i8 as u8]),
        (5122, true, 1.0, |sign| ((sign * 32767) as i16).to_le_bytes().to_vec()),
        (5122, false, 0.001, |sign| ((sign * 1000) as i16).to_le_bytes().to_vec()),
        (5126, false, 1.0, |sign| (sign as f32).to_le_bytes().to_vec()),
    ];
    for (component, normalized, scale, encode) in formats {
        let mut bytes = Vec::new();
        for point in signs.chunks(3) {
            bytes.extend(point.iter().flat_map(|&sign| encode(sign)));
            bytes.resize(bytes.len().next_multiple_of(4), 0xAA);
        }
        let stride = bytes.len() / 8;
        let start = bytes.len();
        let mut document = cube(&json!([{"mesh": 0, "scale": [scale, scale, scale]}]));
        let indices = read(&document).expect("valid").indices;
        bytes.extend(indices.iter().flatten().map(|&index| index as u8));
        document = with(
            document,
            &[
                ("/extensionsUsed", json!(["KHR_mesh_quantization"])),
                ("/extensionsRequired", json!(["KHR_mesh_quantization"])),
                ("/accessors/0/componentType", json!(component)),
                ("/accessors/0/normalized", json!(normalized)),
                ("/bufferViews/0", json!({"buffer": 0, "byteLength": start, "byteStride": stride})),
                ("/bufferViews/1/byteOffset", json!(start)),
                ("/buffers/0", json!({"byteLength": bytes.len(), "uri": data_uri(&bytes)})),
            ],
        );
        let model = read(&document).unwrap_or_else(|error| panic!("{component}: {error}"));
        for (found, wanted) in model.positions.iter().flatten().zip(plain.positions.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-6, "{component} {normalized}: {found} {wanted}");
        }
        assert_eq!(model.indices, plain.indices);
    }
}

/// Sparse values replace those of the base, or zeros without a base.
#[test]
fn sparse_values_replace() {
    let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    bytes.extend(floats(&[9.0; 6]));
    bytes.extend([0, 0, 2, 0]);
    let document = json!({
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "sparse": {
                "count": 2,
                "indices": {"bufferView": 2, "componentType": 5123},
                "values": {"bufferView": 1}
            }
        }],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 4}
        ],
        "buffers": [{"byteLength": 64, "uri": data_uri(&bytes)}]
    });
    assert_eq!(read(&document).expect("valid").positions, [[9.0; 3], [1.0, 0.0, 0.0], [9.0; 3]]);
    let mut bytes = floats(&[4.0, 5.0, 6.0]);
    bytes.extend([1, 0, 0, 0]);
    let document = json!({
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{
            "componentType": 5126, "count": 3, "type": "VEC3",
            "sparse": {
                "count": 1,
                "indices": {"bufferView": 1, "componentType": 5125},
                "values": {"bufferView": 0}
            }
        }],
        "bufferViews": [{"buffer": 0, "byteLength": 12}, {"buffer": 0, "byteOffset": 12, "byteLength": 4}],
        "buffers": [{"byteLength": 16, "uri": data_uri(&bytes)}]
    });
    assert_eq!(read(&document).expect("valid").positions, [[0.0; 3], [4.0, 5.0, 6.0], [0.0; 3]]);
}

/// Indices of all three widths, and none at all.
#[test]
fn widths_of_indices() {
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    for (component, width) in [(5121, 1), (5123, 2), (5125, 4)] {
        let mut bytes = positions.clone();
        bytes.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
        for index in [2u32, 0, 1] {
            bytes.extend(&index.to_le_bytes()[..width]);
        }
        let document = with(
            document::triangle_of(&bytes),
            &[
                ("/accessors/2/componentType", json!(component)),
                ("/bufferViews/2/byteLength", json!(3 * width)),
            ],
        );
        assert_eq!(read(&document).expect("valid").indices, [[2, 0, 1]], "{component}");
    }
    let mut document = triangle();
    document["meshes"][0]["primitives"][0].as_object_mut().expect("an object").remove("indices");
    assert_eq!(read(&document).expect("valid").indices, [[0, 1, 2]]);
}

/// Integers may be written as floats, and `extras` may be any value.
#[test]
fn ways_of_writing() {
    let text = triangle()
        .to_string()
        .replace("\"count\":3", "\"count\":30e-1")
        .replace("\"mesh\":0", "\"mesh\":0.0");
    let model = document::read_bytes(text.as_bytes()).expect("valid");
    assert_eq!(model, read(&triangle()).expect("valid"));
    let extras = json!({"deep": [1e300, {"extensions": 7}]});
    for pointer in ["/extras", "/nodes/0/extras", "/meshes/0/primitives/0/extras"] {
        for value in [extras.clone(), json!(42), json!("text"), Value::Null] {
            assert_eq!(read(&spoiled(&[(pointer, value)])).expect("valid"), model);
        }
    }
}

/// Primitives that share their vertices get them once; missing normals are computed.
#[test]
fn shared_vertices_and_missing_normals() {
    let again = json!({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2});
    let model = read(&spoiled(&[("/meshes/0/primitives/1", again)])).expect("valid");
    assert_eq!((model.positions.len(), model.indices.len()), (3, 2));
    let bare = json!({"attributes": {"POSITION": 0}, "indices": 2});
    let model = read(&spoiled(&[("/meshes/0/primitives/1", bare)])).expect("valid");
    check(&model);
    assert_eq!(model.normals.expect("made"), [[0.0, 0.0, 1.0]; 6]);
    assert!(model.warnings[0].to_string().contains("3 vertices without a normal"));
}

/// The default scene is read, else the first, else every node.
#[test]
fn which_scene_is_read() {
    let nodes = json!([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}]);
    let two = [("/nodes", nodes), ("/scenes", json!([{"nodes": [0]}, {"nodes": [1]}, {}]))];
    let x = |document: &Value| read(document).expect("valid").bounds().map(|(low, high)| (low[0], high[0]));
    let mut document = with(triangle(), &two);
    for (scene, wanted) in [(0, Some((0.0, 1.0))), (1, Some((5.0, 6.0))), (2, None)] {
        document["scene"] = json!(scene);
        assert_eq!(x(&document), wanted);
    }
    document.as_object_mut().expect("an object").remove("scene");
    assert_eq!(x(&document), Some((0.0, 1.0)));
    document.as_object_mut().expect("an object").remove("scenes");
    assert_eq!(x(&document), Some((0.0, 6.0)));
    document.as_object_mut().expect("an object").remove("nodes");
    assert_eq!(x(&document), Some((0.0, 1.0)));
}
