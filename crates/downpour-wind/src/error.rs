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
    /// A value has no keys, or too many.
    #[error("{found} keys; allowed: 1 to {allowed}")]
    KeyCount {
        /// How many it has.
        found: usize,
        /// How many it may have.
        allowed: usize,
    },
    /// Times of keys do not rise.
    #[error(
        "key {index} is at {found} s, after one at {before} s; allowed: times that rise by a microsecond at least"
    )]
    KeyTime {
        /// Which key, from 0.
        index: usize,
        /// Its time, s.
        found: f64,
        /// The time of the key before it, s.
        before: f64,
    },
    /// An axis turns about, from one key to the next.
    #[error(
        "{quantity} turns about up to the key at {time} s; allowed: a key between, that says by which way"
    )]
    AxisReverses {
        /// Which axis.
        quantity: &'static str,
        /// The time of the second key, s.
        time: f64,
    },
    /// A wind has too many parts.
    #[error("the wind has {found} parts; allowed: up to {allowed}")]
    TooManyParts {
        /// How many it has.
        found: usize,
        /// How many it may have.
        allowed: usize,
    },
    /// A point has a core that is of lines.
    #[error("the core of a point is {found}; allowed: rosenhead, or a line")]
    CoreOfPoint {
        /// The core's name.
        found: &'static str,
    },
    /// The first number of a matrix is no type of a primitive.
    #[error("the type of matrix {index} is {found}; allowed: 0 to 7, 9 to 11, 17 to 19")]
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
        match self {
            Self::TooManyCells { .. } | Self::TooManyParts { .. } => 3,
            Self::KeyCount { found: 1.., .. } => 3,
            _ => 2,
        }
    }
}

/// As [`in_range`].
pub(crate) fn in_range_f64(
    quantity: &'static str,
    found: f64,
    unit: &'static str,
    range: RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), WindError> {
    if range.contains(&found) {
        Ok(())
    } else {
        Err(WindError::OutOfRange { quantity, found, unit, allowed })
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
