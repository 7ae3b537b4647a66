//! Uniform wind, and the response of drops to it, in closed form.
//!
//! A drop whose slip relaxes with a time constant tau follows the wind w as y' = (w - y) / tau. The mean wind is U(t),
//! linear between keys with slope m; gusts multiply it by sinusoids, so all of it is a sum of terms
//! `U(t) Re[g e^(i omega t)]` (the mean itself is the one with omega = 0). With q = 1 / (1 + i omega tau),
//!
//! ```text
//! y(t) = sum of Re[(U(t) q - tau m q^2) g e^(i omega t)]
//!      + tau sum over keys k before t, and terms, of Re[q^2 g e^(i omega t_k)] (change of m at k) e^(-(t - t_k) / tau)
//! ```
//!
//! which is the state that began as y = w before the first key (with sinusoids: their steady state). Since
//! y = w - tau y', the displacement of the drop is that of the air, minus tau times the change of y.

use downpour_math::ops::f64 as ops;
use glam::DVec3;

use crate::gusts::{GustMode, Gusts};
use crate::timeline::Keyed;

/// Number of relaxation times after which the past is negligible: exp(-45) is 3e-20.
const MEMORY: f64 = 45.0;

/// Maximum relaxation time, s.
const MAX_RELAXATION_S: f64 = 1.0e6;

/// Maximum absolute time, s.
const MAX_TIME_S: f64 = 1.0e9;

/// Motion of a drop that follows the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Followed {
    /// Velocity due to the wind, m/s.
    pub velocity: DVec3,
    /// Integral of that velocity from time 0, m.
    pub displacement: DVec3,
}

/// Uniform wind: the sum of the uniform parts of a [`Wind`](crate::Wind) and its gusts, at any time in closed form.
#[derive(Clone, Debug, PartialEq)]
pub struct UniformWind {
    /// Times, s, and mean velocities, m/s; never empty.
    keys: Vec<(f64, DVec3)>,
    /// Slopes of the mean before each key and after the last, m/s^2: 0 at both ends.
    slopes: Vec<DVec3>,
    /// Displacement of the air from the first key to each, m.
    travel: Vec<DVec3>,
    modes: Vec<GustMode>,
    /// Sinusoids at each key.
    phasors: Vec<Vec<[f64; 4]>>,
}

/// State of a wind at one time.
#[derive(Clone, Debug)]
struct WindInstant {
    time: f64,
    /// Number of keys up to this time.
    segment: usize,
    mean: DVec3,
    phasors: Vec<[f64; 4]>,
}

/// Factors along and across the mean wind.
#[derive(Clone, Copy)]
struct Gain {
    along: f64,
    across: f64,
}

impl Gain {
    fn apply(self, mean: DVec3) -> DVec3 {
        mean * self.along + beside(mean) * self.across
    }
}

/// Horizontal vector perpendicular to the horizontal part of `v`, with the same length.
fn beside(v: DVec3) -> DVec3 {
    DVec3::new(v.z, 0.0, -v.x)
}

impl UniformWind {
    pub(crate) fn new(mean: &Keyed<DVec3>, gusts: Option<&Gusts>) -> Self {
        let keys = mean.keys().to_vec();
        let mut slopes = vec![DVec3::ZERO];
        slopes.extend(keys.windows(2).filter_map(|pair| match *pair {
            [(start, from), (end, to)] => Some((to - from) / (end - start)),
            _ => None,
        }));
        slopes.push(DVec3::ZERO);
        let modes = gusts.map_or_else(Vec::new, |gusts| gusts.modes(mean_speed(&keys)));
        let mut wind = Self { keys, slopes, travel: Vec::new(), modes, phasors: Vec::new() };
        wind.phasors = wind.keys.iter().map(|&(time, _)| wind.phasors_at(time)).collect();
        let mut way = DVec3::ZERO;
        wind.travel.push(way);
        for (k, pair) in wind.keys.windows(2).enumerate() {
            if let [(start, from), (end, to)] = *pair {
                way += wind.integral(start, end, from.midpoint(to), wind.slope(k + 1));
                wind.travel.push(way);
            }
        }
        wind
    }

    /// Velocity of the air at a time, m/s. Times are clamped to 1e9 s before and after 0.
    #[must_use]
    pub fn velocity(&self, time_s: f64) -> DVec3 {
        let instant = self.instant(limited(time_s));
        self.gain(&instant.phasors).apply(instant.mean)
    }

    /// True if the wind is constant.
    #[must_use]
    pub fn is_steady(&self) -> bool {
        self.modes.is_empty() && self.slopes.iter().all(|&slope| slope == DVec3::ZERO)
    }

    /// Mean velocity without gusts, m/s.
    #[must_use]
    pub fn mean(&self, time_s: f64) -> DVec3 {
        let time = limited(time_s);
        self.mean_at(time, self.segment(time))
    }

    /// Integral of the mean velocity from time 0, m: displacement of the air by the mean wind.
    #[must_use]
    pub fn mean_displacement(&self, time_s: f64) -> DVec3 {
        // The trapezoidal rule is exact between keys.
        let from_first = |time: f64| {
            let segment = self.segment(time);
            let whole: DVec3 = self
                .keys
                .windows(2)
                .take(segment.saturating_sub(1))
                .map(|pair| match *pair {
                    [(start, from), (end, to)] => from.midpoint(to) * (end - start),
                    _ => DVec3::ZERO,
                })
                .sum();
            let (start, from) = self.key_before(segment);
            whole + from.midpoint(self.mean_at(time, segment)) * (time - start)
        };
        from_first(limited(time_s)) - from_first(0.0)
    }

    /// Motion of a drop with a relaxation time, s, at a time; use [`UniformWind::prepared`] for many drops.
    #[must_use]
    pub fn followed(&self, time_s: f64, relaxation_s: f64) -> Followed {
        self.prepared(time_s).followed(relaxation_s)
    }

    /// Precomputes the terms of one time that do not depend on the drop. A call per drop then takes some hundred
    /// operations.
    #[must_use]
    pub fn prepared(&self, time_s: f64) -> UniformWindAt<'_> {
        let here = self.instant(limited(time_s));
        let start = self.instant(0.0);
        let travel = self.traveled(&here) - self.traveled(&start);
        let air = self.gain(&here.phasors).apply(here.mean);
        UniformWindAt { wind: self, here, start, travel, air }
    }

    /// Slope of the mean in a segment.
    fn slope(&self, segment: usize) -> DVec3 {
        self.slopes.get(segment).copied().unwrap_or(DVec3::ZERO)
    }

    fn segment(&self, time: f64) -> usize {
        self.keys.partition_point(|&(key, _)| key <= time)
    }

    /// Key at the start of a segment; the first key for the segment before it.
    fn key_before(&self, segment: usize) -> (f64, DVec3) {
        self.keys.get(segment.saturating_sub(1)).copied().unwrap_or_default()
    }

    fn mean_at(&self, time: f64, segment: usize) -> DVec3 {
        let (start, from) = self.key_before(segment);
        from + self.slope(segment) * (time - start)
    }

    fn phasors_at(&self, time: f64) -> Vec<[f64; 4]> {
        let turned = |mode: &GustMode| {
            let angle = mode.omega * time;
            let (s, c) = (ops::sin(angle), ops::cos(angle));
            let [a, b, x, y] = mode.amplitude;
            [a * c - b * s, a * s + b * c, x * c - y * s, x * s + y * c]
        };
        self.modes.iter().map(turned).collect()
    }

    fn instant(&self, time: f64) -> WindInstant {
        let segment = self.segment(time);
        WindInstant { time, segment, mean: self.mean_at(time, segment), phasors: self.phasors_at(time) }
    }

    /// Factors of the gusts on the mean wind.
    fn gain(&self, phasors: &[[f64; 4]]) -> Gain {
        let start = Gain { along: 1.0, across: 0.0 };
        phasors.iter().fold(start, |g, p| Gain { along: g.along + p[0], across: g.across + p[2] })
    }

    /// Factors on a drop's velocity: each term times q.
    fn lagged(&self, phasors: &[[f64; 4]], tau: f64) -> Gain {
        let mut gain = Gain { along: 1.0, across: 0.0 };
        for (mode, &[a, b, x, y]) in self.modes.iter().zip(phasors) {
            let z = mode.omega * tau;
            let fraction = 1.0 / (1.0 + z * z);
            gain.along += fraction * (a + z * b);
            gain.across += fraction * (x + z * y);
        }
        gain
    }

    /// Each term times q^2.
    fn lagged_twice(&self, phasors: &[[f64; 4]], tau: f64) -> Gain {
        let mut gain = Gain { along: 1.0, across: 0.0 };
        for (mode, &[a, b, x, y]) in self.modes.iter().zip(phasors) {
            let z = mode.omega * tau;
            let fraction = 1.0 / (1.0 + z * z);
            let (re, im) = (fraction * fraction * (1.0 - z * z), fraction * fraction * 2.0 * z);
            gain.along += re * a + im * b;
            gain.across += re * x + im * y;
        }
        gain
    }

    /// Velocity of a drop.
    fn response(&self, at: &WindInstant, tau: f64) -> DVec3 {
        let mut y = self.lagged(&at.phasors, tau).apply(at.mean);
        let slope = self.slope(at.segment);
        if slope != DVec3::ZERO {
            y -= self.lagged_twice(&at.phasors, tau).apply(slope) * tau;
        }
        // The latest key first: the older ones are soon forgotten.
        let passed = self.keys.iter().zip(&self.phasors).enumerate().take(at.segment).rev();
        for (k, (&(time, _), phasors)) in passed {
            let age = at.time - time;
            if age > MEMORY * tau {
                break;
            }
            let bend = self.slope(k + 1) - self.slope(k);
            if bend != DVec3::ZERO {
                y += self.lagged_twice(phasors, tau).apply(bend) * (tau * ops::exp(-age / tau));
            }
        }
        y
    }

    /// Displacement of the air from the first key to a time, m.
    fn traveled(&self, at: &WindInstant) -> DVec3 {
        let (start, from) = self.key_before(at.segment);
        let before = self.travel.get(at.segment.saturating_sub(1)).copied().unwrap_or(DVec3::ZERO);
        before + self.integral(start, at.time, from.midpoint(at.mean), self.slope(at.segment))
    }

    /// Integral of the air's velocity within a segment, m; `middle` is the mean wind half way. It is expanded about the
    /// middle, so that slow sinusoids do not lose digits.
    fn integral(&self, start: f64, end: f64, middle: DVec3, slope: DVec3) -> DVec3 {
        let half = 0.5 * (end - start);
        let phasors = self.phasors_at(start.midpoint(end));
        let mut whole = Gain { along: 1.0, across: 0.0 };
        let mut tilt = Gain { along: 0.0, across: 0.0 };
        for (mode, &[a, b, x, y]) in self.modes.iter().zip(&phasors) {
            let (even, odd) = moments(mode.omega * half);
            whole.along += even * a;
            whole.across += even * x;
            tilt.along -= odd * b;
            tilt.across -= odd * y;
        }
        whole.apply(middle) * (2.0 * half) + tilt.apply(slope) * (2.0 * half * half)
    }
}

/// sin x / x, and (sin x - x cos x) / x^2.
fn moments(x: f64) -> (f64, f64) {
    if x.abs() < 0.02 {
        let s = x * x;
        // The next terms are below 1e-16.
        return (
            1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)),
            x / 3.0 * (1.0 - s / 10.0 * (1.0 - s / 28.0)),
        );
    }
    let (s, c) = (ops::sin(x), ops::cos(x));
    (s / x, (s - x * c) / (x * x))
}

/// Mean of the speed from the first key to the last, by the trapezoidal rule.
fn mean_speed(keys: &[(f64, DVec3)]) -> f64 {
    let (mut way, mut time) = (0.0, 0.0);
    for pair in keys.windows(2) {
        if let [(start, from), (end, to)] = *pair {
            way += 0.5 * (from.length() + to.length()) * (end - start);
            time += end - start;
        }
    }
    if time > 0.0 { way / time } else { keys.first().map_or(0.0, |(_, v)| v.length()) }
}

fn limited(time: f64) -> f64 {
    if time.is_nan() { 0.0 } else { time.clamp(-MAX_TIME_S, MAX_TIME_S) }
}

/// A wind at one time, prepared for any number of drops.
#[derive(Clone, Debug)]
pub struct UniformWindAt<'a> {
    wind: &'a UniformWind,
    here: WindInstant,
    start: WindInstant,
    travel: DVec3,
    air: DVec3,
}

impl UniformWindAt<'_> {
    /// Velocity of the air, m/s.
    #[must_use]
    pub fn velocity(&self) -> DVec3 {
        self.air
    }

    /// Motion of a drop with a relaxation time, at most 1e6 s. A time of 0 or less, or NaN, follows the air at once.
    ///
    /// Across its fall a drop relaxes with v / g, along it with v / 2g, where v is its terminal speed: use x and z of
    /// the former and y of the latter.
    #[must_use]
    pub fn followed(&self, relaxation_s: f64) -> Followed {
        if relaxation_s.is_nan() || relaxation_s <= 0.0 {
            return Followed { velocity: self.air, displacement: self.travel };
        }
        let tau = relaxation_s.min(MAX_RELAXATION_S);
        let velocity = self.wind.response(&self.here, tau);
        let change = velocity - self.wind.response(&self.start, tau);
        Followed { velocity, displacement: self.travel - change * tau }
    }
}
