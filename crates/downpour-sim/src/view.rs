//! What a camera can resolve of a rain.

use glam::DVec3;

use crate::SimError;

/// Half the vertical field of view of [`View::default`]: 25 degrees, as a tangent.
const HALF_HEIGHT: f64 = 0.466_307_658_154_998_6;

/// The part of space that a perspective picture shows, and how fine its pixels are.
///
/// A drop is listed if it touches the pyramid of the picture between `near` and `far`, and if its diameter is at least
/// `least_pixels` pixels on it. What is smaller or farther is left to extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye, metres.
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
    /// Nearest distance from the eye, metres.
    pub near: f64,
    /// Farthest distance from the eye, metres.
    pub far: f64,
    /// The least diameter on the picture, pixels.
    pub least_pixels: f64,
    /// Drops so far outside the sides are listed too, metres: half of what they move while a shutter is open.
    pub margin: f64,
    /// The least diameter is raised until no more drops than this are to be expected.
    pub most_drops: u32,
}

impl Default for View {
    /// From the origin along -Z, 50 degrees high, 1280 x 720 pixels; drops from 0.4 of a pixel, 5 cm to 50 m away,
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
            margin: 0.0,
            most_drops: 2_000_000,
        }
    }
}

/// The corners of a box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl View {
    /// # Errors
    /// [`SimError::OutOfRange`] if a number is not finite or makes no picture.
    pub(crate) fn check(&self) -> Result<(), SimError> {
        let error =
            |quantity, found, unit, allowed| Err(SimError::OutOfRange { quantity, found, unit, allowed });
        for axis in [self.right, self.up, self.forward] {
            let length = axis.length();
            if !length.is_finite() || (length - 1.0).abs() > 1.0e-3 {
                return error("length of an axis of the camera", length, "", "1");
            }
        }
        let place = self.eye.abs().max_element();
        if !(self.eye.is_finite() && place <= 1.0e7) {
            return error("place of the eye", place, "m", "-1e7 to 1e7");
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
        if !(0.0..=1000.0).contains(&self.margin) {
            return error("margin of the picture", self.margin, "m", "0 to 1000");
        }
        Ok(())
    }

    /// How far, in metres, a drop of a diameter in metres is resolved if it has to have so many pixels.
    #[must_use]
    pub fn range(&self, diameter: f64, least_pixels: f64) -> f64 {
        let range = diameter / (self.pixel_angle * least_pixels).max(1.0e-12);
        range.min(self.far)
    }

    /// The volume of the picture up to a distance, at most.
    pub(crate) fn volume(&self, range: f64) -> f64 {
        4.0 * self.half_width * self.half_height * range * range * range / 3.0
    }

    /// A box round the picture up to a distance. Wide pictures are cut to the sphere of that distance.
    pub(crate) fn bounds(&self, range: f64) -> Bounds {
        let (mut low, mut high) = (self.eye, self.eye);
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let corner = self.forward + self.right * (x * self.half_width) + self.up * (y * self.half_height);
            low = low.min(self.eye + corner * range);
            high = high.max(self.eye + corner * range);
        }
        let (reach, margin) = (DVec3::splat(range), DVec3::splat(self.margin));
        Bounds { low: low.max(self.eye - reach) - margin, high: high.min(self.eye + reach) + margin }
    }

    /// Whether a sphere touches the picture between the nearest distance and `range`.
    pub(crate) fn touches(&self, centre: DVec3, radius: f64, range: f64) -> bool {
        let offset = centre - self.eye;
        let distance = offset.length();
        if distance < self.near || distance > range {
            return false;
        }
        self.within_sides(offset, radius + self.margin)
    }

    /// Whether a sphere at `offset` from the eye touches the pyramid's four sides or is between them.
    pub(crate) fn within_sides(&self, offset: DVec3, radius: f64) -> bool {
        let depth = offset.dot(self.forward);
        let beyond = |along: f64, half: f64| {
            // Distance from the side plane through the eye.
            (along.abs() - depth * half) / (1.0 + half * half).sqrt() > radius
        };
        depth > -radius
            && !beyond(offset.dot(self.right), self.half_width)
            && !beyond(offset.dot(self.up), self.half_height)
    }
}
