//! Rooms behind windows: back walls, side walls, ceilings and floors, by day and by lamp light; and curtains.
//!
//! The picture of rooms has 4 x 4 cells: eight back walls above, then four side walls, then two ceilings and two floors.

use crate::noise::{fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Back walls.
pub(crate) const VIEWS: u32 = 8;
/// Curtains in the picture of curtains, side by side.
pub(crate) const CURTAINS: u32 = 4;

/// Texels along each edge of the pictures of rooms.
const SIZE: u32 = 768;

/// Colors of wall papers.
const WALLS: [[f32; 3]; 4] = [[0.62, 0.55, 0.43], [0.50, 0.53, 0.47], [0.66, 0.63, 0.58], [0.52, 0.40, 0.33]];

/// A box in a view: from x, to x, from y, to y, color.
type Thing = ([f32; 4], [f32; 3]);

/// Pictures, shelves, cupboards and people of a view.
fn things(view: u32) -> Vec<Thing> {
    let r = |n: i32| hash(view as i32, n, 132);
    let wood = mix3([0.22, 0.13, 0.07], [0.40, 0.30, 0.2], r(1));
    let mut all = Vec::new();
    let x = mix(0.15, 0.6, r(2));
    match view % 4 {
        0 => {
            all.push(([x, x + 0.26, 0.22, 0.44], [0.2, 0.15, 0.08]));
            all.push(([x + 0.02, x + 0.24, 0.24, 0.42], mix3([0.25, 0.3, 0.28], [0.5, 0.4, 0.3], r(3))));
            all.push(([0.05, 0.5, 0.70, 1.0], wood));
        }
        1 => {
            // A wall of shelves, filled.
            all.push(([0.03, 0.97, 0.10, 1.0], wood.map(|c| 0.55 * c)));
            for row in 0..5 {
                let y = 0.115 + 0.176 * row as f32;
                all.push(([0.03, 0.97, y + 0.155, y + 0.176], wood));
                let mut left = 0.05;
                let mut k = 100 * row;
                while left < 0.92 {
                    k += 5;
                    let wide = mix(0.018, 0.085, r(k) * r(k));
                    if r(k + 1) > 0.14 {
                        let tall = mix(0.05, 0.145, r(k + 2));
                        let gray = mix(0.03, 0.62, r(k + 3) * r(k + 3));
                        let color = mix3([1.25, 0.85, 0.55], [0.75, 1.0, 1.05], r(k + 4)).map(|c| c * gray);
                        let right = (left + wide).min(0.955);
                        all.push(([left, right, y + 0.155 - tall, y + 0.155], color));
                    }
                    left += wide + 0.004;
                }
            }
        }
        2 => {
            all.push(([x, x + 0.30, 0.12, 1.0], wood.map(|c| c * 1.4)));
            all.push(([x + 0.04, x + 0.26, 0.18, 0.5], wood.map(|c| c * 1.15)));
            all.push(([x + 0.04, x + 0.26, 0.56, 0.94], wood.map(|c| c * 1.15)));
            if view > 3 {
                // Somebody stands before the wall.
                let (dark, skin) = ([0.05, 0.055, 0.07], [0.16, 0.10, 0.075]);
                let at = if x > 0.4 { x - 0.18 } else { x + 0.42 };
                all.push(([at - 0.075, at + 0.075, 0.50, 1.0], dark));
                all.push(([at - 0.055, at + 0.055, 0.475, 0.50], dark));
                all.push(([at - 0.018, at + 0.018, 0.44, 0.475], skin));
                all.push(([at - 0.033, at + 0.033, 0.355, 0.45], skin));
                all.push(([at - 0.036, at + 0.036, 0.335, 0.38], [0.04, 0.03, 0.02]));
            }
        }
        _ => {
            all.push(([x, x + 0.12, 0.25, 0.42], [0.55, 0.5, 0.4]));
            all.push(([x + 0.17, x + 0.30, 0.20, 0.36], [0.3, 0.22, 0.2]));
            all.push(([0.45, 0.95, 0.74, 1.0], [0.30, 0.14, 0.12]));
        }
    }
    all
}

/// The cell of a point: its number, and the point in it.
fn cell(u: f32, v: f32) -> (u32, f32, f32) {
    let (x, y) = (u * 4.0, v * 4.0);
    (x.floor() as u32 + 4 * y.floor() as u32, x.fract(), y.fract())
}

/// Albedo of walls and things.
fn albedo(views: &[Vec<Thing>], u: f32, v: f32) -> [f32; 3] {
    let (number, x, y) = cell(u, v);
    match number {
        0..VIEWS => {
            let wall = WALLS[number as usize % 4];
            let base = if y > 0.93 {
                [0.6, 0.58, 0.54]
            } else {
                wall.map(|c| c * mix(0.94, 1.04, fractal(x, y, [8, 8], 2, 131)))
            };
            let found = views[number as usize]
                .iter()
                .rev()
                .find(|([x0, x1, y0, y1], _)| (*x0..*x1).contains(&x) && (*y0..*y1).contains(&y));
            found.map_or(base, |(_, color)| *color)
        }
        8..12 => WALLS[number as usize % 4].map(|c| c * mix(0.9, 1.0, fractal(x, y, [3, 3], 3, 133))),
        12..14 => [0.72, 0.71, 0.68],
        _ => mix3([0.20, 0.12, 0.07], [0.30, 0.19, 0.11], fractal(x, y, [20, 3], 2, 134)),
    }
}

/// Reflectance by day.
pub(super) fn by_day() -> Raster {
    let views: Vec<Vec<Thing>> = (0..VIEWS).map(things).collect();
    Raster::new(SIZE, SIZE, |u, v| {
        let [r, g, b] = albedo(&views, u, v);
        [r, g, b, 1.0]
    })
}

/// Radiance with the room's light on, relative to the brightest.
pub(super) fn lit() -> Raster {
    let views: Vec<Vec<Thing>> = (0..VIEWS).map(things).collect();
    Raster::new(SIZE, SIZE, |u, v| {
        let (number, x, y) = cell(u, v);
        let middle = 1.0 - (2.0 * x - 1.0) * (2.0 * x - 1.0);
        let light = match number {
            // A lamp hangs from the ceiling; some rooms have one on a table.
            0..VIEWS if number % 3 == 2 => {
                let (dx, dy) = (x - 0.7, y - 0.62);
                0.28 + 0.9 * smooth(0.6, 0.0, (dx * dx + dy * dy).sqrt())
            }
            0..VIEWS => mix(0.55, 1.0, middle) * mix(1.0, 0.42, smooth(0.1, 1.0, y)),
            8..12 => mix(0.8, 0.45, x) * mix(0.9, 0.5, y),
            12..14 => mix(0.55, 1.0, middle),
            _ => 0.55,
        };
        let [r, g, b] = albedo(&views, u, v).map(|c| (1.35 * c * light).min(1.0));
        [r, g, b, 1.0]
    })
}

/// Curtains: linen, rust, net, blue; folds along v.
pub(super) fn curtains() -> Raster {
    const CLOTHS: [[f32; 3]; 4] =
        [[0.60, 0.55, 0.46], [0.40, 0.24, 0.17], [0.66, 0.65, 0.62], [0.33, 0.37, 0.42]];
    Raster::new(512, 128, |u, v| {
        let k = (u * CURTAINS as f32).floor();
        let x = u * CURTAINS as f32 - k;
        let fold = x * 6.0 + fractal(x, v, [5, 1], 2, 121) * 1.2;
        let t = fold - fold.floor();
        let shade = mix(0.5, 1.0, 4.0 * t * (1.0 - t)) * mix(1.0, 0.78, v);
        let [r, g, b] = CLOTHS[(k as usize).min(3)].map(|c| c * shade);
        [r, g, b, 1.0]
    })
}
