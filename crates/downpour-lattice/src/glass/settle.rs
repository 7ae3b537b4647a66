//! Settling: the water that moved to a cell becomes its drop. Twin of `shaders/wgsl/lattice/glass_settle.wgsl`.

use std::sync::atomic::{AtomicU64, Ordering};

use downpour_shaders::lattice::glass::{
    GLASS_INDEX, GLASS_MAX_MASS, GLASS_RIDGE, GLASS_RIDGE_CLASS, GLASS_RIDGE_PUSHED,
};

use super::cells::Motion;
use super::motion::{glass_motion_merged, glass_motion_pack, glass_motion_unpack};
use super::ridge::glass_ridge_ahead;
use super::totals::Counters;

/// Removes the mass above the maximum from the pane.
fn glass_settle_spill(mass: u32, counters: &Counters) -> u32 {
    if mass <= GLASS_MAX_MASS {
        return mass;
    }
    counters.spilled.fetch_add((mass - GLASS_MAX_MASS).into(), Ordering::Relaxed);
    counters.saturated.fetch_add(1, Ordering::Relaxed);
    GLASS_MAX_MASS
}

/// Motion of the drop of a cell: that of the largest drop that moved to it by itself. Water that a blade has pushed is a ridge.
fn glass_settle_motion_of(mass: u32, winner: u32, fresh: u32, decided: &[AtomicU64]) -> Motion {
    if mass == 0 || winner == 0 {
        return [0; 2];
    }
    if winner >> 24 == GLASS_RIDGE_PUSHED {
        return [glass_motion_pack(glass_ridge_ahead(winner)), GLASS_RIDGE | fresh];
    }
    let motion = decided[(winner & GLASS_INDEX) as usize].load(Ordering::Relaxed);
    if winner >> 24 == GLASS_RIDGE_CLASS {
        return [motion as u32, (motion >> 32) as u32];
    }
    let v = glass_motion_merged(glass_motion_unpack(motion as u32), winner >> 24, mass);
    [glass_motion_pack(v), (motion >> 32) as u32]
}

/// Mass and motion of a cell, from the water that moved to it and the largest drop among it.
pub(super) fn settle_cell(
    come: u32,
    winner: u32,
    fresh: u32,
    decided: &[AtomicU64],
    counters: &Counters,
) -> (u32, Motion) {
    let mass = glass_settle_spill(come, counters);
    (mass, glass_settle_motion_of(mass, winner, fresh, decided))
}
