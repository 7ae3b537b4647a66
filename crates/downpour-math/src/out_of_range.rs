//! The error of a number outside its range, shared by all crates.

use std::borrow::Cow;
use std::error::Error;
use std::fmt;
use std::ops::RangeInclusive;

/// A number that is not finite, or outside its range.
///
/// ```
/// use downpour_math::OutOfRange;
/// let error = OutOfRange { quantity: "diameter", found: 12.0, unit: "mm", allowed: "0 to 9".into() };
/// assert_eq!(error.to_string(), "diameter is 12 mm; allowed: 0 to 9");
/// let error = OutOfRange { quantity: "gain", found: -1.5, unit: "", allowed: "0 to 1".into() };
/// assert_eq!(error.to_string(), "gain is -1.5; allowed: 0 to 1");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Name of the quantity: `diameter`, `temperature`, ...
    pub quantity: &'static str,
    /// Value found, in `unit`.
    pub found: f64,
    /// Unit of the value and of the range, as files and arguments write it; empty for a plain number.
    pub unit: &'static str,
    /// Allowed range, in words.
    pub allowed: Cow<'static, str>,
}

/// Returns `value` if it is within `range`; NaN is in no range. The message names the value times `factor`, so that
/// meters can be reported as millimeters.
///
/// # Errors
/// [`OutOfRange`] with the value in `unit`.
///
/// ```
/// use downpour_math::in_range;
/// assert_eq!(in_range("depth", 0.01, "mm", &(0.0..=0.1), 1.0e3, "0 to 100"), Ok(0.01));
/// let error = in_range("depth", 0.5, "mm", &(0.0..=0.1), 1.0e3, "0 to 100").unwrap_err();
/// assert_eq!(error.to_string(), "depth is 500 mm; allowed: 0 to 100");
/// ```
pub fn in_range<T: PartialOrd + Copy + Into<f64>>(
    quantity: &'static str,
    value: T,
    unit: &'static str,
    range: &RangeInclusive<T>,
    factor: f64,
    allowed: &'static str,
) -> Result<T, OutOfRange> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(OutOfRange { quantity, found: value.into() * factor, unit, allowed: allowed.into() })
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, found, unit, allowed } = self;
        let space = if unit.is_empty() { "" } else { " " };
        write!(f, "{quantity} is {found}{space}{unit}; allowed: {allowed}")
    }
}

impl Error for OutOfRange {}
