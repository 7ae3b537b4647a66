//! Views through windows: eight views of rooms, four in a row, by day and by lamp light.
//!
//! By day a room shows a few hundredths of the light of its walls through the pane, curtains a fifth. A room lit with 100 lux has
//! walls and curtains of 10 to 40 cd/m^2; the lit picture is relative to the brightest.

use crate::scenes::noise::{fractal, hash, mix, mix3, smooth};
use crate::scenes::raster::Raster;

/// Views in a row, and rows.
pub(in crate::scenes) const VIEWS: [u32; 2] = [4, 2];

/// The two pictures.
pub(super) struct Panes {
    /// Reflectance by day.
    pub(super) by_day: Raster,
    /// Radiance with the room's light on, relative.
    pub(super) lit: Raster,
}

/// Folds of a curtain at a sideways position, 0 in a valley to 1.
fn folds(u: f32, count: f32, seed: u32) -> f32 {
    let x = u * count + fractal(u, 0.5, [9, 1], 2, seed) * 0.9;
    let t = x - x.floor();
    let ridge = 4.0 * t * (1.0 - t);
    mix(0.45, 1.0, ridge)
}

/// Fraction of a view that a curtain covers, with its folds: view 0 has drawn curtains, 1 and 4 parted ones, 2 a net, 3 a blind,
/// 5 none, 6 a net below the middle, 7 one half drawn.
fn curtain(view: u32, u: f32, v: f32) -> Option<(f32, [f32; 3])> {
    const LINEN: [f32; 3] = [0.55, 0.50, 0.42];
    const RUST: [f32; 3] = [0.42, 0.22, 0.14];
    const BLUE: [f32; 3] = [0.28, 0.33, 0.40];
    let swing = 0.04 * fractal(0.5, v, [1, 3], 2, 120 + view);
    let parted = |open: f32| u.min(1.0 - u) < open + swing - 0.05 * v;
    match view {
        0 => Some((folds(u, 11.0, 121), RUST)),
        1 if parted(0.26) => Some((folds(u, 14.0, 122), LINEN)),
        2 => Some((folds(u, 9.0, 123) * 0.5 + 0.35, [0.62, 0.61, 0.58])),
        3 if v < 0.46 => {
            let slat = (v * 48.0).fract();
            Some((mix(0.55, 1.0, slat), [0.60, 0.58, 0.52]))
        }
        4 if parted(0.16) => Some((folds(u, 18.0, 124), BLUE)),
        6 if v > 0.52 => Some((folds(u, 10.0, 125) * 0.4 + 0.4, [0.60, 0.59, 0.56])),
        7 if u < 0.52 + swing => Some((folds(u, 12.0, 126), LINEN)),
        _ => None,
    }
}

/// A room behind the pane: a far wall with a picture or a shelf, darker toward the floor, in [0, 1].
fn room(view: u32, u: f32, v: f32) -> [f32; 3] {
    let wall = mix3([0.75, 0.62, 0.42], [0.62, 0.62, 0.58], hash(view as i32, 0, 130));
    let light = mix(1.0, 0.35, v) * mix(0.75, 1.1, fractal(u, v, [3, 5], 2, 131 + view));
    let (x, y) = (hash(view as i32, 1, 132), hash(view as i32, 2, 132));
    let picture = (u - mix(0.3, 0.7, x)).abs() < 0.13 && (v - mix(0.4, 0.5, y)).abs() < 0.08;
    let shelf = v > 0.62 && (u - mix(0.2, 0.8, y)).abs() < 0.2;
    let shade = if picture {
        0.35
    } else if shelf {
        0.22
    } else {
        1.0
    };
    wall.map(|c| c * light * shade)
}

/// Makes both pictures, 512 texels square.
pub(super) fn panes() -> Panes {
    let view_at = |u: f32, v: f32| {
        let (x, y) = (u * VIEWS[0] as f32, v * VIEWS[1] as f32);
        let view = x.floor() as u32 + VIEWS[0] * y.floor() as u32;
        (view, x.fract(), y.fract())
    };
    let by_day = Raster::new(512, 512, |u, v| {
        let (view, u, v) = view_at(u, v);
        let [r, g, b] = match curtain(view, u, v) {
            Some((fold, color)) => color.map(|c| c * fold * 0.42),
            None => room(view, u, v).map(|c| c * 0.05 + 0.004),
        };
        [r, g, b, 1.0]
    });
    let lit = Raster::new(512, 512, |u, v| {
        let (view, u, v) = view_at(u, v);
        // A lamp under the ceiling: brighter above and in the middle.
        let strength = mix(0.25, 1.0, hash(view as i32, 9, 133));
        let lamp = strength * mix(1.0, 0.4, v) * mix(1.0, 0.7, (2.0 * u - 1.0) * (2.0 * u - 1.0));
        const WARM: [f32; 3] = [1.0, 0.70, 0.40];
        let color = match curtain(view, u, v) {
            Some((fold, cloth)) => {
                let through: [f32; 3] = std::array::from_fn(|k| WARM[k] * mix(0.25, 1.0, cloth[k]));
                through.map(|c| c * mix(0.35, 1.0, fold) * lamp * 0.55)
            }
            None => {
                let room = room(view, u, v);
                std::array::from_fn(|k| WARM[k] * room[k] * lamp * 0.9)
            }
        };
        // Edges of the pane receive less light.
        let frame = smooth(0.0, 0.06, u.min(1.0 - u)) * smooth(0.0, 0.04, v.min(1.0 - v));
        let [r, g, b] = color.map(|c| c * mix(0.6, 1.0, frame));
        [r, g, b, 1.0]
    });
    Panes { by_day, lit }
}
