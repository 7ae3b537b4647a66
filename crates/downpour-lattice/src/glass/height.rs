//! Heights of the water, and normals of its surface. Twin of `shaders/wgsl/lattice/glass_height.wgsl`.
//!
//! Each drop is a cap of a sphere over its disk, stretched behind its center if it moves; the highest of overlapping
//! caps counts.

use std::sync::atomic::{AtomicU32, Ordering};

use downpour_shaders::lattice::glass::{GLASS_CELL, GLASS_HEIGHT_STRETCH};
use glam::IVec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::frame::{GlassFrame, glass_frame_cell, glass_frame_holds, glass_frame_index};
use super::motion::{glass_motion_length, glass_motion_root, glass_motion_unpack};
use super::ridge::{glass_ridge_center, glass_ridge_is};
use super::size::GlassTable;

/// Stretch of a drop behind its center relative to the front, in units of 1/256.
#[inline]
#[must_use]
pub fn glass_height_stretch(speed: u32) -> u32 {
    256 + speed.min(GLASS_CELL as u32) / GLASS_HEIGHT_STRETCH
}

/// Squared distance of a cell from the center of a drop, with the stretch undone, in (cells / 256)^2.
#[inline]
#[must_use]
pub fn glass_height_squared(away: IVec2, v: IVec2) -> u32 {
    let speed = glass_motion_length(v) as i32;
    // A drop this slow is round; its direction is not resolved.
    if speed < 4 {
        return ((away.x * away.x + away.y * away.y) as u32) << 16;
    }
    let along = (away.x * v.x + away.y * v.y) * 16 / speed * 16;
    let across = (away.y * v.x - away.x * v.y) * 16 / speed * 16;
    let behind = along * 256 / glass_height_stretch(speed as u32) as i32;
    let far = if along > 0 { along } else { behind };
    (far * far) as u32 + (across * across) as u32
}

/// Height of a cap at a squared distance, all in cells / 256.
#[inline]
#[must_use]
pub fn glass_height_cap(radius: u32, sphere: u32, squared: u32) -> u32 {
    if squared >= radius * radius {
        return 0;
    }
    glass_motion_root(sphere * sphere - squared) - glass_motion_root(sphere * sphere - radius * radius)
}

/// Adds the cap of the drop of a cell. Of a ridge it is a cap as wide, which those of its neighbors make a ridge.
fn glass_height_drop(
    cells: &Cells,
    frame: &GlassFrame,
    table: &GlassTable,
    heights: &[AtomicU32],
    cell: IVec2,
) {
    let index = glass_frame_index(frame, cell) as usize;
    let row = table.row(cells.mass[index]);
    let mut v = glass_motion_unpack(cells.motion[index][0]);
    let (mut center, mut radius, mut sphere) = (cell, row.radius, row.sphere);
    if glass_ridge_is(cells.motion[index][1]) {
        center = glass_ridge_center(cell, v, row.ahead);
        radius = row.ridge;
        sphere = row.sphere * row.ridge / row.radius.max(1);
        v = IVec2::ZERO;
    }
    // The rim may be 15 % beyond the disk.
    let reach = (radius * glass_height_stretch(glass_motion_length(v)) / 56000) as i32 + 1;
    for y in -reach..=reach {
        for x in -reach..=reach {
            let to = center + IVec2::new(x, y);
            if !glass_frame_holds(frame, to) {
                continue;
            }
            let at = glass_frame_index(frame, to) as usize;
            // The rim follows the affinity of the glass: inwards where it repels, outwards where it attracts.
            let rim = 320 - (cells.surface[at] & 255) / 2;
            let squared = (glass_height_squared(IVec2::new(x, y), v) >> 8) * rim;
            let height = glass_height_cap(radius, sphere, squared);
            if height != 0 {
                heights[at].fetch_max(height, Ordering::Relaxed);
            }
        }
    }
}

/// Heights of all cells, in cells / 256, before smoothing.
pub(super) fn caps(cells: &Cells, frame: &GlassFrame, table: &GlassTable) -> Vec<u32> {
    let heights: Vec<AtomicU32> = cells.mass.iter().map(|_| AtomicU32::new(0)).collect();
    cells.drops.par_iter().for_each(|&index| {
        glass_height_drop(cells, frame, table, &heights, glass_frame_cell(frame, index));
    });
    heights.into_iter().map(AtomicU32::into_inner).collect()
}
