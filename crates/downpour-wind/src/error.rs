//! Errors of wind parameters.

use downpour_math::OutOfRange;

/// Error of a wind parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WindError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// An axis has length 0.
    #[error("{quantity} is {found:?}; allowed: a vector at least 1e-3 long")]
    ZeroAxis {
        /// Name of the axis.
        quantity: &'static str,
        /// Its components.
        found: [f32; 3],
    },
    /// A value has no keys, or too many.
    #[error("{found} keys; allowed: 1 to {allowed}")]
    KeyCount {
        /// Number of keys found.
        found: usize,
        /// Maximum number of keys.
        allowed: usize,
    },
    /// Times of keys do not increase.
    #[error(
        "key {index} is at {found} s, after one at {before} s; allowed: times that rise by a microsecond at least"
    )]
    KeyTime {
        /// Index of the key, from 0.
        index: usize,
        /// Its time, s.
        found: f64,
        /// Time of the previous key, s.
        before: f64,
    },
    /// An axis reverses from one key to the next.
    #[error(
        "{quantity} reverses before the key at {time} s; allowed: a key between that defines the rotation"
    )]
    AxisReverses {
        /// Name of the axis.
        quantity: &'static str,
        /// Time of the second key, s.
        time: f64,
    },
    /// A wind has too many parts.
    #[error("the wind has {found} parts; allowed: up to {allowed}")]
    TooManyParts {
        /// Number of parts found.
        found: usize,
        /// Maximum number of parts.
        allowed: usize,
    },
    /// A point form has a core that is defined for lines only.
    #[error("the core of a point is {found}; allowed: rosenhead, or a line")]
    CoreOfPoint {
        /// Name of the core.
        found: &'static str,
    },
    /// The first number of a matrix is not a type of primitive.
    #[error("the type of matrix {index} is {found}; allowed: 0 to 7, 9 to 11, 17 to 19")]
    UnknownType {
        /// Index of the matrix, from 0.
        index: usize,
        /// Number found.
        found: f32,
    },
    /// An updraft is not followed by the other parts of its tornado.
    #[error(
        "matrix {index} is an updraft without its tornado; allowed: an updraft followed by point sink, point source and line vortex \
         of the same tornado"
    )]
    LoneUpdraft {
        /// Index of the matrix, from 0.
        index: usize,
    },
    /// A mask and its grid differ in the number of cells.
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
        /// Number of cells found.
        found: u64,
        /// Maximum number of cells.
        allowed: u64,
    },
}
