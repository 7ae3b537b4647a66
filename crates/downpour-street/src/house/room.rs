//! Rooms behind windows: a box with a back wall, and curtains; some are lit at night, each in its own hue.

use glam::{Vec2, Vec3};

use super::{House, Opening, REVEAL_M};
use crate::material::{Material, ROOM_LIGHTS};
use crate::mesh::{Mesh, Paint, tinted};
use crate::noise::{hash, mix};
use crate::textures::{CURTAINS, VIEWS};

/// A cell of the picture of rooms as corners, from the lower left.
pub(super) fn cell(number: u32) -> [Vec2; 4] {
    let (x, y) = ((number % 4) as f32, (number / 4) as f32);
    [[0.02, 0.98], [0.98, 0.98], [0.98, 0.02], [0.02, 0.02]].map(|[a, b]| Vec2::new(x + a, y + b) / 4.0)
}

/// Draws the room of a window on a story.
pub(super) fn room(house: &House, opening: &Opening, story: usize, mesh: &mut Mesh) {
    let id = [(opening.x[0] * 100.0) as i32 + 977 * house.seed as i32, (opening.y[0] * 100.0) as i32];
    let random = |n: u32| hash(id[0], id[1], 321 + n);
    // Rooms of a flat are lit together, more or less.
    let flat = hash(house.seed as i32, story as i32, 330);
    let is_lit = random(0) < (house.lit * (0.35 + 1.3 * flat)).min(1.0);
    let light = if is_lit { 1 + (random(1) * f32::from(ROOM_LIGHTS - 1)) as u8 } else { 0 };
    let paint = Paint { material: Material::Room(light), tint: Vec3::splat(mix(0.5, 0.9, random(2))) };
    let ([x0, x1], [y0, y1]) = (opening.x, opening.y);
    let (front, back) = (-REVEAL_M - 0.06, -REVEAL_M - mix(1.1, 1.9, random(3)));
    // The room is wider than its window, up to half a meter.
    let (l, r, low, high) = (x0 - 0.35, x1 + 0.35, y0 - 0.25, y1 + 0.25);
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let view = (random(4) * VIEWS as f32) as u32;
    let wall = 8 + view % 4;
    mesh.quad_uv(paint, [p(l, low, back), p(r, low, back), p(r, high, back), p(l, high, back)], cell(view));
    mesh.quad_uv(paint, [p(l, low, front), p(l, low, back), p(l, high, back), p(l, high, front)], cell(wall));
    mesh.quad_uv(paint, [p(r, low, back), p(r, low, front), p(r, high, front), p(r, high, back)], cell(wall));
    mesh.quad_uv(paint, [p(l, high, back), p(r, high, back), p(r, high, front), p(l, high, front)], cell(12));
    mesh.quad_uv(paint, [p(l, low, front), p(r, low, front), p(r, low, back), p(l, low, back)], cell(14));
    curtains(opening, light, [random(5), random(6), random(7)], mesh);
}

/// Curtains at the sides, half drawn, or a net over the lower half.
fn curtains(opening: &Opening, light: u8, [sort, drawn, cloth]: [f32; 3], mesh: &mut Mesh) {
    let paint = tinted(Material::Curtain(light), [0.92; 3]);
    let ([x0, x1], [y0, y1]) = (opening.x, opening.y);
    let width = x1 - x0;
    let number = (cloth * CURTAINS as f32) as u32;
    let mut sheet = |from: f32, to: f32, low: f32, number: u32| {
        const FOLDS: usize = 8;
        let z = -REVEAL_M - 0.13;
        mesh.grid(
            [FOLDS, 1],
            |i, j| {
                let t = i as f32 / FOLDS as f32;
                let fold = if i % 2 == 0 { 0.025 } else { -0.025 };
                let y = if j == 0 { low } else { y1 + 0.1 };
                let uv =
                    Vec2::new((number as f32 + 0.03 + 0.94 * t) / CURTAINS as f32, 1.0 - j as f32 * 0.98);
                (Vec3::new(mix(from, to, t), y, z + fold), uv, paint.tint)
            },
            |_, _| Some(paint.material),
        );
    };
    if sort < 0.40 {
        let side = width * mix(0.12, 0.24, drawn);
        sheet(x0, x0 + side, y0 - 0.1, number);
        sheet(x1 - side, x1, y0 - 0.1, number);
    } else if sort < 0.55 {
        sheet(x0, x0 + width * mix(0.45, 0.8, drawn), y0 - 0.1, number);
    } else if sort < 0.72 {
        sheet(x0, x1, y0 - 0.1, 2);
    } else if sort < 0.84 {
        sheet(x0, x0 + width * 0.5 - 0.01, y0 - 0.1, number);
        sheet(x0 + width * 0.5 + 0.01, x1, y0 - 0.1, number);
    }
}
