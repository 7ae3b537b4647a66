//! A small valid document for tests to spoil, independent of the crate: tests of the command use it too.

use serde_json::{Value, json};

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

/// The document with values set at JSON pointers; a missing last step is added.
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

/// The triangle with values set at JSON pointers.
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
