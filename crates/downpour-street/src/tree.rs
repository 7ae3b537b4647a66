//! A young lime tree, its leaves as small clusters on cards; and the grate in the pavement around its foot.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use crate::material::Material;
use crate::mesh::{BELOW, Mesh, Vertex, plain, tinted};
use crate::noise::{hash, mix, smooth};
use crate::textures::CLUSTERS;

/// Middle of the crown and its half axes, meters.
const CROWN: Vec3 = Vec3::new(0.05, 3.75, 0.03);
const HALF_AXES: Vec3 = Vec3::new(1.40, 1.72, 1.34);
/// Twigs with leaves, and cards on each.
const TWIGS: i32 = 125;
const CARDS: i32 = 11;
/// Half the edge of the grate.
pub(crate) const GRATE_M: f32 = 0.60;

/// A point at random directions within the unit sphere, near its surface more often.
fn direction(id: i32) -> Vec3 {
    let r = |n: i32| hash(id, n, 405);
    let (y, turn) = (mix(-0.92, 1.0, r(0)), r(1) * std::f32::consts::TAU);
    let flat = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(flat * ops::cos(turn), y, flat * ops::sin(turn))
}

/// The tree, 5.5 m high.
pub(crate) fn tree() -> Mesh {
    let mut mesh = Mesh::default();
    let bark = plain(Material::Bark);
    let trunk: Vec<(Vec3, f32)> = (0..=8)
        .map(|k| {
            let t = k as f32 / 8.0;
            let sway = Vec3::new(0.10 * ops::sin(3.1 * t), 0.0, 0.07 * ops::sin(4.3 * t + 1.0));
            let foot = 0.05 * (1.0 - t) * (1.0 - t) * (1.0 - t);
            (sway + Vec3::Y * (4.6 * t - 0.1), mix(0.095, 0.022, t) + foot)
        })
        .collect();
    mesh.tube(bark, &trunk, 9);
    for twig in 0..TWIGS {
        let r = |n: i32| hash(twig, n, 406);
        let way = direction(twig);
        // The outline is uneven: limbs reach farther on some sides, the sky is seen between others.
        let lobes = ops::sin(3.0 * way.x + 4.0 * way.y + 1.0) * ops::sin(3.6 * way.z - 2.0 * way.y + 0.4);
        let reach = mix(0.50, 1.0, r(2).sqrt()) * (1.0 + 0.16 * lobes);
        let tip = CROWN + way * HALF_AXES * reach;
        // It rises from the trunk, steeper below.
        let from = trunk[(2.0 + 5.0 * smooth(2.2, 5.2, tip.y - 0.5)) as usize].0;
        let bend = from.lerp(tip, 0.55) - Vec3::Y * 0.12;
        if twig % 4 == 0 {
            mesh.tube(bark, &[(from, 0.018), (bend, 0.010), (tip, 0.004)], 4);
        }
        let along = (tip - bend).normalize_or_zero();
        let hue = Vec3::new(mix(0.62, 0.98, r(3)), mix(0.78, 0.94, r(4)), mix(0.60, 1.0, r(5)));
        for leaf in 0..CARDS {
            let id = twig * CARDS + leaf;
            let q = |n: i32| hash(id, n, 407);
            let jitter = Vec3::new(q(0) - 0.5, q(1) - 0.55, q(2) - 0.5) * 0.46;
            let at = tip - along * (0.55 * q(3)) + jitter;
            let off = (at - CROWN) / HALF_AXES;
            // Leaves within the crown and on its lower side get less of the sky.
            let depth = mix(0.34, 1.0, smooth(0.25, 1.05, off.length()));
            let height = mix(0.66, 1.0, smooth(-0.9, 0.7, off.y));
            let tint = hue * (depth * height * mix(0.85, 1.0, q(4)));
            card(&mut mesh, at, mix(0.20, 0.31, q(5)), off.normalize_or_zero(), tint, id);
        }
    }
    mesh
}

/// A card with a cluster of leaves. Its front looks out of the crown, and its normals are bent that way, so that the crown is shaded
/// as one body.
pub(crate) fn card(mesh: &mut Mesh, center: Vec3, size: f32, out: Vec3, tint: Vec3, id: i32) {
    let r = |n: i32| hash(id, n, 411);
    let random = Vec3::new(r(0) - 0.5, r(1) - 0.5, r(2) - 0.5) * 2.2;
    let drawn = (out * 0.55 + Vec3::Y * 0.35 + random).normalize_or(Vec3::Y);
    let facing = if drawn.dot(out) < 0.0 { -drawn } else { drawn };
    let side = facing.any_orthonormal_vector();
    let up = facing.cross(side);
    let (c, s) = (ops::cos(r(3) * std::f32::consts::TAU), ops::sin(r(3) * std::f32::consts::TAU));
    let (right, up) = (side * c + up * s, up * c - side * s);
    let normal = (out * 0.75 + facing * 0.45 + Vec3::Y * 0.2).normalize_or(Vec3::Y);
    let cell = (r(4) * (CLUSTERS * CLUSTERS) as f32) as u32;
    let (column, row) = ((cell % CLUSTERS) as f32, (cell / CLUSTERS) as f32);
    let part = mesh.part(Material::Leaf);
    let first = part.vertices.len() as u32;
    for [x, y] in [[-0.5f32, -0.5f32], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
        // Bent along a diagonal, as leaves hang.
        let droop = facing * (-0.16 * size * (x + y) * (x + y));
        part.vertices.push(Vertex {
            position: center + (right * x + up * y) * size + droop,
            normal,
            uv: Vec2::new(column + x + 0.5, row + 0.5 - y) / CLUSTERS as f32,
            tint,
        });
    }
    part.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
}

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
    fn a_tree_has_the_size_of_a_young_lime() {
        let mesh = tree();
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for vertex in mesh.parts.values().flat_map(|part| &part.vertices) {
            (low, high) = (low.min(vertex.position), high.max(vertex.position));
        }
        let size = high - low;
        assert!((5.2..6.3).contains(&high.y) && (2.4..4.0).contains(&size.x), "{low} {high}");
        assert!(mesh.triangle_count() < 5000, "{}", mesh.triangle_count());
    }

    /// Cards that face outwards are lit as one body: no normal points into the crown or behind its card.
    #[test]
    fn leaves_look_out_of_the_crown() {
        let mesh = tree();
        let part = &mesh.parts[&Material::Leaf];
        for triangle in part.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| part.vertices[triangle[k] as usize]);
            let face = (b.position - a.position).cross(c.position - a.position).normalize();
            assert!(face.dot(a.normal) > 0.0, "{} {face} {}", a.position, a.normal);
        }
    }

    #[test]
    fn a_grate_lies_in_its_pavement() {
        let mesh = grate(0.02);
        for vertex in &mesh.parts[&Material::Iron].vertices {
            let over = vertex.position.y - 0.02 * vertex.position.x;
            assert!((-1e-6..0.0141).contains(&over), "{over}");
        }
    }
}
