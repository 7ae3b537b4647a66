//! Errors of specimens.

use downpour_drop::DropError;
use downpour_mask::MaskError;
use downpour_math::OutOfRange;

use downpour_render::RenderError;

/// Reason why a specimen cannot be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpecimenError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The picture, or the sky map, would be smaller or larger than allowed.
    #[error("{quantity} is {found}; allowed: {min} to {max}")]
    Size {
        /// Name of the quantity.
        quantity: &'static str,
        /// The number asked for.
        found: u64,
        /// Minimum allowed.
        min: u64,
        /// Maximum allowed.
        max: u64,
    },
    /// The sky map is not a picture of radiance.
    #[error("the sky map has {found}; allowed: {allowed}")]
    Sky {
        /// The fault, and where it is.
        found: String,
        /// The requirement.
        allowed: String,
    },
    /// The drop itself is not possible.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// Its masks are not possible.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The renderer of rain cannot draw it.
    #[error(transparent)]
    Render(#[from] RenderError),
}
