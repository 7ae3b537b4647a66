//! What can be wrong with what is asked of a rain.

use downpour_drop::DropError;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A number is not finite or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is.
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit, as files and arguments write it.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
    /// The physics of drops does not know it.
    #[error(transparent)]
    Drop(#[from] DropError),
}

impl SimError {
    /// The exit code of the command for this error: 2, bad input.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        2
    }
}
