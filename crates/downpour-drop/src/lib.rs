//! Physics of a raindrop and of rain.
//!
//! One drop: its [`shape`] and [`axis_ratio`], its [`mesh`], its [`fall_speed`], its [`oscillation`], its
//! [`optics`]; drops that leave an edge ([`drip`]) and their [`splash`]. Many drops: their size [`distribution`], computed from a
//! rain rate, the [`spray`] that they throw up, and the [`wetness`] of what they fall on. The
//! media: [`water`] and [`air`].
//!
//! Units are SI: meters, seconds, kilograms, radians, pascals; temperatures in degrees Celsius where the name says
//! `_c`, rain rates in millimeters per hour where it says `_mm_h`. A diameter is that of the sphere of the same
//! volume. Functions whose names start with the stem of their module are twins of WGSL functions.
//!
//! ```
//! use downpour_drop::DropShape;
//! use downpour_drop::air::Air;
//! use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
//!
//! let drop = DropShape::new(2.0e-3)?;
//! assert!((drop.axis_ratio() - 0.926).abs() < 1.0e-3);
//! let speed = terminal_speed(FallSpeedModel::Beard1976, 2.0e-3, &Air::standard())?;
//! assert!((speed - 6.506).abs() < 1.0e-3);
//! # Ok::<(), downpour_drop::DropError>(())
//! ```

pub mod air;
pub mod axis_ratio;
pub mod distribution;
pub mod drip;
mod error;
pub mod fall_speed;
pub mod mesh;
pub mod optics;
pub mod oscillation;
pub mod shape;
pub mod splash;
pub mod spray;
pub mod water;
pub mod wetness;

pub use error::DropError;
pub use mesh::DropMesh;
pub use shape::DropShape;

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
