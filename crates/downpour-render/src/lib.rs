//! Pictures, on a GPU and as a CPU reference that traces the same rays.
//!
//! - [`specimen`]: one exact drop in front of a sky map;
//! - [`data`], [`scene`], `gpu`: a scene of triangles under a sky, traced by rays ([`path`], [`scatter`], [`surface`],
//!   [`texture`], [`sky`], [`brdf`]); [`sky_light`] prepares the sky, [`camera`] the frame;
//! - [`shower`]: which drops there are before an eye, from picture to picture;
//! - [`rain`]: drops before a scene; [`picture`] puts the two together;
//! - [`glass`]: rain on a pane before the camera, and the picture through it;
//! - [`tone`] and [`mod@file`]: from radiance to a file;
//! - [`wind_picture`]: a wind as colours and streaks.

mod assemble;
pub mod brdf;
pub mod builder;
pub mod camera;
pub mod data;
mod error;
pub mod file;
pub mod glass;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod halves;
pub mod light;
pub mod material;
pub mod path;
pub mod picture;
pub mod puddle;
pub mod rain;
pub mod scatter;
pub mod scene;
pub mod shower;
pub mod sky;
pub mod sky_light;
pub mod skylight;
pub mod specimen;
pub mod stage;
pub mod surface;
pub mod texture;
pub mod tone;
pub mod trace;
pub mod wet_ground;
pub mod wind_picture;

pub use error::RenderError;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
