//! A scene of triangles under a sky, and the light of its lamps at a place. Twin of `shaders/wgsl/render/scene.wgsl`.
//!
//! Light of lamps and sun comes with rays that find what hides it; see-through surfaces dim it. [`path`](crate::path) follows
//! the rays of the camera, [`scatter`](crate::scatter) draws those that look for the light of sky and surfaces.

mod lamps;
pub mod water;

use glam::Vec3;

use crate::data::{RenderFrame, SceneData};
pub(crate) use lamps::scene_share;

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
        let frame = self.frame;
        let u = 2.0 * x / frame.width as f32 - 1.0;
        let v = 1.0 - 2.0 * y / frame.height as f32;
        let direction = Vec3::from(frame.forward) + Vec3::from(frame.right) * u + Vec3::from(frame.up) * v;
        direction / direction.dot(direction).sqrt()
    }
}
