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
