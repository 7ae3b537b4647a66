//! Camera of a picture: position, orientation and projection.

use downpour_math::OutOfRange;
use glam::{DVec3, Vec2, Vec3};

use crate::RenderError;

/// Allowed number of pixels along an edge of a picture.
pub const PIXELS: std::ops::RangeInclusive<u32> = 1..=16384;

pub use downpour_weather::MAX_EXPOSURE_S;

/// Motion of the eye at mid-exposure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeMotion {
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// Angular velocity: right-handed axis, its length is the angular speed, rad/s.
    pub turning: Vec3,
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Position of the eye, meters.
    pub eye: Vec3,
    /// View direction, of any length above 0.
    pub forward: Vec3,
    /// A direction that is up in the picture; need not be perpendicular to `forward`.
    pub up: Vec3,
    /// Vertical field of view, radians.
    pub fov_y: f32,
}

impl Viewpoint {
    /// Returns the camera's unit axes: right, up, forward.
    ///
    /// # Errors
    /// [`RenderError::OutOfRange`] if a number is not finite, or the view direction or field of view is not one.
    pub fn axes(&self) -> Result<[Vec3; 3], RenderError> {
        let bad = |quantity, found: f32, allowed: &'static str| {
            RenderError::OutOfRange(OutOfRange {
                quantity,
                found: f64::from(found),
                unit: "",
                allowed: allowed.into(),
            })
        };
        if !(self.eye.is_finite() && self.forward.is_finite() && self.up.is_finite()) {
            return Err(bad("camera", f32::NAN, "finite numbers"));
        }
        if !(self.fov_y > 1.0e-4 && self.fov_y < std::f32::consts::PI - 1.0e-3) {
            return Err(RenderError::OutOfRange(OutOfRange {
                quantity: "field of view",
                found: f64::from(self.fov_y).to_degrees(),
                unit: "degrees",
                allowed: "above 0.006, below 179.9".into(),
            }));
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

    /// Returns the camera of a picture of `size` pixels; `seed` is the seed of its random numbers.
    ///
    /// # Errors
    /// [`RenderError::Size`] outside [`PIXELS`], or as [`Viewpoint::axes`].
    pub fn camera(&self, size: [u32; 2], seed: u32) -> Result<Camera, RenderError> {
        let [width, height] = size;
        check_size(size)?;
        let [right, up, forward] = self.axes()?;
        let half_height = downpour_math::ops::tan(self.fov_y * 0.5);
        let half_width = half_height * width as f32 / height as f32;
        Ok(Camera {
            eye: self.eye,
            right: right * half_width,
            up: up * half_height,
            forward,
            width,
            height,
            pixel_angle: 2.0 * half_height / height as f32,
            seed,
        })
    }
}

/// A perspective camera with its picture. Twin of `RenderCamera` in `shaders/wgsl/render/camera.wgsl`, and of the same layout.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Camera {
    /// Position of the eye, meters.
    pub eye: Vec3,
    /// Columns of the picture.
    pub width: u32,
    /// Half the picture's width at distance 1, along the camera's right.
    pub right: Vec3,
    /// Rows of the picture.
    pub height: u32,
    /// Half the picture's height at distance 1, along the camera's up.
    pub up: Vec3,
    /// Seed of the random numbers of this picture.
    pub seed: u32,
    /// View direction, of length 1.
    pub forward: Vec3,
    /// Width of a pixel at distance 1.
    pub pixel_angle: f32,
}

impl Camera {
    /// Columns and rows of the picture.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Ray through a position of the picture, in pixels from the top left, not normalized: its part along the view direction
    /// is 1.
    #[must_use]
    pub fn camera_ray(&self, x: f32, y: f32) -> Vec3 {
        let u = 2.0 * x / self.width as f32 - 1.0;
        let v = 1.0 - 2.0 * y / self.height as f32;
        self.forward + self.right * u + self.up * v
    }

    /// Unit direction of [`Camera::camera_ray`].
    #[must_use]
    pub fn camera_direction(&self, x: f32, y: f32) -> Vec3 {
        let ray = self.camera_ray(x, y);
        ray / ray.dot(ray).sqrt()
    }

    /// Position on the picture of a point relative to the eye, right and up from the middle in halves of the picture; `depth`
    /// is the point's part along the view direction, or what a caller divides by in its place.
    #[must_use]
    pub fn camera_place(&self, point: Vec3, depth: f32) -> Vec2 {
        let (right, up) = (self.right, self.up);
        Vec2::new(point.dot(right) / (right.dot(right) * depth), point.dot(up) / (up.dot(up) * depth))
    }

    /// Position on the picture, in pixels from the top left, of a point relative to the eye.
    #[must_use]
    pub fn camera_project(&self, point: Vec3) -> Vec2 {
        let place = self.camera_place(point, point.dot(self.forward));
        Vec2::new((0.5 + 0.5 * place.x) * self.width as f32, (0.5 - 0.5 * place.y) * self.height as f32)
    }
}

/// Axes of a viewpoint in f64, with half of the picture at distance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureEdge {
    /// Unit vector to the right.
    pub right: DVec3,
    /// Unit vector up in the picture.
    pub up: DVec3,
    /// Unit view direction.
    pub forward: DVec3,
    /// Half the picture's width at distance 1.
    pub half_width: f64,
    /// Half the picture's height at distance 1.
    pub half_height: f64,
}

impl PictureEdge {
    /// Computes the axes of a viewpoint, for a picture of `size` columns and rows.
    ///
    /// # Errors
    /// As [`Viewpoint::axes`].
    pub fn new(viewpoint: &Viewpoint, size: [u32; 2]) -> Result<Self, RenderError> {
        let [right, up, forward] = viewpoint.axes()?.map(|axis| axis.as_dvec3().normalize());
        let [width, height] = size.map(f64::from);
        let half_height = downpour_math::ops::f64::tan(f64::from(viewpoint.fov_y) * 0.5);
        Ok(Self { right, up, forward, half_width: half_height * width / height, half_height })
    }
}

/// Checks the size of a picture.
///
/// # Errors
/// [`RenderError::Size`] outside [`PIXELS`].
pub fn check_size(size: [u32; 2]) -> Result<(), RenderError> {
    if size.iter().all(|edge| PIXELS.contains(edge)) {
        return Ok(());
    }
    Err(RenderError::Size { found: size, min: *PIXELS.start(), max: *PIXELS.end() })
}
