//! The arithmetic that the whole of Downpour stands on.
//!
//! - [`ops`]: transcendental functions with the same bits on every machine;
//! - [`rng`]: counter-based random numbers, bit-equal to the GPU's;
//! - [`packing`]: unit vectors in two numbers;
//! - [`quadrature`]: Gauss-Legendre rules, for the integrals that physics asks for;
//! - [`real`] and [`vector`]: one algorithm for `f32`, `f64` and many lanes at once.
//!
//! Twin of `shaders/wgsl/common`: functions of the same name do the same operations in the same order.

pub mod ops;
pub mod packing;
pub mod quadrature;
pub mod real;
pub mod rng;
pub mod vector;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
