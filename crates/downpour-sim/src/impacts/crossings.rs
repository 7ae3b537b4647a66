//! Drops of a rain in closed form that come through a horizontal rectangle, such as the surface of water.

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use super::ways::Ways;
use super::{check_box, check_span};
use crate::SimError;
use crate::field::RainField;
use crate::view::Bounds;

/// Drop that comes through a horizontal plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Position, m.
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// Volume-equivalent diameter, m.
    pub diameter: f32,
    /// Id of the drop.
    pub id: u64,
    /// Time, s.
    pub time_s: f64,
}

impl RainField {
    /// Drops from a diameter in m on that come down through a horizontal rectangle, `height` m high from `low` to `high` along x and z,
    /// within a span of time, s, without its beginning and including its end. What else they may have met does not count. Where no wind
    /// gusts, or the span begins and ends at whole sixteenths of a second, they meet it where [`RainField::impacts`] says. Their order
    /// depends on the query only.
    ///
    /// # Errors
    /// As [`RainField::impacts`].
    pub fn crossings(
        &self,
        [low, high]: [DVec2; 2],
        height: f64,
        span_s: [f64; 2],
        min_diameter: f64,
    ) -> Result<Vec<Crossing>, SimError> {
        let [low, high] = [low, high].map(|corner| DVec3::new(corner.x, height, corner.y));
        check_box(low, high)?;
        check_span(span_s)?;
        let [begin, end] = span_s;
        let ways = Ways::new(self, begin, end);
        let found = self.classes.par_iter().filter(|class| class.largest >= min_diameter).map(|class| {
            let way = ways.bounds(class.speeds);
            // Where those are at the end that have come through.
            let swept = Bounds { low: low + way.low, high: high + way.high };
            self.gathered(class, &swept, end, ways.last(), |drop, speed| {
                if f64::from(drop.diameter) < min_diameter {
                    return None;
                }
                let (position, velocity, time_s) = ways.first_through(height, drop, speed)?;
                let [x, z] = [position.x, position.z];
                let is_within = x >= low.x && x < high.x && z >= low.z && z < high.z;
                let (diameter, id) = (drop.diameter, drop.id);
                is_within.then_some(Crossing { position, velocity, diameter, id, time_s })
            })
        });
        let found: Vec<Vec<Crossing>> = found.collect();
        Ok(found.into_iter().flatten().collect())
    }
}
