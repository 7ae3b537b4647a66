//! Errors of a requested picture.

use downpour_math::OutOfRange;

/// Error of a picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The picture is too small or too large.
    #[error("the picture is {} x {} pixels; allowed: {min} to {max} each way", found[0], found[1])]
    Size {
        /// Width and height asked for.
        found: [u32; 2],
        /// Minimum edge.
        min: u32,
        /// Maximum edge.
        max: u32,
    },
    /// The color of a lamp is negative or not finite.
    #[error("light {index} has a color of {found}; allowed: finite numbers from 0 to 1e30")]
    Light {
        /// Index among the lights of the scene.
        index: u32,
        /// The first number that is wrong.
        found: f32,
    },
    /// A picture could not be encoded.
    #[error("the picture could not be written as {format}: {reason}")]
    Encode {
        /// The format.
        format: &'static str,
        /// Reason of the failure.
        reason: String,
    },
}
