//! Cameras: glTF 2.0, section 3.10. A camera looks along -Z of its node with +Y up; scale has no effect on it.

use glam::Vec3;

/// A camera without a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file; may be empty.
    pub name: String,
    /// Projection.
    pub lens: Lens,
}

/// Projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Rays from one point.
    Perspective {
        /// The vertical angle of view in radians, between 0 and pi.
        yfov: f32,
        /// Width by height; `None` for that of the picture.
        aspect: Option<f32>,
        /// The nearest distance, in meters; above 0.
        near: f32,
        /// The farthest distance, in meters; `None` for no end.
        far: Option<f32>,
    },
    /// Parallel rays.
    Orthographic {
        /// Half the width, in meters; negative for a mirrored picture.
        xmag: f32,
        /// Half the height, in meters; negative for a mirrored picture.
        ymag: f32,
        /// The nearest distance, in meters; from 0 on.
        near: f32,
        /// The farthest distance, in meters.
        far: f32,
    },
}

/// A camera in the world. The three directions are unit vectors at right angles.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedCamera {
    /// Node of the camera.
    pub node: usize,
    /// Index of the camera.
    pub camera: usize,
    /// Position, in meters.
    pub eye: Vec3,
    /// Viewing direction.
    pub forward: Vec3,
    /// Up direction of its picture.
    pub up: Vec3,
}
