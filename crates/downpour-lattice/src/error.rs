//! What can be wrong with the numbers and masks that come from outside.

use std::ops::RangeInclusive;

/// Why a lattice was not made, or did not move.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// A number is not finite, or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is: `time step`, `depth`, ...
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit of the value and of the range.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
    /// A mask or a field has another number of cells than the lattice.
    #[error("{quantity} has {found} cells; allowed: {allowed}, as the lattice")]
    Cells {
        /// What it is.
        quantity: &'static str,
        /// How many cells it has.
        found: usize,
        /// How many cells the lattice has.
        allowed: usize,
    },
}

impl LatticeError {
    /// The exit code of the command for this error: 2, bad input.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        2
    }
}

/// `value` if it is within `range` (NaN is not). The message tells the value times `factor`, in `unit`.
pub(crate) fn in_range(
    quantity: &'static str,
    value: f64,
    unit: &'static str,
    range: &RangeInclusive<f64>,
    factor: f64,
    allowed: &'static str,
) -> Result<f64, LatticeError> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(LatticeError::OutOfRange { quantity, found: value * factor, unit, allowed })
    }
}
