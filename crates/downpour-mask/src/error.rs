//! Errors of masks, models and files.

use downpour_drop::DropError;
use downpour_math::OutOfRange;

/// Reason why a mask could not be traced, written or read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaskError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The mask would be larger than allowed.
    #[error("mask size is {found}; allowed: {min} to {max}")]
    Size {
        /// The size asked for, in pixels along an edge.
        found: u32,
        /// Minimum size.
        min: u32,
        /// Maximum size.
        max: u32,
    },
    /// The drop itself is not possible.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// A mesh is not a closed surface that light could pass through.
    #[error("the drop model is not a closed surface: {found}; allowed: {allowed}")]
    Mesh {
        /// The fault, and where it is.
        found: String,
        /// The requirement.
        allowed: &'static str,
    },
    /// A mask file is not what it should be.
    #[error("{location}: found {found}; allowed: {allowed}")]
    File {
        /// The part of the file.
        location: &'static str,
        /// The content found.
        found: String,
        /// The allowed content.
        allowed: &'static str,
    },
    /// A mask could not be encoded.
    #[error("the mask could not be written as {format}: {reason}")]
    Encode {
        /// The format.
        format: &'static str,
        /// The encoder's reason.
        reason: String,
    },
    /// Something is wrong in a file with a name.
    #[error("{path}: {error}")]
    InFile {
        /// The file or folder.
        path: String,
        /// The fault in it.
        error: Box<MaskError>,
    },
}
