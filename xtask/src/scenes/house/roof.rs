//! Roofs: pitched with the ridge along the street, mansards with dormers, or flat behind a parapet.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::{DEPTH_M, Dressing, House, Opening, PlacedWindow, WindowKind, window};
use crate::scenes::material::Material;
use crate::scenes::mesh::{BEHIND, BELOW, Mesh, Paint, plain, tinted};
use crate::scenes::noise::hash;

/// Sorts of roofs, with the color of their tiles.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenes) enum Roof {
    /// Two slopes of a pitch in degrees.
    Pitched { pitch_deg: f32, tiles: [f32; 3] },
    /// A steep slope with dormers, flat above.
    Mansard { tiles: [f32; 3], dormers: u32 },
    /// A parapet of a height in meters.
    Parapet { height_m: f32 },
}

/// Draws the roof, its gutter and its chimneys.
pub(super) fn roof(house: &House, mesh: &mut Mesh, windows: &mut Vec<PlacedWindow>) {
    match house.roof {
        Roof::Pitched { pitch_deg, tiles } => {
            let rise = DEPTH_M * 0.5 * ops::tan(pitch_deg.to_radians());
            pitched(house, rise, tinted(Material::Roof, tiles), mesh);
            chimney(house, house.height_m() + rise, mesh);
        }
        Roof::Mansard { tiles, dormers } => {
            mansard(house, tinted(Material::Roof, tiles), dormers, mesh, windows);
            chimney(house, house.height_m() + 2.5, mesh);
        }
        Roof::Parapet { height_m } => parapet(house, height_m, mesh),
    }
}

/// A slope from an upper to a lower edge along x, with rows of tiles along it.
fn slope(mesh: &mut Mesh, paint: Paint, x: [f32; 2], upper: [f32; 2], lower: [f32; 2]) {
    let length = ((upper[0] - lower[0]) * (upper[0] - lower[0])
        + (upper[1] - lower[1]) * (upper[1] - lower[1]))
        .sqrt();
    let tile = paint.material.tile_m();
    let p = |x: f32, [y, z]: [f32; 2]| Vec3::new(x, y, z);
    let uv = |x: f32, v: f32| Vec2::new(x, v) / tile;
    let corners = [p(x[0], lower), p(x[1], lower), p(x[1], upper), p(x[0], upper)];
    let uvs = [uv(x[0], length), uv(x[1], length), uv(x[1], 0.0), uv(x[0], 0.0)];
    let is_front = lower[1] > upper[1];
    if is_front {
        mesh.quad_uv(paint, corners, uvs);
    } else {
        let [a, b, c, d] = corners;
        let [ua, ub, uc, ud] = uvs;
        mesh.quad_uv(paint, [b, a, d, c], [ub, ua, ud, uc]);
    }
}

/// Half a pipe along the eaves.
fn gutter(house: &House, y: f32, z: f32, mesh: &mut Mesh) {
    let path = [(Vec3::new(-0.02, y, z), 0.062), (Vec3::new(house.width_m + 0.02, y, z), 0.062)];
    mesh.tube(plain(Material::Zinc), &path, 8);
}

fn pitched(house: &House, rise: f32, paint: Paint, mesh: &mut Mesh) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let over = 0.26;
    let drop = over * rise / (d * 0.5);
    let x = [-0.03, w + 0.03];
    slope(mesh, paint, x, [h + rise, -d * 0.5], [h - drop, over]);
    slope(mesh, paint, x, [h + rise, -d * 0.5], [h - drop, -d - over]);
    // The eaves from below, and the gables.
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.quad(
        tinted(Material::Joinery, [0.3, 0.29, 0.27]),
        [p(x[0], h - drop, over), p(x[0], h, 0.0), p(x[1], h, 0.0), p(x[1], h - drop, over)],
    );
    let wall = house.wall_paint();
    mesh.polygon(wall, &[p(0.0, h, -d), p(0.0, h, 0.0), p(0.0, h + rise, -d * 0.5)]);
    mesh.polygon(wall, &[p(w, h, 0.0), p(w, h, -d), p(w, h + rise, -d * 0.5)]);
    let ridge = [(p(x[0], h + rise - 0.03, -d * 0.5), 0.11), (p(x[1], h + rise - 0.03, -d * 0.5), 0.11)];
    mesh.tube(Paint { tint: paint.tint * 0.8, ..paint }, &ridge, 8);
    gutter(house, h - drop + 0.02, over + 0.04, mesh);
}

fn mansard(house: &House, paint: Paint, dormers: u32, mesh: &mut Mesh, windows: &mut Vec<PlacedWindow>) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let (rise, run) = (2.3, 0.85);
    let (foot, back) = (0.02, -d);
    slope(mesh, paint, [0.0, w], [h + rise, foot - run], [h, foot]);
    slope(mesh, paint, [0.0, w], [h + rise, back + run], [h, back]);
    slope(mesh, paint, [0.0, w], [h + rise + 0.35, -d * 0.5], [h + rise, foot - run + 0.05]);
    slope(mesh, paint, [0.0, w], [h + rise + 0.35, -d * 0.5], [h + rise, back + run - 0.05]);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let outline = |x: f32| {
        [
            p(x, h, foot),
            p(x, h + rise, foot - run),
            p(x, h + rise + 0.35, -d * 0.5),
            p(x, h + rise, back + run),
            p(x, h, back),
        ]
    };
    let wall = house.wall_paint();
    mesh.polygon(wall, &outline(w));
    let mut left = outline(0.0);
    left.reverse();
    mesh.polygon(wall, &left);
    gutter(house, h + 0.05, 0.20, mesh);
    let [dw, dh] = WindowKind::Small.size_m();
    for k in 0..dormers {
        let x = w * (k as f32 + 0.5) / dormers as f32;
        let low = h + 0.55;
        let zinc = plain(Material::Zinc);
        let front = 0.0;
        // Cheeks, head and sides of the front; the window stands in it.
        let wood = tinted(Material::Joinery, [0.42, 0.41, 0.38]);
        for side in [x - dw / 2.0 - 0.1, x + dw / 2.0] {
            mesh.cuboid(
                wood,
                p(side, low - 0.1, -1.0),
                p(side + 0.1, low + dh + 0.12, front),
                BEHIND | BELOW,
            );
        }
        mesh.cuboid(wood, p(x - dw / 2.0, low + dh, -1.0), p(x + dw / 2.0, low + dh + 0.12, front), BEHIND);
        mesh.cuboid(
            wood,
            p(x - dw / 2.0 - 0.1, low - 0.1, -1.0),
            p(x + dw / 2.0 + 0.1, low, front + 0.06),
            BEHIND,
        );
        mesh.block(zinc, [x - dw / 2.0 - 0.18, low + dh + 0.12, -1.05], [dw + 0.36, 0.06, 1.15]);
        let corner = p(x - dw / 2.0, low, front);
        windows.push(PlacedWindow { design: house.design(WindowKind::Small, Dressing::None), corner });
        let opening = Opening { x: [corner.x, corner.x + dw], y: [low, low + dh], is_window: true };
        let is_lit = hash(house.seed as i32, k as i32, 331) < 0.4;
        window::glaze(mesh, is_lit, k % 8, &opening, front - 0.132);
    }
}

fn parapet(house: &House, height: f32, mesh: &mut Mesh) {
    let (w, h, d) = (house.width_m, house.height_m(), DEPTH_M);
    let wall = house.wall_paint();
    mesh.cuboid(wall, Vec3::new(0.0, h, -0.25), Vec3::new(w, h + height, 0.0), BELOW);
    mesh.cuboid(
        house.stone_paint(),
        Vec3::new(-0.02, h + height, -0.29),
        Vec3::new(w + 0.02, h + height + 0.07, 0.04),
        0,
    );
    for x in [0.0, w - 0.22] {
        mesh.cuboid(wall, Vec3::new(x, h, -d), Vec3::new(x + 0.22, h + height * 0.8, -0.25), BELOW);
    }
    let roof = tinted(Material::Stone, [0.16, 0.16, 0.165]);
    let p = |x: f32, z: f32| Vec3::new(x, h + 0.05, z);
    mesh.quad(roof, [p(0.0, -0.2), p(w, -0.2), p(w, -d), p(0.0, -d)]);
}

/// A stack with pots near the left end of the ridge.
fn chimney(house: &House, ridge: f32, mesh: &mut Mesh) {
    let x = 0.45 + hash(house.seed as i32, 2, 341) * 0.5;
    let (z, top) = (-DEPTH_M * 0.5 + 0.6, ridge + 1.15);
    let paint = tinted(Material::Brick, [0.8; 3]);
    mesh.cuboid(paint, Vec3::new(x - 0.42, ridge - 1.8, z - 0.32), Vec3::new(x + 0.42, top, z + 0.32), BELOW);
    mesh.cuboid(
        house.stone_paint(),
        Vec3::new(x - 0.48, top, z - 0.38),
        Vec3::new(x + 0.48, top + 0.09, z + 0.38),
        0,
    );
    let clay = tinted(Material::Stone, [0.36, 0.17, 0.10]);
    for dx in [-0.22, 0.22] {
        let profile = [[0.13, 0.0], [0.115, 0.34], [0.135, 0.37], [0.135, 0.42], [0.10, 0.42]];
        mesh.lathe(clay, Vec3::new(x + dx, top + 0.09, z), &profile, 9);
    }
}
