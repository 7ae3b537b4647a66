//! Which drops of the rain in closed form have come as far as they are: those with nothing in their way.
//!
//! The path of a drop is known, so that it is looked at backwards, from where the drop is to above all that stands there.
//! With a steady wind it is one straight line and the answer is exact. Else it is cut at whole quarters of a second, the
//! same for every time that is asked about, so that drops do not come and go.
//!
//! What moves is taken where it is now: behind a car, its shadow in the rain is straight.
//!
//! Surfaces may have holes, as the cards that leaves are painted on ([`Holes`]): rain falls through them. What is there at
//! all stops drops, however well it is seen through: a pane of glass is a roof.

use downpour_bvh::{BvhNode, BvhTriangle, Hit, bvh_nearest};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_wind::UniformWind;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::drift::Drift;
use crate::field::FallingDrop;

/// Where a path is cut, s.
const CUT_S: f64 = 0.25;

/// A path is followed so far back, s; slower drops come from above all the same.
const LONGEST_S: f64 = 120.0;

/// A drop on a surface is not behind it, m.
const CLEAR_M: f32 = 1.0e-4;

/// Holes in a way to the sky, at most: a way through more ends in the open.
const MOST_HOLES: u32 = 64;

/// Where triangles are not there, though they are in the list: alpha of a texture, say.
pub trait Holes: std::fmt::Debug + Sync {
    /// Whether there is nothing at a hit.
    fn is_hole(&self, hit: &Hit) -> bool;
}

/// What stands in the rain: the arrays of a `downpour_bvh::Bvh`, relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct Obstacles<'a> {
    /// Nodes; none: nothing stands there.
    pub nodes: &'a [BvhNode],
    /// Triangles.
    pub triangles: &'a [BvhTriangle],
    /// Where they have holes; none: nowhere.
    pub holes: Option<&'a dyn Holes>,
    /// m.
    pub origin: DVec3,
}

/// The past of the wind, as far as paths are followed.
struct Past<'a> {
    law: &'a TerminalSpeed,
    now: Drift,
    time_s: f64,
    /// At the last whole quarter of a second, and before; empty with a steady wind.
    cuts: Vec<Drift>,
    last_cut_s: f64,
}

/// Drops of the sky that nothing has stopped: the others are left out, in place.
pub(crate) fn keep_open(
    drops: &mut Vec<FallingDrop>,
    obstacles: &Obstacles<'_>,
    law: &TerminalSpeed,
    wind: &UniformWind,
    time_s: f64,
) {
    let Some(root) = obstacles.nodes.first() else { return };
    if obstacles.triangles.is_empty() {
        return;
    }
    let (low, high) = (Vec3::from(root.low), Vec3::from(root.high));
    let steady = wind.is_steady();
    let last_cut_s = (time_s / CUT_S).floor() * CUT_S;
    // Slow drops are near the eye and seldom; they decide how far back the wind must be known.
    let slowest = drops.iter().map(|drop| speed(law, drop)).fold(f64::INFINITY, f64::min);
    let deepest = drops.iter().map(|d| d.position.y - obstacles.origin.y).fold(f64::INFINITY, f64::min);
    let longest = ((f64::from(high.y) - deepest).max(0.0) / slowest.max(0.05)).min(LONGEST_S);
    let cuts = if steady { 0 } else { (longest / CUT_S).ceil() as usize + 1 };
    let past = Past {
        law,
        now: Drift::new(wind, time_s),
        time_s,
        cuts: (0..cuts).into_par_iter().map(|k| Drift::new(wind, last_cut_s - k as f64 * CUT_S)).collect(),
        last_cut_s,
    };
    let open: Vec<bool> = drops.par_iter().map(|drop| past.is_open(drop, obstacles, low, high)).collect();
    let mut open = open.into_iter();
    drops.retain(|_| open.next().unwrap_or(true));
}

fn speed(law: &TerminalSpeed, drop: &FallingDrop) -> f64 {
    law.at(f64::from(drop.diameter)).unwrap_or(0.0)
}

impl Past<'_> {
    fn is_open(&self, drop: &FallingDrop, obstacles: &Obstacles<'_>, low: Vec3, high: Vec3) -> bool {
        let speed = speed(self.law, drop);
        let [displacement, velocity] = self.now.of(speed);
        let here = drop.position - obstacles.origin;
        let mut from = here.as_vec3();
        if self.cuts.is_empty() {
            let back = -(velocity - DVec3::Y * speed).as_vec3();
            return clear(obstacles, from, back.normalize_or(Vec3::Y), f32::MAX);
        }
        for (k, cut) in self.cuts.iter().enumerate() {
            if from.y > high.y || !could_meet(from, low, high, speed) {
                return true;
            }
            let age = self.time_s - (self.last_cut_s - k as f64 * CUT_S);
            let to = (here - (displacement - cut.of(speed)[0]) + DVec3::Y * (speed * age)).as_vec3();
            let way = to - from;
            let length = way.length();
            if length > 0.0 && !clear(obstacles, from, way / length, length) {
                return false;
            }
            from = to;
        }
        true
    }
}

/// Whether nothing is met within a distance.
fn clear(obstacles: &Obstacles<'_>, from: Vec3, direction: Vec3, distance: f32) -> bool {
    let (origin, direction) = (from.to_array(), direction.to_array());
    let far = distance.min(downpour_shaders::bvh::BVH_FAR);
    let mut near = CLEAR_M;
    for _ in 0..MOST_HOLES {
        let hit = bvh_nearest(obstacles.nodes, obstacles.triangles, origin, direction, near, far);
        let Some(hit) = hit else { return true };
        if !obstacles.holes.is_some_and(|holes| holes.is_hole(&hit)) {
            return false;
        }
        near = hit.distance.max(near) + CLEAR_M;
    }
    true
}

/// Whether a drop beside all that stands there could have come from it: nothing is carried by more than 60 m/s.
fn could_meet(from: Vec3, low: Vec3, high: Vec3, speed: f64) -> bool {
    let reach = (high.y - from.y).max(0.0) * (60.0 / speed.max(0.1)) as f32;
    from.x > low.x - reach && from.x < high.x + reach && from.z > low.z - reach && from.z < high.z + reach
}
