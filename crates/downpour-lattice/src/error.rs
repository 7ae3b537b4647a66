//! Errors of numbers and masks.

use downpour_math::OutOfRange;

/// Error of a puddle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// A number is not finite, or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
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
