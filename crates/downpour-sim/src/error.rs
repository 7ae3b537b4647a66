//! What can be wrong with what is asked of a rain.

use downpour_drop::DropError;

/// Memory of a drop, with what its making needs.
pub(crate) const BYTES_PER_DROP: u64 = 34;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A number is not finite or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is.
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit, as files and arguments write it.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
    /// The drops do not fit into memory.
    #[error("{drops} drops need {gib:.1} GiB; allowed: up to 268435456 drops, and what this machine has")]
    Memory {
        /// How many.
        drops: u64,
        /// What they need.
        gib: f64,
    },
    /// The physics of drops does not know it.
    #[error(transparent)]
    Drop(#[from] DropError),
}

impl SimError {
    pub(crate) fn memory(drops: u64) -> Self {
        Self::Memory { drops, gib: (drops * BYTES_PER_DROP) as f64 / f64::from(1 << 30) }
    }

    /// The exit code of the command for this error: 3 for memory, 2 for bad input.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Self::Memory { .. }) { 3 } else { 2 }
    }
}
