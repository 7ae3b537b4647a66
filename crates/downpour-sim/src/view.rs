//! Camera view, and the drops that it can resolve.

use downpour_math::OutOfRange;
use downpour_math::ops::f64 as ops;
use glam::DVec3;

use crate::SimError;

/// Half the vertical field of view of [`View::default`]: 25 degrees, as a tangent.
const HALF_HEIGHT: f64 = 0.466_307_658_154_998_6;

/// Part of space that a perspective picture shows, and the size of its pixels.
///
/// A drop is listed if its path during the exposure touches the pyramid of the picture, if it is between `near` and
/// `far` in the middle of that time, and if its diameter is then at least `least_pixels` pixels on the picture. All
/// others are unresolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the eye, meters.
    pub eye: DVec3,
    /// Unit vectors along the columns, the rows from below, and the view.
    pub right: DVec3,
    /// See `right`.
    pub up: DVec3,
    /// See `right`.
    pub forward: DVec3,
    /// Half the width of the picture at distance 1.
    pub half_width: f64,
    /// Half the height of the picture at distance 1.
    pub half_height: f64,
    /// Width of a pixel at distance 1.
    pub pixel_angle: f64,
    /// Minimum distance from the eye, meters.
    pub near: f64,
    /// Maximum distance from the eye, meters.
    pub far: f64,
    /// Minimum diameter on the picture, pixels.
    pub least_pixels: f64,
    /// Exposure in seconds; the picture's time is in the middle of it.
    pub shutter_s: f64,
    /// Velocity of the eye, m/s.
    pub velocity: DVec3,
    /// Axis of the camera's rotation, right-handed, with the length of its angular speed, rad/s.
    pub turning: DVec3,
    /// Maximum expected number of drops; the minimum diameter is raised to meet it.
    pub max_drops: u32,
}

impl Default for View {
    /// From the origin along -Z, 50 degrees high, 1280 x 720 pixels; drops from 0.4 pixels, at 5 cm to 50 m,
    /// two million at most.
    fn default() -> Self {
        Self {
            eye: DVec3::ZERO,
            right: DVec3::X,
            up: DVec3::Y,
            forward: DVec3::NEG_Z,
            half_width: HALF_HEIGHT * 16.0 / 9.0,
            half_height: HALF_HEIGHT,
            pixel_angle: 2.0 * HALF_HEIGHT / 720.0,
            near: 0.05,
            far: 50.0,
            least_pixels: 0.4,
            shutter_s: 0.0,
            velocity: DVec3::ZERO,
            turning: DVec3::ZERO,
            max_drops: 2_000_000,
        }
    }
}

/// Corners of an axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl Bounds {
    /// Middle of the box, and the radius of the ball around it, m.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        (self.low.midpoint(self.high), 0.5 * (self.high - self.low).length())
    }

    /// Box that holds two boxes.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Box that two boxes share; `None` if that has no volume.
    pub(crate) fn common(&self, other: &Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        low.cmplt(high).all().then_some(Self { low, high })
    }
}

impl View {
    /// # Errors
    /// [`SimError::OutOfRange`] if a number is not finite or the view is degenerate.
    pub(crate) fn check(&self) -> Result<(), SimError> {
        let error = |quantity, found, unit, allowed: &'static str| {
            Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }))
        };
        for axis in [self.right, self.up, self.forward] {
            let length = axis.length();
            if !length.is_finite() || (length - 1.0).abs() > 1.0e-3 {
                return error("length of an axis of the camera", length, "", "1");
            }
        }
        let position = self.eye.abs().max_element();
        if !(self.eye.is_finite() && position <= 1.0e7) {
            return error("position of the eye", position, "m", "-1e7 to 1e7");
        }
        for half in [self.half_width, self.half_height] {
            if !(half > 0.0 && half <= 1.0e6) {
                return error("half the picture at distance 1", half, "m", "above 0, at most 1e6");
            }
        }
        if !(self.pixel_angle > 0.0 && self.pixel_angle.is_finite()) {
            return error("width of a pixel at distance 1", self.pixel_angle, "m", "above 0");
        }
        if !(self.near > 0.0 && self.near.is_finite()) {
            return error("nearest distance", self.near, "m", "above 0");
        }
        if !(self.far >= self.near && self.far <= 1000.0) {
            return error("farthest distance of drops", self.far, "m", "from the nearest to 1000");
        }
        if !(self.least_pixels >= 0.0 && self.least_pixels.is_finite()) {
            return error("least diameter of drops", self.least_pixels, "pixels", "0 or more");
        }
        if !(0.0..=10.0).contains(&self.shutter_s) {
            return error("time of the shutter", self.shutter_s, "s", "0 to 10");
        }
        let speed = self.velocity.length();
        if !(0.0..=1.0e4).contains(&speed) {
            return error("speed of the eye", speed, "m/s", "0 to 1e4");
        }
        let turning = self.turning.length();
        if !(0.0..=1.0e3).contains(&turning) {
            return error("angular speed of the camera", turning, "rad/s", "0 to 1000");
        }
        Ok(())
    }

    /// Distance, in meters, up to which a drop of a diameter in meters has so many pixels.
    #[must_use]
    pub fn range(&self, diameter: f64, least_pixels: f64) -> f64 {
        (diameter / self.least_angle(least_pixels)).min(self.far)
    }

    /// Width of so many pixels at distance 1.
    pub(crate) fn least_angle(&self, least_pixels: f64) -> f64 {
        (self.pixel_angle * least_pixels).max(1.0e-12)
    }

    /// Upper bound of the volume of the picture up to a distance.
    pub(crate) fn volume(&self, range: f64) -> f64 {
        4.0 * self.half_width * self.half_height * range * range * range / 3.0
    }

    /// Upper bound of the volume, m^3, of what comes into the picture during the exposure up to a distance: the pyramid of all that
    /// the turning camera sees, with a margin, within the ball of that distance.
    pub(crate) fn swept_volume(&self, range: f64, margin: f64) -> f64 {
        let [inner, surface] = self.swept_body(range);
        // A convex body that moves by twice the margin sweeps its outline across the way, at most half its surface.
        (inner + surface * margin).min(ball(range))
    }

    /// Volume, m^3, and surface, m^2, of the pyramid of all that the turning camera sees up to a distance.
    fn swept_body(&self, range: f64) -> [f64; 2] {
        let [wide, high] = self.swept_half();
        let inner = 4.0 * wide * high * range * range * range / 3.0;
        let sides =
            2.0 * range * range * (wide * (1.0 + high * high).sqrt() + high * (1.0 + wide * wide).sqrt());
        let base = 4.0 * wide * high * range * range;
        [inner, sides + base]
    }

    /// Upper bound of the volume, m^3, of all that is within a margin of the picture up to a distance.
    #[cfg(feature = "wgpu")]
    pub(crate) fn near_volume(&self, range: f64, margin: f64) -> f64 {
        let [inner, surface] = self.swept_body(range);
        // Steiner's formula: the mean width is less than 1.1 times the distance for all but the widest pictures.
        let edges = 2.2 * std::f64::consts::PI * range * margin * margin;
        (inner + surface * margin + edges + ball(margin)).min(ball(range + margin))
    }

    /// Box around the picture up to a distance, with a margin. Wide pictures are cut to the sphere of that distance.
    pub(crate) fn bounds(&self, range: f64, margin: f64) -> Bounds {
        let (mut low, mut high) = (self.eye, self.eye);
        let half = self.swept_half();
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let corner = self.forward + self.right * (x * half[0]) + self.up * (y * half[1]);
            low = low.min(self.eye + corner * range);
            high = high.max(self.eye + corner * range);
        }
        let (reach, margin) = (DVec3::splat(range), DVec3::splat(margin));
        Bounds { low: low.max(self.eye - reach) - margin, high: high.min(self.eye + reach) + margin }
    }

    /// Half the picture's width and height at distance 1, widened by the rotation of the camera during the exposure.
    fn swept_half(&self) -> [f64; 2] {
        let turned = 0.5 * self.shutter_s * self.turning.length();
        [self.half_width, self.half_height].map(|half| half + turned * (1.0 + half * half))
    }

    /// Distance, m, that a drop of a velocity moves relative to the eye in half the exposure.
    pub(crate) fn half_way(&self, velocity: DVec3) -> f64 {
        0.5 * self.shutter_s * (velocity - self.velocity).length()
    }

    /// Outward normals of the pyramid's sides: right, left, top and bottom; and of the plane behind the eye.
    pub(crate) fn sides(&self) -> [DVec3; 5] {
        let side = |along: DVec3, half: f64| (along - self.forward * half) / (1.0 + half * half).sqrt();
        [
            side(self.right, self.half_width),
            side(-self.right, self.half_width),
            side(self.up, self.half_height),
            side(-self.up, self.half_height),
            -self.forward,
        ]
    }

    /// Sides of the pyramid that holds all that the camera sees during the exposure.
    pub(crate) fn swept_sides(&self) -> [DVec3; 5] {
        let [half_width, half_height] = self.swept_half();
        Self { half_width, half_height, ..*self }.sides()
    }

    /// True if the path of a sphere touches the picture during a part of the exposure, and it is between the minimum
    /// distance and `range` at the picture's time. `part`: times relative to the picture's, s.
    pub(crate) fn shows(
        &self,
        sides: &[DVec3; 5],
        center: DVec3,
        velocity: DVec3,
        radius: f64,
        range: f64,
        part: [f64; 2],
    ) -> bool {
        let offset = center - self.eye;
        let distance = offset.length();
        if distance < self.near || distance > range {
            return false;
        }
        let half = 0.5 * self.shutter_s;
        let relative = velocity - self.velocity;
        let ends = part.map(|time| {
            let time = time.clamp(-half, half);
            turned(offset + relative * time, -self.turning * time)
        });
        sides.iter().all(|side| side.dot(ends[0]).min(side.dot(ends[1])) <= radius)
    }
}

/// Volume of a ball, m^3, by its radius, m.
fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}

/// Rotates `v` about an axis by the axis's length, in radians.
fn turned(v: DVec3, axis: DVec3) -> DVec3 {
    let angle = axis.length();
    if angle < 1.0e-12 {
        return v;
    }
    let axis = axis / angle;
    let (sine, cosine) = (ops::sin(angle), ops::cos(angle));
    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine))
}

/// True if a sphere at `offset` from the eye is within a margin of planes through the eye.
pub(crate) fn within(sides: &[DVec3; 5], offset: DVec3, margin: f64) -> bool {
    sides.iter().all(|side| side.dot(offset) <= margin)
}

/// Normals of the sides of a picture as rows of four.
pub(crate) fn side_rows(sides: [DVec3; 5]) -> [[f32; 4]; 5] {
    sides.map(|side| side.as_vec3().extend(0.0).to_array())
}
