//! Scenes in the rain.

mod assemble;
pub mod brdf;
pub mod camera;
pub mod data;
mod error;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod light;
pub mod material;
pub mod scene;
pub mod sky;
pub mod sky_light;
pub mod specimen;
pub mod surface;
pub mod texture;
pub mod tone;

pub use assemble::DAYLIGHT_EFFICACY;
pub use error::RenderError;
