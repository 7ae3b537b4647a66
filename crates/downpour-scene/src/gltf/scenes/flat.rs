//! Flat normals for primitives without normals, as glTF 2.0 requires (section 3.7.2.1): each triangle gets three
//! separate vertices with the normal of its plane. Tangents of the file are not used then.

use super::vertices::reorder;
use crate::scene::Primitive;
use glam::{DVec3, Vec3};

/// Takes corners apart and gives each the normal of its face.
pub(super) fn shade(part: &mut Primitive) {
    part.tangents.clear();
    let order = std::mem::take(&mut part.indices);
    reorder(part, &order);
    part.indices = (0u32..).take(order.len()).collect();
    part.normals = Vec::with_capacity(part.positions.len());
    for corners in part.positions.chunks_exact(3) {
        let normal = match corners {
            &[a, b, c] => normal(a, b, c),
            _ => Vec3::Y,
        };
        part.normals.extend([normal; 3]);
    }
}

/// The unit normal of a triangle; up for one without area.
fn normal(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let edge = |to: Vec3| {
        let (a, to) = (a.as_dvec3(), to.as_dvec3());
        DVec3::new(to.x - a.x, to.y - a.y, to.z - a.z)
    };
    edge(b).cross(edge(c)).try_normalize().map_or(Vec3::Y, DVec3::as_vec3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folded_square_has_two_normals() {
        let mut part = Primitive {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            colors: Some(vec![
                [0.0, 0.1, 0.2, 1.0].into(),
                [1.0; 4].into(),
                [0.5; 4].into(),
                [0.0; 4].into(),
            ]),
            indices: vec![0, 1, 2, 0, 3, 1, 3, 3, 3],
            ..Primitive::default()
        };
        shade(&mut part);
        assert_eq!(part.indices, (0..9).collect::<Vec<u32>>());
        assert_eq!(part.normals, [[Vec3::Z; 3], [Vec3::Y; 3], [Vec3::Y; 3]].concat());
        assert_eq!(part.positions[4], Vec3::Z);
        assert_eq!(part.colors.unwrap()[4], [0.0; 4].into());
    }
}
