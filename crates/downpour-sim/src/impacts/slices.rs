//! Slices of time in which a GPU searches for impacts.
//!
//! Slices begin at whole multiples of their length, so that an impact is the same whichever picture it is searched for. Within one the
//! path of a drop is straight: its ends are where the drop is. Drops whose path comes near the picture are found as those of a picture
//! with that exposure, and asked for what they hit. On a CPU it is faster to look where surfaces are, as `impacts` does.

use glam::{DVec3, Vec3};

use crate::drift::Drift;
use crate::field::{Class, RainField};
use crate::view::{Bounds, View};

/// A span of time in which paths of drops are straight.
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    /// Begin and end, s.
    pub(crate) span_s: [f64; 2],
    /// Motion of drops by the wind in the middle.
    pub(crate) drift: Drift,
}

impl Slice {
    /// Slices of a length that hold a span of time.
    pub(crate) fn all(field: &RainField, [begin, end]: [f64; 2], lasts_s: f64) -> Vec<Self> {
        let [first, last] = [(begin / lasts_s).floor(), (end / lasts_s).ceil()];
        let at = |k: i64| Drift::new(&field.wind, k as f64 * lasts_s);
        let ends: Vec<Drift> = (first as i64..=last as i64).map(at).collect();
        let slice = |(k, pair): (i64, &[Drift])| Self {
            span_s: [k, k + 1].map(|k| k as f64 * lasts_s),
            drift: Drift::chord(&pair[0], &pair[1], lasts_s),
        };
        (first as i64..).zip(ends.windows(2)).map(slice).collect()
    }

    /// Time of the middle, s.
    pub(crate) fn middle_s(&self) -> f64 {
        self.span_s[0].midpoint(self.span_s[1])
    }

    /// Half of its length, s.
    pub(crate) fn half_s(&self) -> f64 {
        0.5 * (self.span_s[1] - self.span_s[0])
    }

    /// Longest way of a drop in the slice, m.
    pub(crate) fn longest_way(&self, field: &RainField) -> f64 {
        let speed = |class: &Class| class.speeds[1] + self.drift.of(class.speeds[1])[1].length();
        // Slower drops are carried farther by a margin at most.
        2.0 * self.half_s() * 1.25 * field.classes.iter().map(speed).fold(0.0, f64::max)
    }

    /// Box in which drops are, in the middle of the slice, that hit something in it: around obstacles within two corners.
    pub(crate) fn around(&self, field: &RainField, [low, high]: [Vec3; 2], origin: DVec3) -> Bounds {
        let way = self.longest_way(field);
        Bounds { low: origin + low.as_dvec3() - way, high: origin + high.as_dvec3() + way }
    }

    /// The picture of a search: that of an eye that stands still for as long.
    pub(crate) fn view(&self, view: &View) -> View {
        let shutter_s = self.span_s[1] - self.span_s[0];
        View { near: 0.0, shutter_s, velocity: DVec3::ZERO, turning: DVec3::ZERO, ..*view }
    }
}
