//! One hexagon of radius 1 in each of the seven primitive modes, side by side, with its buffer in a separate file.

use super::triangle::floats;
use serde_json::{Value, json};

/// Bytes of `hexagon.bin`: the middle, six corners counter-clockwise, and the lists of indices.
pub(crate) fn buffer() -> Vec<u8> {
    let half = 0.75f32.sqrt();
    let corners = [[1.0, 0.0], [0.5, half], [-0.5, half], [-1.0, 0.0], [-0.5, -half], [0.5, -half]];
    let mut bytes = floats(&[0.0; 3]);
    for [x, y] in corners {
        bytes.extend(floats(&[x, y, 0.0]));
    }
    for list in lists() {
        bytes.extend(list.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

/// Indices of points, lines, a loop, a strip of lines, triangles, a strip of them and a fan: in the order of glTF's modes.
fn lists() -> [&'static [u16]; 7] {
    [
        &[1, 2, 3, 4, 5, 6],
        &[1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 1],
        &[1, 2, 3, 4, 5, 6],
        &[1, 2, 3, 4, 5, 6, 1],
        &[0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 1],
        // Of six corners, from one end to the other.
        &[1, 2, 6, 3, 5, 4],
        &[0, 1, 2, 3, 4, 5, 6, 1],
    ]
}

/// The document: the shape of mode k is at x = 3 (k - 5).
pub(crate) fn document() -> Value {
    let mut offset = 84;
    let mut views = vec![json!({"buffer": 0, "byteLength": 84})];
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": 5126, "count": 7, "type": "VEC3",
        "min": [-1, -1, 0], "max": [1, 1, 0]
    })];
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    for (mode, list) in lists().iter().enumerate() {
        views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": 2 * list.len()}));
        accessors.push(json!({
            "bufferView": mode + 1, "componentType": 5123, "count": list.len(), "type": "SCALAR"
        }));
        let primitive =
            json!({"attributes": {"POSITION": 0}, "indices": mode + 1, "mode": mode, "material": 0});
        meshes.push(json!({"primitives": [primitive]}));
        nodes.push(json!({"mesh": mode, "translation": [3.0 * (mode as f64 - 5.0), 0, 0]}));
        offset += 2 * list.len();
    }
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3, 4, 5, 6]}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [{"name": "plain"}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": "hexagon.bin", "byteLength": offset}]
    })
}
