//! Limit of growth: memory for the contents of a file, relative to the size of the file.

use crate::Budget;
use crate::error::{SceneError, size};
use std::fmt;

/// Memory that any file may need, in bytes, and additional bytes per byte of the file.
const FREE_GROWTH: u64 = 256 << 20;
const GROWTH: u64 = 64;

/// Remaining budget of a file: that of the caller, and a limit of growth.
pub(super) struct GrowthBudget<'a> {
    pub(super) budget: &'a mut Budget,
    source: u64,
    spent: u64,
}

impl<'a> GrowthBudget<'a> {
    /// Creates the budget of a file of `source` bytes, buffers included.
    pub(super) fn new(budget: &'a mut Budget, source: u64) -> Self {
        Self { budget, source, spent: 0 }
    }

    /// Deducts memory for contents of the file.
    pub(super) fn take(&mut self, cost: u64, path: impl fmt::Display) -> Result<(), SceneError> {
        let most = FREE_GROWTH.saturating_add(self.source.saturating_mul(GROWTH));
        self.spent = self.spent.saturating_add(cost);
        if self.spent > most {
            let found = format!("{} of geometry from {} of files", size(self.spent), size(self.source));
            return Err(SceneError::limit(path, found, format!("{} for files of this size", size(most)))
                .with_advice("instance or simplify less, or store the geometry itself"));
        }
        self.budget.take_bytes(cost, path)
    }
}
