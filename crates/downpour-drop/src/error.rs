//! What can be wrong with the numbers that come from outside.

use std::ops::RangeInclusive;

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

/// `value` if it is within `range` (NaN is not). An end is met up to rounding, so that `9.0 * 1e-3` is 9 mm; the end
/// itself is returned then. The message tells the value times `factor`, in `unit`.
pub(crate) fn in_range(
    quantity: &'static str,
    value: f64,
    unit: &'static str,
    range: &RangeInclusive<f64>,
    factor: f64,
    allowed: &'static str,
) -> Result<f64, DropError> {
    const ROUNDING: f64 = 1.0e-12;
    let (start, end) = (*range.start(), *range.end());
    if value >= start - ROUNDING * start.abs() && value <= end + ROUNDING * end.abs() {
        Ok(value.max(start).min(end))
    } else {
        Err(DropError::OutOfRange { quantity, found: value * factor, unit, allowed })
    }
}
