//! Errors of physical quantities out of range.

use downpour_math::OutOfRange;
use std::ops::RangeInclusive;

/// Error of a physical quantity outside the range of its law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DropError {
    /// The number is not finite, or outside the range in which the law holds.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

/// Returns `value` if it is within `range` (NaN is not). The ends have a rounding tolerance, so that `9.0 * 1e-3` is
/// 9 mm; the result is clamped to them. The message shows the value times `factor`, in `unit`.
pub(crate) fn in_rounded_range(
    quantity: &'static str,
    value: f64,
    unit: &'static str,
    range: &RangeInclusive<f64>,
    factor: f64,
    allowed: &'static str,
) -> Result<f64, DropError> {
    const ROUNDING: f64 = 1.0e-12;
    let (start, end) = (*range.start(), *range.end());
    let rounded = start - ROUNDING * start.abs()..=end + ROUNDING * end.abs();
    let value = downpour_math::in_range(quantity, value, unit, &rounded, factor, allowed)?;
    Ok(value.max(start).min(end))
}
