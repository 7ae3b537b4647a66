//! Claim: each drop claims the cells that it wets; the largest wins. Twin of `shaders/wgsl/lattice/glass_claim.wgsl`.

use std::sync::atomic::Ordering;

use glam::IVec2;

use super::cells::{Cells, Tick};
use super::frame::{glass_frame_holds, glass_frame_index};
use super::size::glass_size_key;

/// Claims the disk of a drop; a moving drop also wets it.
pub(super) fn glass_claim_drop(cells: &Cells, tick: &Tick<'_>, cell: IVec2) {
    let index = glass_frame_index(tick.frame, cell);
    let mass = cells.mass[index as usize];
    if mass == 0 {
        return;
    }
    let row = tick.table.row(mass);
    let key = glass_size_key(mass, index);
    let moves = cells.motion[index as usize][0] != 0;
    let reach = (row.radius >> 8) as i32;
    let most = row.radius * row.radius;
    for y in -reach..=reach {
        // The cells of a row that WGSL tests one by one.
        let mut half = reach;
        while ((half * half + y * y) as u32) << 16 > most {
            half -= 1;
        }
        let low = cell + IVec2::new(-half, y);
        let high = cell + IVec2::new(half, y);
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
                at.fetch_max(tick.clock, Ordering::Relaxed);
            }
        }
    }
}
