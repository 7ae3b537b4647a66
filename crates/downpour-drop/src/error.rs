//! What can be wrong with the numbers that come from outside.

/// A quantity that is outside what the physics is known for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DropError {
    /// A number is not finite, or outside the range in which the law holds.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is: `diameter`, `temperature`, ...
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit of the value and of the range, as files and arguments write it.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
}
