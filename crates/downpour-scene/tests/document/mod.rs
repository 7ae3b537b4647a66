//! A small valid document for tests to spoil.

#![allow(dead_code, reason = "each test binary uses its part of this module")]

use downpour_scene::beneath::NoFiles;
use downpour_scene::gltf::{TriangleModel, read_triangles_from_bytes};
use downpour_scene::scene::{Scene, skin_primitive};
use downpour_scene::{Budget, SceneError};
use serde_json::{Value, json};
use std::path::PathBuf;

/// The folder of test files.
pub(crate) fn data() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data"))
}

/// Base64 as an address.
pub(crate) fn data_uri(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::from("data:application/octet-stream;base64,");
    for group in bytes.chunks(3) {
        let word = group.iter().enumerate().fold(0u32, |word, (i, &b)| word | u32::from(b) << (16 - 8 * i));
        for i in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= group.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

/// Little-endian bytes of floats.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// One triangle with normals and 16-bit indices; 36 + 36 + 8 bytes in one buffer, three views, three accessors.
pub(crate) fn triangle() -> Value {
    let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    bytes.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    triangle_of(&bytes)
}

/// The same document on other bytes.
pub(crate) fn triangle_of(bytes: &[u8]) -> Value {
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 0, "byteOffset": 72, "byteLength": 8}
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(bytes)}]
    })
}

/// The document with values put at JSON pointers; a last step that is missing is added.
pub(crate) fn with(mut document: Value, changes: &[(&str, Value)]) -> Value {
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer begins with /");
        let parent = document.pointer_mut(parent).unwrap_or_else(|| panic!("no {parent}"));
        match parent {
            Value::Array(items) => match key.parse::<usize>() {
                Ok(index) if index < items.len() => items[index] = value.clone(),
                _ => items.push(value.clone()),
            },
            _ => parent[key] = value.clone(),
        }
    }
    document
}

/// The triangle with values put at JSON pointers.
pub(crate) fn spoiled(changes: &[(&str, Value)]) -> Value {
    with(triangle(), changes)
}

/// A GLB of a JSON and a binary chunk.
pub(crate) fn glb(json: &[u8], binary: Option<&[u8]>) -> Vec<u8> {
    let mut chunks = Vec::new();
    for (kind, data, pad) in [(0x4E4F_534Au32, Some(json), b' '), (0x004E_4942, binary, 0)] {
        let Some(data) = data else { continue };
        let mut data = data.to_vec();
        data.resize(data.len().next_multiple_of(4), pad);
        chunks.extend((data.len() as u32).to_le_bytes());
        chunks.extend(kind.to_le_bytes());
        chunks.extend(data);
    }
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((chunks.len() as u32 + 12).to_le_bytes());
    bytes.extend(chunks);
    bytes
}

/// Reads a document that needs no other files.
pub(crate) fn read(document: &Value) -> Result<TriangleModel, SceneError> {
    read_bytes(document.to_string().as_bytes())
}

/// Reads bytes that need no other files.
pub(crate) fn read_bytes(bytes: &[u8]) -> Result<TriangleModel, SceneError> {
    read_triangles_from_bytes("test", bytes, &NoFiles, &mut Budget::default())
}

/// What is promised of every model.
pub(crate) fn check(model: &TriangleModel) {
    let finite = |vectors: &[[f32; 3]]| vectors.iter().flatten().all(|part| part.is_finite());
    assert!(finite(&model.positions));
    assert!(model.positions.iter().flatten().all(|part| part.abs() <= 1e9));
    if let Some(normals) = &model.normals {
        assert_eq!(normals.len(), model.positions.len());
        for normal in normals {
            let square: f32 = normal.iter().map(|part| part * part).sum();
            assert!((square - 1.0).abs() < 1e-5, "{normal:?}");
        }
    }
    assert!(model.indices.iter().flatten().all(|&index| (index as usize) < model.positions.len()));
}

/// What is promised of every message: one line, no control characters, not endless.
pub(crate) fn check_message(message: &str) {
    assert!(!message.chars().any(char::is_control), "{message:?}");
    assert!(message.chars().count() < 600, "{message}");
}

/// What is promised of every scene: no number without end, no index that leads nowhere, in any pose.
pub(crate) fn check_scene(scene: &Scene) {
    for part in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let count = part.positions.len();
        assert!(count > 0 && part.positions.iter().all(|p| p.abs().max_element() <= 1e9));
        assert!(part.normals.len() == count && part.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
        for list in [part.tangents.len(), part.uvs[0].len(), part.uvs[1].len(), part.joints.len()] {
            assert!(list == 0 || list == count);
        }
        assert!(part.tangents.iter().all(|t| (t.truncate().length() - 1.0).abs() < 1e-3 && t.w.abs() == 1.0));
        assert!(part.uvs.iter().flatten().all(|uv| uv.is_finite()));
        assert!(part.weights.iter().all(|w| (w.iter().sum::<f32>() - 1.0).abs() < 1e-5));
        assert_eq!(part.weights.len(), part.joints.len());
        assert!(part.indices.len() % 3 == 0 && part.indices.iter().all(|&index| (index as usize) < count));
        assert!(part.material < scene.materials.len());
    }
    for material in &scene.materials {
        assert!(material.textures().all(|used| used.texture < scene.textures.len() && used.uv_set < 2));
        assert!(material.textures().all(|used| used.transform.is_finite()));
        assert!(material.emissive.min_element() >= 0.0);
    }
    for node in &scene.nodes {
        assert!(node.mesh.is_none_or(|mesh| mesh < scene.meshes.len()));
        assert!(node.skin.is_none_or(|skin| skin < scene.skins.len()));
        assert!(node.light.is_none_or(|light| light < scene.lights.len()));
    }
    let poses = (0..scene.animations.len().min(3)).flat_map(|i| [0.0, 0.37, 1.9].map(|time| (Some(i), time)));
    for (animation, time) in poses.chain([(None, 0.0)]) {
        let pose = scene.pose(animation, time);
        for instance in &pose.instances {
            assert!(instance.world.is_finite() && instance.normal.is_finite());
            for part in &scene.meshes[instance.mesh].primitives {
                let last = part.joints.iter().flatten().max().map_or(0, |&joint| usize::from(joint));
                assert!(!part.is_skinned() || instance.joints.is_empty() || last < instance.joints.len());
                let skinned = skin_primitive(part, instance);
                assert!(skinned.positions.iter().chain(&skinned.normals).all(|v| v.is_finite()));
            }
        }
        assert!(pose.lights.iter().all(|light| light.position.is_finite() && light.direction.is_finite()));
        assert!(pose.cameras.iter().all(|eye| eye.eye.is_finite() && eye.up.dot(eye.forward).abs() < 1e-5));
    }
}
