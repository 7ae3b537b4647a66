//! Where the drops of a rain are.
//!
//! - [`field`]: rain in still air in closed form: any place, any time, the same drops from the same seed;
//! - [`view`]: what a camera can resolve of it.
//!
//! Units are SI; rates are in mm/h where the name says so. Axes are those of glTF: right-handed, +Y up.

mod error;
pub mod field;
mod poisson;
pub mod view;

pub use error::SimError;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
