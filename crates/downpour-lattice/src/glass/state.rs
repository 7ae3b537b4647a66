//! The water on a pane at one time.

/// The water on a pane at one time, as pictures show it: cell by cell, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GlassState {
    /// Mass in units of [`Glass::UNIT_M3`](super::Glass::UNIT_M3).
    pub mass: Vec<u32>,
    /// Velocity and progress of the drop in the cell, in the format of the kernels.
    pub motion: Vec<[u32; 2]>,
    /// Wetness where water has passed, 0 to 255.
    pub traversal: Vec<u8>,
    /// Thickness of the water that tracks of running drops still hold: [`GlassState::TAIL_UNITS_PER_M`].
    pub tails: Vec<u16>,
}

impl GlassState {
    /// Units of [`GlassState::tails`] in a meter: a unit is 10 nm.
    pub const TAIL_UNITS_PER_M: f64 = 1.0e8;
}
