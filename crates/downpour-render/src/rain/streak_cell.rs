//! Positions across a drop and along a chord: the rim, where the light changes fastest, has more of them. Twin of
//! `shaders/wgsl/render/streak_cell.wgsl`.

use downpour_math::ops;
use downpour_shaders::render::rain::STREAK_QUARTER;

/// Position between -1 and 1 of a cell coordinate from 0 to `count`: 0 is the first edge, 0.5 the middle of the first cell.
#[must_use]
pub fn streak_cell_position(position: f32, count: u32) -> f32 {
    ops::sin(STREAK_QUARTER * (position * (2.0 / count as f32) - 1.0))
}

/// Cell coordinate of a position: 0 at -1, `count` at 1.
#[must_use]
pub fn streak_cell_index(position: f32, count: u32) -> f32 {
    (ops::asin(position.clamp(-1.0, 1.0)) / STREAK_QUARTER * 0.5 + 0.5) * count as f32
}

/// Slope of the position over the angle at a cell coordinate: the cosine whose sine is the position.
#[must_use]
pub fn streak_cell_slope(position: f32, count: u32) -> f32 {
    ops::cos(STREAK_QUARTER * (position * (2.0 / count as f32) - 1.0))
}

/// Mean over a cell of the squared slope, as a lookup weighs it that is linear between the middles of cells: the integral of the squared
/// slope times the cell's hat, over the width of a cell. Beyond the middles of the first and the last cell the lookup is constant.
///
/// With `u` the angle of a cell, `c` its middle's cosine and `s = sin^2(u) / u^2`: `(1 - s) / 2 + s c^2`, and
/// `u^2 (5 / 12 - 91 / 720 u^2)` at either end; by series, for differences of nearly equal numbers have no digits left.
#[must_use]
pub fn streak_cell_weight(cell: u32, count: u32) -> f32 {
    let angle = 2.0 * STREAK_QUARTER / count as f32;
    let square = angle * angle;
    if cell == 0 || cell + 1 == count {
        return square * (5.0 / 12.0 - square * (91.0 / 720.0));
    }
    let slope = streak_cell_slope(cell as f32 + 0.5, count);
    // 1 - s.
    let flat = square * (1.0 / 3.0 - square * (2.0 / 45.0));
    0.5 * flat + (1.0 - flat) * (slope * slope)
}
