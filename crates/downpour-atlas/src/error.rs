//! Errors of streak atlases.

use downpour_math::OutOfRange;
use std::path::Path;

use downpour_drop::DropError;
use downpour_mask::MaskError;

/// Reason why an atlas could not be traced, written or read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtlasError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The drop itself is not possible.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// The texture array could not be encoded.
    #[error(transparent)]
    Encode(#[from] MaskError),
    /// An atlas file is not what it should be.
    #[error("{location}: found {found}; allowed: {allowed}")]
    File {
        /// The part of the file.
        location: &'static str,
        /// The content found.
        found: String,
        /// The allowed content.
        allowed: &'static str,
    },
    /// A file or folder is missing or cannot be read.
    #[error("{path}: {reason}")]
    Unreadable {
        /// The file or folder.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// Something is wrong in a file with a name.
    #[error("{path}: {error}")]
    InFile {
        /// The file or folder.
        path: String,
        /// The fault in it.
        error: Box<AtlasError>,
    },
}

impl AtlasError {
    pub(crate) fn in_file(self, path: &Path) -> Self {
        Self::InFile { path: path.display().to_string(), error: Box::new(self) }
    }
}
