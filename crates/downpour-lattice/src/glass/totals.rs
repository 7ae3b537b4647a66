//! Water balance, to the unit.

use std::sync::atomic::{AtomicU64, Ordering};

/// Water balance since the pane was created, in units of [`Glass::UNIT_M3`](super::Glass::UNIT_M3), a nanoliter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GlassTotals {
    /// Rain that has landed.
    pub landed: u64,
    /// Water that was poured by the caller.
    pub poured: u64,
    /// Water on the pane.
    pub stored: u64,
    /// Water that has left over the edge.
    pub over_edge: u64,
    /// Water that has evaporated.
    pub evaporated: u64,
    /// Water that blades have pushed off the pane or onto an obstacle.
    pub wiped: u64,
    /// Water above the maximum mass of a cell, which is removed from the pane.
    pub spilled: u64,
    /// Number of times that a cell exceeded the maximum mass.
    pub saturated: u64,
}

impl GlassTotals {
    /// Water that came in.
    #[must_use]
    pub fn came(&self) -> u64 {
        self.landed + self.poured
    }

    /// Water that went out.
    #[must_use]
    pub fn went(&self) -> u64 {
        self.over_edge + self.evaporated + self.wiped + self.spilled
    }

    /// Water that came in minus the water that is stored or went out: always 0.
    #[must_use]
    pub fn lost(&self) -> i128 {
        i128::from(self.came()) - i128::from(self.stored) - i128::from(self.went())
    }
}

/// Counters shared by the threads.
#[derive(Debug, Default)]
pub(super) struct Counters {
    pub(super) landed: AtomicU64,
    pub(super) over_edge: AtomicU64,
    pub(super) evaporated: AtomicU64,
    pub(super) wiped: AtomicU64,
    pub(super) spilled: AtomicU64,
    pub(super) saturated: AtomicU64,
}

impl Counters {
    pub(super) fn totals(&self, poured: u64, stored: u64) -> GlassTotals {
        let [landed, over_edge, evaporated, wiped, spilled, saturated] =
            [&self.landed, &self.over_edge, &self.evaporated, &self.wiped, &self.spilled, &self.saturated]
                .map(|counter| counter.load(Ordering::Relaxed));
        GlassTotals { landed, poured, stored, over_edge, evaporated, wiped, spilled, saturated }
    }
}
