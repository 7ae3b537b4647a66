//! Scenes of triangles under a sky, traced by rays: plates for rain, on a GPU and as a CPU reference that traces the same rays.
//!
//! - [`builder`], [`data`]: a scene as the buffers that the shaders read; [`sky_light`] prepares the sky;
//! - [`scene`], [`path`], [`scatter`], [`surface`], [`texture`], [`sky`], [`brdf`], `gpu`: what a ray of the camera sees, and the
//!   light that comes there; [`skylight`] filters it over neighboring pixels, [`temporal`] over the frames of a clip, [`running_light`] over live frames;
//! - [`capture`]: radiance from every direction around the eye, for the drops;
//! - [`emitter`]: surfaces that shine, as lights;
//! - [`wet`]: surfaces that rain has made wet; [`impostor`]: their reflections as billboards; [`puddle`], [`wet_ground`]: water that
//!   stands on the ground; [`pane_shadow`]: the light through a wet pane;
//! - [`frame_scene`]: the scene and the eye of a weather at a time;
//! - [`truth`]: what the pixels of a picture show, in numbers;
//! - [`picture`]: the plate of a scene, and the rain of [`downpour_render`] before it.

#![cfg_attr(
    not(feature = "parity"),
    allow(unreachable_pub, dead_code, reason = "pub for comparisons with the shaders")
)]

mod assemble;
mod background;
pub mod billboards;
#[cfg(not(feature = "parity"))]
mod brdf;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod brdf;
pub mod builder;
pub mod capture;
pub mod data;
#[cfg(not(feature = "parity"))]
mod emitter;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod emitter;
pub mod frame_scene;
#[cfg(not(feature = "parity"))]
mod glazing;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod glazing;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod impostor;
pub mod kept;
pub mod kept_environment;
pub mod material;
pub mod pane_shadow;
#[cfg(not(feature = "parity"))]
mod path;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod path;
pub mod picture;
pub mod puddle;
pub mod running_light;
#[cfg(not(feature = "parity"))]
mod scatter;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod scatter;
pub mod scene;
mod scene_change;
pub mod shared_rows;
#[cfg(not(feature = "parity"))]
mod sky;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod sky;
pub mod sky_light;
#[cfg(not(feature = "parity"))]
mod skylight;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod skylight;
pub mod still_part;
#[cfg(not(feature = "parity"))]
mod surface;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod surface;
pub mod temporal;
#[cfg(not(feature = "parity"))]
mod texture;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod texture;
#[cfg(not(feature = "parity"))]
mod trace;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod trace;
#[cfg(not(feature = "parity"))]
mod translucent;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod translucent;
pub mod truth;
#[cfg(not(feature = "parity"))]
mod wet;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod wet;
pub mod wet_ground;

pub use builder::{MeshPart, SceneBuilder};
pub use capture::trace_environment;
pub use data::{RenderFrame, SceneData};
pub use frame_scene::{FrameScene, FrameSceneError};
pub use material::{MaterialLook, TextureSlot, TextureUse};
pub use picture::{picture_frame, render_picture};
pub use puddle::{PuddleError, PuddleLook, PuddleMap};
pub use scene::SceneView;
pub use sky_light::SkyLight;
pub use wet::SceneWetness;
pub use wet_ground::WetGround;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
