//! The front of a house: wall with reveals, plinth, sills, lintels, cornice, and the grime of years.

use glam::{Vec2, Vec3};

use super::{DEPTH_M, House, Opening, ground_m};
use crate::scenes::material::Material;
use crate::scenes::mesh::{ABOVE, BEHIND, BELOW, FRONT, Mesh, plain};
use crate::scenes::noise::{hash, mix, smooth, world};

/// Depth of reveals.
pub(super) const REVEAL_M: f32 = 0.11;
/// Height of the plinth over the pavement.
const PLINTH_M: f32 = 0.45;
/// The longest edge of a cell of the wall: grime is kept at its corners.
const CELL_M: f32 = 0.55;

/// Sorted cuts with the gaps between them divided.
fn cuts(mut all: Vec<f32>) -> Vec<f32> {
    all.sort_by(f32::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1.0e-3);
    let mut fine = Vec::new();
    for pair in all.windows(2) {
        let parts = ((pair[1] - pair[0]) / CELL_M).ceil().max(1.0);
        fine.extend((0..parts as i32).map(|k| mix(pair[0], pair[1], k as f32 / parts)));
    }
    fine.extend(all.last());
    fine
}

/// Weathering of a wall's color: splashes at the foot, soot under the cornice, runs under sills.
fn grime(house: &House, openings: &[Opening], x: f32, y: f32) -> f32 {
    let up = y - ground_m();
    let cloud = world(x, y, 3.0, 2, 301 + house.seed);
    let foot = mix(0.66, 1.0, smooth(0.10, 0.8 + 0.5 * cloud, up));
    let top = mix(0.86, 1.0, smooth(0.0, 0.9, house.height_m() - y + 0.3 * cloud));
    let run: f32 = openings
        .iter()
        .filter(|opening| opening.is_window && y < opening.y[0])
        .map(|opening| {
            let beside = (opening.x[0] - x).max(x - opening.x[1]);
            let down = opening.y[0] - y;
            0.15 * smooth(0.25, -0.05, beside) * smooth(1.25, 0.1, down)
        })
        .fold(0.0, f32::max);
    foot * top * (1.0 - run) * mix(0.95, 1.03, cloud)
}

/// Draws the front with its side walls and its back.
pub(super) fn front(house: &House, openings: &[Opening], mesh: &mut Mesh) {
    let (width, height, low) = (house.width_m, house.height_m(), ground_m() - 0.25);
    wall(house, openings, mesh, [low, height]);
    let paint = house.wall_paint();
    // Side walls and back, down to the ground.
    mesh.cuboid(paint, Vec3::new(0.0, low, -DEPTH_M), Vec3::new(width, height, 0.0), ABOVE | BELOW | FRONT);
    for opening in openings {
        reveal(house, opening, mesh);
    }
    plinth(house, openings, mesh);
    cornice(house, mesh);
    downpipe(house, mesh);
}

fn wall(house: &House, openings: &[Opening], mesh: &mut Mesh, heights: [f32; 2]) {
    let mut xs = vec![0.0, house.width_m];
    let mut ys = vec![heights[0], heights[1], ground_m(), ground_m() + PLINTH_M];
    for opening in openings {
        xs.extend(opening.x);
        ys.extend(opening.y);
    }
    let (xs, ys) = (cuts(xs), cuts(ys));
    let shift = Vec2::new(hash(house.seed as i32, 0, 311), hash(house.seed as i32, 1, 311));
    let tile = house.wall.tile_m();
    mesh.grid(
        [xs.len() - 1, ys.len() - 1],
        |i, j| {
            let (x, y) = (xs[i], ys[j]);
            // Whole courses: the shift is a multiple of the tile's rows.
            let uv = Vec2::new(x, -y) / tile + (shift * 18.0).floor() / 18.0;
            let tint = (Vec3::from(house.tint) * grime(house, openings, x, y)).min(Vec3::ONE);
            (Vec3::new(x, y, 0.0), uv, tint)
        },
        |i, j| {
            let (x, y) = ((xs[i] + xs[i + 1]) * 0.5, (ys[j] + ys[j + 1]) * 0.5);
            let is_open = |o: &Opening| (o.x[0]..o.x[1]).contains(&x) && (o.y[0]..o.y[1]).contains(&y);
            (!openings.iter().any(is_open)).then_some(house.wall)
        },
    );
}

/// Sides of an opening, to the visible depth of the wall.
fn reveal(house: &House, opening: &Opening, mesh: &mut Mesh) {
    let mut paint = house.wall_paint();
    paint.tint *= 0.9;
    let ([x0, x1], [y0, y1]) = (opening.x, opening.y);
    let deep = -REVEAL_M - 0.06;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.quad(paint, [p(x0, y0, 0.0), p(x0, y0, deep), p(x0, y1, deep), p(x0, y1, 0.0)]);
    mesh.quad(paint, [p(x1, y0, deep), p(x1, y0, 0.0), p(x1, y1, 0.0), p(x1, y1, deep)]);
    mesh.quad(paint, [p(x0, y1, 0.0), p(x0, y1, deep), p(x1, y1, deep), p(x1, y1, 0.0)]);
    mesh.quad(paint, [p(x0, y0, deep), p(x0, y0, 0.0), p(x1, y0, 0.0), p(x1, y0, deep)]);
}

fn plinth(house: &House, openings: &[Opening], mesh: &mut Mesh) {
    let mut paint = house.stone_paint();
    paint.tint *= 0.62;
    let top = ground_m() + PLINTH_M;
    let mut from = 0.0;
    let mut gaps: Vec<[f32; 2]> = openings.iter().filter(|o| o.y[0] < top).map(|o| o.x).collect();
    gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
    gaps.push([house.width_m; 2]);
    for [to, next] in gaps {
        if to > from + 0.02 {
            mesh.cuboid(paint, Vec3::new(from, -0.1, 0.0), Vec3::new(to, top, 0.035), BEHIND);
        }
        from = next;
    }
}

fn cornice(house: &House, mesh: &mut Mesh) {
    let paint = house.stone_paint();
    let (w, h) = (house.width_m, house.height_m());
    let mut ledge = |y: [f32; 2], out: f32| {
        mesh.cuboid(paint, Vec3::new(0.0, y[0], 0.0), Vec3::new(w, y[1], out), BEHIND);
    };
    ledge([h - 0.34, h - 0.24], 0.045);
    ledge([h - 0.24, h - 0.11], 0.11);
    ledge([h - 0.11, h], 0.21);
    let string = ground_m() + house.ground_floor_m();
    if house.shop.is_none() {
        ledge([string - 0.02, string + 0.12], 0.05);
    }
    if house.wall != Material::Plaster {
        // A course of brackets under the cornice.
        let count = (w / 0.62) as i32;
        for k in 0..count {
            let x = (k as f32 + 0.5) * w / count as f32;
            mesh.cuboid(
                paint,
                Vec3::new(x - 0.06, h - 0.30, 0.045),
                Vec3::new(x + 0.06, h - 0.11, 0.16),
                BEHIND | ABOVE,
            );
        }
    }
}

/// A downpipe at the right end of the front.
fn downpipe(house: &House, mesh: &mut Mesh) {
    let paint = plain(Material::Zinc);
    let (x, top) = (house.width_m - 0.12, house.height_m() + 0.02);
    let path: Vec<(Vec3, f32)> = [
        (x, top, 0.27),
        (x, top - 0.16, 0.26),
        (x, top - 0.42, 0.12),
        (x, top - 0.55, 0.085),
        (x, 0.45, 0.085),
        (x, 0.30, 0.10),
        (x, 0.20, 0.17),
    ]
    .map(|(x, y, z)| (Vec3::new(x, y, z), 0.042))
    .to_vec();
    mesh.tube(paint, &path, 7);
    for y in [1.2, 3.4, 5.6, 7.8] {
        if y < top - 0.8 {
            mesh.cuboid(paint, Vec3::new(x - 0.055, y, 0.0), Vec3::new(x + 0.055, y + 0.03, 0.13), BEHIND);
        }
    }
}
