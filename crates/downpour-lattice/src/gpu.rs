//! GPU versions of the lattices.

pub mod glass;
pub mod puddle;
