//! Roofs: pitched with the ridge along the street, mansards with dormers, or flat behind a balustrade.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::window::{Balcony, Frame, Surround};
use super::{Built, DEPTH_M, House, Opening, PlacedWindow, Roof, WindowDesign, room};
use crate::material::Material;
use crate::mesh::{BEHIND, BELOW, Mesh, Paint, plain, tinted};
use crate::noise::hash;

/// Draws the roof, its gutter and its chimneys.
pub(super) fn roof(house: &House, built: &mut Built) {
    let h = house.height_m();
    match house.roof {
        Roof::Pitched { pitch_deg, tiles } => {
            let rise = DEPTH_M * 0.5 * ops::tan(pitch_deg.to_radians());
            pitched(house, rise, tinted(Material::Roof, tiles), &mut built.mesh);
            chimneys(house, h + rise, &mut built.mesh);
        }
        Roof::Mansard { paint, tiles } => {
            mansard(house, tinted(paint, tiles), built);
            chimneys(house, h + 3.0, &mut built.mesh);
        }
        Roof::Balustrade => {
            balustrade(house, &mut built.mesh);
            chimneys(house, h + 0.7, &mut built.mesh);
        }
    }
}

/// A slope from an upper to a lower edge (y, z) along x, with rows of tiles along it.
fn slope(mesh: &mut Mesh, paint: Paint, x: [f32; 2], upper: [f32; 2], lower: [f32; 2]) {
    let (dy, dz) = (upper[0] - lower[0], upper[1] - lower[1]);
    let length = (dy * dy + dz * dz).sqrt();
    let tile = paint.material.tile_m();
    let (columns, rows) = (((x[1] - x[0]) / 0.9).ceil() as usize, (length / 0.9).ceil().max(1.0) as usize);
    let is_front = lower[1] > upper[1];
    // The roof has sagged a little over the years.
    let sag = |s: f32, t: f32| -0.05 * 4.0 * s * (1.0 - s) * t * (1.0 - t) * 4.0;
    mesh.grid(
        [columns, rows],
        |i, j| {
            let s = i as f32 / columns as f32;
            let s = if is_front { s } else { 1.0 - s };
            let t = j as f32 / rows as f32;
            let at = x[0] + (x[1] - x[0]) * s;
            let tone = 0.80 + 0.2 * hash((at * 7.0) as i32, (t * length * 7.0) as i32, 345);
            let y = lower[0] + dy * t + sag(s, t);
            (Vec3::new(at, y, lower[1] + dz * t), Vec2::new(at, length * (1.0 - t)) / tile, paint.tint * tone)
        },
        |_, _| Some(paint.material),
    );
}

/// A half-round gutter along the eaves.
fn gutter(house: &House, y: f32, z: f32, mesh: &mut Mesh) {
    let path = [(Vec3::new(-0.02, y, z), 0.07), (Vec3::new(house.width_m + 0.02, y, z), 0.07)];
    mesh.tube(tinted(Material::Zinc, [0.75, 0.76, 0.76]), &path, 8);
}

fn pitched(house: &House, rise: f32, paint: Paint, mesh: &mut Mesh) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let over = 0.34;
    let drop = over * rise / (d * 0.5);
    let x = [-0.03, w + 0.03];
    slope(mesh, paint, x, [h + rise, -d * 0.5], [h - drop, over]);
    slope(mesh, paint, x, [h + rise, -d * 0.5], [h - drop, -d - over]);
    // The eaves from below, and the gables.
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.quad(
        tinted(Material::Wood, [0.26, 0.19, 0.13]),
        [
            p(x[0], h - drop - 0.03, over),
            p(x[0], h - 0.06, 0.0),
            p(x[1], h - 0.06, 0.0),
            p(x[1], h - drop - 0.03, over),
        ],
    );
    mesh.quad(
        tinted(Material::Wood, [0.26, 0.19, 0.13]),
        [
            p(x[0], h - drop - 0.04, over),
            p(x[1], h - drop - 0.04, over),
            p(x[1], h - drop, over),
            p(x[0], h - drop, over),
        ],
    );
    let mut wall = house.wall_paint();
    wall.tint *= 0.85;
    mesh.polygon(wall, &[p(0.0, h, -d), p(0.0, h, 0.0), p(0.0, h + rise, -d * 0.5)]);
    mesh.polygon(wall, &[p(w, h, 0.0), p(w, h, -d), p(w, h + rise, -d * 0.5)]);
    let ridge = [(p(x[0], h + rise - 0.02, -d * 0.5), 0.11), (p(x[1], h + rise - 0.02, -d * 0.5), 0.11)];
    mesh.tube(Paint { tint: paint.tint * 0.8, ..paint }, &ridge, 8);
    gutter(house, h - drop + 0.01, over + 0.05, mesh);
}

fn mansard(house: &House, paint: Paint, built: &mut Built) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let (rise, run) = (2.5, 0.9);
    let (foot, back) = (-0.12, -d);
    let zinc = tinted(Material::Zinc, [0.86, 0.88, 0.91]);
    let mesh = &mut built.mesh;
    slope(mesh, paint, [0.0, w], [h + rise, foot - run], [h, foot]);
    slope(mesh, paint, [0.0, w], [h + rise, back + run], [h, back]);
    slope(mesh, zinc, [0.0, w], [h + rise + 0.9, -d * 0.5], [h + rise, foot - run]);
    slope(mesh, zinc, [0.0, w], [h + rise + 0.9, -d * 0.5], [h + rise, back + run]);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let edge = [(p(0.0, h + rise, foot - run + 0.01), 0.055), (p(w, h + rise, foot - run + 0.01), 0.055)];
    mesh.tube(zinc, &edge, 7);
    // Party walls rise above the roof.
    let outline = |x: f32, up: f32| {
        [
            p(x, h - 0.1, foot + 0.05),
            p(x, h + up, foot + 0.05),
            p(x, h + rise + up, foot - run + 0.05),
            p(x, h + rise + 0.9 + up, -d * 0.5),
            p(x, h + rise + up, back + run),
            p(x, h + up, back),
            p(x, h - 0.1, back),
        ]
    };
    let wall = tinted(Material::Plaster, [0.50, 0.47, 0.41]);
    for x in [0.0, w - 0.22] {
        let (a, b) = (outline(x, 0.28), outline(x + 0.22, 0.28));
        let mut left = a;
        left.reverse();
        mesh.polygon(wall, &left.map(|q| q));
        mesh.polygon(wall, &b);
        for k in 0..a.len() - 1 {
            mesh.quad(wall, [a[k], b[k], b[k + 1], a[k + 1]]);
        }
    }
    gutter(house, h + 0.04, 0.34, mesh);
    let (dw, dh) = (0.95, 1.38);
    for bay in 0..house.bays {
        let x = house.bay(bay);
        let low = h + 0.42;
        dormer(house, x, low, [dw, dh], built);
    }
}

/// A dormer whose window is in the plane of the front.
fn dormer(house: &House, x: f32, low: f32, [dw, dh]: [f32; 2], built: &mut Built) {
    let mesh = &mut built.mesh;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let zinc = tinted(Material::Zinc, [0.82, 0.84, 0.87]);
    let face = tinted(Material::Joinery, [0.56, 0.545, 0.50]);
    let (l, r, top) = (x - dw / 2.0, x + dw / 2.0, low + dh);
    let (front, back) = (-0.02, -1.15);
    for [a, b] in [[l - 0.13, l], [r, r + 0.13]] {
        mesh.cuboid(face, p(a, low - 0.22, back), p(b, top + 0.14, front), BEHIND | BELOW);
    }
    mesh.cuboid(face, p(l, top, back), p(r, top + 0.14, front), BEHIND);
    mesh.cuboid(face, p(l - 0.13, low - 0.22, back), p(r + 0.13, low, front + 0.03), BEHIND);
    // A flat arch of zinc.
    const STEPS: usize = 8;
    let half = dw / 2.0 + 0.24;
    let arc = |k: usize| {
        let t = 2.0 * k as f32 / STEPS as f32 - 1.0;
        (x + t * half, top + 0.14 + 0.24 * (1.0 - t * t))
    };
    for k in 0..STEPS {
        let ((x0, y0), (x1, y1)) = (arc(k), arc(k + 1));
        mesh.quad(zinc, [p(x0, y0, 0.08), p(x1, y1, 0.08), p(x1, y1, back - 0.5), p(x0, y0, back - 0.5)]);
        mesh.quad(face, [p(x0, top + 0.13, 0.05), p(x1, top + 0.13, 0.05), p(x1, y1, 0.05), p(x0, y0, 0.05)]);
        mesh.quad(zinc, [p(x0, y0 - 0.04, 0.08), p(x1, y1 - 0.04, 0.08), p(x1, y1, 0.08), p(x0, y0, 0.08)]);
    }
    let corner = p(l, low, front);
    let design = WindowDesign {
        size_cm: [(dw * 100.0) as u16, (dh * 100.0) as u16],
        frame: Frame::Dormer,
        surround: Surround::None,
        shutters: None,
        balcony: Balcony::None,
        has_flowers: false,
        ..house.ground_design
    };
    built.windows.push(PlacedWindow { design, corner });
    let opening = Opening { x: [l, r], y: [low, top], is_window: true };
    room::room(house, &opening, 99, mesh);
}

fn balustrade(house: &House, mesh: &mut Mesh) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let stone = house.stone_paint();
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let (high, z) = (0.85, [-0.26, 0.02]);
    mesh.cuboid(stone, p(0.0, h, z[0]), p(w, h + 0.14, z[1]), 0);
    mesh.cuboid(stone, p(0.0, h + high, z[0] - 0.02), p(w, h + high + 0.13, z[1] + 0.03), 0);
    for bay in 0..=house.bays {
        let x = (0.30 + (w - 0.6) * bay as f32 / house.bays as f32).clamp(0.16, w - 0.16);
        mesh.cuboid(stone, p(x - 0.15, h + 0.14, z[0] + 0.01), p(x + 0.15, h + high, z[1] - 0.01), BELOW);
        mesh.cuboid(stone, p(x - 0.18, h + high, z[0] - 0.03), p(x + 0.18, h + high + 0.17, z[1] + 0.045), 0);
    }
    let count = (w / 0.24) as i32;
    for k in 0..count {
        let x = (k as f32 + 0.5) * w / count as f32;
        let profile = [
            [0.06, 0.0],
            [0.06, 0.06],
            [0.03, 0.09],
            [0.075, 0.27],
            [0.03, 0.52],
            [0.055, 0.66],
            [0.06, 0.71],
        ];
        mesh.lathe(stone, p(x, h + 0.14, -0.12), &profile, 6);
    }
    let roof = tinted(Material::Zinc, [0.8; 3]);
    slope(mesh, roof, [0.0, w], [h + 0.5, -d * 0.5], [h + 0.02, -0.2]);
    slope(mesh, roof, [0.0, w], [h + 0.5, -d * 0.5], [h + 0.02, -d]);
}

/// Stacks with pots at both ends of the ridge, of several widths.
fn chimneys(house: &House, ridge: f32, mesh: &mut Mesh) {
    let random = |n: u32| hash(house.seed as i32, n as i32, 341);
    for (k, end) in [0.55, house.width_m - 0.55].into_iter().enumerate() {
        let n = 10 * k as u32;
        if random(n) < 0.3 {
            continue;
        }
        let pots = 2 + (random(n + 1) * 3.0) as i32;
        let half = 0.19 * pots as f32;
        let (z, top) = (-DEPTH_M * 0.5 + 1.6 * random(n + 2), ridge + 0.7 + 0.7 * random(n + 3));
        let paint = if random(n + 4) < 0.5 {
            tinted(Material::Brick, [0.85; 3])
        } else {
            tinted(Material::Plaster, [0.50, 0.46, 0.39])
        };
        let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        mesh.cuboid(paint, p(end - 0.28, ridge - 2.6, z - half), p(end + 0.28, top, z + half), BELOW);
        mesh.cuboid(
            house.stone_paint(),
            p(end - 0.34, top, z - half - 0.06),
            p(end + 0.34, top + 0.1, z + half + 0.06),
            0,
        );
        let clay = tinted(Material::Stone, [0.46, 0.24, 0.15]);
        for pot in 0..pots {
            let at = z - half + 0.19 + 0.38 * pot as f32;
            let tall = 0.40 + 0.3 * random(n + 5 + pot as u32);
            let profile = [
                [0.13, 0.0],
                [0.105, tall],
                [0.13, tall + 0.03],
                [0.13, tall + 0.08],
                [0.09, tall + 0.08],
                [0.085, tall * 0.5],
            ];
            mesh.lathe(clay, p(end, top + 0.1, at), &profile, 9);
        }
    }
    if random(40) < 0.45 {
        let iron = plain(Material::Zinc);
        let (x, z, y) = (house.width_m * 0.5, -DEPTH_M * 0.45, ridge - 0.4);
        mesh.bar(iron, Vec3::new(x, y, z), Vec3::new(x, y + 2.4, z), 0.03);
        for k in 0..5 {
            let at = y + 2.3 - 0.22 * k as f32;
            mesh.bar(
                iron,
                Vec3::new(x - 0.5 + 0.05 * k as f32, at, z),
                Vec3::new(x + 0.5 - 0.05 * k as f32, at, z),
                0.014,
            );
        }
    }
}
