//! Normals for vertices without: the sum of the faces at a vertex, weighted by area.

use glam::Vec3;

/// Replaces zero normals and returns their number. All others are unchanged.
pub(super) fn fill(positions: &[[f32; 3]], indices: &[[u32; 3]], normals: &mut [[f32; 3]]) -> usize {
    let bare: Vec<bool> = normals.iter().map(|normal| *normal == [0.0; 3]).collect();
    let count = bare.iter().filter(|bare| **bare).count();
    if count == 0 {
        return 0;
    }
    let at = |index: u32| usize::try_from(index).unwrap_or(usize::MAX);
    let is_bare = |index: u32| bare.get(at(index)).copied().unwrap_or(false);
    for triangle in indices {
        if !triangle.iter().any(|&corner| is_bare(corner)) {
            continue;
        }
        let corner =
            |index| positions.get(at(index)).map_or(Vec3::ZERO, |&position| Vec3::from_array(position));
        let [a, b, c] = triangle.map(corner);
        // Twice the area times the unit normal. Distances below 1e9 keep it far inside the range of f32.
        let face = edge(a, b).cross(edge(a, c)).to_array();
        for &corner in triangle.iter().filter(|&&corner| is_bare(corner)) {
            if let Some(normal) = normals.get_mut(at(corner)) {
                for (sum, part) in normal.iter_mut().zip(face) {
                    *sum += part;
                }
            }
        }
    }
    for (normal, _) in normals.iter_mut().zip(&bare).filter(|(_, bare)| **bare) {
        // A vertex of no face has no better normal than up.
        *normal = Vec3::from_array(*normal).try_normalize().unwrap_or(Vec3::Y).to_array();
    }
    count
}

fn edge(from: Vec3, to: Vec3) -> Vec3 {
    Vec3::new(to.x - from.x, to.y - from.y, to.z - from.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_of_a_cube_leans_equally() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [9.0; 3]];
        let indices = [[0, 2, 1], [0, 1, 3], [0, 3, 2]];
        let mut normals = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]];
        assert_eq!(fill(&positions, &indices, &mut normals), 4);
        let third = -(1.0f32 / 3.0).sqrt();
        for part in normals[0] {
            assert!((part - third).abs() < 1e-6);
        }
        assert_eq!(normals[1], [1.0, 0.0, 0.0]);
        assert_eq!(normals[4], [0.0, 1.0, 0.0]);
        assert_eq!(fill(&positions, &indices, &mut normals), 0);
    }
}
