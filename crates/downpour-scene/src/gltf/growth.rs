//! How much a file may grow: its cost in memory is held against the size of what was read.

use crate::Budget;
use crate::error::{SceneError, size};
use std::fmt;

/// What every file may grow to in memory, in bytes, and how many bytes more for each byte that was read.
const FREE_GROWTH: u64 = 256 << 20;
const GROWTH: u64 = 64;

/// A budget for what is made of a file, and how far it may still grow.
pub(super) struct Purse<'a> {
    pub(super) budget: &'a mut Budget,
    source: u64,
    spent: u64,
}

impl<'a> Purse<'a> {
    /// A purse for a file of so many bytes, buffers included.
    pub(super) fn new(budget: &'a mut Budget, source: u64) -> Self {
        Self { budget, source, spent: 0 }
    }

    /// Takes memory for what is made of the file.
    pub(super) fn take(&mut self, cost: u64, place: impl fmt::Display) -> Result<(), SceneError> {
        let most = FREE_GROWTH.saturating_add(self.source.saturating_mul(GROWTH));
        self.spent = self.spent.saturating_add(cost);
        if self.spent > most {
            let found = format!("{} of geometry from {} of files", size(self.spent), size(self.source));
            return Err(SceneError::limit(place, found, format!("{} for files of this size", size(most)))
                .way_out("instance or simplify less, or store the geometry itself"));
        }
        self.budget.take_bytes(cost, place)
    }
}
