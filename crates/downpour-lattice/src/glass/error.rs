//! What can be wrong with a pane that comes from outside.

/// Why there is no pane, or no step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GlassError {
    /// A number is not finite or outside its range.
    #[error("{quantity} is {found} {unit}; allowed: {allowed}")]
    OutOfRange {
        /// What it is.
        quantity: &'static str,
        /// The value, in `unit`.
        found: f64,
        /// The unit.
        unit: &'static str,
        /// The range, in words.
        allowed: &'static str,
    },
    /// A texture has another number of cells than the pane.
    #[error("{quantity} has {found} cells; allowed: {allowed}, as the pane")]
    CellCount {
        /// Which texture.
        quantity: &'static str,
        /// Cells of the texture.
        found: usize,
        /// Cells of the pane.
        allowed: usize,
    },
    /// A value of a texture is not finite or outside its range.
    #[error("{quantity} of cell {index} is {found}; allowed: {allowed}")]
    CellValue {
        /// Which texture.
        quantity: &'static str,
        /// Which cell, row by row from 0.
        index: usize,
        /// The value.
        found: f64,
        /// The range, in words.
        allowed: &'static str,
    },
    /// A wiper never touches the pane.
    #[error("wiper {index} turns about ({x}, {y}) m and never touches the pane; allowed: a blade that does")]
    WiperOutside {
        /// Which wiper, from 0.
        index: usize,
        /// Its pivot, m from the left edge.
        x: f64,
        /// Its pivot, m from the top edge.
        y: f64,
    },
    /// Water was poured where none can be.
    #[error("cell ({x}, {y}) is off the pane or an obstacle; allowed: a free cell")]
    NoSuchCell {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
    },
    /// The rain cannot be what is asked for.
    #[error(transparent)]
    Rain(#[from] downpour_drop::DropError),
}

impl GlassError {
    /// The exit code of the command for this error: 2, bad input.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        2
    }
}

/// `value` if it is within the range (NaN is not); `scale` turns it into `unit` for the message.
pub(super) fn in_range(
    quantity: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    scale: f64,
    unit: &'static str,
    allowed: &'static str,
) -> Result<f64, GlassError> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(GlassError::OutOfRange { quantity, found: value * scale, unit, allowed })
    }
}
