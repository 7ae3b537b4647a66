//! The grate in the pavement around the foot of a tree.

use glam::Vec3;

use crate::material::Material;
use crate::mesh::{BELOW, Mesh, plain, tinted};
use crate::noise::mix;

/// Half the edge of the grate, meters.
pub(crate) const GRATE_M: f32 = 0.60;

/// The grate, in the plane of a pavement that rises by `slope` along x: bars of cast iron over earth, open around the trunk.
pub(crate) fn grate(slope: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, [0.085, 0.078, 0.07]);
    let half = GRATE_M;
    mesh.block(plain(Material::Soil), [-half, -0.03, -half], [2.0 * half, 0.034, 2.0 * half]);
    let mut bar = |x: [f32; 2], z: [f32; 2]| {
        mesh.cuboid(iron, Vec3::new(x[0], 0.0, z[0]), Vec3::new(x[1], 0.014, z[1]), BELOW);
    };
    for side in [-1.0f32, 1.0] {
        let (a, b) = (side * half, side * (half - 0.05));
        bar([a.min(b), a.max(b)], [-half, half]);
        bar([0.05 - half, half - 0.05], [a.min(b), a.max(b)]);
    }
    const BARS: i32 = 17;
    const HOLE_M: f32 = 0.21;
    for k in 0..BARS {
        let x = mix(0.08 - half, half - 0.08, k as f32 / (BARS - 1) as f32);
        let (w, end) = (0.019, half - 0.05);
        let hole = (HOLE_M * HOLE_M - x * x).max(0.0).sqrt();
        if hole > 0.0 {
            bar([x - w, x + w], [-end, -hole]);
            bar([x - w, x + w], [hole, end]);
        } else {
            bar([x - w, x + w], [-end, end]);
        }
    }
    for side in [-1.0f32, 1.0] {
        let z = side * 0.30;
        bar([0.05 - half, half - 0.05], [z - 0.02, z + 0.02]);
    }
    for part in mesh.parts.values_mut() {
        for vertex in &mut part.vertices {
            vertex.position.y += slope * vertex.position.x;
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grate_lies_in_its_pavement() {
        let mesh = grate(0.02);
        for vertex in &mesh.parts[&Material::Iron].vertices {
            let over = vertex.position.y - 0.02 * vertex.position.x;
            assert!((-1e-6..0.0141).contains(&over), "{over}");
        }
    }
}
