//! Errors of documents.

/// Reason why a document is not opened, edited or saved. Messages are one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    /// Message of the parser about the text.
    #[error("{0}")]
    Refused(String),
    /// No such key or entry.
    #[error("{path}: not in the weather file; allowed: a key or an entry that is there")]
    Absent {
        /// Path of the key.
        path: String,
    },
    /// A file that the system does not let us read or write.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: String,
        /// Message of the system.
        reason: String,
    },
    /// Another program has changed the file since it was read.
    #[error(
        "{path}: changed on disk by another program; allowed: reload it, or keep this one and save again"
    )]
    ChangedOnDisk {
        /// The file.
        path: String,
    },
    /// The document has no file yet.
    #[error("the weather has no file yet; allowed: save as a .toml")]
    NoFile,
}
