//! A scene of triangles under a sky, and the light of its lamps at a position. Twin of `shaders/wgsl/render/scene.wgsl`.
//!
//! Light of lamps and sun comes with rays that find what hides it; see-through surfaces dim it. [`path`](crate::path) follows
//! the rays of the camera, [`scatter`](crate::scatter) draws those that look for the light of sky and surfaces.

mod lamps;
#[cfg(not(feature = "parity"))]
pub(crate) mod puddle_flow;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod puddle_flow;
#[cfg(not(feature = "parity"))]
pub(crate) mod puddle_rings;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod puddle_rings;
#[cfg(not(feature = "parity"))]
pub(crate) mod puddle_wake;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod puddle_wake;
#[cfg(not(feature = "parity"))]
pub(crate) mod water;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod water;

use crate::data::{RenderFrame, SceneData};
pub(crate) use lamps::SceneAsked;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub use lamps::{scene_alpha, scene_disk, scene_softness};

/// A scene and a frame, as rays need them.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// The scene.
    pub data: &'a SceneData,
    /// The frame.
    pub frame: &'a RenderFrame,
}
