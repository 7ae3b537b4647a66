//! Drops of the rain in closed form that obstacles have not stopped when the shutter opens. Hits during the exposure
//! end their streaks.
//!
//! The path of a drop is known, so it is followed backwards from the drop to above all obstacles. In a steady wind it is
//! one straight line and the answer is exact. Else it is divided at whole quarters of a second, the same for every
//! query, so that drops do not appear or vanish. During the exposure it is straight, as it is drawn.
//!
//! The wind is uniform: it blows through obstacles, which shelter from rain and not from wind.
//!
//! Moving objects are taken at their current position: behind a car, its rain shadow is straight.
//!
//! Surfaces may have holes, as the cards with painted leaves ([`Holes`]): rain falls through them. All other surfaces
//! stop drops, even transparent ones: a pane of glass is a roof.

use downpour_bvh::{BvhNode, BvhTriangle, Hit, bvh_blocker, bvh_bounds, bvh_hit};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_shaders::sim::field::{SHELTER_CARRIED, SHELTER_CLEAR, SHELTER_CUT, SHELTER_HOLES};
use downpour_wind::UniformWind;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::drift::Drift;
use crate::falling::FallingDrop;

/// Interval at which a path is divided, s.
pub(crate) const CUT_S: f64 = SHELTER_CUT as f64;

/// Maximum time for which a path is followed back, s; slower drops count as coming from the sky.
pub(crate) const MAX_BACK_S: f64 = 120.0;

/// Distance from a surface below which a drop counts as on it, m.
const CLEAR_M: f32 = SHELTER_CLEAR;

/// Holes in triangles of the list, as by the alpha of a texture. A triangle with holes is marked as one that
/// [lets rays through](BvhTriangle::lets_through).
pub trait Holes: std::fmt::Debug + Sync {
    /// True if there is a hole at a hit.
    fn is_hole(&self, hit: &Hit) -> bool;
}

/// Obstacles in the rain: the arrays of a `downpour_bvh::Bvh`, relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct Obstacles<'a> {
    /// Nodes; empty without obstacles.
    pub nodes: &'a [BvhNode],
    /// Triangles.
    pub triangles: &'a [BvhTriangle],
    /// Holes of the triangles; `None` without holes.
    pub holes: Option<&'a dyn Holes>,
    /// Origin, m.
    pub origin: DVec3,
}

impl Obstacles<'_> {
    /// Corners of the box around all of them, m, relative to their origin; `None` without obstacles.
    #[must_use]
    pub fn corners(&self) -> Option<[Vec3; 2]> {
        bvh_bounds(self.nodes).map(|corners| corners.map(Vec3::from))
    }
}

/// Paths of drops from the sky up to a time.
pub(crate) struct SkyPaths<'a> {
    obstacles: &'a Obstacles<'a>,
    /// Lower corner of the bounds of all obstacles.
    low: Vec3,
    high: Vec3,
    /// Drift of drops up to that time.
    open: Drift,
    open_s: f64,
    /// Drift up to the last whole quarter of a second, and before; empty in a steady wind.
    cuts: Vec<Drift>,
    last_cut_s: f64,
}

impl<'a> SkyPaths<'a> {
    /// Paths up to a time of drops that are no slower than a speed, m/s, and no lower than a height, m, relative to the
    /// obstacles' origin. `None` without obstacles.
    pub(crate) fn new(
        obstacles: &'a Obstacles<'a>,
        wind: &UniformWind,
        open_s: f64,
        slowest: f64,
        deepest: f64,
    ) -> Option<Self> {
        let [low, high] = obstacles.corners()?;
        let last_cut_s = (open_s / CUT_S).floor() * CUT_S;
        let cuts = number_of_cuts(wind, f64::from(high.y) - deepest, slowest);
        let cut = |k: usize| Drift::new(wind, last_cut_s - k as f64 * CUT_S);
        let cuts = (0..cuts).into_par_iter().map(cut).collect();
        Some(Self { obstacles, low, high, open: Drift::new(wind, open_s), open_s, cuts, last_cut_s })
    }

    /// Drift of drops up to the time.
    pub(crate) fn drift(&self) -> &Drift {
        &self.open
    }

    /// True if nothing is between the sky and `from`, which is near `at`, the position of a drop of a terminal speed
    /// at the time; its velocity is for a steady wind. Positions are relative to the obstacles' origin.
    pub(crate) fn shelter_is_open(&self, mut from: Vec3, at: DVec3, speed: f64, velocity: Vec3) -> bool {
        if self.cuts.is_empty() {
            return shelter_clear(self.obstacles, from, (-velocity).normalize_or(Vec3::Y), f32::MAX);
        }
        let displacement = self.open.of(speed)[0];
        for (k, cut) in self.cuts.iter().enumerate() {
            if from.y > self.high.y || !self.shelter_could_meet(from, speed) {
                return true;
            }
            let age = self.open_s - (self.last_cut_s - k as f64 * CUT_S);
            let to = (at - (displacement - cut.of(speed)[0]) + DVec3::Y * (speed * age)).as_vec3();
            let way = to - from;
            let length = way.length();
            if length > 0.0 && !shelter_clear(self.obstacles, from, way / length, length) {
                return false;
            }
            from = to;
        }
        true
    }

    /// True if a drop beside all obstacles could have come from them: nothing is carried by more than 60 m/s.
    fn shelter_could_meet(&self, from: Vec3, speed: f64) -> bool {
        let (low, high) = (self.low, self.high);
        let reach = (high.y - from.y).max(0.0) * (f64::from(SHELTER_CARRIED) / speed.max(0.1)) as f32;
        from.x > low.x - reach && from.x < high.x + reach && from.z > low.z - reach && from.z < high.z + reach
    }
}

/// Number of quarters of a second that paths are followed back, up to a height, m, above the lowest drop.
pub(crate) fn number_of_cuts(wind: &UniformWind, height: f64, slowest: f64) -> usize {
    // Slow drops are near the eye and rare; they determine how far back the wind is needed.
    let longest = (height.max(0.0) / slowest.max(0.05)).min(MAX_BACK_S);
    if wind.is_steady() { 0 } else { (longest / CUT_S).ceil() as usize + 1 }
}

/// Keeps the drops that nothing has stopped when the shutter opens, half of the exposure before the picture's time. The
/// others are removed in place, and those that are stopped during the exposure get their times.
pub(crate) fn keep_open(
    drops: &mut Vec<FallingDrop>,
    obstacles: &Obstacles<'_>,
    law: &TerminalSpeed,
    wind: &UniformWind,
    time_s: f64,
    shutter_s: f64,
) {
    let half = 0.5 * shutter_s;
    let slowest = drops.iter().map(|drop| speed(law, drop)).fold(f64::INFINITY, f64::min);
    let height = |drop: &FallingDrop| drop.position.y - obstacles.origin.y;
    let deepest = drops.iter().map(height).fold(f64::INFINITY, f64::min);
    let Some(paths) = SkyPaths::new(obstacles, wind, time_s - half, slowest, deepest) else { return };
    let picture = Drift::new(wind, time_s);
    let until = |drop: &FallingDrop| {
        let (speed, velocity) = (speed(law, drop), Vec3::from(drop.velocity));
        let here = drop.position - obstacles.origin;
        // As it is drawn, and as it has moved.
        let from = here.as_vec3() - velocity * half as f32;
        let back = picture.of(speed)[0] - paths.drift().of(speed)[0] - DVec3::Y * (speed * half);
        if !paths.shelter_is_open(from, here - back, speed, velocity) {
            return None;
        }
        let met = (shutter_s > 0.0).then(|| met(obstacles, from, velocity, shutter_s as f32)).flatten();
        Some(met.map_or(f32::INFINITY, |hit| hit.distance - half as f32))
    };
    let open: Vec<Option<f32>> = drops.par_iter().map(until).collect();
    let mut open = open.into_iter();
    drops.retain_mut(|drop| {
        let until = open.next().flatten();
        drop.present_s[1] = until.unwrap_or(drop.present_s[1]);
        drop.position += (Vec3::from(drop.velocity) * drop.seen_s()).as_dvec3();
        until.is_some()
    });
}

fn speed(law: &TerminalSpeed, drop: &FallingDrop) -> f64 {
    law.at(f64::from(drop.diameter)).unwrap_or(0.0)
}

/// First hit at a velocity within a time; the hit's distance is a time, s.
pub(crate) fn met(obstacles: &Obstacles<'_>, from: Vec3, velocity: Vec3, time_s: f32) -> Option<Hit> {
    shelter_hit(obstacles, from, velocity, 0.0, time_s)
}

/// True if nothing is hit within a distance.
fn shelter_clear(obstacles: &Obstacles<'_>, from: Vec3, direction: Vec3, distance: f32) -> bool {
    let far = distance.min(downpour_shaders::bvh::BVH_FAR);
    shelter_hit_any(obstacles, from, direction, CLEAR_M, far).is_none()
}

/// Nearest hit that is not a hole, at a distance from `near` to `far` times the length of `way`.
fn shelter_hit(obstacles: &Obstacles<'_>, from: Vec3, way: Vec3, near: f32, far: f32) -> Option<Hit> {
    shelter_hit_walk::<false>(obstacles, from, way, near, far)
}

/// Any hit that is not a hole, at a distance from `near` to `far` times the length of `way`.
fn shelter_hit_any(obstacles: &Obstacles<'_>, from: Vec3, way: Vec3, near: f32, far: f32) -> Option<Hit> {
    shelter_hit_walk::<true>(obstacles, from, way, near, far)
}

/// The nearest hit that is not a hole or, if `ANY`, any.
fn shelter_hit_walk<const ANY: bool>(
    obstacles: &Obstacles<'_>,
    from: Vec3,
    way: Vec3,
    mut near: f32,
    far: f32,
) -> Option<Hit> {
    let (origin, direction) = (from.to_array(), way.to_array());
    let walk = if ANY { bvh_blocker } else { bvh_hit };
    let step = CLEAR_M / way.length().max(CLEAR_M);
    for _ in 0..SHELTER_HOLES {
        let hit = walk(obstacles.nodes, obstacles.triangles, origin, direction, near, far)?;
        if !obstacles.holes.is_some_and(|holes| holes.is_hole(&hit)) {
            return Some(hit);
        }
        near = hit.distance.max(near) + step;
    }
    None
}
