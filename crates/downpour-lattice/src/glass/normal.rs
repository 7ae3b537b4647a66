//! Normals of the water surface by a Sobel filter (Tatarchuk & Isidoro 2006, section 5).
//! Twin of `shaders/wgsl/lattice/glass_normal.wgsl`.

use glam::{IVec2, UVec2, Vec2};
use rayon::prelude::*;

use super::frame::{GlassFrame, glass_frame_cell, glass_frame_index};

/// Height at a cell; cells outside the pane are clamped to its edge.
fn glass_normal_at(frame: &GlassFrame, heights: &[u32], cell: IVec2) -> i32 {
    let inside = cell.clamp(IVec2::ZERO, UVec2::from(frame.size).as_ivec2() - 1);
    heights[glass_frame_index(frame, inside) as usize] as i32
}

/// Sobel sums along x and y: 2048 is a slope of 1.
fn glass_normal_sobel(frame: &GlassFrame, heights: &[u32], cell: IVec2) -> IVec2 {
    let at = |x, y| glass_normal_at(frame, heights, cell + IVec2::new(x, y));
    let mut sum = IVec2::ZERO;
    for k in -1..=1i32 {
        let weight = 2 - k.abs();
        sum.x += weight * (at(1, k) - at(-1, k));
        sum.y += weight * (at(k, 1) - at(k, -1));
    }
    sum
}

/// x and y of the unit normal of a surface from its slopes times 2048.
#[inline]
#[must_use]
pub fn glass_normal_unit(sobel: IVec2) -> Vec2 {
    let slope = sobel.as_vec2() / 2048.0;
    -slope / (1.0 + slope.x * slope.x + slope.y * slope.y).sqrt()
}

/// x and y of the normals of all cells.
pub(super) fn normals(frame: &GlassFrame, heights: &[u32]) -> Vec<Vec2> {
    let normal =
        |index| glass_normal_unit(glass_normal_sobel(frame, heights, glass_frame_cell(frame, index as u32)));
    (0..heights.len()).into_par_iter().map(normal).collect()
}
