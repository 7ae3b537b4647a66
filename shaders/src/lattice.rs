//! `wgsl/lattice`: water on surfaces. The Rust twins are in `downpour-lattice`.

pub mod glass;
pub mod puddle;
