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

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
