//! A model as files.

use std::path::Path;

/// Writes a mesh as `floor.gltf` and `floor.bin` into a folder: positions, m, and three indices for each triangle.
pub(crate) fn write(folder: &Path, positions: &[[f32; 3]], indices: &[u32]) -> std::io::Result<()> {
    let places: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let corners: Vec<u8> = indices.iter().flat_map(|k| k.to_le_bytes()).collect();
    let (first, second) = (places.len(), corners.len());
    let bound = |pick: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|k| positions.iter().map(|p| p[k]).reduce(pick).unwrap_or_default())
    };
    let model = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "buffers":[{{"uri":"floor.bin","byteLength":{}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{first}}},{{"buffer":0,"byteOffset":{first},"byteLength":{second}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":{:?},"max":{:?}}},
        {{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}}"#,
        first + second,
        positions.len(),
        bound(f32::min),
        bound(f32::max),
        indices.len()
    );
    std::fs::write(folder.join("floor.bin"), [places, corners].concat())?;
    std::fs::write(folder.join("floor.gltf"), model)
}
