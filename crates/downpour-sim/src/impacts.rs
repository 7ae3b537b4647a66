//! Impacts of the rain in closed form, their splashes, and the droplets that rebound from them.
//!
//! The path of a drop is known, and so are the position and the time of its first hit on the way from the sky. Impacts
//! can therefore be found for any part of space and any span of time, in any order, and they are those of the drops
//! that pictures show.
//!
//! In a steady wind a path is one straight line and the impact exact; else it is divided at whole sixteenths of a
//! second, so that an impact is some millimeters off. Moving objects are taken at their current position.
//!
//! ```
//! use downpour_bvh::Bvh;
//! use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
//! use downpour_sim::{field::RainField, shelter::Obstacles};
//! use glam::DVec3;
//!
//! let rain = RainField::new(&DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0)?, 7)?;
//! let [a, b, c, d] = [[-3.0, 0.0, -3.0], [-3.0, 0.0, 3.0], [3.0, 0.0, 3.0], [3.0, 0.0, -3.0]];
//! let ground = Bvh::new(&[[a, b, c], [a, c, d]]);
//! let obstacles = Obstacles { nodes: &ground.nodes, triangles: &ground.triangles, holes: None, origin: DVec3::ZERO };
//! let (low, high) = (DVec3::new(-0.5, -0.1, -0.5), DVec3::new(0.5, 0.1, 0.5));
//! // What has hit a square meter within the last tenth of a second.
//! let impacts = rain.impacts(&obstacles, low, high, [12.4, 12.5], 0.5e-3)?;
//! assert!(impacts.iter().all(|impact| impact.position.y.abs() < 1.0e-3 && impact.normal.y > 0.999));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "wgpu")]
#[doc(hidden)]
pub mod bounce_frame;
#[doc(hidden)]
pub mod bounced;
mod crossings;
mod places;
#[cfg(feature = "wgpu")]
pub(crate) mod slices;
#[doc(hidden)]
pub mod splash_frame;
#[cfg(feature = "wgpu")]
pub(crate) mod splash_search;
pub(crate) mod splashes;
mod ways;

use downpour_math::{OutOfRange, in_range};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

pub use self::crossings::Crossing;
use self::places::Places;
pub use self::splashes::SplashOptions;
use self::ways::Ways;
use crate::SimError;
use crate::facets::Facets;
use crate::field::{Class, RainField, check_time};
use crate::shelter::{Obstacles, SkyPaths};
use crate::view::Bounds;

/// Maximum span of time of a query, s.
const MAX_SPAN_S: f64 = 60.0;

/// Impact of a drop on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Position, m.
    pub position: DVec3,
    /// Unit normal of the surface on the side that the drop came from.
    pub normal: Vec3,
    /// Velocity of the drop, m/s.
    pub velocity: Vec3,
    /// Volume-equivalent diameter of the drop, m.
    pub diameter: f32,
    /// Id of the drop.
    pub id: u64,
    /// Time, s.
    pub time_s: f64,
}

/// Drop that may hit something within a span of time.
struct Candidate {
    id: u64,
    /// Diameter, m.
    diameter: f32,
    /// Terminal speed, m/s.
    speed: f64,
    /// Positions at the beginning and at the end if nothing stops it; its path is nearly straight.
    ends: [DVec3; 2],
}

impl Candidate {
    /// Middle of its path, and half of its length, m.
    fn ball(&self) -> (DVec3, f64) {
        let [from, to] = self.ends;
        (from.midpoint(to), 0.5 * from.distance(to) + CURVED_M)
    }
}

/// Impacts of a class that are asked for: those in a box, in parts of it, of some drops.
struct OfClass<P, W> {
    bounds: Bounds,
    in_part: P,
    wanted: W,
}

/// Distance, m, of a path of less than a second in gusts from the line between its ends, at most.
const CURVED_M: f64 = 0.5;

impl RainField {
    /// Distance, m, of a path of less than a second from the line between its ends, at most.
    fn curved(&self) -> f64 {
        if self.wind.is_steady() { 0.01 } else { CURVED_M }
    }

    /// Impacts in a box within a span of time, s, without its beginning and including its end, of drops from a
    /// diameter in m on. Their order depends on the query only.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid box, a time beyond [`MAX_TIME_S`](crate::field::MAX_TIME_S), or an invalid span
    /// or one longer than a minute.
    pub fn impacts(
        &self,
        obstacles: &Obstacles<'_>,
        low: DVec3,
        high: DVec3,
        span_s: [f64; 2],
        min_diameter: f64,
    ) -> Result<Vec<Impact>, SimError> {
        check_box(low, high)?;
        let all = |class: &Class| {
            let bounds = Bounds { low, high };
            let wanted = |drop: &Candidate| f64::from(drop.diameter) >= min_diameter;
            (class.largest >= min_diameter).then_some(OfClass { bounds, in_part: |_: &Bounds| true, wanted })
        };
        let facets = Facets::new(obstacles);
        self.impacts_of(&facets, &mut Places::new(obstacles, 0.0), span_s, all, |impact| Some(*impact))
    }

    /// Results of `make` for the impacts of a span of time: of each class those that `of_class` says. `make` is asked before it is known
    /// whether the drop comes from the sky. Impacts on surfaces that are not in the places may be left out.
    fn impacts_of<P: Fn(&Bounds) -> bool, W: Fn(&Candidate) -> bool + Sync, T: Send>(
        &self,
        facets: &Facets<'_>,
        places: &mut Places<'_>,
        span_s: [f64; 2],
        of_class: impl Fn(&Class) -> Option<OfClass<P, W>>,
        make: impl Fn(&Impact) -> Option<T> + Sync,
    ) -> Result<Vec<T>, SimError> {
        let obstacles = facets.obstacles;
        let [begin, end] = span_s;
        check_span(span_s)?;
        let Some(corners) = obstacles.corners() else { return Ok(Vec::new()) };
        let corners = corners.map(|corner| corner.as_dvec3() + obstacles.origin);
        let ways = Ways::new(self, begin, end);
        let within = |class| {
            let OfClass { bounds: wide, in_part, wanted } = of_class(class)?;
            // There are no impacts without obstacles.
            let low = wide.low.max(corners[0] - 1.0e-3);
            let high = wide.high.min(corners[1] + 1.0e-3);
            low.cmplt(high).all().then_some((class, Bounds { low, high }, in_part, wanted))
        };
        let of_classes: Vec<(&Class, Bounds, P, W)> = self.classes.iter().filter_map(within).collect();
        let all = of_classes.iter().map(|(_, bounds, ..)| *bounds).reduce(|a, b| a.union(&b));
        let Some(all) = all else { return Ok(Vec::new()) };
        let cells = Places::cells(&all);
        let mut boxes: Vec<(&Class, &W, Bounds, Bounds)> = Vec::new();
        for (class, bounds, in_part, wanted) in &of_classes {
            let way = ways.bounds(class.speeds);
            // Drops that at the end are where those are that have been in a place.
            let swept = |place: Bounds| Bounds { low: place.low + way.low, high: place.high + way.high };
            // Whole columns are looked at, and of each chain in them whether it has drops in the box.
            let around = way.high - way.low + DVec3::new(class.edge, class.period, class.edge);
            let parts = places.within(cells, bounds, around, in_part);
            boxes.extend(parts.into_iter().map(|place| (*class, wanted, place, swept(place))));
        }
        let slowest = boxes.iter().map(|(class, ..)| class.speeds[0]).fold(f64::INFINITY, f64::min);
        let lowest = boxes.iter().map(|(.., swept)| swept.low.y).fold(f64::INFINITY, f64::min);
        let deepest = lowest - obstacles.origin.y;
        if boxes.is_empty() {
            return Ok(Vec::new());
        }
        let Some(paths) = SkyPaths::new(obstacles, &self.wind, begin, slowest, deepest) else {
            return Ok(Vec::new());
        };
        let curved = self.curved();
        let in_box = |(class, wanted, bounds, swept): (&Class, &W, Bounds, Bounds)| {
            self.gathered(class, &swept, end, ways.last(), |drop, speed| {
                let start = ways.at_begin(drop, speed);
                let ends = [start, drop.position];
                if !touches(ends, &bounds, curved)
                    || !wanted(&Candidate { id: drop.id, diameter: drop.diameter, speed, ends })
                {
                    return None;
                }
                let (hit, from, velocity, time_s) = ways.first_met(obstacles, drop, speed)?;
                let position = obstacles.origin + (from + velocity * hit.distance).as_dvec3();
                if !(position.cmpge(bounds.low).all() && position.cmplt(bounds.high).all()) {
                    return None;
                }
                let normal = facets.facing(&hit, velocity);
                let (diameter, id) = (drop.diameter, drop.id);
                let made = make(&Impact { position, normal, velocity, diameter, id, time_s })?;
                let start = start - obstacles.origin;
                paths.shelter_is_open(start.as_vec3(), start, speed, velocity).then_some(made)
            })
        };
        let impacts: Vec<Vec<T>> = boxes.into_par_iter().map(in_box).collect();
        Ok(impacts.into_iter().flatten().collect())
    }
}

/// False if a line between two places, m, keeps farther than `margin` from a box.
fn touches([from, to]: [DVec3; 2], bounds: &Bounds, margin: f64) -> bool {
    let middle = bounds.low.midpoint(bounds.high);
    let half = 0.5 * (bounds.high - bounds.low) + margin;
    let (center, reach) = (from.midpoint(to) - middle, 0.5 * (to - from));
    // The axes of the box, and those across the line and one of them.
    let across = |axis: DVec3| {
        let normal = reach.cross(axis);
        center.dot(normal).abs() <= half.dot(normal.abs()) + 1.0e-9
    };
    center.abs().cmple(half + reach.abs()).all() && across(DVec3::X) && across(DVec3::Y) && across(DVec3::Z)
}

/// Fails for a span of time that is too long, or of times that are out of range.
pub(crate) fn check_span([begin, end]: [f64; 2]) -> Result<(), SimError> {
    check_time(begin)?;
    check_time(end)?;
    in_range("span of time", end - begin, "s", &(0.0..=MAX_SPAN_S), 1.0, "0 to 60")?;
    Ok(())
}

fn check_box(low: DVec3, high: DVec3) -> Result<(), SimError> {
    let found = low.abs().max(high.abs()).max_element();
    if low.is_finite() && high.is_finite() && found <= 1.0e7 && low.cmple(high).all() {
        return Ok(());
    }
    let (quantity, unit, allowed) = ("a side of the box", "m", "-1e7 to 1e7, low below high");
    Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }))
}
