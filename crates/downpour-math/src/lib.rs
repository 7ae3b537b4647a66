//! Numeric foundation of Downpour.
//!
//! - [`ops`]: transcendental functions with the same bits on every machine;
//! - [`bins`]: lists by bins;
//! - [`color`], [`equirect`], [`octant`]: luminance and sRGB, equirectangular maps, angles from tangents;
//! - [`rng`]: counter-based random numbers, bit-equal to the GPU's;
//! - [`packing`]: unit vectors in two numbers;
//! - [`pyramid`]: mip levels of a map;
//! - [`quadrature`]: Gauss-Legendre rules for integrals in f64;
//! - [`real`] and [`vector`]: one algorithm for `f32`, `f64` and many lanes at once;
//! - [`OutOfRange`] and [`in_range`]: the error of a number outside its range, and its check.
//!
//! Twin of `shaders/wgsl/common`: functions of the same name do the same operations in the same order.

mod out_of_range;

pub mod bins;
pub mod color;
pub mod equirect;
pub mod octant;
pub mod ops;
pub mod packing;
pub mod pyramid;
pub mod quadrature;
pub mod real;
pub mod rng;
pub mod vector;

pub use out_of_range::{OutOfRange, in_range};

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
