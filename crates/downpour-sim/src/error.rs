//! Errors of simulations.

use downpour_drop::DropError;
use downpour_math::OutOfRange;

/// Memory of a drop, including that of its creation.
pub(crate) const BYTES_PER_DROP: u64 = 34;

/// Error of a simulation or of a query.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The drops do not fit into memory.
    #[error("{drops} drops need {gib:.1} GiB; allowed: up to 268435456 drops, and what this machine has")]
    Memory {
        /// Number of drops.
        drops: u64,
        /// Memory that they need, GiB.
        gib: f64,
    },
    /// A quantity of the physics of drops is out of range.
    #[error(transparent)]
    Drop(#[from] DropError),
}

impl SimError {
    pub(crate) fn memory(drops: u64) -> Self {
        Self::Memory { drops, gib: (drops * BYTES_PER_DROP) as f64 / f64::from(1 << 30) }
    }
}
