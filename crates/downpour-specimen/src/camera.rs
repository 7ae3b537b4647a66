//! Position of the camera, and size of the drop in the picture.
//!
//! The outline of the drop is highest and lowest in the plane of the drop's axis and the camera: the drop is the same
//! on both sides of it. There the profile is a closed curve P(theta), and the image of a point is
//! P.up / (D - P.back), which is maximized.

use downpour_drop::DropShape;
use downpour_math::ops::f64 as ops;

use super::SpecimenError;
use super::options::{MAX_FOV_DEG, SpecimenOptions};
use super::trace::SpecimenCamera;

/// Fraction of the height that the drop fills by default.
const FILLED: f64 = 0.8;

/// Points of the profile among which the extreme one is looked for, and the steps that make it exact.
const PROFILE_POINTS: u32 = 720;
const PROFILE_STEPS: u32 = 60;

/// The largest distance of the surface from the drop's origin, in meters.
pub(crate) fn bounding_radius(shape: &DropShape) -> f64 {
    let step = std::f64::consts::PI / f64::from(PROFILE_POINTS);
    (0..=PROFILE_POINTS).map(|i| shape.radius(f64::from(i) * step)).fold(0.0, f64::max)
}

/// The vertical field of view, in radians, in which the drop fills 80 % of the height, seen from `distance_m` meters at
/// an elevation of `pitch` radians.
///
/// ```
/// use downpour_drop::DropShape;
/// use downpour_specimen::default_fov;
/// let fov = default_fov(&DropShape::new(1.0e-3)?, 0.1, 0.0)?;
/// assert!((fov.to_degrees() - 0.7).abs() < 0.03); // 1 mm / 0.8 at 100 mm
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SpecimenError::OutOfRange`] if the distance is not outside the drop, or the pitch not within [-pi/2, pi/2].
pub fn default_fov(shape: &DropShape, distance_m: f64, pitch: f64) -> Result<f64, SpecimenError> {
    SpecimenOptions { distance_m, pitch, ..SpecimenOptions::default() }.check(shape)?;
    let height = outline(shape, distance_m, pitch, 1.0, 0.0) + outline(shape, distance_m, pitch, -1.0, 0.0);
    Ok(2.0 * ops::atan(height / (2.0 * FILLED)))
}

/// The same for a drop that falls from `half_path` meters above the origin to as far below it: the farther end of its path
/// is at 80 % of the distance to the edge of the picture.
pub(crate) fn path_fov(
    shape: &DropShape,
    distance_m: f64,
    pitch: f64,
    half_path: f64,
) -> Result<f64, SpecimenError> {
    SpecimenOptions { distance_m, pitch, ..SpecimenOptions::default() }.check(shape)?;
    let widest = MAX_FOV_DEG.to_radians();
    let toward = half_path * ops::sin(pitch).abs() + bounding_radius(shape);
    if toward >= distance_m {
        // An end of the path is beside or behind the camera.
        return Ok(widest);
    }
    let (up, down) = (
        outline(shape, distance_m, pitch, 1.0, half_path),
        outline(shape, distance_m, pitch, -1.0, -half_path),
    );
    Ok((2.0 * ops::atan(up.max(down) / FILLED)).min(widest))
}

/// Slope (tangent of the angle to the axis of the camera) of the upper (`side` = 1) or lower (-1) end of the outline,
/// away from the axis, for a drop `lift` meters above the origin.
pub(crate) fn outline(shape: &DropShape, distance_m: f64, pitch: f64, side: f64, lift: f64) -> f64 {
    let (sin, cos) = (ops::sin(pitch), ops::cos(pitch));
    // theta from the downward axis, on the camera's side for positive theta.
    let slope = |theta: f64| {
        let radius = shape.radius(theta.abs());
        let (toward, down) = (radius * ops::sin(theta), radius * ops::cos(theta));
        let down = down - lift;
        side * (-toward * sin - down * cos) / (distance_m - (toward * cos - down * sin))
    };
    let step = std::f64::consts::TAU / f64::from(PROFILE_POINTS);
    let angle = |i: u32| f64::from(i) * step - std::f64::consts::PI;
    let best = (0..PROFILE_POINTS).max_by(|&a, &b| slope(angle(a)).total_cmp(&slope(angle(b)))).unwrap_or(0);
    let (mut low, mut high) = (angle(best) - step, angle(best) + step);
    for _ in 0..PROFILE_STEPS {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if slope(a) < slope(b) {
            low = a;
        } else {
            high = b;
        }
    }
    slope(0.5 * (low + high))
}

impl SpecimenOptions {
    /// The camera in units of the drop's equivalent radius.
    ///
    /// # Errors
    /// As [`SpecimenOptions::check`].
    pub fn camera(&self, shape: &DropShape) -> Result<SpecimenCamera, SpecimenError> {
        self.check(shape)?;
        let (sin_yaw, cos_yaw) = (ops::sin(self.yaw), ops::cos(self.yaw));
        let (sin_pitch, cos_pitch) = (ops::sin(self.pitch), ops::cos(self.pitch));
        let samples = f64::from(self.size[1]) * f64::from(self.samples);
        Ok(SpecimenCamera {
            right: [cos_yaw, 0.0, -sin_yaw],
            up: [-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch],
            back: [sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch],
            step: 2.0 * ops::tan(0.5 * self.fov(shape)?) / samples,
            distance: self.distance_m / shape.equivalent_radius(),
        })
    }
}
