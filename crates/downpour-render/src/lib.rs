//! Rain on a plate: a picture without rain, with its distances, its lamps and its environment, comes in; rain goes before it.
//! Each pass is on a GPU, and on the CPU as its reference.
//!
//! - [`plate`]: what rain asks of a picture, wherever it comes from; [`camera`], [`light`];
//! - [`rain`]: drops, streaks, unresolved drops and the light of lamps on them; [`picture`] puts the layers together;
//! - [`glass`]: rain on a pane before the camera, and the picture through it;
//! - [`tone`] and [`mod@file`]: from radiance to a file;
//! - [`wind_picture`]: a wind as colors and streaks.

pub mod camera;
mod error;
pub mod file;
pub mod glass;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod halves;
pub mod light;
pub mod path_lattice;
pub mod picture;
pub mod plate;
pub mod rain;
pub mod tone;
pub mod wind_picture;

pub use error::RenderError;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
