//! A street of blocks, 90 m long: so simple that the time of a frame is mostly that of its rain.

/// Half the width of the road, m, and of the street between the houses: these are farther from the camera than drops are
/// drawn, so that only the volumes lose drops, and no wall hides them.
const ROAD_M: f64 = 4.5;
const STREET_M: f64 = 10.5;

/// Half the length of the street, m.
const LENGTH_M: f64 = 45.0;

/// Length and depth of a house, m.
const HOUSE_M: [f64; 2] = [9.0, 8.0];

/// Names of the materials, with linear reflectance and roughness.
pub(super) const MATERIALS: [(&str, [f64; 3], f64); 7] = [
    ("road", [0.055, 0.055, 0.06], 0.3),
    ("pavement", [0.2, 0.19, 0.18], 0.6),
    ("brick", [0.28, 0.1, 0.07], 0.9),
    ("plaster", [0.55, 0.5, 0.42], 0.9),
    ("ochre", [0.45, 0.3, 0.12], 0.9),
    ("slate", [0.17, 0.2, 0.24], 0.9),
    ("window", [0.02, 0.025, 0.03], 0.15),
];
const ROAD: usize = 0;
const PAVEMENT: usize = 1;
const WALLS: [usize; 4] = [2, 3, 4, 5];
const WINDOW: usize = 6;

/// A block with its edges along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// Number of its material.
    pub(super) material: usize,
    /// m.
    pub(super) middle: [f64; 3],
    /// Edges, m.
    pub(super) size: [f64; 3],
}

/// All blocks.
pub(super) fn blocks() -> Vec<Block> {
    let long = 2.0 * LENGTH_M;
    let mut blocks =
        vec![Block { material: ROAD, middle: [0.0, -0.25, 0.0], size: [40.0, 0.5, long + 40.0] }];
    let [length, depth] = HOUSE_M;
    let count = (long / length) as u32;
    for (side, first) in [(-1.0, 0), (1.0, 2)] {
        let middle = side * 0.5 * (ROAD_M + STREET_M);
        let width = STREET_M - ROAD_M;
        blocks.push(Block { material: PAVEMENT, middle: [middle, 0.0, 0.0], size: [width, 0.3, long] });
        for k in 0..count {
            let z = -LENGTH_M + (f64::from(k) + 0.5) * length;
            // Heights and colors of neighbors differ.
            let height = 7.0 + f64::from((5 * k + first) % 4) * 1.3;
            let material = WALLS[((k + first) % 4) as usize];
            let x = side * (STREET_M + 0.5 * depth);
            blocks.push(Block { material, middle: [x, 0.5 * height, z], size: [depth, height, length] });
            for (row, column) in [(0, -1), (0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] {
                let (y, along) = (2.0 + 2.8 * f64::from(row), z + 2.8 * f64::from(column));
                let middle = [side * STREET_M, y, along];
                blocks.push(Block { material: WINDOW, middle, size: [0.1, 1.6, 1.1] });
            }
        }
    }
    for (side, material) in [(-1.0, WALLS[1]), (1.0, WALLS[3])] {
        let z = side * (LENGTH_M + 0.5 * depth);
        blocks.push(Block { material, middle: [0.0, 5.0, z], size: [40.0, 10.0, depth] });
    }
    blocks
}

/// Positions and normals of a cube with edges of 1 about the origin, and its triangles, counter-clockwise from outside.
pub(super) fn cube() -> (Vec<[f64; 3]>, Vec<[f64; 3]>, Vec<u16>) {
    let (mut positions, mut normals, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let at = |u: f64, v: f64| {
                let mut position = [0.0; 3];
                position[axis] = 0.5 * side;
                // In the order of the axes these two and the side's are right-handed.
                position[(axis + 1) % 3] = 0.5 * u * side;
                position[(axis + 2) % 3] = 0.5 * v;
                position
            };
            let mut normal = [0.0; 3];
            normal[axis] = side;
            let first = positions.len() as u16;
            positions.extend([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
            normals.extend([normal; 4]);
            corners.extend([0, 1, 2, 0, 2, 3].map(|k: u16| first + k));
        }
    }
    (positions, normals, corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_faces_outwards() {
        let (positions, normals, corners) = cube();
        assert_eq!((positions.len(), normals.len(), corners.len()), (24, 24, 36));
        for triangle in corners.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| positions[usize::from(triangle[k])]);
            let normal = normals[usize::from(triangle[0])];
            let edge = |to: [f64; 3]| [to[0] - a[0], to[1] - a[1], to[2] - a[2]];
            let (p, q) = (edge(b), edge(c));
            let cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
            assert_eq!(cross, normal);
            assert_eq!((0..3).map(|k| a[k] * normal[k]).sum::<f64>(), 0.5);
        }
    }

    /// Walls are farther from the camera than any drop, and the road is below it.
    #[test]
    fn the_way_is_free() {
        for step in 0..=40u32 {
            let eye = super::super::walk::eye(f64::from(step) * 0.05).position;
            for block in blocks() {
                let away = (0..3).map(|k| (eye[k] - block.middle[k]).abs() - 0.5 * block.size[k]);
                let least = if block.size[1] > 1.0 { super::super::weather::FAR_M } else { 1.0 };
                assert!(away.reduce(f64::max) > Some(least), "{block:?}");
            }
        }
    }
}
