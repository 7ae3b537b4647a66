//! Droplets that rebound from impacts. Twin of `shaders/wgsl/sim/bounce.wgsl`, `shaders/wgsl/sim/bounce_find.wgsl` and
//! `shaders/wgsl/sim/bounce_hit.wgsl`, in f64 and in the world.

use downpour_drop::fall_speed::relaxation;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::bounce::{BOUNCE_CHANCE, BOUNCE_HIGH, BOUNCE_LOW, BOUNCE_MIN_RELAXATION};
use downpour_shaders::sim::step::{STEP_CLEAR, VOLUME_RADIUS};
use glam::DVec3;

use super::places::Places;
use super::{Candidate, Impact, MAX_SPAN_S, OfClass};
use crate::SimError;
use crate::drift::Drift;
use crate::facets::Facets;
use crate::falling::{DropKind, FallingDrop};
use crate::field::{Class, RainField, check_time};
use crate::motion::motion_bounce;
use crate::options::Bounce;
use crate::shelter::{Obstacles, met};
use crate::view::{Bounds, View, within};

/// Interval at which the path of a droplet is divided, s.
const FINE_S: f64 = 1.0 / 60.0;

/// Distance that the wind carries droplets, at most about, in a span of time in which impacts are searched at once, m: those of a span
/// come from nearby.
const SLICE_M: f64 = 1.5;

/// Least span of time in which impacts are searched at once, s: that of the slips of droplets.
const SLICE_S: f64 = 0.125;

/// Difference between the id of a drop and that of its droplet.
const DROPLET: u64 = (BOUNCE_HIGH as u64) << 32 | BOUNCE_LOW as u64;

impl RainField {
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
        let longest = bounce.longest_s(view);
        let sent_up = |id: u64| {
            let [chance, ..] = rng_draw([id as u32, (id >> 32) as u32], 0, 0, BOUNCE_CHANCE).map(rng_unit);
            chance < bounce.fraction
        };
        let sides = view.sides();
        let swept_sides = view.swept_sides();
        // In slices of time: within one, the wind has displaced all droplets similarly. Without wind it is one, since each slice looks
        // at the same chains of drops.
        let span = longest + view.shutter_s;
        let slices =
            (self.carried(time_s - span + half, time_s + half) / SLICE_M).min(span / SLICE_S).ceil().max(1.0);
        let curved = self.curved();
        let facets = Facets::new(obstacles);
        let mut places = Places::new(obstacles, 0.0);
        let mut droplets = Vec::new();
        for slice in 0..slices as u32 {
            let ages = [slice, slice + 1].map(|k| f64::from(k) * span / slices - half);
            let travels = Travels::new(self, time_s, ages);
            let of_class = |class: &Class| {
                let fastest = self.fastest_droplet(class, bounce);
                let origins = travels.origins((class, fastest), view, least_pixels, bounce)?;
                let (bounds, swept_sides) = (origins.bounds, &swept_sides);
                let in_part = move |place: &Bounds| origins.may_be_in(place, view, swept_sides);
                let travels = &travels;
                let wanted = move |drop: &Candidate| {
                    sent_up(drop.id) && {
                        let range = view.range(f64::from(drop.diameter * bounce.size), least_pixels);
                        let (middle, radius) = travels.bounce_ball(self, drop, bounce);
                        bounce_may_show((middle, radius + curved + origins.margin), range, view, swept_sides)
                    }
                };
                Some(OfClass { bounds, in_part, wanted })
            };
            let span = [time_s - ages[1], time_s - ages[0]];
            let shown = |impact: &Impact| {
                let droplet = Droplet::bounce_hit_droplet(self, impact, bounce)?;
                let age = time_s - impact.time_s;
                // A droplet that starts later in the exposure is listed as if it had always moved.
                let (position, velocity) = if age > 0.0 {
                    droplet.bounce_at(age)
                } else {
                    (droplet.start + droplet.leaves * age, droplet.leaves)
                };
                let range = view.range(droplet.diameter, least_pixels);
                let radius = f64::from(VOLUME_RADIUS) * droplet.diameter;
                let part = [-age, longest - age];
                let is_shown =
                    part[1] >= -half && view.shows(&sides, position, velocity, radius, range, part);
                is_shown.then_some((impact.id, age, droplet, position, velocity))
            };
            droplets.extend(self.impacts_of(&facets, &mut places, span, of_class, shown)?);
        }
        let listed = droplets.into_iter().filter_map(|(id, age, droplet, position, velocity)| {
            let stopped =
                droplet.bounce_hit_stopped(obstacles, (age + half).min(longest)).map(|after| after - age);
            let until = stopped.unwrap_or(longest - age);
            let mut drop = FallingDrop {
                position,
                velocity: velocity.as_vec3().to_array(),
                diameter: droplet.diameter as f32,
                id: id ^ DROPLET,
                kind: DropKind::Bounced,
                present_s: [-age, until].map(|time| time as f32),
                normal: FallingDrop::LEVEL,
            };
            drop.position += velocity * f64::from(drop.seen_s());
            (until > -half).then_some(drop)
        });
        Ok(listed.collect())
    }

    /// Terminal speed of the largest droplet of a class, m/s.
    pub(super) fn fastest_droplet(&self, class: &Class, bounce: &Bounce) -> f64 {
        self.speed.at(class.largest * f64::from(bounce.size)).unwrap_or(0.0)
    }

    /// Distance that the wind carries the drops that follow it best, from a time to another, m.
    fn carried(&self, begin_s: f64, end_s: f64) -> f64 {
        let slowest = self.classes.iter().map(|class| class.speeds[0]).fold(f64::INFINITY, f64::min);
        if !slowest.is_finite() {
            return 0.0;
        }
        let lag = relaxation(slowest).horizontal_s;
        let [from, to] = [begin_s, end_s].map(|time| self.wind.prepared(time).followed(lag).displacement);
        from.distance(to)
    }
}

/// Displacement of droplets of some age.
pub(super) struct Travels {
    /// Ages, s, the smaller not below 0.
    pub(super) ages: [f64; 2],
    /// Drift of drops up to the picture's time, and up to the start of the oldest and the youngest.
    pub(super) drifts: [Drift; 3],
}

impl Travels {
    fn new(field: &RainField, time_s: f64, ages: [f64; 2]) -> Self {
        let ages = ages.map(|age| age.max(0.0));
        let at = |age: f64| Drift::new(&field.wind, time_s - age);
        Self { ages, drifts: [at(0.0), at(ages[1]), at(ages[0])] }
    }

    /// Ball in which the droplet of a drop is at the picture's time, wherever on its path the drop has hit something: middle, and
    /// radius, m, in a wind that is steady meanwhile.
    fn bounce_ball(&self, field: &RainField, drop: &Candidate, bounce: &Bounce) -> (DVec3, f64) {
        let speed = field.speed.at(f64::from(drop.diameter * bounce.size)).unwrap_or(0.0);
        let [now, oldest, youngest] = &self.drifts;
        let (carried, fall) = (now.of(speed)[0], DVec3::Y * speed);
        let wind = oldest.of(drop.speed)[1].length().max(now.of(drop.speed)[1].length());
        let leaves = leaving_speed(bounce, drop.speed, wind);
        // The slip that it has from the wind and its fall, as if it left the surface at rest; the path of the drop is a line.
        let from = [(0, oldest, 1), (1, youngest, 0)].map(|(end, then, age)| {
            let [displacement, velocity] = then.of(speed);
            let slip = fall - velocity;
            let [moved, _] = bounce_slip(slip, speed, self.ages[age]);
            (drop.ends[end] + carried - displacement - fall * self.ages[age] + moved, slip)
        });
        let slip = from[0].1.length().max(from[1].1.length());
        let bent = slip_bends(self.ages, speed) * slip;
        let radius = 0.5 * from[0].0.distance(from[1].0) + bent + leaves * slip_lasts(self.ages[1], speed);
        (from[0].0.midpoint(from[1].0), radius)
    }

    /// Origins of droplets that a picture shows, of the drops of a class, of which the fastest droplet falls with a speed, m/s.
    pub(super) fn origins(
        &self,
        (class, fastest): (&Class, f64),
        view: &View,
        least_pixels: f64,
        bounce: &Bounce,
    ) -> Option<Origins> {
        let size = f64::from(bounce.size);
        let range = view.range(class.largest * size, least_pixels);
        if range < view.near {
            return None;
        }
        let speeds = [class.speeds[0] * 0.2 * size, fastest];
        let [now, oldest, youngest] = &self.drifts;
        let wind = oldest.of(class.speeds[1])[1].length().max(now.of(class.speeds[1])[1].length());
        let leaves = leaving_speed(bounce, class.speeds[1], wind);
        let own = leaves * slip_lasts(self.ages[1], speeds[1]);
        // Displacement by the wind of a drop that takes its velocity on.
        let carried = speeds.iter().flat_map(|&speed| {
            [(oldest, self.ages[1]), (youngest, self.ages[0])].map(|(then, age)| {
                let [displacement, velocity] = then.of(speed);
                now.of(speed)[0] - displacement - velocity * slip_lasts(age, speed)
            })
        });
        let (low, high) = carried
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)));
        let own = own + 0.05 * (high - low).length();
        let margin = 0.5 * view.shutter_s * (leaves + wind + view.velocity.length()) + class.largest;
        let seen = view.bounds(range, margin);
        let way = Bounds {
            low: low - DVec3::splat(own) - DVec3::Y * (speeds[1] * self.ages[1]),
            high: high + DVec3::splat(own),
        };
        let bounds = Bounds { low: seen.low - way.high, high: seen.high - way.low };
        Some(Origins { bounds, way, range, margin })
    }
}

/// Maximum speed, m/s, with which a droplet leaves a surface that a drop with a terminal speed hits in a wind, m/s.
pub(super) fn leaving_speed(bounce: &Bounce, speed: f64, wind: f64) -> f64 {
    f64::from(bounce.restitution.max(1.0 - bounce.grip)) * ops::hypot(speed, wind)
}

/// Seconds for which the slip of a droplet with a terminal speed counts up to an age, s, across the fall.
pub(super) fn slip_lasts(age_s: f64, speed: f64) -> f64 {
    let time = slip_time(speed);
    time * (1.0 - ops::exp(-age_s / time))
}

/// Seconds in which the slip of a droplet with a terminal speed relaxes across the fall.
fn slip_time(speed: f64) -> f64 {
    relaxation(speed).horizontal_s.max(BOUNCE_MIN_RELAXATION.into())
}

/// Maximum distance, per slip in m/s, of the way by the slip from a line between two ages, s, the smaller first.
pub(super) fn slip_bends(ages: [f64; 2], speed: f64) -> f64 {
    let [young, old] = ages.map(|age| slip_lasts(age, speed));
    // An exponential is as far from its chord.
    (old - young) * (0.125 * (ages[1] - ages[0]) / slip_time(speed)).min(1.0)
}

impl Bounce {
    /// Maximum time of a droplet of a picture, s.
    pub(super) fn longest_s(&self, view: &View) -> f64 {
        f64::from(self.max_time_s).min(MAX_SPAN_S - view.shutter_s)
    }
}

/// Places from which the droplets of a class in a picture come.
#[derive(Clone, Copy)]
pub(super) struct Origins {
    pub(super) bounds: Bounds,
    /// Bounds of the droplets' ways.
    way: Bounds,
    /// Maximum distance from the eye, m.
    range: f64,
    /// Distance, m, that a droplet moves in half the exposure.
    margin: f64,
}

impl Origins {
    /// False if no droplet that starts in a box gets into the picture's pyramid, given by its sides.
    fn may_be_in(&self, place: &Bounds, view: &View, sides: &[DVec3; 5]) -> bool {
        let (low, high) = (place.low + self.way.low, place.high + self.way.high);
        let radius = 0.5 * (high - low).length() + self.margin;
        bounce_may_show((low.midpoint(high), radius), self.range, view, sides)
    }
}

/// False if a ball, by its middle and its radius, m, is farther from the eye than `range` or outside of the picture's sides.
fn bounce_may_show((middle, radius): (DVec3, f64), range: f64, view: &View, sides: &[DVec3; 5]) -> bool {
    let offset = middle - view.eye;
    offset.length() - radius <= range && within(sides, offset, radius)
}

/// Displacement, m, due to the slip between a droplet of a terminal speed and the air after a time, and what is left of the slip, m/s.
#[must_use]
pub fn bounce_slip(slip: DVec3, speed: f64, age_s: f64) -> [DVec3; 2] {
    let relaxation = relaxation(speed);
    let times = DVec3::new(relaxation.horizontal_s, relaxation.vertical_s, relaxation.horizontal_s)
        .max(DVec3::splat(BOUNCE_MIN_RELAXATION.into()));
    let left = DVec3::from_array((-age_s / times).to_array().map(ops::exp));
    [slip * times * (1.0 - left), slip * left]
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
    fn bounce_hit_droplet(field: &'a RainField, impact: &Impact, bounce: &Bounce) -> Option<Self> {
        let leaves =
            motion_bounce(impact.velocity, impact.normal, bounce.restitution, bounce.grip).as_dvec3();
        let diameter = f64::from(impact.diameter) * f64::from(bounce.size);
        let speed = field.speed.at(diameter).ok()?;
        let start = impact.position + impact.normal.as_dvec3() * f64::from(STEP_CLEAR);
        let begin_s = impact.time_s;
        let mut droplet = Self { field, start, leaves, diameter, speed, begin_s, follows: [DVec3::ZERO; 2] };
        droplet.follows = droplet.bounce_carried(0.0);
        Some(droplet)
    }

    /// Motion, up to an age after the impact, of a drop of its size that has always followed the wind.
    fn bounce_carried(&self, age_s: f64) -> [DVec3; 2] {
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
    fn bounce_at(&self, age_s: f64) -> (DVec3, DVec3) {
        let slip = self.leaves - self.follows[1];
        let [carried, velocity] = self.bounce_carried(age_s);
        let [moved, left] = bounce_slip(slip, self.speed, age_s);
        (self.start + carried - self.follows[0] + moved, velocity + left)
    }

    /// Age at which it hits something, up to an age.
    fn bounce_hit_stopped(&self, obstacles: &Obstacles<'_>, age_s: f64) -> Option<f64> {
        let steps = (age_s / FINE_S).ceil().max(0.0) as u32;
        let mut from = self.start - obstacles.origin;
        for step in 1..=steps {
            let to = self.bounce_at(f64::from(step) * FINE_S).0 - obstacles.origin;
            let velocity = ((to - from) / FINE_S).as_vec3();
            if let Some(hit) = met(obstacles, from.as_vec3(), velocity, FINE_S as f32) {
                return Some(f64::from(step - 1) * FINE_S + f64::from(hit.distance));
            }
            from = to;
        }
        None
    }
}
