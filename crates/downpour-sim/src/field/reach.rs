//! Drops of a class that a search is for.

use downpour_shaders::sim::field::FIELD_RADIUS;
use glam::DVec3;

use crate::view::{Bounds, View};

/// Which drops of a class a search is for: those that are near enough to the eye and whose path touches the picture, or those of which
/// something else will.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach {
    /// Distance from the eye: the diameter over this, and as much more, m; no farther than `farthest`.
    pub(crate) angle: f64,
    /// See `angle`.
    pub(crate) beyond: f64,
    /// See `angle`.
    pub(crate) farthest: f64,
    /// Radius of what is seen: so many diameters, and as much more, m.
    pub(crate) radius: f64,
    /// See `radius`.
    pub(crate) margin: f64,
    /// Box in which all drops are that the search is for.
    pub(crate) within: Bounds,
}

impl Reach {
    /// For the drops of a picture that have so many pixels.
    pub(crate) fn of_view(view: &View, least_pixels: f64) -> Self {
        Self {
            angle: view.least_angle(least_pixels),
            beyond: 0.0,
            farthest: view.far,
            radius: f64::from(FIELD_RADIUS),
            margin: 0.0,
            within: Bounds { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY },
        }
    }

    /// Distance from the eye up to which a drop of a diameter in m is searched for, m.
    pub(crate) fn range(&self, diameter: f64) -> f64 {
        (diameter / self.angle + self.beyond).min(self.farthest)
    }

    /// Radius of what is seen of a drop of a diameter in m, m.
    pub(crate) fn radius(&self, diameter: f64) -> f64 {
        self.radius * diameter + self.margin
    }
}
