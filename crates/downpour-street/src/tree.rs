//! A young lime tree: a trunk, limbs that bend up to the light, branches on them, and twigs with leaves along those.

pub(crate) mod foliage;
pub(crate) mod grate;

use downpour_math::ops;
use glam::Vec3;

use crate::material::Material;
use crate::mesh::{Mesh, plain};
use crate::noise::{hash, mix, smooth};
use foliage::Twig;

/// Middle of the crown and its half axes, meters.
const CROWN: Vec3 = Vec3::new(0.05, 3.75, 0.03);
const HALF_AXES: Vec3 = Vec3::new(1.45, 1.85, 1.40);
/// Height up to which the trunk is kept clear of limbs, and its end, meters.
const CLEAR_M: f32 = 1.95;
const TRUNK_M: f32 = 5.0;
/// Limbs, from the lowest to the highest.
const LIMBS: i32 = 13;
/// Turn from one limb to the next, or from one twig to the next: the golden angle.
const TURN: f32 = 2.399_963;

/// Centers and radii of a branch, from its foot to its tip.
type Path = Vec<(Vec3, f32)>;

/// The tree, 5.5 m high.
pub(crate) fn tree() -> Mesh {
    let mut mesh = Mesh::default();
    let bark = plain(Material::Bark);
    let trunk = trunk();
    let tip = trunk.last().map(|&(top, radius)| (top + Vec3::Y * radius, 0.0));
    mesh.tube(bark, &trunk.iter().copied().chain(tip).collect::<Path>(), 10);
    leaves(&mut mesh, &trunk, 0.86, 9, 1);
    for k in 0..LIMBS {
        let limb = limb(&trunk, k);
        mesh.tube(bark, &limb, 6);
        leaves(&mut mesh, &limb, 0.80, 4, 100 + k);
        let height = k as f32 / (LIMBS - 1) as f32;
        let count = mix(6.4, 3.6, height) as i32;
        for n in 0..count {
            let id = 20 * k + n;
            let branch = branch(&limb, (n as f32 + 0.6) / count as f32, mix(1.0, 0.62, height), id);
            mesh.tube(bark, &branch, 3);
            leaves(&mut mesh, &branch, 0.30, 7, 200 + id);
        }
    }
    mesh
}

/// The trunk: it sways a little, tapers, and spreads at its foot.
fn trunk() -> Path {
    (0..=10)
        .map(|k| {
            let t = k as f32 / 10.0;
            let sway = Vec3::new(0.10 * ops::sin(3.1 * t), 0.0, 0.07 * ops::sin(4.3 * t + 1.0));
            let foot = 0.055 * (1.0 - smooth(0.0, 0.16, t));
            (sway + Vec3::Y * ((TRUNK_M + 0.1) * t - 0.1), mix(0.082, 0.012, t) + foot)
        })
        .collect()
}

/// A limb of the trunk: the lowest reach far out and rise late, the highest go up.
fn limb(trunk: &[(Vec3, f32)], k: i32) -> Path {
    let r = |n: i32| hash(k, n, 404);
    let t = k as f32 / (LIMBS - 1) as f32;
    let foot = mix(CLEAR_M, 4.35, t) / TRUNK_M;
    let (from, thick) = at(trunk, foot);
    let turn = TURN * k as f32 + 0.7 * (r(0) - 0.5);
    let out = Vec3::new(ops::cos(turn), 0.0, ops::sin(turn));
    let reach = mix(1.18, 0.42, t * t) * mix(0.82, 1.10, r(1));
    let rise = mix(0.75, 0.95, t) * mix(0.85, 1.15, r(2));
    let to = from + out * reach + Vec3::Y * rise;
    let bend = from + out * (0.62 * reach) + Vec3::Y * (mix(0.22, 0.45, t) * rise);
    path([from, bend, to], [thick * mix(0.42, 0.60, t), 0.007], 6, 0.035, 500 + k)
}

/// A branch of a limb at a part of its length, on alternate sides.
fn branch(limb: &[(Vec3, f32)], part: f32, scale: f32, id: i32) -> Path {
    let r = |n: i32| hash(id, n, 405);
    let along = mix(0.22, 0.97, part);
    let (from, thick) = at(limb, along);
    let tangent = (at(limb, along + 0.03).0 - at(limb, along - 0.03).0).normalize_or(Vec3::Y);
    let across = tangent.cross(Vec3::Y).normalize_or(Vec3::X);
    let side = if id % 2 == 0 { 1.0 } else { -1.0 };
    let spread = across * (side * mix(0.45, 0.95, r(0)));
    let way =
        (tangent * mix(0.35, 0.8, r(1)) + spread + Vec3::Y * mix(-0.30, 0.55, r(2))).normalize_or(Vec3::Y);
    let length = scale * mix(0.86, 0.44, part) * mix(0.8, 1.15, r(3));
    let to = from + way * length;
    let bend = from + way * (0.5 * length) - Vec3::Y * (0.10 * length);
    path([from, bend, to], [0.6 * thick, 0.0025], 3, 0.02, 600 + id)
}

/// A curve from the first point to the last, drawn toward the one between them and not quite smooth, as of `steps` pieces.
fn path([from, bend, to]: [Vec3; 3], radii: [f32; 2], steps: i32, wander: f32, id: i32) -> Path {
    (0..=steps)
        .map(|k| {
            let t = k as f32 / steps as f32;
            let r = |n: i32| hash(20 * id + k, n, 406) - 0.5;
            let off = Vec3::new(r(0), r(1), r(2)) * (4.0 * wander * t * (1.0 - t));
            let center = from.lerp(bend, t).lerp(bend.lerp(to, t), t);
            (center + off, mix(radii[0], radii[1], t))
        })
        .collect()
}

/// Point and radius of a path at a part of it, 0 to 1.
fn at(path: &[(Vec3, f32)], part: f32) -> (Vec3, f32) {
    let place = part.clamp(0.0, 1.0) * (path.len() - 1) as f32;
    let k = (place as usize).min(path.len() - 2);
    let ((a, a_radius), (b, b_radius)) = (path[k], path[k + 1]);
    let t = place - k as f32;
    (a.lerp(b, t), mix(a_radius, b_radius, t))
}

/// Twigs along the end of a path, from a part of it on, and one at its tip.
fn leaves(mesh: &mut Mesh, path: &[(Vec3, f32)], start: f32, count: i32, id: i32) {
    for k in 0..count {
        let id = 16 * id + k;
        let r = |n: i32| hash(id, n, 407);
        let part = mix(start, 1.0, k as f32 / (count - 1) as f32);
        let foot = at(path, part).0;
        let tangent = (at(path, part + 0.02).0 - at(path, part - 0.06).0).normalize_or(Vec3::Y);
        let across = tangent.any_orthonormal_vector();
        let turn = TURN * k as f32 + r(0);
        let around = across * ops::cos(turn) + tangent.cross(across) * ops::sin(turn);
        // Weak twigs hang; the last goes on where its branch ends.
        let aside = if k + 1 == count { 0.15 } else { mix(0.6, 1.2, r(1)) };
        let along = tangent * 0.7 + around * aside - Vec3::Y * (0.28 * r(2));
        let off = (foot + along * 0.15 - CROWN) / HALF_AXES;
        // Young leaves at the outside are lighter than old ones within.
        let light = mix(0.72, 1.0, smooth(0.35, 1.0, off.length())) * mix(0.84, 1.08, r(3));
        let hue = Vec3::new(mix(0.80, 1.05, r(4)), 1.0, mix(0.75, 1.0, r(5)));
        Twig {
            at: foot,
            along,
            size: mix(0.32, 0.46, r(6)),
            out: off.normalize_or(Vec3::Y),
            tint: hue * light,
            id,
        }
        .grow(mesh);
    }
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
        assert!((5.2..6.3).contains(&high.y) && (2.4..4.2).contains(&size.x), "{low} {high}");
        assert!(mesh.triangle_count() < 6500, "{}", mesh.triangle_count());
    }

    /// Leaves of a street's lime cover its ground three to six times.
    #[test]
    fn the_crown_has_the_leaves_of_a_lime() {
        let mesh = tree();
        let part = &mesh.parts[&Material::Leaf];
        let corner = |k: u32| part.vertices[k as usize].position;
        let area =
            |t: &[u32]| 0.5 * (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).length();
        let cards: f32 = part.indices.chunks_exact(3).map(area).sum();
        let ground = std::f32::consts::PI * HALF_AXES.x * HALF_AXES.z;
        // Leaves cover a third of their cards.
        let index = cards / 3.0 / ground;
        assert!((3.0..6.0).contains(&index), "{index}");
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
}
