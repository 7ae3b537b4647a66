//! Fall of a drop from rest, with the wind, until it hits something.

use downpour_drop::fall_speed::{fall_from_rest, relaxation};
use downpour_math::ops::f64 as ops;
use downpour_wind::UniformWind;
use glam::{DVec3, Vec3};

use crate::facets::Facets;
use crate::shelter::{Obstacles, met};

/// Interval at which a path is divided, s.
const FINE_S: f64 = 1.0 / 20.0;

/// Maximum time of a fall, s: 500 m.
pub(super) const MAX_FALL_S: f64 = 60.0;

/// Fall of one drop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall<'a> {
    wind: &'a UniformWind,
    start: DVec3,
    /// Terminal speed, m/s.
    terminal: f64,
    begin_s: f64,
    /// Horizontal motion at the start of a drop that has always followed the wind: displacement and velocity.
    follows: [DVec3; 2],
}

/// End of a fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Landing {
    /// Time after the start, s.
    pub(super) after_s: f64,
    /// Unit normal of the surface on the side that the drop came from; `None` where nothing was hit.
    pub(super) normal: Option<Vec3>,
}

impl<'a> Fall<'a> {
    pub(super) fn new(wind: &'a UniformWind, start: DVec3, terminal: f64, begin_s: f64) -> Self {
        let mut fall = Self { wind, start, terminal, begin_s, follows: [DVec3::ZERO; 2] };
        fall.follows = fall.followed(0.0);
        fall
    }

    /// Horizontal motion up to an age of a drop that has always followed the wind.
    fn followed(&self, age_s: f64) -> [DVec3; 2] {
        let found = self.wind.followed(self.begin_s + age_s, relaxation(self.terminal).horizontal_s);
        [found.displacement, found.velocity].map(|v| DVec3::new(v.x, 0.0, v.z))
    }

    /// Position and velocity at an age in s: by quadratic drag along the fall, by relaxation across it. Vertical wind is left out.
    pub(super) fn at(&self, age_s: f64) -> (DVec3, DVec3) {
        let age_s = age_s.max(0.0);
        let [distance, speed] = fall_from_rest(self.terminal, age_s);
        let across = relaxation(self.terminal).horizontal_s.max(1.0e-9);
        let left = ops::exp(-age_s / across);
        let [displacement, velocity] = self.followed(age_s);
        let slip = -self.follows[1];
        let position = self.start + displacement - self.follows[0] + slip * (across * (1.0 - left));
        (position - DVec3::Y * distance, velocity + slip * left - DVec3::Y * speed)
    }

    /// The end of the fall, if it is before an age in s.
    pub(super) fn landing(
        &self,
        obstacles: &Obstacles<'_>,
        facets: &Facets<'_>,
        age_s: f64,
    ) -> Option<Landing> {
        if obstacles.triangles.is_empty() {
            return None;
        }
        let mut from = self.start - obstacles.origin;
        let lowest = obstacles.corners().map_or(f64::INFINITY, |[low, _]| f64::from(low.y)) - 1.0;
        let steps = (age_s.min(MAX_FALL_S) / FINE_S).ceil().max(0.0) as u32;
        for step in 1..=steps {
            let begin_s = f64::from(step - 1) * FINE_S;
            let to = self.at(f64::from(step) * FINE_S).0 - obstacles.origin;
            let velocity = ((to - from) / FINE_S).as_vec3();
            if let Some(hit) = met(obstacles, from.as_vec3(), velocity, FINE_S as f32) {
                let normal = facets.facing(&hit, velocity);
                // The path curves: along it the surface is met where the chord has gone as far down.
                let after_s = self.curved(begin_s, f64::from(hit.distance));
                return Some(Landing { after_s, normal: Some(normal) });
            }
            from = to;
            if from.y < lowest {
                return Some(Landing { after_s: f64::from(step) * FINE_S, normal: None });
            }
        }
        None
    }

    /// Age at which the drop is as low as its chord of an interval is after a part of it, s.
    fn curved(&self, begin_s: f64, part_s: f64) -> f64 {
        let [begin, end] = [begin_s, begin_s + FINE_S].map(|age| fall_from_rest(self.terminal, age)[0]);
        let depth = begin + (end - begin) * (part_s / FINE_S);
        downpour_drop::fall_speed::time_of_fall(self.terminal, depth).clamp(begin_s, begin_s + FINE_S)
    }
}
