//! The mesh of a drop as a file that Mitsuba reads.

use downpour_drop::DropShape;
use downpour_drop::mesh::DropMesh;

/// Units of the file per meter. Mitsuba moves the foot of a ray by an epsilon of 9e-5 times its coordinates, but
/// at least times 1, so drops of a millimeter have to be large in its units. The sky is at infinity: nothing else changes.
pub(super) const UNITS_PER_METER: f64 = 1.0e5;

/// A binary PLY with normals: 20 * 4^`subdivisions` triangles.
pub(super) fn ply(shape: &DropShape, subdivisions: u32) -> Result<Vec<u8>, String> {
    let mesh = DropMesh::icosphere(shape, subdivisions).map_err(|error| error.to_string())?;
    Ok(moved_ply(&mesh, 0.0))
}

/// A binary PLY with normals, of a drop whose origin is `height` meters above the world's.
pub(super) fn moved_ply(mesh: &DropMesh, height: f64) -> Vec<u8> {
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {faces}\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for (position, normal) in mesh.positions().iter().zip(mesh.normals()) {
        let [x, y, z] = position.map(f64::from);
        let scaled = [x, y + height, z].map(|p| (p * UNITS_PER_METER) as f32);
        bytes.extend(scaled.iter().chain(normal).flat_map(|v| v.to_le_bytes()));
    }
    for triangle in mesh.triangles() {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_holds_what_its_header_says() {
        let shape = DropShape::new(2.0e-3).expect("in range");
        let bytes = ply(&shape, 2).expect("in range");
        let end = b"end_header\n";
        let header = bytes.windows(end.len()).position(|w| w == end).expect("a header") + end.len();
        let text = std::str::from_utf8(&bytes[..header]).expect("text");
        let (vertices, faces) = (2 + 10 * 16, 20 * 16);
        assert!(text.contains(&format!("element vertex {vertices}\n")), "{text}");
        assert!(text.contains(&format!("element face {faces}\n")), "{text}");
        assert_eq!(bytes.len(), header + vertices * 24 + faces * 13);
        let first: [f32; 3] = std::array::from_fn(|k| {
            let at = header + 4 * k;
            f32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
        });
        let length = first.iter().map(|v| v * v).sum::<f32>().sqrt();
        assert!((90.0..110.0).contains(&length), "a drop of 2 mm has a radius of 100 units: {length}");
    }
}
