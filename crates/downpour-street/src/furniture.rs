//! Street furniture: lamps, trees, benches, bollards, bins, signs; and the window of a room.

use downpour_math::ops;
use glam::Vec3;

use crate::material::Material;
use crate::mesh::{BEHIND, Mesh, circle, plain, tinted};
use crate::model::Lamp;
use crate::noise::{hash, mix};
use crate::settings::LampEra;
use crate::tree::foliage::Twig;

/// Paint of cast iron.
const IRON: [f32; 3] = [0.028, 0.032, 0.030];
/// Radius of the foot of the widest lamp post, meters.
pub(crate) const LAMP_FOOT_M: f32 = 0.17;

/// A street lamp, its light to the side of +x, and the lamp in it.
pub(crate) fn lamp(era: LampEra) -> (Mesh, Lamp) {
    match era {
        LampEra::Lantern => lantern_post(),
        LampEra::Sodium => arm_post([1.0, 0.62, 0.22], 1500.0, 0.05),
        LampEra::Led => arm_post([1.0, 0.90, 0.76], 1700.0, 0.03),
    }
}

/// A lantern: a cage of four panes that widen upwards under a hood, 0.75 m high, its foot at a point.
fn lantern(mesh: &mut Mesh, foot: Vec3) {
    let iron = tinted(Material::Iron, IRON.map(|c| 2.0 * c));
    let (low, high, top) = (0.105, 0.185, 0.46);
    let corner = |k: i32, half: f32, y: f32| {
        let (c, s) = (if matches!(k, 0 | 3) { half } else { -half }, if k < 2 { half } else { -half });
        foot + Vec3::new(c, y, -s)
    };
    for k in 0..4 {
        let n = (k + 1) % 4;
        let inset = 0.96;
        let q = [
            corner(k, low * inset, 0.03),
            corner(n, low * inset, 0.03),
            corner(n, high * inset, top),
            corner(k, high * inset, top),
        ];
        mesh.quad(plain(Material::LampGlass), [q[0], q[1], q[2], q[3]]);
        mesh.bar(iron, corner(k, low, 0.02), corner(k, high, top), 0.018);
        mesh.bar(iron, corner(k, low, 0.03), corner(n, low, 0.03), 0.016);
        mesh.bar(iron, corner(k, high, top), corner(n, high, top), 0.022);
        // The hood.
        mesh.quad(
            iron,
            [
                corner(k, high + 0.03, top),
                corner(n, high + 0.03, top),
                corner(n, 0.07, top + 0.17),
                corner(k, 0.07, top + 0.17),
            ],
        );
    }
    mesh.lathe(iron, foot, &[[0.035, -0.08], [0.11, 0.0], [0.115, 0.03]], 8);
    mesh.lathe(
        iron,
        foot,
        &[
            [0.085, top + 0.16],
            [0.075, top + 0.23],
            [0.03, top + 0.26],
            [0.035, top + 0.30],
            [0.0, top + 0.36],
        ],
        8,
    );
}

/// A lantern on a cast post.
fn lantern_post() -> (Mesh, Lamp) {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, IRON.map(|c| 2.0 * c));
    let post = [
        [0.17, 0.0],
        [0.17, 0.10],
        [0.14, 0.13],
        [0.13, 0.55],
        [0.15, 0.58],
        [0.15, 0.63],
        [0.10, 0.70],
        [0.085, 0.95],
        [0.10, 0.98],
        [0.10, 1.02],
        [0.065, 1.08],
        [0.052, 2.55],
        [0.075, 2.60],
        [0.075, 2.65],
        [0.045, 2.72],
        [0.038, 3.05],
        [0.06, 3.10],
        [0.03, 3.20],
        [0.0, 3.20],
    ];
    mesh.lathe(iron, Vec3::ZERO, &post, 14);
    // The bar for the ladder.
    mesh.bar(iron, Vec3::new(0.0, 2.78, -0.26), Vec3::new(0.0, 2.78, 0.26), 0.022);
    lantern(&mut mesh, Vec3::new(0.0, 3.27, 0.0));
    let lamp = Lamp {
        name: "street lamp",
        position: [0.0, 3.52, 0.0],
        direction: None,
        cone_deg: [0.0; 2],
        color: [1.0, 0.84, 0.63],
        intensity_cd: 210.0,
        range_m: 24.0,
    };
    (mesh, lamp)
}

/// A lantern on a bracket before a wall; the wall is at x = 0, the street at +x.
pub(crate) fn wall_lamp() -> (Mesh, Lamp) {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, IRON.map(|c| 2.0 * c));
    mesh.block(iron, [0.0, 0.0, -0.06], [0.02, 0.42, 0.12]);
    let arm: Vec<(Vec3, f32)> = (0..=8)
        .map(|k| {
            let t = k as f32 / 8.0;
            (Vec3::new(0.58 * t, 0.30 + 0.16 * ops::sin(3.0 * t) - 0.10 * t, 0.0), 0.016)
        })
        .collect();
    mesh.tube(iron, &arm, 7);
    mesh.bar(iron, Vec3::new(0.0, 0.05, 0.0), Vec3::new(0.40, 0.36, 0.0), 0.014);
    lantern(&mut mesh, Vec3::new(0.58, 0.33, 0.0));
    let lamp = Lamp {
        name: "wall lamp",
        position: [0.58, 0.58, 0.0],
        direction: None,
        cone_deg: [0.0; 2],
        color: [1.0, 0.84, 0.63],
        intensity_cd: 60.0,
        range_m: 16.0,
    };
    (mesh, lamp)
}

/// A slim post with an arm over the road.
fn arm_post(color: [f32; 3], intensity_cd: f32, head_m: f32) -> (Mesh, Lamp) {
    let mut mesh = Mesh::default();
    let steel = tinted(Material::Iron, [0.30, 0.31, 0.31]);
    mesh.lathe(steel, Vec3::ZERO, &[[0.09, 0.0], [0.09, 1.1], [0.065, 1.15], [0.045, 5.2], [0.0, 5.22]], 12);
    let arm: Vec<(Vec3, f32)> = (0..=8)
        .map(|k| {
            let t = k as f32 / 8.0;
            (Vec3::new(1.3 * t, 5.15 + 0.40 * t * (2.0 - t), 0.0), mix(0.042, 0.03, t))
        })
        .collect();
    mesh.tube(steel, &arm, 8);
    let (x, y) = (1.45, 5.52);
    mesh.block(steel, [x - 0.28, y, -0.11], [0.56, 0.05 + head_m, 0.22]);
    mesh.block(plain(Material::LampGlass), [x - 0.22, y - 0.025, -0.08], [0.44, 0.026, 0.16]);
    let lamp = Lamp {
        name: "street lamp",
        position: [x, y - 0.06, 0.0],
        direction: Some([0.0, -1.0, 0.0]),
        cone_deg: [56.0, 84.0],
        color,
        intensity_cd,
        range_m: 24.0,
    };
    (mesh, lamp)
}

/// A bench of planks on iron feet, 1.7 m wide, its front along +z.
pub(crate) fn bench() -> Mesh {
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
    mesh
}

/// A cast bollard, 0.95 m high.
pub(crate) fn bollard() -> Mesh {
    let mut mesh = Mesh::default();
    let profile = [
        [0.0, 0.0],
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
    mesh.lathe(tinted(Material::Iron, IRON), Vec3::ZERO, &profile, 10);
    let band = [[0.0, 0.60], [0.0655, 0.60], [0.0645, 0.66], [0.0, 0.66]];
    mesh.lathe(tinted(Material::Iron, [0.55, 0.55, 0.52]), Vec3::ZERO, &band, 10);
    mesh
}

/// A litter bin.
pub(crate) fn bin() -> Mesh {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, [0.09, 0.115, 0.10]);
    let bin = [
        [0.0, 0.10],
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
    mesh.lathe(iron, Vec3::ZERO, &bin, 16);
    mesh.lathe(iron, Vec3::ZERO, &[[0.0, 0.0], [0.16, 0.0], [0.16, 0.10], [0.0, 0.10]], 12);
    mesh
}

/// A sign that forbids to stop on a post, its face along +z.
pub(crate) fn sign_post() -> Mesh {
    let mut mesh = Mesh::default();
    let zinc = plain(Material::Zinc);
    mesh.tube(
        zinc,
        &[(Vec3::ZERO, 0.030), (Vec3::new(0.0, 2.75, 0.0), 0.030), (Vec3::new(0.0, 2.76, 0.0), 0.0)],
        9,
    );
    let plate = |radius: f32, z: f32| circle(Vec3::new(0.0, 2.42, z), radius, 24);
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
    mesh
}

/// A round cafe table of 70 cm on one foot.
pub(crate) fn table() -> Mesh {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, [0.07; 3]);
    mesh.lathe(
        tinted(Material::Stone, [0.62, 0.61, 0.58]),
        Vec3::ZERO,
        &[[0.0, 0.715], [0.34, 0.715], [0.35, 0.725], [0.35, 0.74], [0.34, 0.745], [0.0, 0.745]],
        20,
    );
    mesh.lathe(
        iron,
        Vec3::ZERO,
        &[[0.06, 0.05], [0.025, 0.10], [0.022, 0.66], [0.10, 0.70], [0.10, 0.715]],
        8,
    );
    for k in 0..3 {
        let angle = k as f32 * std::f32::consts::TAU / 3.0;
        let out = Vec3::new(ops::cos(angle), 0.0, ops::sin(angle));
        mesh.tube(
            iron,
            &[
                (out * 0.02 + Vec3::Y * 0.11, 0.018),
                (out * 0.20 + Vec3::Y * 0.06, 0.016),
                (out * 0.29, 0.014),
            ],
            5,
        );
    }
    mesh
}

/// A bistro chair with a seat of slats, its front along +z.
pub(crate) fn chair() -> Mesh {
    let mut mesh = Mesh::default();
    let iron = tinted(Material::Iron, [0.085, 0.12, 0.10]);
    let wood = tinted(Material::Wood, [0.40, 0.26, 0.15]);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    for x in [-0.19, 0.19] {
        mesh.tube(iron, &[(p(x, 0.0, 0.20), 0.011), (p(x, 0.45, 0.17), 0.011)], 5);
        mesh.tube(
            iron,
            &[(p(x, 0.0, -0.24), 0.011), (p(x, 0.45, -0.19), 0.011), (p(x, 0.88, -0.27), 0.011)],
            5,
        );
        mesh.bar(iron, p(x, 0.44, -0.19), p(x, 0.44, 0.18), 0.018);
    }
    for k in 0..7 {
        let z = -0.19 + 0.058 * k as f32;
        mesh.block(wood, [-0.205, 0.445, z], [0.41, 0.016, 0.042]);
    }
    for (y, z) in [(0.60, -0.225), (0.70, -0.243), (0.80, -0.262)] {
        mesh.block(wood, [-0.20, y, z], [0.40, 0.062, 0.014]);
    }
    mesh
}

/// A bicycle along x, leaning a little.
pub(crate) fn bicycle() -> Mesh {
    let mut mesh = Mesh::default();
    let paint = tinted(Material::CarPaint, [0.06, 0.13, 0.14]);
    let steel = plain(Material::Alloy);
    let p = |x: f32, y: f32| Vec3::new(x, y, 0.12 - 0.16 * y);
    for x in [-0.52, 0.52] {
        for (radius, thick, sort) in
            [(0.33, 0.016, tinted(Material::Rubber, [1.0; 3])), (0.305, 0.010, steel)]
        {
            let ring: Vec<(Vec3, f32)> = (0..=20)
                .map(|k| {
                    let angle = k as f32 / 20.0 * std::f32::consts::TAU;
                    (p(x + radius * ops::cos(angle), 0.345 + radius * ops::sin(angle)), thick)
                })
                .collect();
            mesh.tube(sort, &ring, 5);
        }
        for k in 0..10 {
            let angle = k as f32 / 10.0 * std::f32::consts::TAU;
            mesh.bar(
                steel,
                p(x, 0.345),
                p(x + 0.30 * ops::cos(angle), 0.345 + 0.30 * ops::sin(angle)),
                0.004,
            );
        }
    }
    for (a, b, radius) in [
        ([-0.52, 0.345], [-0.08, 0.30], 0.009),
        ([-0.52, 0.345], [-0.20, 0.80], 0.009),
        ([-0.08, 0.30], [-0.22, 0.86], 0.015),
        ([-0.08, 0.30], [0.36, 0.74], 0.016),
        ([-0.20, 0.78], [0.34, 0.80], 0.015),
        ([0.52, 0.345], [0.32, 0.96], 0.013),
    ] {
        mesh.tube(paint, &[(p(a[0], a[1]), radius), (p(b[0], b[1]), radius)], 7);
    }
    let bar = p(0.30, 0.99);
    mesh.tube(
        steel,
        &[
            (bar + Vec3::new(-0.10, -0.03, -0.27), 0.012),
            (bar, 0.012),
            (bar + Vec3::new(-0.10, -0.03, 0.27), 0.012),
        ],
        7,
    );
    mesh.tube(
        tinted(Material::Trim, [1.0; 3]),
        &[(p(-0.36, 0.89), 0.05), (p(-0.22, 0.895), 0.06), (p(-0.10, 0.88), 0.02)],
        8,
    );
    mesh
}

/// A tub with a shrub.
pub(crate) fn planter() -> Mesh {
    let mut mesh = Mesh::default();
    let wood = tinted(Material::Joinery, [0.17, 0.20, 0.17]);
    mesh.block(wood, [-0.24, 0.03, -0.24], [0.48, 0.44, 0.48]);
    mesh.block(wood, [-0.26, 0.44, -0.26], [0.52, 0.05, 0.52]);
    mesh.block(plain(Material::Soil), [-0.22, 0.44, -0.22], [0.44, 0.055, 0.44]);
    let middle = Vec3::new(0.0, 0.75, 0.0);
    for k in 0..64 {
        let r = |n: i32| hash(k, n, 431);
        let (turn, out) = (r(0) * std::f32::consts::TAU, 0.22 * r(1).sqrt());
        let at = Vec3::new(out * ops::cos(turn), 0.50 + 0.42 * r(2), out * ops::sin(turn));
        let away = (at - middle).normalize_or(Vec3::Y);
        let tint = Vec3::new(0.62, 0.80, 0.72) * mix(0.7, 1.0, 3.6 * out);
        let along = away + Vec3::Y * 0.5;
        Twig { at, along, size: mix(0.20, 0.28, r(3)), out: away, tint, id: 9000 + k }.grow(&mut mesh);
    }
    mesh
}

/// A wire that sags between two points.
pub(crate) fn wire(mesh: &mut Mesh, from: Vec3, to: Vec3, sag: f32) {
    let path: Vec<(Vec3, f32)> = (0..=10)
        .map(|k| {
            let t = k as f32 / 10.0;
            (from.lerp(to, t) - Vec3::Y * (4.0 * sag * t * (1.0 - t)), 0.008)
        })
        .collect();
    mesh.tube(plain(Material::Trim), &path, 5);
}

/// A window's opening seen from inside: jambs, head, sill and the surrounding wall; the pane would be at z = 0, the room at z > 0.
pub(crate) fn window_opening() -> Mesh {
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
    mesh
}
