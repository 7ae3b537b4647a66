//! Water on surfaces, as lattices.
//!
//! - [`puddle`]: ripples on shallow water;
//! - [`glass`]: drops on a pane.

mod error;
pub mod glass;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod puddle;

pub use error::LatticeError;

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
