//! Where the picture is taken from.

use downpour_shaders::render::scene::{SCENE_PICTURE, SKYLIGHT_RADIUS};
use glam::Vec3;

use crate::RenderError;
use crate::data::{RenderFrame, SceneData};

/// Smallest and largest number of pixels along an edge.
pub const PIXELS: std::ops::RangeInclusive<u32> = 1..=16384;

/// Part of the pixels over which the filter takes means that one is.
const WINDOW_SHARE: f32 = 1.0 / ((2 * SKYLIGHT_RADIUS + 1) * (2 * SKYLIGHT_RADIUS + 1)) as f32;

/// The longest exposure, s.
pub const LONGEST_EXPOSURE_S: f64 = 1.0;

/// How the eye moves in the middle of the exposure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeMotion {
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// The axis about which it turns, right-handed, of the length of its angular speed, rad/s.
    pub turning: Vec3,
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Place of the eye, metres.
    pub eye: Vec3,
    /// View direction, of any length above 0.
    pub forward: Vec3,
    /// A direction that is up in the picture; need not be perpendicular to `forward`.
    pub up: Vec3,
    /// Vertical field of view, radians.
    pub fov_y: f32,
}

impl Viewpoint {
    /// The camera's axes: right, up, forward, of length 1.
    ///
    /// # Errors
    /// [`RenderError::OutOfRange`] if a number is not finite, or the view direction or field of view is not one.
    pub fn axes(&self) -> Result<[Vec3; 3], RenderError> {
        let bad = |quantity, found: f32, allowed| RenderError::OutOfRange {
            quantity,
            found: f64::from(found),
            unit: "",
            allowed,
        };
        if !(self.eye.is_finite() && self.forward.is_finite() && self.up.is_finite()) {
            return Err(bad("camera", f32::NAN, "finite numbers"));
        }
        if !(self.fov_y > 1.0e-4 && self.fov_y < std::f32::consts::PI - 1.0e-3) {
            return Err(RenderError::OutOfRange {
                quantity: "field of view",
                found: f64::from(self.fov_y).to_degrees(),
                unit: "degrees",
                allowed: "above 0.006, below 179.9",
            });
        }
        let length = self.forward.length();
        if !(length > 1.0e-12 && length.is_finite()) {
            return Err(bad("length of the view direction", length, "above 0"));
        }
        let forward = self.forward / length;
        // Looking along up, any sideways direction is right.
        let right = forward.cross(self.up);
        let right = if right.length() > 1.0e-6 * self.up.length().max(1.0e-12) {
            right.normalize()
        } else {
            forward.any_orthonormal_vector()
        };
        Ok([right, right.cross(forward), forward])
    }

    /// The frame of a picture of a scene. `grid` samples along an edge of a pixel, `sky_rays` rays to the sky per
    /// sample (0: no surroundings hide the sky).
    ///
    /// # Errors
    /// [`RenderError::Size`] outside [`PIXELS`], or as [`Viewpoint::axes`].
    pub fn frame(
        &self,
        scene: &SceneData,
        size: [u32; 2],
        grid: u32,
        sky_rays: u32,
        seed: u64,
    ) -> Result<RenderFrame, RenderError> {
        let [width, height] = size;
        if !PIXELS.contains(&width) || !PIXELS.contains(&height) {
            let (least, most) = (*PIXELS.start(), *PIXELS.end());
            return Err(RenderError::Size { found: size, least, most });
        }
        let [right, up, forward] = self.axes()?;
        let half_height = downpour_math::ops::tan(self.fov_y * 0.5);
        let half_width = half_height * width as f32 / height as f32;
        let (low, high) = scene.bounds();
        let extent = (high - low).length().clamp(1.0e-3, 1.0e5);
        // Rays of a place far from the origin start where f32 still tells it from its surface.
        let far = self.eye.abs().max_element().max(low.abs().max_element()).max(high.abs().max_element());
        Ok(RenderFrame {
            eye: self.eye.into(),
            width,
            right: (right * half_width).into(),
            height,
            up: (up * half_height).into(),
            grid: grid.clamp(1, 16),
            forward: forward.into(),
            pixel_angle: 2.0 * half_height / height as f32,
            slots: scene.slots,
            lights: scene.lights,
            light_count: scene.light_count,
            sky_rays,
            first_row: 0,
            seed: (seed ^ (seed >> 32)) as u32,
            nearest: (extent * 1.0e-5).max(far.min(1.0e5) * 1.0e-6).max(1.0e-6),
            ray_share: WINDOW_SHARE / sky_rays.max(1) as f32,
            projection: SCENE_PICTURE,
            suns_out: 0,
            puddles: scene.puddles,
            puddle_count: scene.puddle_count,
            pane: scene.pane,
            skylight_pass: 0,
            unused_1: 0,
            unused_2: 0,
            sky_levels: scene.sky_levels,
            sky_irradiance: scene.sky_irradiance,
        })
    }
}
