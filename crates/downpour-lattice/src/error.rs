//! Errors of numbers and masks.

use std::ops::RangeInclusive;

/// Error of a puddle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// A number is not finite, or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// Name of the quantity: `time step`, `depth`, ...
        quantity: &'static str,
        /// Value found, in `unit`.
        found: f64,
        /// Unit of the value and of the range.
        unit: &'static str,
        /// Allowed range, in words.
        allowed: &'static str,
    },
    /// A mask or a field differs from the lattice in the number of cells.
    #[error("{quantity} has {found} cells; allowed: {allowed}, as the lattice")]
    Cells {
        /// Name of the mask or field.
        quantity: &'static str,
        /// Number of its cells.
        found: usize,
        /// Number of cells of the lattice.
        allowed: usize,
    },
}

/// Returns `value` if it is within `range` (NaN is not). The message shows the value times `factor`, in `unit`.
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
