//! A point that drips: its drops at any time.

use downpour_drop::drip::{BROAD_RADIUS_M, Drip};
use downpour_drop::fall_speed::time_of_fall;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};
use downpour_shaders::sim::drip::{DRIP_DROP, DRIP_HANGS, DRIP_JITTER, DRIP_MARGIN};
#[cfg(feature = "wgpu")]
use downpour_shaders::sim::field::FIELD_ALWAYS;
use downpour_wind::UniformWind;
use glam::DVec3;
#[cfg(feature = "wgpu")]
use glam::Vec3;

use super::clock::{Clock, DripRain};
use super::fall::{Fall, Landing, MAX_FALL_S};
use super::points::DripPoint;
#[cfg(feature = "wgpu")]
use super::row::DripRow;
use super::{DripOptions, MIN_PER_S};
use crate::SimError;
use crate::facets::Facets;
use crate::falling::{DropKind, FallingDrop};
use crate::impacts::Impact;
use crate::shelter::Obstacles;

/// Part of a drop's diameter by which its center hangs below the edge.
const HANGS: f64 = DRIP_HANGS as f64;

/// Jitter of the time of a drop, in intervals: half of it before, half after.
const JITTER: f64 = DRIP_JITTER as f64;

/// Range of the radii of broad edges relative to the usual one, as a half width.
const UNEVEN: f64 = 0.35;

/// Dimension of the random numbers of a point.
const OF_POINT: u32 = 8317;

/// Obstacles and wind that a drop falls among.
#[derive(Clone, Copy)]
pub(super) struct Query<'a> {
    pub(super) obstacles: &'a Obstacles<'a>,
    pub(super) facets: &'a Facets<'a>,
    pub(super) wind: &'a UniformWind,
}

/// A point that drips.
#[derive(Clone, Debug)]
pub(super) struct Emitter {
    position: DVec3,
    /// The drop that hangs, whether it falls or feeds a jet.
    hanging: Drip,
    /// Diameter of the drops that fall, m.
    diameter: f64,
    is_jet: bool,
    /// Terminal speed, m/s.
    terminal: f64,
    clock: Clock,
    /// Fraction of an interval by which its drops are late.
    phase: f64,
    key: [u32; 2],
    /// End of each fall, in a steady wind.
    landing: Option<Landing>,
    /// Longest time of a fall, s.
    longest_s: f64,
    /// End of a fall that takes this long, m.
    end: DVec3,
}

impl Emitter {
    /// Emitter of a point that was found, in a rain.
    pub(super) fn of_point(
        point: &DripPoint,
        rain: &DripRain,
        options: &DripOptions,
    ) -> Result<Option<Self>, SimError> {
        let [size, ..] = drawn(key_of(point.position, options.seed), 0, OF_POINT);
        let broad = BROAD_RADIUS_M * (1.0 + UNEVEN * (2.0 * size - 1.0));
        let radius = point.radius_m.map_or(broad, |radius| radius.min(broad));
        let drip = Drip::new(radius, options.temperature_c)?;
        let flow = drip.flow(rain.rate_m_s * point.catchment_m2);
        let Some(clock) = Clock::new(rain, flow.per_s, point.flow_m) else { return Ok(None) };
        let found = Self::new(point.position, drip, flow.per_s, clock, options)?;
        Ok(match found {
            Some(emitter) if flow.is_jet => {
                let terminal = options.speed.at(flow.diameter_m)?;
                Some(Self { diameter: flow.diameter_m, is_jet: true, terminal, ..emitter })
            }
            found => found,
        })
    }

    /// Emitter of drops at a rate; `None` for too low a rate.
    pub(super) fn new(
        position: DVec3,
        hanging: Drip,
        per_s: f64,
        clock: Clock,
        options: &DripOptions,
    ) -> Result<Option<Self>, SimError> {
        if per_s.is_nan() || per_s < MIN_PER_S {
            return Ok(None);
        }
        let key = key_of(position, options.seed);
        let [_, phase, ..] = drawn(key, 0, OF_POINT);
        Ok(Some(Self {
            position,
            hanging,
            diameter: hanging.diameter_m,
            is_jet: false,
            terminal: options.speed.at(hanging.diameter_m)?,
            clock,
            phase,
            key,
            landing: None,
            longest_s: 0.0,
            end: position,
        }))
    }

    /// The same emitter, of drops from a jet or of drops that hang.
    pub(super) fn with_jet(self, is_jet: bool) -> Self {
        Self { is_jet, ..self }
    }

    /// Finds how far its drops fall.
    pub(super) fn land(&mut self, obstacles: &Obstacles<'_>, facets: &Facets<'_>, wind: &UniformWind) {
        let fall = self.fall(wind, 0.0);
        self.landing = fall.landing(obstacles, facets, MAX_FALL_S);
        let depth = |low: f32| self.position.y - obstacles.origin.y - f64::from(low) + 1.0;
        let to_bottom = obstacles.corners().map_or(MAX_FALL_S, |[low, _]| {
            time_of_fall(self.terminal, depth(low.y).max(0.0)).min(MAX_FALL_S)
        });
        self.longest_s = match self.landing {
            Some(landing) if wind.is_steady() => landing.after_s,
            _ => to_bottom,
        };
        self.end = fall.at(self.longest_s).0;
    }

    /// True if its drops fall farther than their diameter.
    pub(super) fn has_room(&self) -> bool {
        self.position.y - self.end.y > 2.0 * self.diameter
    }

    /// Volume of its water while it rains, m^3/s.
    pub(super) fn flow(&self) -> f64 {
        self.clock.per_s() * downpour_drop::drip::sphere_volume(self.diameter)
    }

    /// Diameter of its largest drops, m.
    pub(super) fn largest(&self) -> f64 {
        if self.is_jet { self.diameter } else { self.hanging.hanging_diameter(1.0) }
    }

    /// Diameter of the drops that fall, m, and upper bound of their speed in still air, m/s.
    pub(super) fn falling(&self) -> [f64; 2] {
        [self.diameter, self.terminal]
    }

    /// Drops per second while it rains.
    #[cfg(feature = "wgpu")]
    pub(super) fn per_s(&self) -> f64 {
        self.clock.per_s()
    }

    /// Middle and radius of a ball that holds its drops, where an unsteady wind blows at up to `reach` m/s.
    pub(super) fn around(&self, reach: f64) -> (DVec3, f64) {
        let middle = self.position.midpoint(self.end);
        (middle, 0.5 * self.position.distance(self.end) + reach * self.longest_s + f64::from(DRIP_MARGIN))
    }

    /// The point as a device has it, relative to an origin.
    #[cfg(feature = "wgpu")]
    pub(super) fn row(&self, origin: DVec3) -> DripRow {
        let end = self.clock.end();
        let words = |count: f64| {
            let units = (count * 4_294_967_296.0).round() as i128;
            [(units >> 64) as u32, (units >> 32) as u32, units as u32]
        };
        let cube = |diameter: f64| (diameter * diameter * diameter) as f32;
        let whole = self.hanging.hanging_diameter(1.0);
        let until = self.landing.map_or(FIELD_ALWAYS, |landing| landing.after_s as f32);
        DripRow {
            position: (self.position - origin).as_vec3(),
            terminal: self.terminal as f32,
            end: (self.end - origin).as_vec3(),
            longest: self.longest_s as f32,
            due: words(self.phase - self.clock.count_in_rain(0.0)),
            units: self.clock.rate.units,
            left: words(
                end.map_or(0.0, |[_, count, drain_s]| count + drain_s * self.clock.per_s() - self.phase),
            ),
            shift: self.clock.rate.shift,
            key: self.key,
            diameter: self.diameter as f32,
            below: self.below() as f32,
            until,
            hanging: if self.is_jet { 0.0 } else { cube(whole) },
            leaving: cube(self.hanging.diameter_m),
            drain: end.map_or(0.0, |[.., drain_s]| drain_s as f32),
            normal: self.landing.and_then(|landing| landing.normal).unwrap_or(Vec3::NEG_Y),
            unused: 0,
        }
    }

    /// End of the rain whose drops it has, s; `None` if that goes on.
    #[cfg(feature = "wgpu")]
    pub(super) fn rain_end(&self) -> Option<f64> {
        self.clock.end().map(|[stop_s, ..]| stop_s)
    }

    /// Upper bound of the number of drops in an exposure, which grows with its half time: at an instant, and per second of that.
    #[cfg(feature = "wgpu")]
    pub(super) fn most(&self) -> [f64; 2] {
        let per_s = self.clock.per_s();
        let falling = self.longest_s * per_s + JITTER + 1.0;
        if self.is_jet { [falling, 2.0 * per_s] } else { [falling + JITTER + 2.0, 4.0 * per_s] }
    }

    /// Distance of the center of a drop from the edge when it begins to fall, m.
    fn below(&self) -> f64 {
        if self.is_jet { 0.5 * self.diameter } else { self.hangs(1.0) }
    }

    /// Fall of a drop that leaves at a time.
    fn fall<'a>(&self, wind: &'a UniformWind, begin_s: f64) -> Fall<'a> {
        Fall::new(wind, self.position - DVec3::Y * self.below(), self.terminal, begin_s)
    }

    /// Distance of the center of the hanging drop from the edge, m.
    fn hangs(&self, fraction: f64) -> f64 {
        HANGS * self.hanging.hanging_diameter(fraction)
    }

    /// Time at which a drop leaves, s; infinite for one that never does.
    fn leaves(&self, drop: i64) -> f64 {
        let [jitter, ..] = drawn(self.key, drop, DRIP_DROP);
        self.clock.time(drop as f64 + self.phase + JITTER * (jitter - 0.5))
    }

    /// Numbers of the drops that may leave between two times.
    fn leaving(&self, begin_s: f64, end_s: f64) -> std::ops::RangeInclusive<i64> {
        let at = |time_s: f64, more: f64| (self.clock.count(time_s) - self.phase + more) as i64;
        at(begin_s, -JITTER - 1.0).max(0)..=at(end_s, JITTER + 1.0)
    }

    fn id(&self, drop: i64) -> u64 {
        let [a, b, ..] = rng_draw(self.key, drop as u32, (drop >> 32) as u32, DRIP_DROP + 1);
        u64::from(a) << 32 | u64::from(b)
    }

    /// End of a fall; in an unsteady wind only if it is before an age.
    fn landing(&self, query: &Query<'_>, fall: &Fall<'_>, age_s: f64) -> Option<Landing> {
        if query.wind.is_steady() {
            return self.landing;
        }
        fall.landing(query.obstacles, query.facets, age_s)
    }

    /// Adds its drops at a time, as an exposure of twice `half` shows them.
    pub(super) fn list(&self, query: &Query<'_>, time_s: f64, half: f64, drops: &mut Vec<FallingDrop>) {
        for drop in self.leaving(time_s - half - self.longest_s, time_s + half) {
            let begin_s = self.leaves(drop);
            let age = time_s - begin_s;
            if age <= -half || age - half > self.longest_s {
                continue;
            }
            let fall = self.fall(query.wind, begin_s);
            let landed = self.landing(query, &fall, age + half);
            let until = landed.map_or(f64::INFINITY, |landing| landing.after_s);
            if until <= age - half {
                continue;
            }
            let (position, velocity) = fall.at(age.min(until));
            drops.push(FallingDrop {
                position,
                velocity: velocity.as_vec3().to_array(),
                diameter: self.diameter as f32,
                id: self.id(drop),
                kind: DropKind::Dripped,
                present_s: [-age, until - age].map(|time| time as f32),
                normal: FallingDrop::LEVEL,
            });
        }
        if !self.is_jet {
            self.list_hanging(time_s, half, drops);
        }
    }

    /// Adds the drops that hang at some time of an exposure.
    fn list_hanging(&self, time_s: f64, half: f64, drops: &mut Vec<FallingDrop>) {
        // It has left before the exposure, unless it is the first of all.
        let first = *self.leaving(time_s - half, time_s + half).start();
        let mut since = f64::NEG_INFINITY;
        for drop in first.. {
            let leaves = self.leaves(drop);
            if leaves > time_s - half {
                // Before its first drop an edge becomes wet.
                let begin = if since.is_finite() { since } else { leaves - 1.0 / self.clock.per_s() };
                let seen = time_s.clamp(begin, leaves);
                // The last one hangs for good.
                let fraction = if leaves.is_finite() { (seen - begin) / (leaves - begin) } else { 0.5 };
                let diameter = self.hanging.hanging_diameter(fraction);
                if begin < time_s + half {
                    drops.push(FallingDrop {
                        position: self.position - DVec3::Y * self.hangs(fraction),
                        velocity: [0.0; 3],
                        diameter: diameter as f32,
                        id: self.id(drop),
                        kind: DropKind::Dripped,
                        present_s: [since, leaves].map(|time| (time - time_s) as f32),
                        normal: FallingDrop::LEVEL,
                    });
                }
            }
            if leaves >= time_s + half {
                break;
            }
            since = leaves;
        }
    }

    /// Where all of its drops land in a steady wind, m; `None` in another, or if they do not.
    pub(super) fn lands(&self, wind: &UniformWind) -> Option<DVec3> {
        (wind.is_steady() && self.landing.is_some()).then_some(self.end)
    }

    /// Its impacts within a span of time, s.
    pub(super) fn impacts(&self, query: &Query<'_>, [begin_s, end_s]: [f64; 2]) -> Vec<Impact> {
        let mut impacts = Vec::new();
        // In a steady wind all falls are as long.
        let shortest = self.landing.filter(|_| query.wind.is_steady()).map_or(0.0, |landing| landing.after_s);
        for drop in self.leaving(begin_s - self.longest_s, end_s - shortest) {
            let leaves = self.leaves(drop);
            if leaves >= end_s {
                continue;
            }
            let fall = self.fall(query.wind, leaves);
            let Some(landing) = self.landing(query, &fall, end_s - leaves) else { continue };
            let time_s = leaves + landing.after_s;
            let Some(normal) = landing.normal.filter(|_| time_s > begin_s && time_s <= end_s) else {
                continue;
            };
            let (position, velocity) = fall.at(landing.after_s);
            let (velocity, diameter) = (velocity.as_vec3(), self.diameter as f32);
            impacts.push(Impact { position, normal, velocity, diameter, id: self.id(drop), time_s });
        }
        impacts
    }
}

/// Key of the random numbers of a point: of its position in millimeters.
fn key_of(position: DVec3, seed: u64) -> [u32; 2] {
    let [x, y, z] = (position * 1.0e3).round().to_array().map(|x| (x as i64) as u32);
    let [a, b, ..] = rng_draw(seed_words(seed), x, y, z);
    [a, b]
}

fn drawn(key: [u32; 2], drop: i64, dimension: u32) -> [f64; 4] {
    rng_draw(key, drop as u32, (drop >> 32) as u32, dimension).map(|word| f64::from(rng_unit(word)))
}
