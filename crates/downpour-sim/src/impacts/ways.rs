//! Paths of drops in closed form in a span of time.

use downpour_bvh::Hit;
use glam::{DVec3, Vec3};

use crate::drift::Drift;
use crate::falling::FallingDrop;
use crate::field::RainField;
use crate::shelter::{Obstacles, met};
use crate::view::Bounds;

/// Interval at which a path is divided, s.
const CUT_S: f64 = 1.0 / 16.0;

/// Paths of drops in a span of time.
pub(super) struct Ways {
    end: f64,
    /// Times from the beginning to the end, and the drift of drops up to them.
    cuts: Vec<(f64, Drift)>,
}

impl Ways {
    pub(super) fn new(field: &RainField, begin: f64, end: f64) -> Self {
        let mut times = vec![begin];
        if !field.wind.is_steady() {
            let first = (begin / CUT_S).floor() as i64 + 1;
            times.extend((first..).map(|k| k as f64 * CUT_S).take_while(|&time| time < end));
        }
        times.push(end);
        let cuts = times.into_iter().map(|time| (time, Drift::new(&field.wind, time))).collect();
        Self { end, cuts }
    }

    /// Drift of drops up to the end.
    pub(super) fn last(&self) -> &Drift {
        // There are at least two cuts.
        &self.cuts[self.cuts.len() - 1].1
    }

    /// Displacement of a drop of a speed from a cut to the end.
    fn moved(&self, cut: usize, speed: f64) -> DVec3 {
        let (time, drift) = &self.cuts[cut];
        self.last().of(speed)[0] - drift.of(speed)[0] - DVec3::Y * (speed * (self.end - time))
    }

    /// Bounds of the ways to the end, from any time on, of drops of some speeds.
    pub(super) fn bounds(&self, speeds: [f64; 2]) -> Bounds {
        let [slow, fast] = speeds;
        let all = (0..self.cuts.len())
            .flat_map(|cut| [slow, slow.midpoint(fast), fast].map(|s| self.moved(cut, s)));
        let (low, high) = all
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)));
        // Between the cuts, and between the speeds, paths are slightly curved.
        Bounds { low: low - 0.05, high: high + 0.05 }
    }

    /// Position of a drop at the beginning.
    pub(super) fn at_begin(&self, drop: &FallingDrop, speed: f64) -> DVec3 {
        drop.position - self.moved(0, speed)
    }

    /// First hit of a drop: the hit, whose distance is a time, s, from a position relative to the obstacles' origin
    /// with a velocity; and its time.
    pub(super) fn first_met(
        &self,
        obstacles: &Obstacles<'_>,
        drop: &FallingDrop,
        speed: f64,
    ) -> Option<(Hit, Vec3, Vec3, f64)> {
        self.parts(drop.position - obstacles.origin, speed).find_map(|([from, to], since, lasts)| {
            let velocity = ((to - from) / lasts).as_vec3();
            let hit = met(obstacles, from.as_vec3(), velocity, lasts as f32)?;
            let time_s = since + f64::from(hit.distance);
            Some((hit, from.as_vec3(), velocity, time_s))
        })
    }

    /// The place at which a drop first comes down through a height, m, with its velocity and the time.
    pub(super) fn first_through(
        &self,
        height: f64,
        drop: &FallingDrop,
        speed: f64,
    ) -> Option<(DVec3, Vec3, f64)> {
        self.parts(drop.position, speed).find_map(|([from, to], since, lasts)| {
            if from.y <= height || to.y > height {
                return None;
            }
            let part = (from.y - height) / (from.y - to.y);
            let velocity = ((to - from) / lasts).as_vec3();
            Some((from.lerp(to, part).with_y(height), velocity, since + lasts * part))
        })
    }

    /// Straight parts of the way of a drop of a speed to a position at the end: ends, m, and when and for how long, s.
    fn parts(&self, end: DVec3, speed: f64) -> impl Iterator<Item = ([DVec3; 2], f64, f64)> {
        let mut from = end - self.moved(0, speed);
        let parts = self.cuts.windows(2).enumerate().map(move |(cut, pair)| {
            let to = end - self.moved(cut + 1, speed);
            let ends = [std::mem::replace(&mut from, to), to];
            (ends, pair[0].0, pair[1].0 - pair[0].0)
        });
        parts.filter(|(.., lasts)| *lasts > 0.0)
    }
}
