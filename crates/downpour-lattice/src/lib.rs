//! Water on surfaces, as lattices.
//!
//! - [`puddle`]: ripples on shallow water;
//! - [`glass`]: drops on a pane.

pub mod glass;
pub mod puddle;
