//! Street furniture: lamps, trees, benches, bollards, bins, signs; and the window of a room.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::material::Material;
use super::mesh::{BEHIND, Mesh, Vertex, plain, tinted};
use super::model::{Lamp, Model};
use super::noise::{hash, mix};

/// Paint of cast iron.
const IRON: [f32; 3] = [0.028, 0.032, 0.030];

/// A street lamp, 5 m high, with its head 0.95 m in front of its post, along +x.
pub(super) fn lamp() -> Model {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, IRON);
    let post = [
        [0.13, 0.0],
        [0.13, 0.05],
        [0.105, 0.08],
        [0.10, 0.75],
        [0.115, 0.79],
        [0.115, 0.83],
        [0.075, 0.90],
        [0.058, 2.6],
        [0.066, 2.63],
        [0.066, 2.68],
        [0.052, 2.72],
        [0.042, 4.5],
        [0.0, 4.52],
    ];
    mesh.lathe(iron, Vec3::ZERO, &post, 14);
    // The arm: a quarter of a circle, then level.
    let mut arm = Vec::new();
    for k in 0..=8 {
        let angle = k as f32 / 8.0 * std::f32::consts::FRAC_PI_2;
        let p = Vec3::new(0.52 * (1.0 - ops::cos(angle)), 4.45 + 0.52 * ops::sin(angle), 0.0);
        arm.push((p, mix(0.040, 0.028, k as f32 / 8.0)));
    }
    arm.push((Vec3::new(0.86, 4.965, 0.0), 0.027));
    mesh.tube(iron, &arm, 9);
    // A scroll under the arm.
    let scroll: Vec<(Vec3, f32)> = (0..=7)
        .map(|k| {
            let t = k as f32 / 7.0;
            (Vec3::new(mix(0.04, 0.40, t), 4.15 + 0.66 * t - 0.20 * t * t, 0.0), 0.013)
        })
        .collect();
    mesh.tube(iron, &scroll, 6);
    let head = Vec3::new(0.95, 4.72, 0.0);
    let hood = [
        [0.205, 0.0],
        [0.21, 0.012],
        [0.185, 0.09],
        [0.12, 0.165],
        [0.05, 0.20],
        [0.045, 0.26],
        [0.02, 0.285],
        [0.0, 0.29],
    ];
    mesh.lathe(iron, head, &hood, 16);
    mesh.lathe(tinted(Material::Iron, [0.55; 3]), head, &[[0.0, 0.05], [0.12, 0.04], [0.203, 0.002]], 16);
    let bowl = [[0.0, -0.105], [0.06, -0.098], [0.11, -0.072], [0.14, -0.035], [0.15, 0.004]];
    mesh.lathe(plain(Material::LampGlass), head, &bowl, 16);
    let lamps = vec![Lamp {
        name: "street lamp",
        position: [head.x, head.y - 0.13, 0.0],
        direction: Some([0.0, -1.0, 0.0]),
        cone_deg: [58.0, 85.0],
        color: [1.0, 0.76, 0.47],
        intensity_cd: 900.0,
        range_m: 18.0,
    }];
    Model { lamps, ..Model::single("lamp", mesh) }
}

/// A young lime tree, 5.5 m high, its leaves as sprays on cards.
pub(super) fn tree() -> Model {
    let mut mesh = Mesh::default();
    let bark = plain(Material::Bark);
    let random = |n: i32| hash(n, 0, 401);
    let trunk: Vec<(Vec3, f32)> = (0..=8)
        .map(|k| {
            let t = k as f32 / 8.0;
            let sway = Vec3::new(0.10 * ops::sin(3.1 * t), 0.0, 0.07 * ops::sin(4.3 * t + 1.0));
            (
                sway + Vec3::Y * (4.6 * t - 0.1),
                mix(0.095, 0.022, t) + 0.05 * (1.0 - t) * (1.0 - t) * (1.0 - t),
            )
        })
        .collect();
    mesh.tube(bark, &trunk, 9);
    let mut id = 0;
    for limb in 0..11 {
        let t = mix(0.42, 0.97, limb as f32 / 10.0);
        let at = trunk[(t * 8.0) as usize]
            .0
            .lerp(trunk[(t * 8.0) as usize + usize::from(t < 1.0)].0, (t * 8.0).fract());
        let around = limb as f32 * 2.4 + random(limb);
        let reach = mix(1.25, 0.55, (t - 0.42) / 0.55) * mix(0.85, 1.15, random(limb + 20));
        let out = Vec3::new(ops::cos(around), 0.0, ops::sin(around));
        let path: Vec<(Vec3, f32)> = (0..=4)
            .map(|k| {
                let s = k as f32 / 4.0;
                (at + out * reach * s + Vec3::Y * (0.75 * s - 0.18 * s * s), mix(0.035, 0.008, s))
            })
            .collect();
        mesh.tube(bark, &path, 5);
        for (k, &(center, _)) in path.iter().enumerate().skip(1) {
            for card in 0..if k == 1 { 2 } else { 3 } {
                id += 1;
                let jitter =
                    Vec3::new(random(id + 100) - 0.5, random(id + 200) - 0.35, random(id + 300) - 0.5) * 0.55;
                spray(&mut mesh, center + jitter, mix(0.66, 0.98, random(id + 400)), id * 7 + card);
            }
        }
    }
    // A bed in the pavement with an iron rim.
    mesh.block(plain(Material::Soil), [-0.55, -0.05, -0.55], [1.1, 0.055, 1.1]);
    let rim = tinted(Material::Iron, [0.06, 0.055, 0.05]);
    for [x, z, w, d] in [
        [-0.6, -0.6, 1.2, 0.06],
        [-0.6, 0.54, 1.2, 0.06],
        [-0.6, -0.54, 0.06, 1.08],
        [0.54, -0.54, 0.06, 1.08],
    ] {
        mesh.block(rim, [x, -0.05, z], [w, 0.062, d]);
    }
    Model::single("tree", mesh)
}

/// A card with a spray of leaves, tilted at random; its normals point out of the crown, for soft shading.
fn spray(mesh: &mut Mesh, center: Vec3, size: f32, id: i32) {
    let r = |n: i32| hash(id, n, 411);
    let around = r(0) * std::f32::consts::TAU;
    let lean = mix(-0.9, 0.9, r(1));
    let (c, s) = (ops::cos(around), ops::sin(around));
    let right = Vec3::new(c, 0.0, s);
    let forward = Vec3::new(-s, 0.0, c);
    let up = Vec3::Y * ops::cos(lean) + forward * ops::sin(lean);
    let crown = Vec3::new(0.0, 3.6, 0.0);
    let out = (center - crown).normalize_or_zero();
    let shade = mix(0.62, 1.0, r(2)) * mix(0.75, 1.0, ((center.y - 2.2) / 3.0).clamp(0.0, 1.0));
    let part = mesh.part(Material::Leaf);
    let first = part.vertices.len() as u32;
    // Six corners around the spray: less empty area than a square.
    for k in 0..6 {
        let angle = k as f32 / 3.0 * std::f32::consts::PI;
        let (x, y) = (0.5 * ops::cos(angle), 0.5 * ops::sin(angle));
        part.vertices.push(Vertex {
            position: center + (right * x + up * y) * size,
            normal: (out + Vec3::Y * 0.35).normalize_or_zero(),
            uv: Vec2::new(x + 0.5, 0.5 - y),
            tint: Vec3::splat(shade),
        });
    }
    part.indices.extend([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5].map(|k| first + k));
}

/// A bench of planks on iron feet, 1.7 m wide, its front along +z.
pub(super) fn bench() -> Model {
    let mut mesh = Mesh::default();
    let wood = |k: i32| {
        tinted(Material::Wood, [0.24, 0.145, 0.08].map(|c: f32| c * mix(0.8, 1.15, hash(k, 0, 421))))
    };
    let iron = tinted(Material::Iron, IRON);
    for x in [-0.68, 0.62] {
        mesh.block(iron, [x, 0.0, -0.24], [0.06, 0.42, 0.05]);
        mesh.block(iron, [x, 0.0, 0.16], [0.06, 0.42, 0.05]);
        mesh.block(iron, [x, 0.38, -0.24], [0.06, 0.04, 0.45]);
        mesh.block(iron, [x, 0.42, -0.28], [0.06, 0.44, 0.045]);
        mesh.block(iron, [x, 0.62, -0.26], [0.06, 0.035, 0.44]);
        mesh.block(iron, [x, 0.42, 0.13], [0.06, 0.22, 0.045]);
    }
    for k in 0..4 {
        mesh.block(wood(k), [-0.85, 0.42, -0.21 + 0.105 * k as f32], [1.70, 0.032, 0.088]);
    }
    for k in 0..3 {
        mesh.block(
            wood(k + 9),
            [-0.85, 0.52 + 0.115 * k as f32, -0.245 - 0.012 * k as f32],
            [1.70, 0.09, 0.03],
        );
    }
    Model::single("bench", mesh)
}

/// A cast bollard, 0.95 m high.
pub(super) fn bollard() -> Model {
    let mut mesh = Mesh::default();
    let profile = [
        [0.10, 0.0],
        [0.10, 0.06],
        [0.075, 0.09],
        [0.062, 0.70],
        [0.078, 0.72],
        [0.078, 0.76],
        [0.055, 0.78],
        [0.062, 0.83],
        [0.058, 0.89],
        [0.035, 0.935],
        [0.0, 0.95],
    ];
    mesh.lathe(tinted(Material::Iron, IRON), Vec3::ZERO, &profile, 12);
    let band = [[0.0655, 0.60], [0.0645, 0.66]];
    mesh.lathe(tinted(Material::Iron, [0.55, 0.55, 0.52]), Vec3::ZERO, &band, 12);
    Model::single("bollard", mesh)
}

/// A litter bin on a post, and a sign that forbids to stop, its face along +z.
pub(super) fn bin_and_sign() -> Model {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, IRON);
    let bin = [
        [0.19, 0.10],
        [0.215, 0.12],
        [0.225, 0.80],
        [0.235, 0.82],
        [0.235, 0.86],
        [0.20, 0.87],
        [0.19, 0.80],
        [0.18, 0.30],
        [0.0, 0.30],
    ];
    mesh.lathe(iron, Vec3::new(-0.45, 0.0, 0.0), &bin, 16);
    mesh.lathe(iron, Vec3::new(-0.45, 0.0, 0.0), &[[0.16, 0.0], [0.16, 0.10]], 12);
    let zinc = plain(Material::Zinc);
    mesh.tube(zinc, &[(Vec3::ZERO, 0.030), (Vec3::new(0.0, 2.75, 0.0), 0.030)], 9);
    let plate = |radius: f32, z: f32| -> Vec<Vec3> {
        (0..24)
            .map(|k| {
                let angle = k as f32 / 24.0 * std::f32::consts::TAU;
                Vec3::new(radius * ops::cos(angle), 2.42 + radius * ops::sin(angle), z)
            })
            .collect()
    };
    mesh.polygon(tinted(Material::Joinery, [0.36, 0.014, 0.014]), &plate(0.30, 0.040));
    mesh.polygon(tinted(Material::Joinery, [0.012, 0.035, 0.20]), &plate(0.235, 0.042));
    let mut back = plate(0.30, 0.036);
    back.reverse();
    mesh.polygon(zinc, &back);
    let red = tinted(Material::Joinery, [0.36, 0.014, 0.014]);
    let bar = |a: [f32; 2], b: [f32; 2]| {
        let (a, b) = (Vec3::new(a[0], 2.42 + a[1], 0.044), Vec3::new(b[0], 2.42 + b[1], 0.044));
        let side = (b - a).cross(Vec3::Z).normalize_or_zero() * 0.028;
        [a + side, b + side, b - side, a - side]
    };
    mesh.quad(red, bar([-0.17, 0.17], [0.17, -0.17]));
    mesh.quad(red, bar([0.17, 0.17], [-0.17, -0.17]));
    Model::single("bin_and_sign", mesh)
}

/// A window's opening seen from inside: jambs, head, sill and the surrounding wall; the pane would be at z = 0, the room at z > 0.
pub(super) fn window_frame() -> Model {
    let mut mesh = Mesh::default();
    let paint = tinted(Material::Joinery, [0.60, 0.59, 0.55]);
    let wall = tinted(Material::Plaster, [0.62, 0.57, 0.48]);
    let (half, low, high, deep) = (0.55, -0.28, 0.86, 0.26);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.cuboid(paint, p(-half - 0.06, low - 0.04, 0.0), p(half + 0.06, low, deep + 0.05), 0);
    for side in [-1.0f32, 1.0] {
        let (a, b) = (side * half, side * (half + 0.5));
        mesh.cuboid(
            paint,
            p(a.min(side * (half + 0.05)), low, 0.0),
            p(a.max(side * (half + 0.05)), high, 0.05),
            0,
        );
        mesh.cuboid(
            wall,
            p((side * (half + 0.02)).min(b), low - 0.6, 0.05),
            p((side * (half + 0.02)).max(b), high + 0.5, deep),
            BEHIND,
        );
    }
    mesh.cuboid(paint, p(-half, high, 0.0), p(half, high + 0.06, 0.05), 0);
    mesh.cuboid(wall, p(-half - 0.5, high + 0.02, 0.05), p(half + 0.5, high + 0.5, deep), BEHIND);
    mesh.cuboid(wall, p(-half - 0.5, low - 0.6, 0.02), p(half + 0.5, low - 0.04, deep), 0);
    Model::single("window", mesh)
}
