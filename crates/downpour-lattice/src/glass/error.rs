//! Errors of panes.

use downpour_math::OutOfRange;

/// Error of a pane of glass.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GlassError {
    /// A number is not finite or outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A texture differs from the pane in the number of cells.
    #[error("{quantity} has {found} cells; allowed: {allowed}, as the pane")]
    CellCount {
        /// Name of the texture.
        quantity: &'static str,
        /// Number of cells of the texture.
        found: usize,
        /// Number of cells of the pane.
        allowed: usize,
    },
    /// A value of a texture is not finite or outside its range.
    #[error("{quantity} of cell {index} is {found}; allowed: {allowed}")]
    CellValue {
        /// Name of the texture.
        quantity: &'static str,
        /// Index of the cell, row by row from 0.
        index: usize,
        /// Value found.
        found: f64,
        /// Allowed range, in words.
        allowed: &'static str,
    },
    /// A wiper never touches the pane.
    #[error(
        "wiper {index} with its pivot at ({x}, {y}) m never touches the pane; allowed: a blade that touches it"
    )]
    WiperOutside {
        /// Index of the wiper, from 0.
        index: usize,
        /// Pivot, m from the left edge.
        x: f64,
        /// Pivot, m from the top edge.
        y: f64,
    },
    /// Water was poured into a cell that cannot hold it.
    #[error("cell ({x}, {y}) is off the pane or an obstacle; allowed: a free cell")]
    NoSuchCell {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
    },
    /// The rain is not valid.
    #[error(transparent)]
    Rain(#[from] downpour_drop::DropError),
}
