//! Displacement of drops by a uniform wind, by their terminal speed.

use downpour_drop::fall_speed::relaxation;
use downpour_shaders::sim::field::{FIELD_DRIFT, FIELD_DRIFT_SPEED};
use downpour_wind::UniformWind;
use glam::DVec3;

/// Maximum terminal speed of a drop, m/s.
const MAX_SPEED_M_S: f64 = FIELD_DRIFT_SPEED as f64;

/// Number of intervals of the table.
const INTERVALS: usize = FIELD_DRIFT as usize;

/// Position of a terminal speed, m/s, in the table: the entry below, and the fraction of the distance to the next. Twin of the function
/// of this name in `shaders/wgsl/sim/drift.wgsl`.
#[must_use]
pub fn drift_position(speed: f64) -> (usize, f64) {
    let position = (speed * (INTERVALS as f64 / MAX_SPEED_M_S)).clamp(0.0, INTERVALS as f64);
    let lower = (position as usize).min(INTERVALS - 1);
    (lower, position - lower as f64)
}

/// Motion of drops by the wind up to a time. It is linear between the speeds of the table, so that a drop's velocity
/// is the rate of change of its position.
#[derive(Clone, Debug)]
pub(crate) struct Drift {
    /// Displacement since time 0, m, and velocity, m/s.
    table: Vec<[DVec3; 2]>,
}

impl Drift {
    pub(crate) fn new(wind: &UniformWind, time_s: f64) -> Self {
        let at = wind.prepared(time_s);
        let entry = |k: usize| {
            let relaxation = relaxation(MAX_SPEED_M_S * k as f64 / INTERVALS as f64);
            let across = at.followed(relaxation.horizontal_s);
            let along = at.followed(relaxation.vertical_s);
            let joined = |a: DVec3, b: DVec3| DVec3::new(a.x, b.y, a.z);
            [joined(across.displacement, along.displacement), joined(across.velocity, along.velocity)]
        };
        Self { table: (0..=INTERVALS).map(entry).collect() }
    }

    /// The straight motion from a time to one `lasts_s` later, as it is in the middle between the two.
    #[cfg(feature = "wgpu")]
    pub(crate) fn chord(from: &Self, to: &Self, lasts_s: f64) -> Self {
        let entry = |(a, b): (&[DVec3; 2], &[DVec3; 2])| [a[0].midpoint(b[0]), (b[0] - a[0]) / lasts_s];
        Self { table: from.table.iter().zip(&to.table).map(entry).collect() }
    }

    /// Displacements and velocities by terminal speed, from 0 to 12 m/s.
    #[cfg(feature = "wgpu")]
    pub(crate) fn entries(&self) -> impl Iterator<Item = &[DVec3; 2]> {
        self.table.iter()
    }

    /// Displacement of a drop of a middle speed, m.
    #[cfg(feature = "wgpu")]
    pub(crate) fn middle(&self) -> DVec3 {
        self.of(0.5 * MAX_SPEED_M_S)[0]
    }

    /// Displacement since time 0, m, and velocity due to the wind, m/s, of a drop with a terminal speed, m/s.
    pub(crate) fn of(&self, speed: f64) -> [DVec3; 2] {
        let (lower, fraction) = drift_position(speed);
        match self.table.get(lower..lower + 2) {
            Some(&[a, b]) => [a[0].lerp(b[0], fraction), a[1].lerp(b[1], fraction)],
            _ => [DVec3::ZERO; 2],
        }
    }

    /// Minimum and maximum displacement of drops between two speeds, m.
    pub(crate) fn span(&self, slowest: f64, fastest: f64) -> [DVec3; 2] {
        let per_speed = INTERVALS as f64 / MAX_SPEED_M_S;
        let between = self
            .table
            .iter()
            .enumerate()
            .filter(|(k, _)| (slowest * per_speed..=fastest * per_speed).contains(&(*k as f64)));
        let ends = [self.of(slowest)[0], self.of(fastest)[0]];
        let all = between.map(|(_, entry)| entry[0]).chain(ends);
        all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], d| [low.min(d), high.max(d)])
    }
}
