//! Rain in still air or in a uniform wind, in closed form.
//!
//! The field has no borders, no state and no step: the positions of its drops are a function of (seed, time), so any
//! number of cameras, in any order, at any frame rate, sees the same drops.
//!
//! Method: diameters are divided into classes. A class has square columns on a grid of the world's x and z. A column
//! holds chains, as many as a Poisson number of the class's number density; a chain has one diameter, hence one
//! terminal speed v, and one phase. Its drops follow each other at the class's period H: they are at
//! `y = phase H - v t + k H` for all integers k, and each k has its own position in the column. Therefore
//!
//! - number density and sizes are those of the distribution, everywhere and always;
//! - a drop falls straight at its terminal speed, and drops overtake smaller neighbours;
//! - only the part of a column in view is computed, at any time.
//!
//! Wind carries all drops of a chain alike: its displacement, which follows the wind according to the drop's size, is
//! added to their positions ([`downpour_wind::UniformWind`]). Obstacles are found along the drops' paths
//! ([`RainField::visible_among`]), and so are the impacts on them ([`RainField::impacts`]). Obstacles do not affect the
//! wind: it blows through them.
//!
//! What decides which drops there are is done in integers, so that a GPU finds the same ones (`chain`): diameters are multiples of
//! 1 nm, terminal speeds those of the law to 0.003 % (0.02 % where it jumps).
//!
//! A rate that changes leaves out drops of the heaviest rain, each for all of its fall (`thinning`).
//!
//! Limit: drops of one chain share their size, H apart; H is about 8 m per millimeter of diameter, up to 64 m.

#[doc(hidden)]
pub mod chain;
#[cfg(feature = "wgpu")]
#[doc(hidden)]
pub mod frame;
mod reach;
mod room;
#[doc(hidden)]
pub mod thinning;

use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, SampledBy};
use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed};
use downpour_math::rng::{rng_draw, rng_pcg4d, seed_words};
use downpour_math::{OutOfRange, in_range};
use downpour_shaders::sim::field::{
    FIELD_CHAIN, FIELD_DIAMETER_STEP, FIELD_PLACE, FIELD_RATE_STEP, FIELD_THIN,
};
use downpour_wind::{Keyed, UniformWind, Wind};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Arc;

use self::chain::{ChainCount, ChainSizes, FieldTime, field_fallen};
pub(crate) use self::reach::Reach;
#[cfg(feature = "wgpu")]
pub(crate) use self::room::{ROOM, SPARE_ROOM};
use self::thinning::Thinning;
use crate::SimError;
use crate::drift::Drift;
#[doc(hidden)]
pub use crate::drift::drift_position;
pub use crate::falling::{DropKind, EyeDrop, FallingDrop, VisibleDrops};
#[doc(hidden)]
pub use crate::falling::{eye_drop_normal, eye_drop_outside, eye_drop_standing, eye_drop_turned};
use crate::resolved::Resolved;
use crate::shelter::{Obstacles, keep_open};
use crate::view::{Bounds, View, within};

/// Number of diameter classes per factor of two.
const CLASSES_PER_OCTAVE: f64 = 4.0;

/// Maximum absolute time, seconds: a little more than 11 days.
pub const MAX_TIME_S: f64 = 1.0e6;

/// Drops of similar size.
#[derive(Clone, Debug)]
pub(crate) struct Class {
    /// Its number among the classes.
    pub(crate) number: usize,
    pub(crate) seed: [u32; 2],
    pub(crate) largest: f64,
    /// Terminal speeds of the smallest and the largest drop, m/s.
    pub(crate) speeds: [f64; 2],
    /// Drops per cubic meter.
    pub(crate) density: f64,
    pub(crate) sizes: ChainSizes,
    pub(crate) count: ChainCount,
    /// Edge of a column, meters.
    pub(crate) edge: f64,
    /// Period along the vertical, meters.
    pub(crate) period: f64,
}

/// An unbounded rain.
#[derive(Clone, Debug)]
pub struct RainField {
    pub(crate) classes: Vec<Class>,
    pub(crate) speed: TerminalSpeed,
    /// Model and air of these speeds.
    #[cfg_attr(not(feature = "wgpu"), expect(dead_code, reason = "for a device that finds droplets"))]
    pub(crate) falls: (FallSpeedModel, Air),
    pub(crate) wind: UniformWind,
    /// Drops that do not fall, of a rate that changes.
    pub(crate) thinning: Option<Arc<Thinning>>,
}

/// Position and contents of a chain.
#[derive(Clone, Copy, Debug)]
struct Chain {
    column: [u32; 2],
    index: u32,
    /// Diameter and rate of fall, in units.
    size: [u32; 2],
    phase: u32,
    diameter: f32,
    speed: f64,
    /// Current height of the drop k = 0, meters.
    height: f64,
    /// Displacement by the wind, meters, and velocity due to it.
    carried: DVec3,
    wind: DVec3,
}

impl RainField {
    /// Creates the rain of a distribution; the seed selects one realisation.
    ///
    /// # Errors
    /// [`SimError::Drop`] if the distribution cannot be divided into classes.
    pub fn new(rain: &DropSizeDistribution, seed: u64) -> Result<Self, SimError> {
        Self::thinned(rain, seed, None)
    }

    /// Creates a rain whose rate changes: at `height_m` it has the rate in mm/h of each time, and at other heights that of the time at
    /// which its drops pass there. `heaviest` is the distribution of the largest rate; the law of the others is the same. In a wind that
    /// rises or falls, drops count as passing the height as they do in still air.
    ///
    /// # Errors
    /// [`SimError::Drop`] for a rate that is none, or as in [`RainField::new`]; [`SimError::OutOfRange`] for a height beyond 100 km.
    pub fn changing(
        heaviest: &DropSizeDistribution,
        rates_mm_h: &Keyed<f64>,
        height_m: f64,
        seed: u64,
    ) -> Result<Self, SimError> {
        Self::thinned(heaviest, seed, Some((rates_mm_h, height_m)))
    }

    fn thinned(
        rain: &DropSizeDistribution,
        seed: u64,
        changes: Option<(&Keyed<f64>, f64)>,
    ) -> Result<Self, SimError> {
        let options = rain.options();
        let speed = TerminalSpeed::new(options.fall_speed, &options.air);
        let mut spans: Vec<(u32, [f64; 2])> = Vec::new();
        if rain.rate_mm_h() > 0.0 {
            spans.extend((0u32..).zip(rain.diameter_classes(CLASSES_PER_OCTAVE)));
        }
        // A narrow last class would have too few drops.
        spans.retain(|(_, [lower, upper])| upper - lower >= 2.0e-6);
        let sizes: Vec<[f64; 2]> = spans.iter().map(|span| span.1).collect();
        let (mut thinning, needed) = match changes {
            Some((rates, height)) => {
                let (thinning, needed) = Thinning::new(rain, rates, height, &sizes)?;
                (Some(thinning), needed)
            }
            None => (None, vec![1.0; sizes.len()]),
        };
        let class = |(number, ((k, [lower, upper]), needed)): (usize, ((u32, [f64; 2]), f64))| {
            let part = rain.restricted_to(lower, upper)?;
            let mm = lower * 1.0e3;
            let (edge, period) = ((0.25 * mm).clamp(0.05, 2.0), (8.0 * mm).clamp(2.0, 64.0));
            let density = part.number_density() * needed;
            Ok(Class {
                number,
                seed: class_seed(seed, k),
                largest: upper,
                speeds: [lower, upper].map(|d| speed.at(d).unwrap_or(0.0)),
                density,
                sizes: ChainSizes::new(&part.sample_table(SampledBy::Number), &speed, period),
                count: ChainCount::new(density * edge * edge * period),
                edge,
                period,
            })
        };
        // The tables of a class take a millisecond or more, and a rain that is changed by hand makes all of them anew.
        let classes: Vec<Result<Class, SimError>> =
            spans.into_par_iter().zip(needed).enumerate().map(class).collect();
        let classes = classes.into_iter().collect::<Result<Vec<_>, _>>()?;
        if let Some(thinning) = &mut thinning {
            for (span, class) in sizes.iter().zip(&classes) {
                thinning.push(*span, class.period);
            }
        }
        let thinning = thinning.map(Arc::new);
        let falls = (options.fall_speed, options.air);
        Ok(Self { classes, speed, falls, wind: Wind::default().air().clone(), thinning })
    }

    /// Sets the wind of the rain: at time 0 its drops are where they would be in still air.
    #[must_use]
    pub fn with_wind(self, wind: UniformWind) -> Self {
        Self { wind, ..self }
    }

    /// Number of drops per cubic meter; of a rate that changes, no less than at any time.
    #[must_use]
    pub fn number_density(&self) -> f64 {
        self.classes.iter().map(|class| class.density).sum()
    }

    /// Drops in a picture at a time in seconds, without those that an obstacle has stopped.
    ///
    /// # Errors
    /// As [`RainField::visible`].
    pub fn visible_among(
        &self,
        obstacles: &Obstacles<'_>,
        view: &View,
        time_s: f64,
    ) -> Result<VisibleDrops, SimError> {
        let mut visible = self.visible(view, time_s)?;
        keep_open(&mut visible.drops, obstacles, &self.speed, &self.wind, time_s, view.shutter_s);
        Ok(visible)
    }

    /// Drops in a picture at a time in seconds.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid view, or a time beyond [`MAX_TIME_S`].
    pub fn visible(&self, view: &View, time_s: f64) -> Result<VisibleDrops, SimError> {
        view.check()?;
        check_time(time_s)?;
        let least_pixels = self.affordable(view);
        let drift = Drift::new(&self.wind, time_s);
        let mut drops = Vec::new();
        let mut simulated = 0;
        for class in &self.classes {
            let range = view.range(class.largest, least_pixels);
            if range < view.near {
                continue;
            }
            let reach = Reach::of_view(view, least_pixels);
            let (found, tried) = self.visible_of(class, view, &reach, time_s, &drift);
            drops.extend(found);
            simulated += tried;
        }
        Ok(VisibleDrops { drops, simulated, resolved: Resolved::of(view, least_pixels) })
    }

    /// All drops in a box at a time in seconds, in an order that depends on the query only.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a box that is invalid, farther than 10 000 km or holds more than ten million drops, or a
    /// time beyond [`MAX_TIME_S`].
    pub fn in_box(&self, low: DVec3, high: DVec3, time_s: f64) -> Result<Vec<FallingDrop>, SimError> {
        check_time(time_s)?;
        let extent = low.abs().max(high.abs()).max_element();
        if !(low.is_finite() && high.is_finite() && extent <= 1.0e7 && low.cmple(high).all()) {
            let (quantity, unit, allowed) = ("a side of the box", "m", "-1e7 to 1e7, low below high");
            return Err(SimError::OutOfRange(OutOfRange {
                quantity,
                found: extent,
                unit,
                allowed: allowed.into(),
            }));
        }
        let found = self.number_density() * (high - low).element_product();
        if found.is_nan() || found > 1.0e7 {
            let (quantity, unit, allowed) = ("number of drops in the box", "", "at most 1e7");
            return Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }));
        }
        let bounds = Bounds { low, high };
        let drift = Drift::new(&self.wind, time_s);
        let mut drops = Vec::new();
        for class in &self.classes {
            let [xs, zs] = class.columns(&bounds, &drift);
            for ix in xs {
                for iz in zs.clone() {
                    self.drops_of_column(class, [ix, iz], &bounds, time_s, &drift, |drop, _| {
                        if drop.position.cmpge(low).all() && drop.position.cmplt(high).all() {
                            drops.push(drop);
                        }
                    });
                }
            }
        }
        Ok(drops)
    }

    /// Rate, in mm/h, of the drops around a position, as a volume disdrometer measures it. Of each class it uses
    /// columns until it has seen about 2000 drops of it or 1024 columns.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid position or time.
    pub fn measured_rate_mm_h(&self, position: DVec3, time_s: f64) -> Result<f64, SimError> {
        check_time(time_s)?;
        View { eye: position, ..View::default() }.check()?;
        let drift = Drift::new(&self.wind, time_s);
        let still = Drift::new(&Wind::default().air().clone(), 0.0);
        let flux = |class: &Class| {
            let per_column = class.density * class.edge * class.edge * class.period;
            let side = (2000.0 / per_column.max(1.0e-6)).sqrt().ceil().clamp(1.0, 32.0);
            let half = DVec3::new(side * class.edge, class.period, side * class.edge) * 0.5;
            // Whole columns and one whole period.
            let corner = (position / class.edge).floor() * class.edge;
            let middle = DVec3::new(corner.x, position.y, corner.z);
            let bounds = Bounds { low: middle - half, high: middle + half };
            // Whole columns, independent of their displacement by the wind.
            let [xs, zs] = class.columns(&bounds, &still);
            let columns = (xs.end() - xs.start() + 1) * (zs.end() - zs.start() + 1);
            let mut sum = 0.0;
            for ix in xs {
                for iz in zs.clone() {
                    self.drops_of_column(class, [ix, iz], &bounds, time_s, &drift, |drop, _| {
                        let d = f64::from(drop.diameter);
                        sum += d * d * d * -f64::from(drop.velocity[1]);
                    });
                }
            }
            let volume = columns as f64 * class.edge * class.edge * class.period;
            std::f64::consts::FRAC_PI_6 * sum / volume
        };
        let parts: Vec<f64> = self.classes.par_iter().map(flux).collect();
        Ok(parts.iter().sum::<f64>() * 3.6e6)
    }

    /// Minimum diameter in pixels for which the view holds no more drops than it allows.
    fn affordable(&self, view: &View) -> f64 {
        let expected = |least: f64| -> f64 {
            self.classes.iter().map(|c| c.density * view.volume(view.range(c.largest, least))).sum()
        };
        let most = f64::from(view.max_drops.max(1));
        let mut least = view.least_pixels;
        while expected(least) > most {
            // 3 % at a time: a power law of at most the third order reaches the limit in a few dozen steps.
            least = (least * 1.03).max(1.0e-3);
        }
        least
    }

    /// The drops of a class that a picture shows, and how many were looked at.
    fn visible_of(
        &self,
        class: &Class,
        view: &View,
        reach: &Reach,
        time_s: f64,
        drift: &Drift,
    ) -> (Vec<FallingDrop>, u64) {
        let sides = view.sides();
        let swept = view.swept_sides();
        let Some(seen) = class.seen(view, reach, drift) else { return (Vec::new(), 0) };
        let [xs, zs] = class.columns(&seen.bounds, drift);
        let rows: Vec<(Vec<FallingDrop>, u64)> = xs
            .into_par_iter()
            .map(|ix| {
                let (mut found, mut tried) = (Vec::new(), 0);
                for iz in zs.clone() {
                    let x = (ix as f64 + 0.5) * class.edge;
                    let z = (iz as f64 + 0.5) * class.edge;
                    let middle = DVec3::new(x, 0.0, z) + seen.middle;
                    if !within(&swept, middle - view.eye, seen.radius) {
                        continue;
                    }
                    self.drops_of_column(class, [ix, iz], &seen.bounds, time_s, drift, |drop, _| {
                        tried += 1;
                        let diameter = f64::from(drop.diameter);
                        let velocity = Vec3::from(drop.velocity).as_dvec3();
                        let (range, radius) = (reach.range(diameter), reach.radius(diameter));
                        let all = [f64::NEG_INFINITY, f64::INFINITY];
                        if view.shows(&sides, drop.position, velocity, radius, range, all) {
                            found.push(drop);
                        }
                    });
                }
                (found, tried)
            })
            .collect();
        let tried = rows.iter().map(|row| row.1).sum();
        (rows.into_iter().flat_map(|row| row.0).collect(), tried)
    }

    /// Collects the results of `make` for the drops of a class within bounds at a time; `make` also gets their
    /// terminal speeds.
    pub(crate) fn gathered<T>(
        &self,
        class: &Class,
        bounds: &Bounds,
        time_s: f64,
        drift: &Drift,
        make: impl Fn(&FallingDrop, f64) -> Option<T>,
    ) -> Vec<T> {
        let [xs, zs] = class.columns(bounds, drift);
        let mut made = Vec::new();
        for ix in xs {
            for iz in zs.clone() {
                self.drops_of_column(class, [ix, iz], bounds, time_s, drift, |drop, speed| {
                    let at = drop.position;
                    if at.cmpge(bounds.low).all() && at.cmple(bounds.high).all() {
                        made.extend(make(&drop, speed));
                    }
                });
            }
        }
        made
    }

    /// Passes on the drops of a column whose height is within the bounds, with their terminal speeds.
    fn drops_of_column(
        &self,
        class: &Class,
        column: [i64; 2],
        bounds: &Bounds,
        time_s: f64,
        drift: &Drift,
        mut each: impl FnMut(FallingDrop, f64),
    ) {
        let [a, b, c, d] = rng_pcg4d([column[0] as u32, column[1] as u32, class.seed[0], class.seed[1]]);
        let key = [a ^ c, b ^ d];
        let time = FieldTime::new(time_s);
        for index in 0..class.count.field_count(key) {
            let [size, phase, ..] = rng_draw(key, index, 0, FIELD_CHAIN);
            let size @ [units, rate] = class.sizes.field_size(size);
            let diameter = units as f32 * FIELD_DIAMETER_STEP;
            let speed = f64::from(rate) * f64::from(FIELD_RATE_STEP) * class.period;
            let [carried, wind] = drift.of(speed);
            let [whole, part] = field_fallen(rate, time);
            // In periods, in units of 2^-32.
            let above = u64::from(phase).wrapping_sub(u64::from(whole) << 32 | u64::from(part)) as i64;
            let height = above as f64 / 4_294_967_296.0 * class.period + carried.y;
            let chain = Chain { column: key, index, size, phase, diameter, speed, height, carried, wind };
            let first = ((bounds.low.y - height) / class.period).ceil() as i64;
            let last = ((bounds.high.y - height) / class.period).floor() as i64;
            for k in first..=last {
                if self.thinning.as_deref().is_some_and(|thinning| !chain.falls(k, class, thinning)) {
                    continue;
                }
                each(chain.drop(k, class, column), speed);
            }
        }
    }
}

/// Part of the columns of a class in which a search may find drops.
pub(crate) struct SeenColumns {
    /// Bounds of the drops.
    pub(crate) bounds: Bounds,
    /// From the middle of a column at height 0 to the middle of this part of it, m.
    pub(crate) middle: DVec3,
    /// Radius around that, with all margins, m.
    pub(crate) radius: f64,
}

impl Class {
    /// Part of its columns in which a search may find drops, if there is any.
    pub(crate) fn seen(&self, view: &View, reach: &Reach, drift: &Drift) -> Option<SeenColumns> {
        let margin = self.half_way(view, drift) + reach.radius(self.largest);
        let bounds = view.bounds(reach.range(self.largest), margin).common(&reach.within)?;
        let [least, most] = drift.span(self.speeds[0], self.speeds[1]);
        let (carried, spread) = (least.midpoint(most), 0.5 * (most - least).length());
        let height = (bounds.low.y + bounds.high.y) * 0.5;
        let half = (bounds.high.y - bounds.low.y) * 0.5;
        let radius = (0.5 * self.edge * self.edge + half * half).sqrt() + spread;
        let middle = DVec3::new(carried.x, height, carried.z);
        Some(SeenColumns { bounds, middle, radius: radius + margin })
    }

    /// Maximum distance, m, that a drop moves relative to the eye in half the exposure.
    pub(crate) fn half_way(&self, view: &View, drift: &Drift) -> f64 {
        let [slow, fast] = self.speeds;
        let way = |speed: f64| view.half_way(drift.of(speed)[1] - DVec3::Y * speed);
        // Between the speeds of the table the velocity is linear, and nearly so over a class.
        1.05 * way(slow).max(way(slow.midpoint(fast))).max(way(fast))
    }

    /// Ranges of columns along x and z whose drops the wind may have carried into a box.
    fn columns(&self, bounds: &Bounds, drift: &Drift) -> [std::ops::RangeInclusive<i64>; 2] {
        let [least, most] = drift.span(self.speeds[0], self.speeds[1]);
        let cell = |x: f64| (x / self.edge).floor() as i64;
        [
            cell(bounds.low.x - most.x)..=cell(bounds.high.x - least.x),
            cell(bounds.low.z - most.z)..=cell(bounds.high.z - least.z),
        ]
    }
}

impl Chain {
    /// True if a drop is among those of a rain whose rate changes.
    fn falls(&self, k: i64, class: &Class, thinning: &Thinning) -> bool {
        let [word, ..] = rng_draw(self.column, self.index, k as u32, FIELD_THIN);
        thinning.field_falls(class.number, self.size, [k as u32, self.phase], word)
    }

    fn drop(&self, k: i64, class: &Class, column: [i64; 2]) -> FallingDrop {
        let [x, z, high, low] = rng_draw(self.column, self.index, k as u32, FIELD_PLACE);
        let unit = |word: u32| (f64::from(word) + 0.5) / 4_294_967_296.0;
        FallingDrop {
            position: DVec3::new(
                (column[0] as f64 + unit(x)) * class.edge + self.carried.x,
                self.height + k as f64 * class.period,
                (column[1] as f64 + unit(z)) * class.edge + self.carried.z,
            ),
            velocity: (self.wind - DVec3::Y * self.speed).as_vec3().to_array(),
            diameter: self.diameter,
            id: u64::from(high) << 32 | u64::from(low),
            kind: DropKind::Falling,
            present_s: FallingDrop::ALWAYS,
            normal: FallingDrop::LEVEL,
        }
    }
}

fn class_seed(seed: u64, class: u32) -> [u32; 2] {
    let [a, b, ..] = rng_draw(seed_words(seed), class, 0, FIELD_CHAIN);
    [a, b]
}

pub(crate) fn check_time(time_s: f64) -> Result<(), SimError> {
    in_range("time", time_s, "s", &(-MAX_TIME_S..=MAX_TIME_S), 1.0, "-1e6 to 1e6")?;
    Ok(())
}
