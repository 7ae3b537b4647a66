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

mod bounced;
mod places;
mod splashes;
mod ways;

use downpour_math::{OutOfRange, in_range};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

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

impl RainField {
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
            (class.largest >= min_diameter).then_some((Bounds { low, high }, |_: &Bounds| true))
        };
        let mut impacts = self.impacts_of(&Facets::new(obstacles), span_s, all, |_| true)?;
        impacts.retain(|impact| f64::from(impact.diameter) >= min_diameter);
        Ok(impacts)
    }

    /// Impacts of a span of time, of the drops that are `wanted`: of each class in the box that `bounds_of` returns, in those parts of
    /// it that the function beside it wants.
    fn impacts_of<P: Fn(&Bounds) -> bool>(
        &self,
        facets: &Facets<'_>,
        span_s: [f64; 2],
        bounds_of: impl Fn(&Class) -> Option<(Bounds, P)>,
        wanted: impl Fn(u64) -> bool + Sync,
    ) -> Result<Vec<Impact>, SimError> {
        let obstacles = facets.obstacles;
        let [begin, end] = span_s;
        check_span(span_s)?;
        let Some(root) = obstacles.nodes.first().filter(|_| !obstacles.triangles.is_empty()) else {
            return Ok(Vec::new());
        };
        let corners = [root.low, root.high].map(|corner| Vec3::from(corner).as_dvec3() + obstacles.origin);
        let ways = Ways::new(self, begin, end);
        let within = |class| {
            let (wide, part_wanted) = bounds_of(class)?;
            // There are no impacts without obstacles.
            let low = wide.low.max(corners[0] - 1.0e-3);
            let high = wide.high.min(corners[1] + 1.0e-3);
            low.cmplt(high).all().then_some((class, Bounds { low, high }, part_wanted))
        };
        let of_classes: Vec<(&Class, Bounds, P)> = self.classes.iter().filter_map(within).collect();
        let all = of_classes.iter().map(|(_, bounds, _)| *bounds).reduce(|a, b| a.union(&b));
        let Some(all) = all else { return Ok(Vec::new()) };
        let mut places = Places::new(obstacles, &all);
        let mut boxes: Vec<(&Class, Bounds, Bounds)> = Vec::new();
        for (class, bounds, part_wanted) in of_classes {
            let way = ways.bounds(class.speeds);
            // Drops that at the end are where those are that have been in a place.
            let swept = |place: Bounds| Bounds { low: place.low + way.low, high: place.high + way.high };
            // Whole columns are looked at, and of each chain in them whether it has drops in the box.
            let around = way.high - way.low + DVec3::new(class.edge, class.period, class.edge);
            let parts = places.within(&bounds, around, part_wanted);
            boxes.extend(parts.into_iter().map(|place| (class, place, swept(place))));
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
        let in_box = |(class, bounds, swept): (&Class, Bounds, Bounds)| {
            self.gathered(class, &swept, end, ways.last(), |drop, speed| {
                if !wanted(drop.id) {
                    return None;
                }
                let (hit, from, velocity, time_s) = ways.first_met(obstacles, drop, speed)?;
                let position = obstacles.origin + (from + velocity * hit.distance).as_dvec3();
                let within = position.cmpge(bounds.low).all() && position.cmplt(bounds.high).all();
                let start = ways.at_begin(drop, speed) - obstacles.origin;
                if !(within && paths.shelter_is_open(start.as_vec3(), start, speed, velocity)) {
                    return None;
                }
                let normal = facets.facing(&hit, velocity);
                Some(Impact { position, normal, velocity, diameter: drop.diameter, id: drop.id, time_s })
            })
        };
        let impacts: Vec<Vec<Impact>> = boxes.into_par_iter().map(in_box).collect();
        Ok(impacts.into_iter().flatten().collect())
    }
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
