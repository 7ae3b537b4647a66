//! The GPU halves.

pub mod glass;
pub mod puddle;
