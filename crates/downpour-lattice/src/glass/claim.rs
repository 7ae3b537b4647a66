//! Claim: each drop claims the cells that it wets; the largest wins, before it a ridge that a blade pushes. Twin of `shaders/wgsl/lattice/glass_claim.wgsl`.

use std::sync::atomic::Ordering;

use downpour_shaders::lattice::glass::{GLASS_RIDGE, GLASS_RIDGE_CLASS};
use glam::IVec2;

use super::cells::{Cells, Tick};
use super::frame::{glass_frame_holds, glass_frame_index};
use super::motion::glass_motion_unpack;
use super::ridge::{glass_ridge_center, glass_ridge_is};
use super::size::glass_size_key;

/// Claims the disk of a drop, or the width of a ridge; a moving drop also wets it. A ridge leaves an eighth of that film, which
/// dries in an eighth of the time.
pub(super) fn glass_claim_drop(cells: &Cells, tick: &Tick<'_>, cell: IVec2) {
    let index = glass_frame_index(tick.frame, cell);
    let mass = cells.mass[index as usize];
    if mass == 0 {
        return;
    }
    let row = tick.table.row(mass);
    let mut key = glass_size_key(mass, index);
    let [velocity, progress] = cells.motion[index as usize];
    let moves = velocity != 0;
    let (mut center, mut radius, mut stamp) = (cell, row.radius, tick.clock);
    if glass_ridge_is(progress) {
        center = glass_ridge_center(cell, glass_motion_unpack(velocity), row.ahead);
        radius = row.ridge;
        stamp = tick.clock - (56 * tick.frame.wet_life).min(tick.clock - 1);
        if progress != GLASS_RIDGE {
            key = (GLASS_RIDGE_CLASS << 24) | index;
        }
    }
    let reach = (radius >> 8) as i32;
    let most = radius * radius;
    for y in -reach..=reach {
        // The cells of a row that WGSL tests one by one.
        let mut half = reach;
        while ((half * half + y * y) as u32) << 16 > most {
            half -= 1;
        }
        let low = center + IVec2::new(-half, y);
        let high = center + IVec2::new(half, y);
        let (low, high) = (low.with_x(low.x.max(0)), high.with_x(high.x.min(tick.frame.size[0] as i32 - 1)));
        if !glass_frame_holds(tick.frame, low) || !glass_frame_holds(tick.frame, high) {
            continue;
        }
        let row = glass_frame_index(tick.frame, low) as usize..=glass_frame_index(tick.frame, high) as usize;
        for at in &cells.keys[row.clone()] {
            // Most cells have one claim: a test avoids the atomic maximum.
            if at.load(Ordering::Relaxed) < key {
                at.fetch_max(key, Ordering::Relaxed);
            }
        }
        if moves {
            for at in &cells.wet[row] {
                at.fetch_max(stamp, Ordering::Relaxed);
            }
        }
    }
}
