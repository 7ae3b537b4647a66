//! A falling drop on the picture: its path during the exposure, its oval, its oscillation.

use std::f32::consts::TAU;

use downpour_drop::oscillation::{FrequencyLaw, Oscillation, drop_oscillation_azimuth};
use downpour_math::ops;
use downpour_math::rng::seed_words;
use downpour_shaders::render::rain::{DROPS_LOOP, DROPS_STILL, DROPS_TABLE};
use downpour_sim::field::FallingDrop;
use glam::{DVec3, Vec2, Vec3};

use super::drops_mask::drops_mask_right;
use super::exposure::{Exposure, StreakSamples};
use super::streak::DropsDrop;
use super::{DropMasks, shapes};
use crate::camera::Camera;
use crate::camera::MAX_EXPOSURE_S;

/// Still drops of a smaller diameter on the picture, in pixels, are spread over the pixels around them.
const SMALL: f32 = 1.0;

/// So are the streaks of drops below this diameter.
const THIN: f32 = 1.5;

/// Drops whose path is shorter than this fraction of their radius stand still.
const STILL: f32 = 0.05;

/// Samples of a pixel of a streak of less than this many pixels across, and of a wider one. No multiples of
/// `STREAK_LATTICE`.
const NARROW: f32 = 4.0;
const NARROW_SAMPLES: u32 = 8;
const WIDE_SAMPLES: u32 = 5;

/// Diameters, meters, of drops that oscillate.
const OSCILLATING: std::ops::RangeInclusive<f64> = 0.05e-3..=9.0e-3;

/// A drop on the picture, and how it moves there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected {
    pub(super) drop: DropsDrop,
    /// Velocity relative to the picture, m/s.
    pub(super) velocity: Vec3,
}

/// The id of a drop in 32 bits, from which its oscillation is drawn.
pub(super) fn short_id(id: u64) -> u32 {
    id as u32 ^ (id >> 32) as u32
}

/// `v` turned about an axis by the axis's length, in radians.
fn turned(v: Vec3, axis: Vec3) -> Vec3 {
    let angle = axis.length();
    if angle < 1.0e-9 {
        return v;
    }
    let axis = axis / angle;
    let (sine, cosine) = (ops::sin(angle), ops::cos(angle));
    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine))
}

/// The fraction of a path from `from` to `to` on which it is at least `least`.
fn ahead(from: f32, to: f32, least: f32) -> [f32; 2] {
    match (from >= least, to >= least) {
        (true, true) => [0.0, 1.0],
        (true, false) => [0.0, (from - least) / (from - to)],
        (false, true) => [(least - from) / (to - from), 1.0],
        (false, false) => [1.0, 0.0],
    }
}

/// A drop on the picture; `None` where it is on none.
pub(super) fn project(
    camera: &Camera,
    eye: DVec3,
    drop: &FallingDrop,
    masks: &DropMasks,
    exposure: &Exposure,
) -> Option<Projected> {
    let present = present(drop, exposure)?;
    // The middle of the part of its path that is there.
    let middle = (present[0].midpoint(present[1]) - 0.5) * shutter(exposure);
    let offset = Travel::of(drop, eye, exposure).at(middle);
    let length = offset.length();
    let radius = 0.5 * drop.diameter;
    if !(length > 2.0 * radius && length.is_finite() && radius > 0.0) {
        return None;
    }
    let towards = offset / length;
    let cosine = towards.dot(camera.forward);
    if cosine < 0.05 {
        return None;
    }
    let elevation = ops::asin((-towards.y).clamp(-1.0, 1.0));
    let mask = masks.lookup(drop.diameter, elevation);
    let path = Path::of(camera, drop, eye, offset, radius, present, exposure)?;
    let distance = if path.moves { path.depth } else { length };
    let slope = radius / distance;
    // The plane of the picture is farther away, and slanted, away from the middle.
    let pixels = slope / (camera.pixel_angle * cosine);
    let blur = blur(exposure, distance) / camera.pixel_angle;
    let width = 2.0 * pixels;
    let blurred = blur >= 1.0 && blur > 0.7 * width;
    let grid = match width {
        _ if blurred => 0,
        d if path.moves && d < THIN => 0,
        d if path.moves && d < NARROW => NARROW_SAMPLES,
        _ if path.moves => WIDE_SAMPLES,
        d if d < SMALL => 0,
        d if d < 2.0 => 8,
        d if d < 16.0 => 4,
        _ => 2,
    };
    let spread = if blurred { (0.75 * width * width + blur * blur).sqrt().max(1.0) } else { 1.0 };
    let larger = if path.moves { distance / path.nearest } else { 1.0 };
    let motion =
        if path.moves { ModeMotion::of(drop, towards, exposure, &path.part) } else { ModeMotion::default() };
    let reach = if grid == 0 {
        0.5 * (spread + 1.0)
    } else {
        mask.half_extent * pixels * larger * (1.0 + motion.most) / cosine * 1.02 + 1.0
    };
    let [first, last] = path.ends.map(|p| camera.project(p));
    let (right, up) = (drops_mask_right(towards), drops_mask_right(towards).cross(towards));
    let [start, end] = path.ends.map(|p| Vec2::new(p.dot(right), p.dot(up)) / p.dot(towards));
    let shown = DropsDrop {
        towards: towards.into(),
        distance,
        position: camera.project(offset).into(),
        slope,
        half_extent: mask.half_extent,
        mask_index: mask.index,
        area: mask.area * pixels * pixels / cosine,
        grid,
        start: start.into(),
        along: (end - start).into(),
        first: first.into(),
        way: (last - first).into(),
        oval: mask.oval,
        depth_ratio: path.depth_ratio,
        mode_phase: motion.mode_phase,
        cycles: motion.cycles,
        fraction: path.part[1] - path.part[0],
        spread,
        nearest: path.nearest - 2.0 * radius,
        kind: kind(&path, exposure),
        shape: shapes::of_row(mask.index[0]),
        profile: 0,
        weights: if path.moves { path.part.map(|part| exposure.response.weight(part)) } else { [1.0; 2] },
        reach,
        id: short_id(drop.id),
    };
    Some(Projected { drop: shown, velocity: path.velocity })
}

/// Method that finds a drop's light.
fn kind(path: &Path, exposure: &Exposure) -> u32 {
    match exposure.samples {
        _ if !path.moves => DROPS_STILL,
        StreakSamples::Table => DROPS_TABLE,
        StreakSamples::Loop(_) => DROPS_LOOP,
    }
}

/// Diameter of the circle of confusion, radians: of a thin lens.
fn blur(exposure: &Exposure, distance: f32) -> f32 {
    let vergence = 1.0 / f64::from(distance) - 1.0 / exposure.focus_m;
    (exposure.aperture_m * vergence.abs()) as f32
}

/// Path of a drop during the exposure, relative to the eye.
struct Path {
    /// Positions at the beginning and at the end of the exposure, or of the part of it in which it is before the eye.
    ends: [Vec3; 2],
    /// That part of the exposure.
    part: [f32; 2],
    /// Mean depth along the direction to the drop, m.
    depth: f32,
    /// The least of it.
    nearest: f32,
    /// Depth at the end divided by that at the beginning.
    depth_ratio: f32,
    velocity: Vec3,
    moves: bool,
}

/// Time for which the shutter is open, s.
fn shutter(exposure: &Exposure) -> f32 {
    let shutter = exposure.shutter_s.clamp(0.0, MAX_EXPOSURE_S) as f32;
    if shutter.is_finite() { shutter } else { 0.0 }
}

/// The part of the exposure in which a drop is there: something stops it meanwhile, or it comes back from something. `None`:
/// it is not there at all.
fn present(drop: &FallingDrop, exposure: &Exposure) -> Option<[f32; 2]> {
    let shutter = shutter(exposure);
    let [begin, end] = drop.present_s;
    if shutter == 0.0 {
        return (begin <= 0.0 && end >= 0.0).then_some([0.0, 1.0]);
    }
    let part = [begin, end].map(|time| (time / shutter + 0.5).clamp(0.0, 1.0));
    (part[0] < part[1]).then_some(part)
}

/// A drop relative to the eye.
struct Travel {
    /// At the picture's time, if it is there then.
    offset: Vec3,
    velocity: Vec3,
    turning: Vec3,
}

impl Travel {
    fn of(drop: &FallingDrop, eye: DVec3, exposure: &Exposure) -> Self {
        let seen = Vec3::from(drop.velocity) * drop.seen_s();
        Self {
            offset: (drop.position - eye).as_vec3() - seen,
            velocity: Vec3::from(drop.velocity) - exposure.eye.velocity,
            turning: exposure.eye.turning,
        }
    }

    /// Position at a time relative to the picture's, s.
    fn at(&self, time: f32) -> Vec3 {
        turned(self.offset + self.velocity * time, -self.turning * time)
    }
}

impl Path {
    /// The path of a drop whose middle is at `offset`; `None` if too little of it is there to be seen.
    fn of(
        camera: &Camera,
        drop: &FallingDrop,
        eye: DVec3,
        offset: Vec3,
        radius: f32,
        present: [f32; 2],
        exposure: &Exposure,
    ) -> Option<Self> {
        let distance = offset.length();
        let towards = offset / distance;
        let still = Self {
            ends: [offset; 2],
            part: [0.0, 1.0],
            depth: distance,
            nearest: distance,
            depth_ratio: 1.0,
            velocity: Vec3::ZERO,
            moves: false,
        };
        let shutter = shutter(exposure);
        if shutter == 0.0 {
            return Some(still);
        }
        let travel = Travel::of(drop, eye, exposure);
        let [open, close] = [-0.5, 0.5].map(|half| travel.at(half * shutter));
        let forward = camera.forward;
        let in_front = ahead(open.dot(forward), close.dot(forward), 2.0 * radius + 0.02);
        let beside = ahead(open.dot(towards), close.dot(towards), 0.2 * distance);
        let part = [in_front[0].max(beside[0]).max(present[0]), in_front[1].min(beside[1]).min(present[1])];
        let ends = part.map(|fraction| open + (close - open) * fraction);
        let depths = ends.map(|p| p.dot(towards));
        let across = (ends[1] / depths[1].max(1.0e-6) - ends[0] / depths[0].max(1.0e-6)).length();
        if part[1] <= part[0] || !across.is_finite() || across < STILL * radius / distance {
            // A drop that stands before the eye, or what is left of one that is there for a moment.
            return (present == [0.0, 1.0]).then_some(still);
        }
        Some(Self {
            ends,
            part,
            depth: 0.5 * (depths[0] + depths[1]),
            nearest: depths[0].min(depths[1]),
            depth_ratio: depths[1] / depths[0],
            velocity: (close - open) / shutter,
            moves: true,
        })
    }
}

/// Oscillation of a drop during the exposure.
#[derive(Clone, Copy, Debug, Default)]
struct ModeMotion {
    mode_phase: [f32; 4],
    cycles: [f32; 2],
    /// No part of the surface goes farther, as a fraction of the radius.
    most: f32,
}

impl ModeMotion {
    fn of(drop: &FallingDrop, towards: Vec3, exposure: &Exposure, part: &[f32; 2]) -> Self {
        let diameter = f64::from(drop.diameter);
        if exposure.oscillation.pair() == [0.0; 2] || !OSCILLATING.contains(&diameter) {
            return Self::default();
        }
        let made =
            Oscillation::new(diameter, exposure.oscillation, &exposure.fluids, FrequencyLaw::Rayleigh1879);
        let Ok(oscillation) = made else {
            return Self::default();
        };
        let seed = seed_words(exposure.seed);
        let id = short_id(drop.id);
        let oscillation = oscillation.of_drop(seed, id);
        let [a20, a31] = exposure.oscillation.pair().map(|a| a as f32);
        // Direction in which the mode (3,1) bulges, against the right of the view.
        let azimuth = TAU * drop_oscillation_azimuth(seed, id);
        let right = drops_mask_right(towards);
        let cosine = ops::cos(azimuth) * right.x + ops::sin(azimuth) * right.z;
        let begin = exposure.time_s + exposure.shutter_s * (f64::from(part[0]) - 0.5);
        let open = exposure.shutter_s * f64::from(part[1] - part[0]);
        let (frequency, phase) = (oscillation.frequency(), oscillation.phase());
        let at = [0, 1].map(|mode| (frequency[mode] * begin + phase[mode]).rem_euclid(1.0) as f32);
        Self {
            mode_phase: [a20, a31 * cosine, at[0], at[1]],
            cycles: frequency.map(|f| (f * open) as f32),
            // P31 reaches 2.07.
            most: a20 + 2.1 * a31,
        }
    }
}
