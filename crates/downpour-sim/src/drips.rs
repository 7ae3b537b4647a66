//! Drips: water that has fallen on surfaces runs to their edges and drips from them.
//!
//! - [`DripPoints::find`] finds from geometry where water drips, and the rain of how large an area: rays from above give the heights of
//!   up to six surfaces in each cell of 5 cm, fixed to the world; water descends over them and leaves over edges. Points on the real
//!   edges are found by rays to less than a millimeter. They depend on the scene alone: not on a camera, a time or the rain.
//! - [`Drips`] are the drops of points in a rain. Their sizes are those of [`downpour_drop::drip`], their times multiples of an
//!   interval with some jitter, drawn from hashes: the drops of any time are found without those before.
//!
//! A drop hangs and grows before it falls, by quadratic drag from rest and with the wind, until it hits something. Water that has
//! dripped runs on over the surface that it falls on, and may drip again. Where a drop lands it splashes as a drop of the rain does
//! ([`Drips::splashes`]).
//!
//! In a steady wind a device finds the same drops ([`row`]; `gpu::DripPipeline`, feature `wgpu`).
//!
//! Limits. Rain falls straight down on what is topmost, even in a wind; the surfaces take up nothing but their storage. A scene that is
//! larger than 80 m is searched around the eye. Objects are taken as they are when points are found: what moves drips where it was. In
//! a steady wind the end of a fall is found once per point. Wires and leaves that are smaller than a cell are met by chance, with the
//! right amount of water in the mean. What runs down a wall stays on it.
//!
//! ```
//! use downpour_bvh::Bvh;
//! use downpour_sim::drips::{DripPoints, DripRegion};
//! use downpour_sim::shelter::Obstacles;
//! use glam::DVec3;
//!
//! // A plate of 2 m x 1 m, tilted towards +z, over a floor.
//! let quad = |[a, b, c, d]: [[f32; 3]; 4]| [[a, b, c], [a, c, d]];
//! let plate = quad([[-1.0, 3.0, 0.0], [-1.0, 2.8, 1.0], [1.0, 2.8, 1.0], [1.0, 3.0, 0.0]]);
//! let floor = quad([[-9.0, 0.0, -9.0], [-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0]]);
//! let bvh = Bvh::new(&[plate, floor].concat());
//! let obstacles = Obstacles { nodes: &bvh.nodes, triangles: &bvh.triangles, holes: None, origin: DVec3::ZERO };
//! let region = DripRegion::new(DVec3::new(-2.0, 0.0, -2.0), DVec3::new(2.0, 3.0, 2.0))?;
//! let found = DripPoints::find(&obstacles, region)?;
//! // All of its water leaves over the lower edge.
//! assert!(found.points.iter().all(|point| (point.position.z - 1.0).abs() < 2.0e-3));
//! let area: f64 = found.points.iter().map(|point| point.catchment_m2).sum();
//! assert!((area - 2.0).abs() < 0.02);
//! # Ok::<(), downpour_sim::SimError>(())
//! ```

mod clock;
mod emitter;
mod fall;
mod points;
pub mod row;
mod runoff;
mod surfaces;
#[cfg(feature = "wgpu")]
pub(crate) mod table;

#[cfg(feature = "wgpu")]
use std::sync::{Arc, OnceLock};

use downpour_drop::drip::{Drip, MAX_DRIPPING_PER_S};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_wind::UniformWind;
use glam::DVec3;
use rayon::prelude::*;

use clock::Clock;
pub use clock::DripRain;
use emitter::{Emitter, Query};
use fall::MAX_FALL_S;
pub use points::{DripPoint, DripPoints, MAX_POINTS};
pub use surfaces::{CELL_M, DripRegion, MAX_CELLS};
#[cfg(feature = "wgpu")]
use table::DripTable;

use crate::SimError;
use crate::facets::Facets;
use crate::falling::FallingDrop;
use crate::field::check_time;
use crate::impacts::splashes::{MAX_CROWN_S, is_shown, largest};
use crate::impacts::{Impact, SplashOptions, check_span};
use crate::shelter::Obstacles;
use crate::view::{View, within};

/// Points that drip less often than this do not drip, per second.
const MIN_PER_S: f64 = 1.0 / 900.0;

/// A point that drips at a rate of its own, whatever the rain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetDrip {
    /// Position, m.
    pub position: DVec3,
    /// Drops per second; above [`MAX_DRIPPING_PER_S`] they come from a jet.
    pub per_s: f64,
    /// Diameter of the drops, m.
    pub diameter_m: f64,
}

/// Properties of drips.
#[derive(Clone, Debug)]
pub struct DripOptions {
    /// Seed of sizes and times.
    pub seed: u64,
    /// Temperature of the water, C.
    pub temperature_c: f64,
    /// Wind.
    pub wind: UniformWind,
    /// Terminal speed of drops.
    pub speed: TerminalSpeed,
}

/// Drops of drip points.
#[derive(Clone, Debug)]
pub struct Drips {
    emitters: Vec<Emitter>,
    options: DripOptions,
    /// Number of points without drops: nothing falls, or only into what is at the point.
    left_out: usize,
    /// The points as a device has them, once it has asked.
    #[cfg(feature = "wgpu")]
    table: OnceLock<Option<Arc<DripTable>>>,
}

impl Drips {
    /// Drips of points in a rain, and of points that are set by hand.
    ///
    /// A point whose drops would hit something within their diameter, as one in a wall or on the ground, has none. One inside a solid
    /// has drops that fall to the inside of its bottom.
    ///
    /// # Errors
    /// [`SimError::Drop`] for a temperature or a diameter out of range.
    pub fn new(
        obstacles: &Obstacles<'_>,
        found: &[DripPoint],
        rain: Option<&DripRain>,
        set: &[SetDrip],
        options: &DripOptions,
    ) -> Result<Self, SimError> {
        let facets = Facets::new(obstacles);
        let mut emitters = Vec::new();
        if let Some(rain) = rain {
            let of_point = |point: &DripPoint| Emitter::of_point(point, rain, options);
            let all: Result<Vec<_>, _> = found.par_iter().map(of_point).collect();
            emitters.extend(all?.into_iter().flatten());
        }
        for drip in set {
            let size = Drip::of_diameter(drip.diameter_m, options.temperature_c)?;
            let clock = Clock::steady(drip.per_s.max(0.0), -2.0e6);
            let emitter = Emitter::new(drip.position, size, drip.per_s, clock, options)?;
            emitters.extend(emitter.map(|emitter| emitter.with_jet(drip.per_s > MAX_DRIPPING_PER_S)));
        }
        let wanted = found.len() + set.len();
        emitters.par_iter_mut().for_each(|emitter| emitter.land(obstacles, &facets, &options.wind));
        emitters.retain(Emitter::has_room);
        Ok(Self {
            left_out: wanted - emitters.len(),
            emitters,
            options: options.clone(),
            #[cfg(feature = "wgpu")]
            table: OnceLock::new(),
        })
    }

    /// Number of points that drip.
    #[must_use]
    pub fn len(&self) -> usize {
        self.emitters.len()
    }

    /// True if nothing drips.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.emitters.is_empty()
    }

    /// Number of points that do not drip, since their water is too little or there is no air below.
    #[must_use]
    pub fn left_out_count(&self) -> usize {
        self.left_out
    }

    /// Volume of the water that drips while it rains, m^3/s.
    #[must_use]
    pub fn flow(&self) -> f64 {
        self.emitters.iter().map(Emitter::flow).sum()
    }

    /// Drops that a picture shows at a time in seconds: those that hang and those that fall, no more than `view.max_drops`, the nearest.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid view, or a time beyond [`MAX_TIME_S`](crate::field::MAX_TIME_S).
    pub fn visible(
        &self,
        obstacles: &Obstacles<'_>,
        view: &View,
        least_pixels: f64,
        time_s: f64,
    ) -> Result<Vec<FallingDrop>, SimError> {
        view.check()?;
        check_time(time_s)?;
        let facets = Facets::new(obstacles);
        let half = 0.5 * view.shutter_s;
        let query = Query { obstacles, facets: &facets, wind: &self.options.wind };
        let (sides, swept) = (view.sides(), view.swept_sides());
        let reach = self.reach([time_s - half - MAX_FALL_S, time_s + half]);
        let shown = |emitter: &Emitter| {
            let mut drops = Vec::new();
            let (middle, radius) = emitter.around(reach);
            let offset = middle - view.eye;
            let range = view.range(emitter.largest(), least_pixels);
            let margin = radius + half * (view.velocity.length() + 12.0);
            if offset.length() - margin > range || !within(&swept, offset, margin) {
                return drops;
            }
            emitter.list(&query, time_s, half, &mut drops);
            drops.retain(|drop| {
                let diameter = f64::from(drop.diameter);
                let range = view.range(diameter, least_pixels);
                let velocity = glam::Vec3::from(drop.velocity).as_dvec3();
                let at = drop.position - velocity * f64::from(drop.seen_s());
                view.shows(&sides, at, velocity, diameter, range, drop.present_s.map(f64::from))
            });
            drops
        };
        let drops: Vec<Vec<FallingDrop>> = self.emitters.par_iter().map(shown).collect();
        let mut drops: Vec<FallingDrop> = drops.into_iter().flatten().collect();
        if drops.len() > view.max_drops as usize {
            let distance = |drop: &FallingDrop| drop.position.distance_squared(view.eye);
            drops.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.id.cmp(&b.id)));
            drops.truncate(view.max_drops as usize);
        }
        Ok(drops)
    }

    /// Crowns of the splashes of drops that have dripped, as a picture shows them at a time in seconds; see [`RainField::splashes`].
    ///
    /// # Errors
    /// As [`RainField::splashes`].
    ///
    /// [`RainField::splashes`]: crate::field::RainField::splashes
    pub fn splashes(
        &self,
        obstacles: &Obstacles<'_>,
        view: &View,
        time_s: f64,
        options: &SplashOptions,
    ) -> Result<Vec<FallingDrop>, SimError> {
        options.check(view, time_s)?;
        let facets = Facets::new(obstacles);
        let query = Query { obstacles, facets: &facets, wind: &self.options.wind };
        let span_s = [time_s - MAX_CROWN_S, time_s];
        let reach = self.reach([span_s[0] - MAX_FALL_S, time_s]);
        let wind = self.options.wind.velocity(time_s).length();
        let sides = view.sides();
        let of_emitter = |emitter: &Emitter| {
            let [diameter, speed] = emitter.falling();
            let crown = options.largest_crown(view, diameter, speed + wind);
            if !crown.is_some_and(|crown| is_shown(view, &sides, emitter.around(reach), crown)) {
                return Vec::new();
            }
            let impacts = emitter.impacts(&query, span_s).into_iter();
            impacts.filter_map(|impact| options.crown(&impact, view, time_s)).collect()
        };
        let crowns: Vec<Vec<FallingDrop>> = self.emitters.par_iter().map(of_emitter).collect();
        Ok(largest(crowns.into_iter().flatten().collect()))
    }

    /// True if a device can find the drops: in a steady wind, where a fall ends in the same place each time.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn fits_device(&self) -> bool {
        self.table().is_some()
    }

    /// The points as a device has them.
    #[cfg(feature = "wgpu")]
    pub(crate) fn table(&self) -> Option<&Arc<DripTable>> {
        self.table.get_or_init(|| DripTable::new(self).map(Arc::new)).as_ref()
    }

    /// Impacts in a box within a span of time, s, without its beginning and including its end, of drops from a diameter in m on. Their
    /// order depends on the query only.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for a time beyond [`MAX_TIME_S`](crate::field::MAX_TIME_S), or an invalid span or one longer than a minute.
    pub fn impacts(
        &self,
        obstacles: &Obstacles<'_>,
        low: DVec3,
        high: DVec3,
        span_s: [f64; 2],
        min_diameter: f64,
    ) -> Result<Vec<Impact>, SimError> {
        self.impacts_where(obstacles, [low, high], span_s, min_diameter, &|_| true)
    }

    /// Those of [`Drips::impacts`] in places, m, that are wanted: in a steady wind a point whose drops land elsewhere is not looked at.
    ///
    /// # Errors
    /// As [`Drips::impacts`].
    pub fn impacts_where(
        &self,
        obstacles: &Obstacles<'_>,
        [low, high]: [DVec3; 2],
        span_s: [f64; 2],
        min_diameter: f64,
        wanted: &(dyn Fn(DVec3) -> bool + Sync),
    ) -> Result<Vec<Impact>, SimError> {
        check_span(span_s)?;
        let [begin, end] = span_s;
        let is_within = |at: DVec3| at.cmpge(low).all() && at.cmplt(high).all() && wanted(at);
        let facets = Facets::new(obstacles);
        let query = Query { obstacles, facets: &facets, wind: &self.options.wind };
        let reach = self.reach([begin - MAX_FALL_S, end]);
        let of_emitter = |emitter: &Emitter| {
            let (middle, radius) = emitter.around(reach);
            let nearest = middle.clamp(low.min(high), high);
            let is_elsewhere = emitter.lands(query.wind).is_some_and(|at| !is_within(at));
            if emitter.largest() < min_diameter || nearest.distance(middle) > radius || is_elsewhere {
                return Vec::new();
            }
            let mut impacts = emitter.impacts(&query, span_s);
            impacts.retain(|impact| is_within(impact.position) && f64::from(impact.diameter) >= min_diameter);
            impacts
        };
        let impacts: Vec<Vec<Impact>> = self.emitters.par_iter().map(of_emitter).collect();
        Ok(impacts.into_iter().flatten().collect())
    }

    /// Upper bound of the distance that an unsteady wind may carry a drop in a fall within a span of time, m; 0 in a steady one.
    fn reach(&self, span_s: [f64; 2]) -> f64 {
        let wind = &self.options.wind;
        if wind.is_steady() {
            return 0.0;
        }
        let steps = 64;
        let at = |k: u32| span_s[0] + (span_s[1] - span_s[0]) * f64::from(k) / f64::from(steps);
        // A drop that follows moves no faster than the air; gusts between the steps are covered by the factor.
        let fastest = (0..=steps).map(|k| wind.velocity(at(k)).length()).fold(0.0, f64::max);
        2.0 * fastest
    }
}
