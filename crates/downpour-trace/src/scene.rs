//! A scene of triangles under a sky, and the light of its lamps at a place. Twin of `shaders/wgsl/render/scene.wgsl`.
//!
//! Light of lamps and sun comes with rays that find what hides it; see-through surfaces dim it. [`path`](crate::path) follows
//! the rays of the camera, [`scatter`](crate::scatter) draws those that look for the light of sky and surfaces.

mod lamps;
pub mod water;

use glam::Vec3;

use crate::data::{RenderFrame, SceneData};

/// A scene and a frame: what a ray needs.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// The scene.
    pub data: &'a SceneData,
    /// The frame.
    pub frame: &'a RenderFrame,
}

impl SceneView<'_> {
    /// The direction of the ray through a place of the picture, in pixels from the top left.
    #[must_use]
    pub fn scene_direction(&self, x: f32, y: f32) -> Vec3 {
        self.frame.camera().direction(x, y)
    }
}
