//! Uniforms and tables with which a GPU finds droplets that rebound. The structs have the layout of those in `shaders/wgsl/sim/bounce.wgsl`, whose twin is
//! `bounced`.
//!
//! A drop is given by its position at the end of the exposure, as if nothing had stopped it. There it is close to its droplet, since
//! the wind carries both, so that few columns are searched however far the wind has carried them. Its path is divided at whole
//! sixteenths of a second, as on the CPU.

use bytemuck::{Pod, Zeroable};
use downpour_drop::fall_speed::FallSpeedAir;
use downpour_math::ops::f64 as ops;
use downpour_shaders::sim::bounce::{BOUNCE_SLICE, BOUNCE_STEP};
use downpour_shaders::sim::field::FIELD_SIDES;
use glam::{DVec3, Vec3};

use super::bounced::{Travels, leaving_speed, slip_bends, slip_lasts};
use crate::drift::Drift;
use crate::falling::EyeDrop;
use crate::field::frame::FieldQuery;
use crate::field::{Class, ROOM, RainField, Reach, SPARE_ROOM};
use crate::options::Bounce;
use crate::resolved::Resolved;
use crate::shelter::Obstacles;
use crate::view::{Bounds, View, side_rows};

/// Uniforms of the search for droplets.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BounceFrame {
    /// Outward normals of the pyramid of the picture.
    pub sides: [[f32; 4]; FIELD_SIDES as usize],
    /// Pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pub pane: [f32; 4],
    /// Air in which droplets fall.
    pub air: FallSpeedAir,
    /// Position of the eye relative to the obstacles, m.
    pub eye: Vec3,
    /// Half the exposure time, s.
    pub half_shutter: f32,
    /// Velocity of the eye, m/s.
    pub velocity: Vec3,
    /// Least distance of a droplet, m.
    pub nearest: f32,
    /// Axis of the camera's rotation, with its angular speed as length, rad/s.
    pub turning: Vec3,
    /// Largest distance of a droplet, m.
    pub farthest: f32,
    /// Distance up to which a droplet is listed, by its diameter.
    pub per_diameter: f32,
    /// Lowest obstacle, relative to the eye, m.
    pub lowest: f32,
    /// Highest obstacle, relative to the eye, m.
    pub highest: f32,
    /// Time of the first row of the motion by the wind, s from the time of the picture.
    pub first_time: f32,
    /// Parts of a path: one less than the rows.
    pub slices: u32,
    /// Maximum time of a droplet, s.
    pub longest: f32,
    /// Fraction of impacts that throw a droplet.
    pub chance: f32,
    /// Fraction of the speed toward the surface that is left.
    pub restitution: f32,
    /// Fraction of the speed along the surface that is lost.
    pub grip: f32,
    /// Diameter of a droplet relative to that of its drop.
    pub size: f32,
    /// Number of the model of terminal speed.
    pub model: u32,
    /// Maximum distance of a path from the line between its ends, m.
    pub slack: f32,
    /// Room for parts of paths.
    pub parts: u32,
    /// Index in the list of the first drop that is searched for.
    pub first: u32,
    /// Room from there on.
    pub room: u32,
    /// 0.
    pub unused: u32,
}

/// Parts of paths on the device: their number, and the first of as many as have room.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct BounceParts {
    /// Number of parts that were found.
    pub count: u32,
    /// 0.
    pub unused: [u32; 3],
    /// The first part.
    pub drops: [EyeDrop; 1],
}

/// The search for the droplets of a picture.
#[derive(Debug)]
pub(crate) struct BounceSearch {
    /// End of the parts of paths, s.
    pub(crate) end_s: f64,
    /// The picture, with the shutter closed: paths to the sky are followed from the end.
    pub(crate) view: View,
    pub(crate) query: FieldQuery,
    pub(crate) frame: BounceFrame,
    pub(crate) rows: Vec<[f32; 4]>,
}

/// Length of the parts of paths, s.
const SLICE_S: f64 = BOUNCE_SLICE as f64;

/// Parts of paths that a GPU is asked for, at most: beyond, a CPU looks where surfaces are.
const MAX_PARTS: f64 = 2_097_152.0;

/// Droplets of a picture for which there is room on a GPU.
pub(crate) const MAX_DROPLETS: u32 = 131_072;

/// Largest distance, m, of a path in a sixteenth of a second from a line, in gusts and in a steady wind.
const SLACK_M: [f64; 2] = [0.05, 0.01];

/// Motion by the wind up to a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BounceMotion {
    /// Displacement, m.
    pub moved: Vec3,
    /// m/s.
    pub velocity: Vec3,
}

/// Motion between the times of two rows: the cubic with their positions and velocities.
#[must_use]
pub fn bounce_between(before: BounceMotion, after: BounceMotion, part: f32) -> BounceMotion {
    let square = part * part;
    let cube = square * part;
    let way = after.moved - before.moved;
    let bent = before.velocity * (part - 2.0 * square + cube) + after.velocity * (cube - square);
    BounceMotion {
        moved: before.moved + way * (3.0 * square - 2.0 * cube) + bent * BOUNCE_SLICE,
        velocity: way * (6.0 * (part - square) / BOUNCE_SLICE)
            + before.velocity * (1.0 - 4.0 * part + 3.0 * square)
            + after.velocity * (3.0 * square - 2.0 * part),
    }
}

impl Bounce {
    /// True if a GPU is to find the droplets of a picture at a time in s, of `least_pixels` pixels and more.
    #[must_use]
    pub fn fits_device(
        &self,
        field: &RainField,
        view: &View,
        least_pixels: f64,
        time_s: f64,
        obstacles: &Obstacles<'_>,
    ) -> bool {
        let expected = |corners| self.expected(field, view, least_pixels, time_s, corners);
        obstacles.corners().is_none_or(|corners| expected(corners) <= MAX_PARTS)
    }

    /// First and last time at which paths are divided, in sixteenths of a second. Droplets are followed for a step beyond the exposure.
    fn span(&self, view: &View, time_s: f64) -> [i64; 2] {
        let half = 0.5 * view.shutter_s;
        let [begin, end] = [time_s - half - self.longest_s(view), time_s + half + f64::from(BOUNCE_STEP)]
            .map(|time| time / SLICE_S);
        [begin.floor() as i64, end.ceil() as i64]
    }

    /// Upper bound of the expected number of parts of paths whose droplets a picture may show, with room for chance.
    pub(crate) fn expected(
        &self,
        field: &RainField,
        view: &View,
        least_pixels: f64,
        time_s: f64,
        [low, high]: [Vec3; 2],
    ) -> f64 {
        let wind = field.wind.velocity(time_s).length();
        let [first, last] = self.span(view, time_s);
        let of_class = |class: &Class| {
            let diameter = class.largest * f64::from(self.size);
            let range = view.range(diameter, least_pixels);
            let Ok(speed) = field.speed.at(diameter) else { return 0.0 };
            if range < view.near {
                return 0.0;
            }
            let leaves = leaving_speed(self, class.speeds[1], wind);
            let slip = ops::hypot(speed, wind);
            // Of the obstacles, with the way of a drop in a part.
            let height = f64::from(high.y - low.y) + SLICE_S * (class.speeds[1] + 0.2 * wind);
            let constant = 0.5 * SLICE_S * (class.speeds[1] + speed + 0.2 * wind)
                + 0.5 * view.shutter_s * (leaves + wind + view.velocity.length() + view.turning.length())
                + SLACK_M[0]
                + class.largest;
            let of_part = |k: i64| {
                let ages =
                    [first + k + 1, first + k].map(|number| (time_s - number as f64 * SLICE_S).max(0.0));
                let radius = constant + leaves * slip_lasts(ages[1], speed) + slip * slip_bends(ages, speed);
                let reach = range + radius;
                view.near_volume(range, radius).min(std::f64::consts::PI * reach * reach * height)
            };
            class.density * f64::from(self.fraction) * (0..last - first).map(of_part).sum::<f64>()
        };
        field.classes.iter().map(of_class).sum::<f64>() * ROOM + SPARE_ROOM
    }

    /// Search for the droplets of a picture at a time in s; `corners` are those of all obstacles, and `drift_of` the motion by the wind
    /// up to a number of sixteenths of a second.
    pub(crate) fn search(
        &self,
        field: &RainField,
        (view, least_pixels): (&View, f64),
        time_s: f64,
        ([low, high], origin): ([Vec3; 2], DVec3),
        mut drift_of: impl FnMut(i64) -> Drift,
    ) -> BounceSearch {
        let [first, last] = self.span(view, time_s);
        let drifts: Vec<Drift> = (first..=last).map(&mut drift_of).collect();
        let now = Drift::new(&field.wind, time_s);
        let end_s = last as f64 * SLICE_S;
        let times: Vec<f64> = (first..=last).map(|k| k as f64 * SLICE_S).collect();
        let at_end = &drifts[drifts.len() - 1];
        let around =
            Bounds { low: origin + low.as_dvec3() - 1.0e-3, high: origin + high.as_dvec3() + 1.0e-3 };
        // Where the drops of a class are at the end.
        let mut boxes: Vec<Option<Bounds>> = vec![None; field.classes.len()];
        let fastest: Vec<f64> =
            field.classes.iter().map(|class| field.fastest_droplet(class, self)).collect();
        for (pair, ends) in drifts.windows(2).zip(times.windows(2)) {
            let ages = [ends[1], ends[0]].map(|time| (time_s - time).max(0.0));
            let travels = Travels { ages, drifts: [now.clone(), pair[0].clone(), pair[1].clone()] };
            for ((class, &fastest), found) in field.classes.iter().zip(&fastest).zip(&mut boxes) {
                let origins = travels.origins((class, fastest), view, least_pixels, self);
                let Some(starts) = origins.and_then(|origins| origins.bounds.common(&around)) else {
                    continue;
                };
                let [slow, fast] = class.speeds;
                let ways = pair.iter().zip(ends).flat_map(|(drift, time)| {
                    [slow, slow.midpoint(fast), fast].map(|speed| {
                        at_end.of(speed)[0] - drift.of(speed)[0] - DVec3::Y * (speed * (end_s - time))
                    })
                });
                let (least, most) = ways.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), way| {
                    (low.min(way), high.max(way))
                });
                // Between the rows, and between the speeds, paths are slightly curved.
                let swept = Bounds { low: starts.low + least - 0.05, high: starts.high + most + 0.05 };
                *found = Some(found.map_or(swept, |found| found.union(&swept)));
            }
        }
        let expected = self.expected(field, view, least_pixels, time_s, [low, high]);
        let closed = View { shutter_s: 0.0, ..*view };
        let resolved = Resolved::of(view, least_pixels);
        let row = |class: &Class, drift: &Drift| {
            let bounds = boxes.get(class.number).copied().flatten()?;
            Some(class.row_within(view, &bounds, drift, drift.middle()))
        };
        let shared = Reach::of_view(view, least_pixels);
        let query = field.query_rows(view, (end_s, at_end.clone()), row, shared, 1, resolved);
        let (model, air) = &field.falls;
        let parts = expected.min(MAX_PARTS) as u32;
        let frame = BounceFrame {
            sides: side_rows(view.sides()),
            air: FallSpeedAir::new(air),
            eye: (view.eye - origin).as_vec3(),
            half_shutter: (0.5 * view.shutter_s) as f32,
            velocity: view.velocity.as_vec3(),
            nearest: view.near as f32,
            turning: view.turning.as_vec3(),
            farthest: view.far as f32,
            per_diameter: (1.0 / view.least_angle(least_pixels)) as f32,
            lowest: (around.low.y - view.eye.y) as f32,
            highest: (around.high.y - view.eye.y) as f32,
            first_time: (first as f64 * SLICE_S - time_s) as f32,
            slices: (last - first) as u32,
            longest: self.longest_s(view) as f32,
            chance: self.fraction,
            restitution: self.restitution,
            grip: self.grip,
            size: self.size,
            model: model.number(),
            slack: SLACK_M[usize::from(field.wind.is_steady())] as f32,
            parts,
            room: parts.min(MAX_DROPLETS),
            ..BounceFrame::zeroed()
        };
        let row = |drift: &Drift| -> Vec<[f32; 4]> {
            let pairs = drift.entries().zip(at_end.entries());
            let both = pairs.flat_map(|(then, end)| [then[0] - end[0], then[1]]);
            both.map(|v| v.as_vec3().extend(0.0).to_array()).collect()
        };
        let rows = drifts.iter().flat_map(row).collect();
        BounceSearch { end_s, view: closed, query, frame, rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::fall_speed::relaxation;
    use downpour_wind::{Gusts, Keyed, Wind, WindPart};

    /// Largest errors of the cubic between rows, m and m/s, of drops that follow the wind within `tau` s, in a sixteenth of a second.
    fn cubic_errors(gusts: Option<Gusts>, tau: f64, begin_s: f64) -> [f32; 2] {
        let speed = Keyed::new(vec![(0.0, 3.0), (4.0, 12.0), (20.0, 6.0)]).unwrap();
        let part = WindPart::uniform(&speed, &DVec3::new(1.0, 0.1, 0.4).into()).unwrap();
        let wind = Wind::new(vec![part], gusts, None).unwrap().uniform().unwrap();
        let base = wind.followed(begin_s, tau).displacement;
        let at = |time_s: f64| {
            let found = wind.followed(time_s, tau);
            BounceMotion { moved: (found.displacement - base).as_vec3(), velocity: found.velocity.as_vec3() }
        };
        let errors = (0..=8).map(|k| {
            let part = f64::from(k) / 8.0;
            let found = bounce_between(at(begin_s), at(begin_s + SLICE_S), part as f32);
            let expected = at(begin_s + part * SLICE_S);
            [(found.moved - expected.moved).length(), (found.velocity - expected.velocity).length()]
        });
        errors.fold([0.0; 2], |most, error| [most[0].max(error[0]), most[1].max(error[1])])
    }

    /// The cubic between rows is the closed form of a wind that swells.
    #[test]
    fn motion_between_rows_is_that_of_the_wind() {
        for (tau, begin_s) in
            [(0.02, 5.0), (0.1, 7.25), (0.4, 11.3125), (relaxation(2.0).horizontal_s, 3.9375)]
        {
            let [moved, velocity] = cubic_errors(None, tau, begin_s);
            assert!(moved < 1.0e-5 && velocity < 2.0e-3, "{tau}: {moved}, {velocity}");
        }
    }

    /// Gusts bend between rows: the sooner a drop follows the wind, the more.
    #[test]
    fn motion_in_gusts_is_off_by_less_the_slower_a_drop_follows() {
        for (tau, begin_s, most) in [
            (0.02, 5.0, [2.5e-3, 0.18]),
            (0.1, 7.25, [6.0e-4, 0.035]),
            (relaxation(2.0).horizontal_s, 3.9375, [4.0e-4, 0.022]),
            (0.4, 11.3125, [6.0e-5, 6.0e-3]),
        ] {
            let [moved, velocity] = cubic_errors(Some(Gusts::default()), tau, begin_s);
            assert!(moved < most[0] && velocity < most[1], "{tau}: {moved}, {velocity}");
        }
    }
}
