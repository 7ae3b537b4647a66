//! Impacts of the rain in closed form, and the droplets that rebound from them.
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

use downpour_bvh::Hit;
use downpour_drop::fall_speed::relaxation;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_math::{OutOfRange, in_range};
use downpour_shaders::sim::step::{STEP_CLEAR, VOLUME_RADIUS};
use glam::{DVec3, Vec3};

use crate::SimError;
use crate::drift::Drift;
use crate::falling::{DropKind, FallingDrop};
use crate::field::{Class, RainField, check_time};
use crate::motion::motion_bounce;
use crate::options::Bounce;
use crate::shelter::{Obstacles, SkyPaths, met};
use crate::view::{Bounds, View};

/// Interval at which a path is divided, s.
const CUT_S: f64 = 1.0 / 16.0;

/// Interval at which the path of a droplet is divided, s.
const FINE_S: f64 = 1.0 / 60.0;

/// Approximate span of time in which impacts of droplets are searched at once, s.
const SLICE_S: f64 = 0.125;

/// Maximum span of time of a query, s.
const MAX_SPAN_S: f64 = 60.0;

/// Dimension of the random numbers of rebounds.
const CHANCE: u32 = 8203;

/// Difference between the id of a drop and that of its droplet.
const DROPLET: u64 = 0x9e37_79b9_7f4a_7c15;

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
        let all = |class: &Class| (class.largest >= min_diameter).then_some(Bounds { low, high });
        let mut impacts = self.impacts_of(&Surfaces::new(obstacles), span_s, all, |_| true)?;
        impacts.retain(|impact| f64::from(impact.diameter) >= min_diameter);
        Ok(impacts)
    }

    /// Droplets that rebound from impacts, as a picture shows them at a time in seconds.
    ///
    /// The rebound of an impact is random, the same for any picture. A droplet starts at the impact with the remaining
    /// velocity, follows the wind according to its size, and is gone when it hits a surface or after its maximum time.
    ///
    /// # Errors
    /// [`SimError::OutOfRange`] for an invalid view, or a time beyond [`MAX_TIME_S`](crate::field::MAX_TIME_S).
    pub fn bounced(
        &self,
        obstacles: &Obstacles<'_>,
        view: &View,
        least_pixels: f64,
        time_s: f64,
        bounce: &Bounce,
    ) -> Result<Vec<FallingDrop>, SimError> {
        view.check()?;
        check_time(time_s)?;
        if bounce.fraction <= 0.0 {
            return Ok(Vec::new());
        }
        let half = 0.5 * view.shutter_s;
        let longest = f64::from(bounce.max_time_s).min(MAX_SPAN_S - view.shutter_s);
        let sent_up = |id: u64| {
            let [chance, ..] = rng_draw([id as u32, (id >> 32) as u32], 0, 0, CHANCE).map(rng_unit);
            chance < bounce.fraction
        };
        let sides = view.sides();
        // In slices of time: within one, the wind has displaced all droplets similarly.
        let span = longest + view.shutter_s;
        let slices = (span / SLICE_S).ceil().max(1.0);
        let surfaces = Surfaces::new(obstacles);
        let mut impacts = Vec::new();
        for slice in 0..slices as u32 {
            let ages = [slice, slice + 1].map(|k| f64::from(k) * span / slices - half);
            let travels = Travels::new(self, time_s, ages);
            let origins = |class: &Class| travels.origins(self, class, view, least_pixels, bounce);
            let span = [time_s - ages[1], time_s - ages[0]];
            impacts.extend(self.impacts_of(&surfaces, span, origins, sent_up)?);
        }
        let shown = impacts.iter().filter_map(|impact| {
            let droplet = Droplet::of(self, impact, bounce)?;
            let age = time_s - impact.time_s;
            // A droplet that starts later in the exposure is listed as if it had always moved.
            let (position, velocity) = if age > 0.0 {
                droplet.at(age)
            } else {
                (droplet.start + droplet.leaves * age, droplet.leaves)
            };
            let range = view.range(droplet.diameter, least_pixels);
            let radius = f64::from(VOLUME_RADIUS) * droplet.diameter;
            let part = [-age, longest - age];
            if part[1] < -half || !view.shows(&sides, position, velocity, radius, range, part) {
                return None;
            }
            let stopped = droplet.stopped(obstacles, (age + half).min(longest)).map(|after| after - age);
            let until = stopped.unwrap_or(longest - age);
            let mut drop = FallingDrop {
                position,
                velocity: velocity.as_vec3().to_array(),
                diameter: droplet.diameter as f32,
                id: impact.id ^ DROPLET,
                kind: DropKind::Bounced,
                present_s: [-age, until].map(|time| time as f32),
            };
            drop.position += velocity * f64::from(drop.seen_s());
            (until > -half).then_some(drop)
        });
        Ok(shown.collect())
    }

    /// Impacts of a span of time, of each class in the box that `bounds_of` returns, of the drops that are `wanted`.
    fn impacts_of(
        &self,
        surfaces: &Surfaces<'_>,
        span_s: [f64; 2],
        bounds_of: impl Fn(&Class) -> Option<Bounds>,
        wanted: impl Fn(u64) -> bool + Sync,
    ) -> Result<Vec<Impact>, SimError> {
        let obstacles = surfaces.obstacles;
        let [begin, end] = span_s;
        check_time(begin)?;
        check_time(end)?;
        in_range("span of time", end - begin, "s", &(0.0..=MAX_SPAN_S), 1.0, "0 to 60")?;
        let Some(root) = obstacles.nodes.first().filter(|_| !obstacles.triangles.is_empty()) else {
            return Ok(Vec::new());
        };
        let corners = [root.low, root.high].map(|corner| Vec3::from(corner).as_dvec3() + obstacles.origin);
        let ways = Ways::new(self, begin, end);
        let within = |class: &Class| {
            let wide = bounds_of(class)?;
            // There are no impacts without obstacles.
            let low = wide.low.max(corners[0] - 1.0e-3);
            let high = wide.high.min(corners[1] + 1.0e-3);
            low.cmple(high).all().then_some(Bounds { low, high })
        };
        let boxed = |class| {
            let bounds = within(class)?;
            Some((class, bounds, ways.swept(&bounds, class.speeds)))
        };
        let boxes: Vec<(&Class, Bounds, Bounds)> = self.classes.iter().filter_map(boxed).collect();
        let slowest = boxes.iter().map(|(class, ..)| class.speeds[0]).fold(f64::INFINITY, f64::min);
        let lowest = boxes.iter().map(|(.., swept)| swept.low.y).fold(f64::INFINITY, f64::min);
        let deepest = lowest - obstacles.origin.y;
        if boxes.is_empty() {
            return Ok(Vec::new());
        }
        let Some(paths) = SkyPaths::new(obstacles, &self.wind, begin, slowest, deepest) else {
            return Ok(Vec::new());
        };
        let mut impacts = Vec::new();
        for (class, bounds, swept) in boxes {
            impacts.extend(self.gathered(class, &swept, end, ways.last(), |drop, speed| {
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
                let normal = surfaces.normal(&hit, velocity);
                Some(Impact { position, normal, velocity, diameter: drop.diameter, id: drop.id, time_s })
            }));
        }
        Ok(impacts)
    }
}

/// Displacement of droplets of some age.
struct Travels {
    /// Ages, s, the smaller not below 0.
    ages: [f64; 2],
    /// Drift of drops up to the picture's time, and up to the start of the oldest and the youngest.
    drifts: [Drift; 3],
}

impl Travels {
    fn new(field: &RainField, time_s: f64, ages: [f64; 2]) -> Self {
        let ages = ages.map(|age| age.max(0.0));
        let at = |age: f64| Drift::new(&field.wind, time_s - age);
        Self { ages, drifts: [at(0.0), at(ages[1]), at(ages[0])] }
    }

    /// Bounds of the origins of droplets that a picture shows, of the drops of a class.
    fn origins(
        &self,
        field: &RainField,
        class: &Class,
        view: &View,
        least_pixels: f64,
        bounce: &Bounce,
    ) -> Option<Bounds> {
        let size = f64::from(bounce.size);
        let range = view.range(class.largest * size, least_pixels);
        if range < view.near {
            return None;
        }
        let speeds = [class.speeds[0] * 0.2 * size, field.speed.at(class.largest * size).unwrap_or(0.0)];
        let [now, oldest, youngest] = &self.drifts;
        // Displacement by the wind of a drop that has always followed it.
        let carried = speeds
            .iter()
            .flat_map(|&speed| [oldest, youngest].map(|then| now.of(speed)[0] - then.of(speed)[0]));
        let (low, high) = carried
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)));
        // The rebounding part of the drop's velocity, and the initial slip of a drop of another size.
        let wind = oldest.of(class.speeds[1])[1].length().max(now.of(class.speeds[1])[1].length());
        let leaves = f64::from(bounce.restitution.max(1.0 - bounce.grip)) * (class.speeds[1] + wind) + wind;
        let slowed = relaxation(speeds[1]).horizontal_s;
        let own = leaves * slowed.min(self.ages[1]);
        let bounds = view.bounds(range, 0.5 * view.shutter_s * (leaves + wind) + class.largest);
        Some(Bounds {
            low: bounds.low - high - DVec3::splat(own),
            high: bounds.high - low + DVec3::splat(own) + DVec3::Y * (speeds[1] * self.ages[1]),
        })
    }
}

/// Paths of drops in a span of time.
struct Ways {
    begin: f64,
    end: f64,
    /// Times from the beginning to the end, and the drift of drops up to them.
    cuts: Vec<(f64, Drift)>,
}

impl Ways {
    fn new(field: &RainField, begin: f64, end: f64) -> Self {
        let mut times = vec![begin];
        if !field.wind.is_steady() {
            let first = (begin / CUT_S).floor() as i64 + 1;
            times.extend((first..).map(|k| k as f64 * CUT_S).take_while(|&time| time < end));
        }
        times.push(end);
        let cuts = times.into_iter().map(|time| (time, Drift::new(&field.wind, time))).collect();
        Self { begin, end, cuts }
    }

    /// Drift of drops up to the end.
    fn last(&self) -> &Drift {
        // There are at least two cuts.
        &self.cuts[self.cuts.len() - 1].1
    }

    /// Displacement of a drop of a speed from a cut to the end.
    fn moved(&self, cut: usize, speed: f64) -> DVec3 {
        let (time, drift) = &self.cuts[cut];
        self.last().of(speed)[0] - drift.of(speed)[0] - DVec3::Y * (speed * (self.end - time))
    }

    /// Bounds at the end of all drops that were in a box within the time.
    fn swept(&self, bounds: &Bounds, speeds: [f64; 2]) -> Bounds {
        let [slow, fast] = speeds;
        let all = (0..self.cuts.len())
            .flat_map(|cut| [slow, slow.midpoint(fast), fast].map(|s| self.moved(cut, s)));
        let (low, high) = all
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)));
        // Between the cuts, and between the speeds, paths are slightly curved.
        Bounds { low: bounds.low + low - 0.05, high: bounds.high + high + 0.05 }
    }

    /// Position of a drop at the beginning.
    fn at_begin(&self, drop: &FallingDrop, speed: f64) -> DVec3 {
        drop.position - self.moved(0, speed)
    }

    /// First hit of a drop: the hit, whose distance is a time, s, from a position relative to the obstacles' origin
    /// with a velocity; and its time.
    fn first_met(
        &self,
        obstacles: &Obstacles<'_>,
        drop: &FallingDrop,
        speed: f64,
    ) -> Option<(Hit, Vec3, Vec3, f64)> {
        let here = drop.position - obstacles.origin;
        let mut from = here - self.moved(0, speed);
        let mut since = self.begin;
        for cut in 1..self.cuts.len() {
            let to = here - self.moved(cut, speed);
            let lasts = self.cuts[cut].0 - since;
            if lasts > 0.0 {
                let velocity = ((to - from) / lasts).as_vec3();
                if let Some(hit) = met(obstacles, from.as_vec3(), velocity, lasts as f32) {
                    let time_s = since + f64::from(hit.distance);
                    return Some((hit, from.as_vec3(), velocity, time_s));
                }
            }
            (from, since) = (to, self.cuts[cut].0);
        }
        None
    }
}

/// Surfaces of obstacles, with their triangles by number.
struct Surfaces<'a> {
    obstacles: &'a Obstacles<'a>,
    /// Index of the triangle of each number, unless they are sorted by number.
    by_number: Option<Vec<u32>>,
}

impl<'a> Surfaces<'a> {
    fn new(obstacles: &'a Obstacles<'a>) -> Self {
        let triangles = obstacles.triangles;
        let in_order = (0u32..).zip(triangles).all(|(k, triangle)| triangle.index == k);
        let by_number = (!in_order).then(|| {
            let most = triangles.iter().map(|triangle| triangle.index as usize).max().unwrap_or(0);
            let mut indices = vec![0; most + 1];
            for (k, triangle) in (0u32..).zip(triangles) {
                indices[triangle.index as usize] = k;
            }
            indices
        });
        Self { obstacles, by_number }
    }

    /// Normal of a hit surface on the side that a drop of a velocity came from.
    fn normal(&self, hit: &Hit, velocity: Vec3) -> Vec3 {
        let index = match &self.by_number {
            None => Some(hit.triangle),
            Some(indices) => indices.get(hit.triangle as usize).copied(),
        };
        let triangle = index.and_then(|index| self.obstacles.triangles.get(index as usize));
        let facet = triangle.map_or(Vec3::Y, |t| Vec3::from(t.edge_1).cross(t.edge_2.into()));
        let normal = facet.normalize_or(Vec3::Y);
        if normal.dot(velocity) > 0.0 { -normal } else { normal }
    }
}

/// A droplet after its rebound.
struct Droplet<'a> {
    field: &'a RainField,
    start: DVec3,
    /// Initial velocity, m/s.
    leaves: DVec3,
    diameter: f64,
    speed: f64,
    begin_s: f64,
    /// State at the start of a droplet that has always followed the wind: displacement of the air and velocity.
    follows: [DVec3; 2],
}

impl<'a> Droplet<'a> {
    fn of(field: &'a RainField, impact: &Impact, bounce: &Bounce) -> Option<Self> {
        let leaves =
            motion_bounce(impact.velocity, impact.normal, bounce.restitution, bounce.grip).as_dvec3();
        let diameter = f64::from(impact.diameter) * f64::from(bounce.size);
        let speed = field.speed.at(diameter).ok()?;
        let start = impact.position + impact.normal.as_dvec3() * f64::from(STEP_CLEAR);
        let begin_s = impact.time_s;
        let mut droplet = Self { field, start, leaves, diameter, speed, begin_s, follows: [DVec3::ZERO; 2] };
        droplet.follows = droplet.followed(0.0);
        Some(droplet)
    }

    /// Motion, up to an age after the impact, of a drop of its size that has always followed the wind.
    fn followed(&self, age_s: f64) -> [DVec3; 2] {
        let at = self.field.wind.prepared(self.begin_s + age_s);
        let relaxation = relaxation(self.speed);
        let across = at.followed(relaxation.horizontal_s);
        let along = at.followed(relaxation.vertical_s);
        let joined = |a: DVec3, b: DVec3| DVec3::new(a.x, b.y, a.z);
        let fall = DVec3::Y * self.speed;
        [
            joined(across.displacement, along.displacement) - fall * age_s,
            joined(across.velocity, along.velocity) - fall,
        ]
    }

    /// Position and velocity at an age: the initial slip decays, along the fall twice as fast as across it.
    fn at(&self, age_s: f64) -> (DVec3, DVec3) {
        let relaxation = relaxation(self.speed);
        let times = DVec3::new(relaxation.horizontal_s, relaxation.vertical_s, relaxation.horizontal_s)
            .max(DVec3::splat(1.0e-9));
        let left = DVec3::from_array((-age_s / times).to_array().map(ops::exp));
        let slip = self.leaves - self.follows[1];
        let [carried, velocity] = self.followed(age_s);
        (self.start + carried - self.follows[0] + slip * times * (1.0 - left), velocity + slip * left)
    }

    /// Age at which it hits something, up to an age.
    fn stopped(&self, obstacles: &Obstacles<'_>, age_s: f64) -> Option<f64> {
        let steps = (age_s / FINE_S).ceil().max(0.0) as u32;
        let mut from = self.start - obstacles.origin;
        for step in 1..=steps {
            let to = self.at(f64::from(step) * FINE_S).0 - obstacles.origin;
            let velocity = ((to - from) / FINE_S).as_vec3();
            if let Some(hit) = met(obstacles, from.as_vec3(), velocity, FINE_S as f32) {
                return Some(f64::from(step - 1) * FINE_S + f64::from(hit.distance));
            }
            from = to;
        }
        None
    }
}

fn check_box(low: DVec3, high: DVec3) -> Result<(), SimError> {
    let found = low.abs().max(high.abs()).max_element();
    if low.is_finite() && high.is_finite() && found <= 1.0e7 && low.cmple(high).all() {
        return Ok(());
    }
    let (quantity, unit, allowed) = ("a side of the box", "m", "-1e7 to 1e7, low below high");
    Err(SimError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }))
}
