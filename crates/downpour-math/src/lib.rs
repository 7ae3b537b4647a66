//! Numeric foundation of Downpour.
//!
//! - [`ops`]: transcendental functions with the same bits on every machine;
//! - [`rng`]: counter-based random numbers, bit-equal to the GPU's;
//! - [`packing`]: unit vectors in two numbers;
//! - [`quadrature`]: Gauss-Legendre rules for integrals in f64;
//! - [`real`] and [`vector`]: one algorithm for `f32`, `f64` and many lanes at once.
//!
//! Twin of `shaders/wgsl/common`: functions of the same name do the same operations in the same order.

pub mod ops;
pub mod packing;
pub mod quadrature;
pub mod real;
pub mod rng;
pub mod vector;

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
