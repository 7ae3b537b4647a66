//! Directions of light, and the frame of a streak.
//!
//! The committed directions lie on rings around the line of sight, so that a ring is one scattering angle: 0 is light
//! from behind the drop, 180 degrees light from the viewer. Scattering by a sphere depends on that angle alone.

use downpour_math::ops::f64 as ops;
use downpour_shaders::atlas::{ATLAS_GRID, ATLAS_RISE_LIMIT, ATLAS_RISES};

/// Scattering angle in degrees of each ring, and its directions from below to above, both on the plane of symmetry.
const RINGS: [(f64, u32); 9] =
    [(0.0, 1), (20.0, 4), (40.0, 5), (60.0, 6), (80.0, 7), (105.0, 7), (130.0, 6), (155.0, 4), (180.0, 1)];

/// The directions toward the light of the committed atlas, in the frame of the streak, x >= 0.
#[must_use]
pub fn light_directions() -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for (degrees, count) in RINGS {
        let (away, along) = (ops::sin(degrees.to_radians()), ops::cos(degrees.to_radians()));
        for k in 0..count {
            // The ends are exactly on the plane x = 0.
            let end = k == 0 || k + 1 == count;
            let turn = if count == 1 { 0.0 } else { f64::from(k) / f64::from(count - 1) - 0.5 };
            let (up, right) = match (count, end) {
                (1, _) => (0.0, 0.0),
                (_, true) => (2.0 * turn, 0.0),
                _ => (ops::sin(turn * std::f64::consts::PI), ops::cos(turn * std::f64::consts::PI)),
            };
            all.push([away * right, away * up, -along]);
        }
    }
    all
}

/// Directions toward the light for which the amount of a streak is stored, in the frame of the streak, x >= 0: `ATLAS_GRID`
/// columns times as many rows, rows along z, columns along y.
///
/// Node (i, k) is the direction whose point (y, z) / (1 + x) is (i, k) in cells of the square from -1 to 1. The disk holds all
/// directions with x >= 0; a node outside of it is a direction with x < 0, and its mirror image is in its slot, so that linear
/// interpolation holds at the rim too.
#[must_use]
pub fn amount_directions() -> Vec<[f64; 3]> {
    let at = |k: u32| 2.0 * f64::from(k) / f64::from(ATLAS_GRID - 1) - 1.0;
    let direction = |k: u32| {
        let (y, z) = (at(k % ATLAS_GRID), at(k / ATLAS_GRID));
        let square = y * y + z * z;
        let scale = 1.0 / (1.0 + square);
        [(1.0 - square).abs() * scale, 2.0 * y * scale, 2.0 * z * scale]
    };
    (0..ATLAS_GRID * ATLAS_GRID).map(direction).collect()
}

/// The elevations of the viewer for which the amount of a streak is stored, in radians: 25, equal steps of the sine from -0.96 to
/// 0.96 (74 degrees).
#[must_use]
pub fn amount_elevations() -> Vec<f64> {
    let middle = (ATLAS_RISES - 1) / 2;
    let step = f64::from(ATLAS_RISE_LIMIT) / f64::from(middle);
    (0..ATLAS_RISES).map(|k| ops::asin(step * (f64::from(k) - f64::from(middle)))).collect()
}

/// Right, up and toward the viewer of the streak of a drop with the axis +Y, seen from `elevation` radians above its
/// horizontal plane.
#[must_use]
pub fn streak_frame(elevation: f64) -> [[f64; 3]; 3] {
    let (sine, cosine) = (ops::sin(elevation), ops::cos(elevation));
    [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]]
}
