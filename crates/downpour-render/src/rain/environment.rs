//! The environment of the eye, as drops show it.
//!
//! By default an octahedral map: all directions, at nearly the same fineness everywhere. The papers' form is a
//! perspective picture 165 degrees wide.

use downpour_math::pyramid::{PyramidLevel, PyramidRounding, pyramid, pyramid_levels};
use glam::Vec3;

use super::{RainOptions, RefractionForm};
use crate::camera::Camera;

/// Tangent of half of 165 degrees: what a drop of water refracts (Rousseau 2006 once has 150: a rounding).
const WIDE: f32 = 7.595_754;

/// Layout of an environment map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentFrame {
    /// Octahedral map, or perspective picture.
    pub form: RefractionForm,
    /// Texels along both edges of the finest level: a power of two.
    pub size: u32,
    /// Samples along an edge of a texel.
    pub grid: u32,
    /// Axes of the papers' form: half of the picture at distance 1.
    pub right: Vec3,
    /// See `right`.
    pub up: Vec3,
    /// View direction of the papers' form.
    pub forward: Vec3,
    /// Angle of a texel, radians: in the papers' form in the middle, where it is coarsest.
    pub texel_angle: f32,
}

/// Radiance from every direction around the eye.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// Texels of all levels, the finest first, each half the one before.
    pub texels: Vec<[f32; 4]>,
}

impl EnvironmentFrame {
    /// Computes the layout for a camera.
    #[must_use]
    pub fn new(camera: &Camera, options: &RainOptions) -> Self {
        let size = options.capture_size.clamp(16, 2048).next_power_of_two();
        let wide = |v: Vec3| v.normalize_or_zero() * WIDE;
        let texel_angle = match options.form {
            // A texel of the sphere.
            RefractionForm::Direction => (4.0 * std::f32::consts::PI).sqrt() / size as f32,
            RefractionForm::Rousseau2006 => 2.0 * WIDE / size as f32,
        };
        Self {
            form: options.form,
            size,
            grid: options.capture_grid.clamp(1, 16),
            right: wide(camera.right),
            up: wide(camera.up),
            forward: camera.forward.normalize_or_zero(),
            texel_angle,
        }
    }

    /// Levels below the finest.
    #[must_use]
    pub fn levels(&self) -> Vec<PyramidLevel> {
        pyramid_levels([self.size; 2], PyramidRounding::Down)
    }

    /// Number of texels of all levels.
    #[must_use]
    pub fn texels(&self) -> u32 {
        self.levels()
            .last()
            .map_or(self.size * self.size, |last| last.target_texel + last.size[0] * last.size[1])
    }
}

impl EnvironmentMap {
    /// Builds a map from its finest level, rows from the top.
    #[must_use]
    pub fn new(frame: &EnvironmentFrame, mut texels: Vec<[f32; 4]>) -> Self {
        pyramid(&mut texels, [frame.size; 2], PyramidRounding::Down);
        Self { texels }
    }
}
