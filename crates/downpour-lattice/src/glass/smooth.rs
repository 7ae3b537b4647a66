//! Smoothing of heights, so that touching drops form one surface. Twin of `shaders/wgsl/lattice/glass_smooth.wgsl`.

use glam::{IVec2, UVec2};
use rayon::prelude::*;

use super::frame::{GlassFrame, glass_frame_cell, glass_frame_index};

/// Height at a cell; cells outside the pane are clamped to its edge.
fn glass_smooth_at(frame: &GlassFrame, from: &[u32], cell: IVec2) -> u32 {
    let inside = cell.clamp(IVec2::ZERO, UVec2::from(frame.size).as_ivec2() - 1);
    from[glass_frame_index(frame, inside) as usize]
}

/// Binomial mean of three by three cells.
fn glass_smooth_mean(frame: &GlassFrame, from: &[u32], cell: IVec2) -> u32 {
    let mut sum = 8;
    for y in -1..=1i32 {
        for x in -1..=1i32 {
            sum += glass_smooth_at(frame, from, cell + IVec2::new(x, y))
                * ((2 - x.abs()) * (2 - y.abs())) as u32;
        }
    }
    sum >> 4
}

/// Smooths all cells once.
pub(super) fn smooth(frame: &GlassFrame, from: &[u32]) -> Vec<u32> {
    let mean = |index| glass_smooth_mean(frame, from, glass_frame_cell(frame, index as u32));
    (0..from.len()).into_par_iter().map(mean).collect()
}
