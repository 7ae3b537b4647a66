//! Scenes of triangles under a sky, traced by rays: plates for rain, on a GPU and as a CPU reference that traces the same rays.
//!
//! - [`builder`], [`data`]: a scene as the buffers that the shaders read; [`sky_light`] prepares the sky;
//! - [`scene`], [`path`], [`scatter`], [`surface`], [`texture`], [`sky`], [`brdf`], `gpu`: what a ray of the camera sees, and the
//!   light that comes there; [`skylight`] filters it;
//! - [`capture`]: radiance from every direction around the eye, for the drops;
//! - [`puddle`], [`wet_ground`]: water that stands on the ground; [`pane_shadow`]: the light through a wet pane;
//! - [`stage`]: the scene and the eye of a weather at a time;
//! - [`picture`]: the plate of a scene, and the rain of [`downpour_render`] before it.

mod assemble;
pub mod brdf;
pub mod builder;
pub mod capture;
pub mod data;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod material;
pub mod pane_shadow;
pub mod path;
pub mod picture;
pub mod puddle;
pub mod scatter;
pub mod scene;
pub mod sky;
pub mod sky_light;
pub mod skylight;
pub mod stage;
pub mod surface;
pub mod texture;
pub mod trace;
pub mod wet_ground;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
