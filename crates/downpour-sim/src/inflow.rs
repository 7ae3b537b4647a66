//! Origins of drops that enter a frustum in a step: thin regions at its planes and its ball.
//!
//! The rain outside the frustum has the density of the undisturbed rain, and moves with the local wind. Each step
//! fills the regions with new candidates, a Poisson number of them, moves them as any drop, and keeps those that arrive
//! ([`crate::enter`]). The density inside therefore stays that of the rain for any motion of camera, shutter and
//! picture; a wind without divergence keeps it uniform, and drops that a vortex throws out are gone. A drop depends
//! only on the step and the number with which it entered, so the drops of a time do not depend on the start of the
//! simulation.
//!
//! A candidate is outside a plane of the frustum by a distance that it can move in the step. The first limit that it
//! violates is that of its region, so that no part of space is filled twice.

use downpour_math::rng::seed_words;
use downpour_shaders::sim::step::VOLUME_BALL;
use glam::DVec3;

use crate::enter::EnterRegion;
use crate::frustum::{Frustum, PLANES};
use crate::poisson::poisson_at;
use crate::population::Bin;

/// First dimension of the random numbers of candidates' counts.
const COUNT: u32 = 24_576;

/// Tolerance of the bounds for rounding, m.
const SLACK_M: f64 = 1.0e-4;

/// Neighbors of a plane on its positive and negative side along normal x tangent, and the half width or height of the
/// picture along it.
const NEIGHBORS: [[usize; 2]; PLANES] = [[2, 3], [3, 2], [1, 0], [0, 1], [2, 3]];

/// Regions of a step of `time` seconds from one frustum to the next, for each bin of sizes. `wind` is that at the eye.
pub(crate) fn regions(
    before: &Frustum,
    now: &Frustum,
    bins: &[Bin],
    wind: DVec3,
    time: f64,
    seed: u64,
    step: u32,
) -> Vec<EnterRegion> {
    let seed = seed_words(seed);
    let mut list = Vec::new();
    let mut first = 0;
    for (number, bin) in (0u32..).zip(bins) {
        let mut of_bin = 0;
        for (region, expected) in of(before, now, bin, wind, time) {
            let dimension = COUNT + number * (PLANES as u32 + 1) + region.face;
            let count = poisson_at(expected * bin.density, seed, step, dimension);
            if count > 0 {
                list.push(EnterRegion { bin: number, first, first_of_bin: of_bin, ..region });
                first += count;
                of_bin += count;
            }
        }
    }
    // Marks the end of the list.
    if first > 0 {
        list.push(EnterRegion { first, ..EnterRegion::default() });
    }
    list
}

/// Regions of a bin, each with the volume in which candidates are drawn, m^3.
fn of(
    before: &Frustum,
    now: &Frustum,
    bin: &Bin,
    wind: DVec3,
    time: f64,
) -> impl Iterator<Item = (EnterRegion, f64)> {
    let [largest, fastest] = [bin.diameters[1], bin.speeds[1]];
    let eye_moved = now.eye - before.eye;
    // Motion of the slowest and the fastest drop relative to the eye, and its uncertainty.
    let moved = bin.speeds.map(|speed| (wind - DVec3::Y * speed) * time - eye_moved);
    let apart = now.spread(now.range(largest)) * time;
    let farthest = moved[0].length().max(moved[1].length()) + apart + SLACK_M;
    let radius = now.reach(largest, fastest).max(now.reach(largest, bin.speeds[0])) + farthest;
    let tangents = before.tangents();
    // Outside each plane candidates are between these two distances.
    let low: [f64; PLANES] =
        std::array::from_fn(|k| before.margins(k, bin.diameters, bin.speeds)[0] - SLACK_M);
    let high: [f64; PLANES] = std::array::from_fn(|k| {
        let normal = now.normals[k];
        let inwards = moved.map(|way| -normal.dot(way));
        let turned = (before.normals[k] - normal).length() * radius;
        now.margins(k, bin.diameters, bin.speeds)[1] + inwards[0].max(inwards[1]) + turned + apart + SLACK_M
    });
    let [wide, high_half] = before.half;
    let [_, _, forward] = before.axes();
    let plane = move |k: usize| {
        let (normal, tangent) = (before.normals[k], tangents[k]);
        if high[k] <= low[k] {
            return None;
        }
        // Depth before the eye is rise * along - sink * distance from the plane.
        let (rise, sink) = (tangent.dot(forward), -normal.dot(forward));
        let half = if k < 2 || k == PLANES - 1 { high_half } else { wide };
        let stretch = (1.0 + half * half).sqrt();
        // Limits by the neighboring planes: half * depth + their distance.
        let depth_less = if sink > 0.0 { sink * low[k] } else { sink * high[k] };
        let [up, down] = NEIGHBORS[k].map(|beside| high[beside] * stretch - half * depth_less);
        let (mut slope, mut width, mut middle) = (half * rise, 0.5 * (up + down), 0.5 * (up - down));
        let reach = (radius * radius - low[k].max(0.0) * low[k].max(0.0)).max(0.0).sqrt();
        let [mut begin, mut end] = [-reach, reach];
        if k == PLANES - 1 {
            // The back: as wide as right and left allow.
            let stretch = (1.0 + wide * wide).sqrt();
            let [right, left] = [0, 1].map(|beside| high[beside] * stretch - wide * depth_less);
            [begin, end] = [begin.max(-left), end.min(right)];
        } else if rise > 1.0e-6 {
            begin = begin.max((sink * low[k] - high[PLANES - 1]) / rise);
        }
        if width + slope * end > 1.5 * radius {
            (slope, width, middle) = (0.0, radius, 0.0);
        }
        if slope > 1.0e-9 {
            begin = begin.max(-width / slope);
        }
        let [near, far] = [width + slope * begin, width + slope * end];
        if begin >= end || near + far <= 0.0 {
            return None;
        }
        let region = EnterRegion {
            face: k as u32,
            low: low[k] as f32,
            high: high[k] as f32,
            begin: begin as f32,
            end: end as f32,
            slope: slope as f32,
            width: width as f32,
            middle: middle as f32,
            ..EnterRegion::default()
        };
        Some((region, (high[k] - low[k]) * (end - begin) * (near + far)))
    };
    let ball = move || {
        let least =
            before.reach(bin.diameters[0], bin.speeds[0]).min(before.reach(bin.diameters[0], bin.speeds[1]))
                - SLACK_M;
        if radius <= least || least <= 0.0 {
            return None;
        }
        // The minimum depth on the ball between the planes.
        let across = high[0].max(high[1]).max(0.0) * (1.0 + wide * wide).sqrt();
        let along = high[2].max(high[3]).max(0.0) * (1.0 + high_half * high_half).sqrt();
        let a = 1.0 + wide * wide + high_half * high_half;
        let b = wide * across + high_half * along;
        let c = across * across + along * along - least * least;
        let root = b * b - a * c;
        let depth = if root > 0.0 { (root.sqrt() - b) / a } else { -least };
        let cosine = (depth / least).clamp(-1.0, 1.0);
        let lean = (1.0 - cosine).max(1.0e-9);
        let region = EnterRegion {
            face: VOLUME_BALL,
            low: least as f32,
            high: radius as f32,
            slope: lean as f32,
            ..EnterRegion::default()
        };
        // A square around the disk of directions, and the largest radius for all.
        Some((region, 8.0 * lean * radius * radius * (radius - least)))
    };
    (0..PLANES).filter_map(plane).chain(std::iter::once_with(ball).flatten())
}
