//! The front of a house: wall with reveals, plinth, courses, cornice, quoins, pilasters, downpipe, and the grime of years.

use glam::{Vec2, Vec3};

use super::{DEPTH_M, House, HouseKind, Opening, REVEAL_M, Roof};
use crate::material::Material;
use crate::mesh::{ABOVE, BEHIND, BELOW, FRONT, Mesh, Paint, tinted};
use crate::noise::{hash, mix, smooth, world};

/// Height of the plinth over the pavement.
const PLINTH_M: f32 = 0.55;
/// The longest edge of a cell of the wall: grime is kept at its corners.
const CELL_M: f32 = 0.75;

/// Sorted cuts with the gaps between them divided.
fn cuts(mut all: Vec<f32>) -> Vec<f32> {
    all.sort_by(f32::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 2.0e-3);
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
    let up = y - house.foot;
    let cloud = world(x, y, 3.0, 3, 301 + (house.seed & 0xFFFF));
    let foot = mix(0.56, 1.0, smooth(0.0, 1.0 + 1.1 * cloud, up));
    let top = mix(0.74, 1.0, smooth(0.0, 1.3, house.height_m() - y + 0.8 * (cloud - 0.5)));
    let sides = mix(0.84, 1.0, smooth(0.0, 0.35 + 0.4 * cloud, x.min(house.width_m - x)));
    let run: f32 = openings
        .iter()
        .filter(|opening| opening.is_window && y < opening.y[0] + 0.01)
        .map(|opening| {
            let edge = (opening.x[0] - x).abs().min((x - opening.x[1]).abs());
            let beside = (opening.x[0] - x).max(x - opening.x[1]);
            let down = opening.y[0] - y;
            let long = 0.7 + 1.3 * hash((opening.x[0] * 50.0) as i32, (opening.y[0] * 50.0) as i32, 302);
            let fade = smooth(long, 0.05, down);
            (0.20 * smooth(0.20, -0.05, beside) + 0.16 * smooth(0.22, 0.0, edge)) * fade
        })
        .fold(0.0, f32::max);
    let weathered = foot * top * sides * (1.0 - run) * mix(0.86, 1.05, cloud);
    mix(1.0, weathered, 0.45 + house.age).clamp(0.0, 1.0)
}

/// Draws the front with its side walls and its back.
pub(super) fn front(house: &House, openings: &[Opening], mesh: &mut Mesh) {
    let (width, height, low) = (house.width_m, house.height_m(), house.foot - 0.25);
    wall(house, openings, mesh, [low, height]);
    let mut paint = house.wall_paint();
    if paint.material == Material::Ashlar {
        paint = tinted(Material::Plaster, house.tint);
    }
    paint.tint *= 0.85;
    // Side walls and back, down to the ground.
    mesh.cuboid(paint, Vec3::new(0.0, low, -DEPTH_M), Vec3::new(width, height, 0.0), ABOVE | BELOW | FRONT);
    for opening in openings {
        reveal(house, opening, mesh);
    }
    plinth(house, openings, mesh);
    courses(house, mesh);
    cornice(house, mesh);
    if house.has_quoins {
        quoins(house, mesh);
    }
    if house.has_pilasters {
        pilasters(house, mesh);
    }
    downpipe(house, mesh);
}

/// Top of the ground floor's own wall.
fn base_top(house: &House) -> f32 {
    house.foot + house.ground_m - 0.1
}

fn wall(house: &House, openings: &[Opening], mesh: &mut Mesh, heights: [f32; 2]) {
    let base_top = base_top(house);
    let mut xs = vec![0.0, house.width_m, 0.12, house.width_m - 0.12];
    let mut ys = vec![heights[0], heights[1], house.foot, house.foot + PLINTH_M, base_top, heights[1] - 0.35];
    for opening in openings {
        xs.extend(opening.x);
        ys.extend(opening.y);
        if opening.is_window {
            xs.extend([opening.x[0] - 0.2, opening.x[1] + 0.2]);
        }
    }
    xs.retain(|x| (0.0..=house.width_m).contains(x));
    ys.retain(|y| (heights[0]..=heights[1]).contains(y));
    let (xs, ys) = (cuts(xs), cuts(ys));
    let shift = Vec2::new(hash(house.seed as i32, 0, 311), hash(house.seed as i32, 1, 311));
    for is_base in [true, false] {
        let (material, tint) = if is_base { house.base } else { (house.wall, house.tint) };
        let tile = material.tile_m();
        // Whole courses: the shift is a multiple of the tile's rows.
        let rows = if matches!(material, Material::Plaster) { 97.0 } else { 18.0 };
        let shift = (shift * rows).floor() / rows;
        mesh.grid(
            [xs.len() - 1, ys.len() - 1],
            |i, j| {
                let (x, y) = (xs[i], ys[j]);
                let uv = Vec2::new(x, base_top - y) / tile + shift;
                let hue = world(x + 40.0, y, 4.5, 3, 303 + (house.seed & 0xFFFF)) - 0.5;
                let tone = Vec3::from(tint) * grime(house, openings, x, y);
                (
                    Vec3::new(x, y, 0.0),
                    uv,
                    (tone * Vec3::new(1.0 + 0.05 * hue, 1.0, 1.0 - 0.12 * hue)).min(Vec3::ONE),
                )
            },
            |i, j| {
                let (x, y) = ((xs[i] + xs[i + 1]) * 0.5, (ys[j] + ys[j + 1]) * 0.5);
                let is_open = |o: &Opening| (o.x[0]..o.x[1]).contains(&x) && (o.y[0]..o.y[1]).contains(&y);
                ((y < base_top) == is_base && !openings.iter().any(is_open)).then_some(material)
            },
        );
    }
}

/// Sides of an opening, to the visible depth of the wall.
fn reveal(house: &House, opening: &Opening, mesh: &mut Mesh) {
    let is_base = opening.y[0] < base_top(house);
    let (material, tint) = if is_base { house.base } else { (house.wall, house.tint) };
    let paint = Paint { material, tint: Vec3::from(tint) * 0.84 };
    let ([x0, x1], [y0, y1]) = (opening.x, opening.y);
    let deep = -REVEAL_M - 0.06;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.quad(paint, [p(x0, y0, 0.0), p(x0, y0, deep), p(x0, y1, deep), p(x0, y1, 0.0)]);
    mesh.quad(paint, [p(x1, y0, deep), p(x1, y0, 0.0), p(x1, y1, 0.0), p(x1, y1, deep)]);
    let shade = Paint { tint: paint.tint * 0.85, ..paint };
    mesh.quad(shade, [p(x0, y1, 0.0), p(x0, y1, deep), p(x1, y1, deep), p(x1, y1, 0.0)]);
    mesh.quad(paint, [p(x0, y0, deep), p(x0, y0, 0.0), p(x1, y0, 0.0), p(x1, y0, deep)]);
}

fn plinth(house: &House, openings: &[Opening], mesh: &mut Mesh) {
    let top = house.foot + PLINTH_M;
    let mut from = 0.0;
    let mut gaps: Vec<[f32; 2]> = openings.iter().filter(|o| o.y[0] < top).map(|o| o.x).collect();
    gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
    gaps.push([house.width_m; 2]);
    for (n, [to, next]) in gaps.into_iter().enumerate() {
        let count = ((to - from) / 0.85).ceil().max(1.0) as i32;
        if to > from + 0.02 {
            for k in 0..count {
                let at = |k: i32| from + (to - from) * k as f32 / count as f32;
                let mut paint = house.stone_paint();
                paint.tint *= mix(0.46, 0.66, hash(k + 31 * n as i32, house.seed as i32, 304));
                let (low, high) = (
                    Vec3::new(at(k) + 0.002, house.foot - 0.12, 0.0),
                    Vec3::new(at(k + 1) - 0.002, top, 0.045),
                );
                mesh.beveled(paint, low, high, 0.012);
            }
        }
        from = next;
    }
}

/// String courses between stories.
fn courses(house: &House, mesh: &mut Mesh) {
    let mut paint = house.stone_paint();
    paint.tint *= 0.92;
    for (k, _) in house.stories.iter().enumerate().filter(|(_, story)| story.has_course) {
        if k == 0 && house.shop.is_some() && house.kind == HouseKind::Old {
            continue;
        }
        let y = house.floor(k) - 0.14;
        let profile = [
            [0.0, y],
            [0.05, y],
            [0.06, y + 0.03],
            [0.10, y + 0.05],
            [0.11, y + 0.14],
            [0.02, y + 0.17],
            [0.0, y + 0.17],
        ];
        mesh.molding(paint, [0.0, house.width_m], 0.0, &profile);
    }
}

fn cornice(house: &House, mesh: &mut Mesh) {
    let mut paint = house.stone_paint();
    paint.tint *= 0.90;
    let (w, h) = (house.width_m, house.height_m());
    if house.kind == HouseKind::Old {
        // Ends of rafters under the eaves.
        let wood = tinted(Material::Wood, [0.20, 0.13, 0.08]);
        let count = (w / 0.55) as i32;
        for k in 0..count {
            let x = (k as f32 + 0.5) * w / count as f32;
            mesh.cuboid(
                wood,
                Vec3::new(x - 0.045, h - 0.20, 0.0),
                Vec3::new(x + 0.045, h - 0.06, 0.36),
                BEHIND,
            );
        }
        return;
    }
    let out = if matches!(house.kind, HouseKind::Boulevard | HouseKind::Classical) { 0.36 } else { 0.24 };
    let profile = [
        [0.0, h - 0.46],
        [0.035, h - 0.46],
        [0.035, h - 0.34],
        [0.07, h - 0.32],
        [0.09, h - 0.26],
        [out - 0.10, h - 0.17],
        [out - 0.04, h - 0.16],
        [out - 0.04, h - 0.08],
        [out - 0.02, h - 0.07],
        [out, h - 0.02],
        [out, h],
        [0.0, h + 0.02],
    ];
    mesh.molding(paint, [0.0, w], 0.0, &profile);
    // Brackets or teeth.
    let (gap, wide) = if out > 0.3 { (0.46, 0.13) } else { (0.20, 0.09) };
    let count = (w / gap) as i32;
    for k in 0..count {
        let x = (k as f32 + 0.5) * w / count as f32;
        let (low, high) =
            (Vec3::new(x - wide / 2.0, h - 0.31, 0.06), Vec3::new(x + wide / 2.0, h - 0.18, out - 0.08));
        mesh.cuboid(paint, low, high, BEHIND | ABOVE);
    }
}

/// Blocks of two lengths in turn along the ends of the front.
fn quoins(house: &House, mesh: &mut Mesh) {
    let (from, to) = (base_top(house) + 0.15, house.height_m() - 0.5);
    let count = ((to - from) / 0.36).round().max(1.0) as i32;
    for k in 0..count {
        let y = [0, 1].map(|n| from + (to - from) * (k + n) as f32 / count as f32);
        let long = if k % 2 == 0 { 0.48 } else { 0.30 };
        let mut paint = house.stone_paint();
        paint.tint *= mix(0.82, 1.0, hash(k, house.seed as i32, 305));
        for x in [[0.0, long], [house.width_m - long, house.width_m]] {
            mesh.beveled(
                paint,
                Vec3::new(x[0], y[0] + 0.004, 0.0),
                Vec3::new(x[1], y[1] - 0.004, 0.03),
                0.012,
            );
        }
    }
}

/// Flat columns between the bays.
fn pilasters(house: &House, mesh: &mut Mesh) {
    let paint = house.stone_paint();
    let (low, high) = (base_top(house) + 0.14, house.height_m() - 0.48);
    for bay in 0..=house.bays {
        let x =
            (0.45 + (house.width_m - 0.9) * bay as f32 / house.bays as f32).clamp(0.24, house.width_m - 0.30);
        let block = |mesh: &mut Mesh, half: f32, y: [f32; 2], out: f32| {
            mesh.beveled(paint, Vec3::new(x - half, y[0], 0.0), Vec3::new(x + half, y[1], out), 0.008);
        };
        block(mesh, 0.17, [low, high], 0.06);
        block(mesh, 0.21, [low, low + 0.30], 0.085);
        block(mesh, 0.22, [high - 0.26, high], 0.10);
        block(mesh, 0.19, [high - 0.38, high - 0.32], 0.085);
    }
}

/// A downpipe at the right end of the front.
fn downpipe(house: &House, mesh: &mut Mesh) {
    let paint = tinted(Material::Zinc, [0.75, 0.76, 0.76]);
    let (x, foot) = (house.width_m - 0.10, house.foot);
    let top = house.height_m() + if matches!(house.roof, Roof::Pitched { .. }) { -0.1 } else { 0.02 };
    let path: Vec<(Vec3, f32)> =
        [(top - 0.05, 0.34), (top - 0.22, 0.33), (top - 0.55, 0.15), (top - 0.72, 0.10), (foot + 1.9, 0.10)]
            .map(|(y, z)| (Vec3::new(x, y, z), 0.046))
            .to_vec();
    mesh.tube(paint, &path, 8);
    // The lowest part is of cast iron, with a shoe.
    let iron = tinted(Material::Iron, [0.22, 0.215, 0.20]);
    let path: Vec<(Vec3, f32)> =
        [(foot + 1.95, 0.10), (foot + 0.22, 0.10), (foot + 0.10, 0.14), (foot + 0.05, 0.22)]
            .map(|(y, z)| (Vec3::new(x, y, z), 0.055))
            .to_vec();
    mesh.tube(iron, &path, 8);
    let mut y = foot + 1.2;
    while y < top - 1.0 {
        mesh.cuboid(paint, Vec3::new(x - 0.06, y, 0.0), Vec3::new(x + 0.06, y + 0.03, 0.155), BEHIND);
        y += 2.3;
    }
}
