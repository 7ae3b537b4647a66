//! What can be wrong with a wind that comes from outside.

use std::ops::RangeInclusive;

/// Why there is no wind.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WindError {
    /// A number is not finite or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is.
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
    /// An axis has no direction.
    #[error("{quantity} is {found:?}; allowed: a vector at least 1e-3 long")]
    ZeroAxis {
        /// Which axis.
        quantity: &'static str,
        /// Its components.
        found: [f32; 3],
    },
    /// The first number of a matrix is no type of a primitive.
    #[error("the type of matrix {index} is {found}; allowed: whole numbers from 0 to 7")]
    UnknownType {
        /// Which matrix, from 0.
        index: usize,
        /// The number.
        found: f32,
    },
    /// An updraft is not followed by the other parts of its tornado.
    #[error(
        "matrix {index} is an updraft alone; allowed: an updraft followed by point sink, point source and line vortex \
         of the same tornado"
    )]
    LoneUpdraft {
        /// Which matrix, from 0.
        index: usize,
    },
    /// A mask has another number of cells than the grid.
    #[error("the mask has {found} cells; allowed: {allowed}, as the grid")]
    MaskSize {
        /// Cells of the mask.
        found: usize,
        /// Cells of the grid.
        allowed: usize,
    },
    /// A grid has more cells than a buffer holds.
    #[error("the grid has {found} cells; allowed: up to {allowed}")]
    TooManyCells {
        /// How many it has.
        found: u64,
        /// How many it may have.
        allowed: u64,
    },
}

impl WindError {
    /// The exit code of the command for this error: 3 for a limit, 2 for bad input.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Self::TooManyCells { .. }) { 3 } else { 2 }
    }
}

/// Nothing if `value` is within `range` (NaN is not).
pub(crate) fn in_range(
    quantity: &'static str,
    value: f32,
    unit: &'static str,
    range: &RangeInclusive<f32>,
    allowed: &'static str,
) -> Result<(), WindError> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(WindError::OutOfRange { quantity, found: value.into(), unit, allowed })
    }
}
