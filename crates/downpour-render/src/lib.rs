//! Rain on a plate: a picture without rain, with its distances, its lamps and its environment, comes in; rain goes before it.
//! Each pass is on a GPU, and on the CPU as its reference.
//!
//! - [`plate`]: what rain asks of a picture, wherever it comes from; [`camera`], [`light`];
//! - [`rain`]: drops, streaks, unresolved drops and the light of lamps on them; [`picture`] puts the layers together;
//! - [`glass`]: rain on a pane before the camera, and the picture through it;
//! - [`mod@glow`]: light around lights; [`tone`] and [`mod@file`]: from radiance to a file; [`flashing`]: flashes of a clip, counted on its pixels;
//! - [`wind_picture`]: a wind as colors and streaks.

#![cfg_attr(
    not(feature = "parity"),
    allow(unreachable_pub, dead_code, reason = "pub for comparisons with the shaders")
)]

pub mod camera;
mod error;
pub mod file;
pub mod flashing;
pub mod glass;
pub mod glow;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod host;
pub mod light;
pub mod path_lattice;
pub mod picture;
pub mod plate;
pub mod rain;
pub mod refine;
pub mod spacing;
pub mod tone;
pub mod wind_picture;

pub use camera::{Camera, EyeMotion, Viewpoint};
pub use error::RenderError;
pub use glow::Glow;
pub use light::{Light, LightSample, LightSource};
pub use picture::{Picture, PictureOptions, rain_layer};
pub use plate::{Lighting, Plate};
pub use rain::{
    DropMasks, EnvironmentFrame, EnvironmentMap, Exposure, Rain, RainMedium, RainOptions, RefractionForm,
};

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
