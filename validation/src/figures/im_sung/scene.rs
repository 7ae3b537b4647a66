//! The glTF of the figures: a street of blocks, and a camera that goes along it.

use downpour_math::ops::f64 as ops;
use serde_json::{Value, json};

use super::blocks::{MATERIALS, blocks, cube};
use super::walk::{BEGIN_M, Eye, FOV_DEG, NEAR_M, eye, frames};

const FLOAT: u32 = 5126;
const SHORT: u32 = 5123;

/// A buffer, its views and accessors, which have the same numbers.
#[derive(Debug, Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    fn put(
        &mut self,
        bytes: &[u8],
        kind: u32,
        form: &str,
        count: usize,
        bounds: Option<[Value; 2]>,
    ) -> usize {
        let number = self.views.len();
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        let mut accessor =
            json!({ "bufferView": number, "componentType": kind, "count": count, "type": form });
        if let Some([least, most]) = bounds {
            accessor["min"] = least;
            accessor["max"] = most;
        }
        self.accessors.push(accessor);
        number
    }

    fn floats(&mut self, values: &[f64], form: &str, width: usize, bounds: Option<[Value; 2]>) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|&value| (value as f32).to_le_bytes()).collect();
        self.put(&bytes, FLOAT, form, values.len() / width, bounds)
    }
}

/// Text of the glTF and its buffer, a file beside it with the name `file`.
///
/// The animation has a key for each frame, and one more: it repeats at the time of its last key.
pub(super) fn gltf(fps: u32, file: &str) -> (String, Vec<u8>) {
    let mut buffer = Buffer::default();
    let times: Vec<f64> = (0..=frames(fps)).map(|k| f64::from(k) / f64::from(fps)).collect();
    let eyes: Vec<Eye> = times.iter().map(|&time| eye(time)).collect();
    let last = times.last().map_or(0.0, |&time| f64::from(time as f32));
    let time = buffer.floats(&times, "SCALAR", 1, Some([json!([0.0]), json!([last])]));
    let positions: Vec<f64> = eyes.iter().flat_map(|eye| eye.position).collect();
    let position = buffer.floats(&positions, "VEC3", 3, None);
    let turns: Vec<f64> =
        eyes.iter().flat_map(|eye| [0.0, ops::sin(0.5 * eye.yaw), 0.0, ops::cos(0.5 * eye.yaw)]).collect();
    let turn = buffer.floats(&turns, "VEC4", 4, None);
    let (corners, normals, triangles) = cube();
    let bounds = [json!([-0.5, -0.5, -0.5]), json!([0.5, 0.5, 0.5])];
    let corner = buffer.floats(&corners.concat(), "VEC3", 3, Some(bounds));
    let normal = buffer.floats(&normals.concat(), "VEC3", 3, None);
    let indices: Vec<u8> = triangles.iter().flat_map(|index| index.to_le_bytes()).collect();
    let index = buffer.put(&indices, SHORT, "SCALAR", triangles.len(), None);

    let material = |&(name, [red, green, blue], roughness): &(&str, [f64; 3], f64)| {
        let surface = json!({
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": roughness,
        });
        json!({ "name": name, "pbrMetallicRoughness": surface })
    };
    let mesh = |material: usize| {
        let attributes = json!({ "POSITION": corner, "NORMAL": normal });
        json!({ "primitives": [{ "attributes": attributes, "indices": index, "material": material }] })
    };
    let mut nodes = vec![json!({ "name": "eye", "camera": 0, "translation": BEGIN_M })];
    nodes.extend(
        blocks().iter().map(|b| json!({ "mesh": b.material, "translation": b.middle, "scale": b.size })),
    );
    let text = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<usize>>() }],
        "nodes": nodes,
        "materials": MATERIALS.iter().map(material).collect::<Vec<Value>>(),
        "meshes": (0..MATERIALS.len()).map(mesh).collect::<Vec<Value>>(),
        "cameras": [{
            "type": "perspective",
            "perspective": { "yfov": FOV_DEG.to_radians(), "znear": NEAR_M },
        }],
        "animations": [{
            "name": "walk",
            "samplers": [
                { "input": time, "output": position, "interpolation": "LINEAR" },
                { "input": time, "output": turn, "interpolation": "LINEAR" },
            ],
            "channels": [
                { "sampler": 0, "target": { "node": 0, "path": "translation" } },
                { "sampler": 1, "target": { "node": 0, "path": "rotation" } },
            ],
        }],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "uri": file, "byteLength": buffer.bytes.len() }],
    });
    (format!("{text:#}\n"), buffer.bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The file holds the path, and the animation is longer than the clip.
    #[test]
    fn the_file_holds_the_path() {
        let (text, bytes) = gltf(12, "walk.bin");
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["buffers"][0]["byteLength"], bytes.len());
        let numbers: Vec<f32> =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().expect("four bytes"))).collect();
        let view = |accessor: usize, width: usize| {
            let view = &value["bufferViews"]
                [value["accessors"][accessor]["bufferView"].as_u64().expect("a view") as usize];
            let begin = view["byteOffset"].as_u64().expect("offset") as usize / 4;
            let count = value["accessors"][accessor]["count"].as_u64().expect("count") as usize;
            assert_eq!(view["byteLength"].as_u64(), Some((count * width * 4) as u64));
            numbers[begin..begin + count * width].to_vec()
        };
        let (times, positions, turns) = (view(0, 1), view(1, 3), view(2, 4));
        assert!(f64::from(*times.last().expect("times")) > f64::from(frames(12) - 1) / 12.0);
        for (k, &time) in times.iter().enumerate() {
            let eye = eye(time.into());
            for (axis, position) in eye.position.iter().enumerate() {
                assert!((f64::from(positions[3 * k + axis]) - position).abs() < 1.0e-5);
            }
            // Viewing direction of the camera, -Z rotated by the quaternion.
            let [x, y, z, w] = [0, 1, 2, 3].map(|n| f64::from(turns[4 * k + n]));
            let forward = [-2.0 * (x * z + w * y), -2.0 * (y * z - w * x), -(1.0 - 2.0 * (x * x + y * y))];
            let expected = [-ops::sin(eye.yaw), 0.0, -ops::cos(eye.yaw)];
            for (found, expected) in forward.iter().zip(expected) {
                assert!((found - expected).abs() < 1.0e-5, "{time}: {forward:?}");
            }
        }
    }
}
