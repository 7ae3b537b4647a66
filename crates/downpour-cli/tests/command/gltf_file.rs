//! Drop models as `.gltf` files whose data is within.

use serde_json::json;

type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// The text of a `.gltf` file of one mesh.
pub(crate) fn gltf(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> String {
    let mut bytes: Vec<u8> = positions.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
    let indices_at = bytes.len();
    bytes.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
        (0..3).map(|k| positions.iter().map(|p| p[k]).reduce(pick).unwrap_or(0.0)).collect()
    };
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": positions.len(), "type": "VEC3",
             "min": bound(f32::min), "max": bound(f32::max)},
            {"bufferView": 1, "componentType": 5125, "count": 3 * triangles.len(), "type": "SCALAR"}
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": indices_at},
            {"buffer": 0, "byteOffset": indices_at, "byteLength": bytes.len() - indices_at}
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes))}]
    })
    .to_string()
}

/// A file without any mesh.
pub(crate) fn empty() -> String {
    json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{}]}).to_string()
}

/// A closed tetrahedron, triangles outward.
pub(crate) fn tetrahedron() -> Mesh {
    let positions = vec![[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    (positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, k| (word << 8) | u32::from(*chunk.get(k).unwrap_or(&0)));
        for k in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * k)) as usize & 63];
            text.push(if k <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}
