//! Errors of settings and of files.

/// Error of a street.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StreetError {
    /// A key of the settings with a value that is not allowed.
    #[error("{file}: {key}: {found}; allowed: {allowed}")]
    Setting {
        /// File of the settings, or `settings`.
        file: String,
        /// The key; of a text that is not TOML, its line.
        key: String,
        /// Value or problem.
        found: String,
        /// Values that the key takes.
        allowed: String,
    },
    /// A picture that could not be encoded.
    #[error("texture {name}: {problem}")]
    Texture {
        /// Name of the texture.
        name: String,
        /// Message of the encoder.
        problem: String,
    },
}
