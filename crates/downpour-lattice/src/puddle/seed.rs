//! Craters of impacts and footprints of moving objects. Twin of `shaders/wgsl/lattice/puddle_seed.wgsl`.
//!
//! Tatarchuk & Isidoro 2006 seed a damped sine by the drop's mass. Here its shape is
//!
//! > -a (2 / sqrt 3) exp(-q) sin(sqrt(3) q + pi / 3),   q = distance / length:
//!
//! the damped sine that is smooth in the middle and whose rim holds exactly the water of its hollow, so that a drop
//! makes rings without lifting the puddle. (The drop's own water is not added: a puddle in the rain overflows or
//! drains.)
//!
//! Length: the hollow, 1.209 lengths wide, is the crater whose potential energy, pi/4 rho g R^4 + pi sigma R^2 for a
//! half sphere, is a quarter of the drop's kinetic energy. Amplitude: the energy of the damped sine,
//! pi a^2 (3/16 rho g length^2 + 3/4 sigma), is [`wave_energy_fraction`](super::PuddleOptions::wave_energy_fraction)
//! of the drop's. The two fractions are chosen, not measured. Slopes and depths stay within the linear law: a is at
//! most half a length and half the depth, and a length is at least 1.25 cells.

#[cfg(feature = "wgpu")]
use downpour_math::bins::Bins;
use downpour_math::in_range;
use std::f64::consts::PI;
use std::sync::LazyLock;

use downpour_math::ops;
use downpour_shaders::lattice::puddle::{
    PUDDLE_SEED_BUMP, PUDDLE_SEED_CRATER, PUDDLE_SEED_HEIGHT, PUDDLE_SEED_SHIFT, PUDDLE_SEED_TURN,
};
use rayon::prelude::*;

use super::dispersion::Dispersion;
use super::lattice::Links;
use super::model::Model;
use crate::error::LatticeError;

/// Fraction of a drop's kinetic energy that opens the crater.
const CRATER_FRACTION: f64 = 0.25;
/// Radius of the hollow of a damped sine, in lengths.
const HOLLOW: f64 = 1.209_2;
/// Radius beyond which a damped sine is cut, in lengths.
const REACH: f64 = 6.0;
/// Craters that are worth a thread of their own.
const MIN_TOGETHER: usize = 32;
/// Minimum length, in cells.
const MIN_LENGTH_CELLS: f64 = 1.25;

/// A drop that hits the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Position, m from the corner of the first cell, along x and y.
    pub position_m: [f32; 2],
    /// Speed, m/s: 0 to 30.
    pub speed_m_s: f32,
    /// Diameter, m: up to 9e-3.
    pub diameter_m: f32,
}

/// A round object that moves through the surface: it presses the water down at its new position and releases it at the
/// old one. A sequence of steps makes a wake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wake {
    /// Previous position, m.
    pub from_m: [f32; 2],
    /// New position, m.
    pub to_m: [f32; 2],
    /// Radius of its footprint, m: at least 2 cells.
    pub radius_m: f32,
    /// Draft, the depth to which it presses the water down, m: up to the depth.
    pub draft_m: f32,
}

/// A crater or a bump, in the layout of `PuddleSeed` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PuddleSeed {
    /// Center, in cells from the corner of the first.
    pub center: [f32; 2],
    /// Inverse of the length, 1/cells.
    pub per_length: f32,
    /// Amplitude, m, upwards.
    pub amplitude: f32,
    /// Fraction of exp(-q) that compensates the volume lost to the cells, the border and the land.
    pub lift: f32,
    /// Radius in cells beyond which the seed is 0; below 0 for a bump.
    pub reach: f32,
}

/// Height of a seed of amplitude 1 without lift, at a distance in lengths.
#[must_use]
pub fn puddle_seed_shape(shape: u32, q: f32) -> f32 {
    shape_of(shape, q, ops::exp(-q))
}

/// The same where exp(-q) is known.
fn shape_of(shape: u32, q: f32, fall: f32) -> f32 {
    if shape == PUDDLE_SEED_BUMP {
        let hill = (1.0 - q * q).max(0.0);
        return hill * hill;
    }
    PUDDLE_SEED_HEIGHT * fall * ops::sin(PUDDLE_SEED_TURN * (q + PUDDLE_SEED_SHIFT))
}

/// Distance of a cell's middle from the center of a seed, in cells.
fn distance(seed: &PuddleSeed, cell: [f32; 2]) -> f32 {
    let [x, y] = [0, 1].map(|axis| cell[axis] + 0.5 - seed.center[axis]);
    (x * x + y * y).sqrt()
}

/// Height that a seed adds to a cell.
#[must_use]
pub fn puddle_seed_height(seed: &PuddleSeed, cell: [f32; 2]) -> f32 {
    let distance = distance(seed, cell);
    let q = distance * seed.per_length;
    if distance < seed.reach.abs() {
        let fall = ops::exp(-q);
        seed.amplitude * (shape_of(seed.shape(), q, fall) + seed.lift * fall)
    } else {
        0.0
    }
}

impl PuddleSeed {
    /// `PUDDLE_SEED_CRATER` or `PUDDLE_SEED_BUMP`.
    fn shape(&self) -> u32 {
        if self.reach < 0.0 { PUDDLE_SEED_BUMP } else { PUDDLE_SEED_CRATER }
    }

    /// Columns and rows of the cells that a seed may touch.
    fn cells(&self, size: [usize; 2]) -> [std::ops::Range<usize>; 2] {
        let reach = self.reach.abs();
        [0, 1].map(|axis| {
            // A cast from f32 saturates, and NaN becomes 0.
            let low = (self.center[axis] - reach).floor().max(0.0) as usize;
            let high = (self.center[axis] + reach).ceil().max(0.0) as usize;
            low.min(size[axis])..high.min(size[axis])
        })
    }

    /// Calls `visit` with the cells of water that the seed touches, row by row.
    pub(crate) fn visit(&self, links: &Links, mut visit: impl FnMut(usize, usize)) {
        let [columns, rows] = self.cells(links.size);
        for y in rows {
            for x in columns.clone() {
                if links.is_water(x, y) {
                    visit(x, y);
                }
            }
        }
    }

    /// Sums of the shape and of exp(-q) over the cells of water.
    fn sums(&self, links: &Links) -> [f64; 2] {
        let mut sums = [0.0; 2];
        let profile = match self.shape() {
            PUDDLE_SEED_BUMP => None,
            _ => Some(&*CRATER_PROFILE),
        };
        self.visit(links, |x, y| {
            let distance = distance(self, [x as f32, y as f32]);
            if distance < self.reach.abs() {
                let q = distance * self.per_length;
                let [height, fall] = match profile {
                    Some(profile) => profile.at(q),
                    None => {
                        let fall = ops::exp(-q);
                        [shape_of(self.shape(), q, fall), fall]
                    }
                };
                sums[0] += f64::from(height);
                sums[1] += f64::from(fall);
            }
        });
        sums
    }
}

/// The shape of a crater and exp(-q), linear between distances: within 1e-6 of them.
struct CraterProfile(Vec<[f32; 2]>);

/// Nodes of it in a length.
const NODES_PER_LENGTH: f32 = 1024.0;

static CRATER_PROFILE: LazyLock<CraterProfile> = LazyLock::new(|| {
    let node = |k: u16| {
        let q = f32::from(k) / NODES_PER_LENGTH;
        let fall = ops::exp(-q);
        [shape_of(PUDDLE_SEED_CRATER, q, fall), fall]
    };
    // One more than within reach.
    CraterProfile((0..=(REACH as f32 * NODES_PER_LENGTH) as u16 + 1).map(node).collect())
});

impl CraterProfile {
    /// Both at a distance in lengths, up to the reach of a crater.
    fn at(&self, q: f32) -> [f32; 2] {
        let at = q * NODES_PER_LENGTH;
        let node = (at as usize).min(self.0.len() - 2);
        let part = at - node as f32;
        let [near, far] = [self.0[node], self.0[node + 1]];
        [0, 1].map(|k| near[k] + (far[k] - near[k]) * part)
    }
}

/// Craters of impacts.
pub(crate) fn craters(model: &Model, impacts: &[Impact]) -> Result<Vec<PuddleSeed>, LatticeError> {
    impacts.par_iter().with_min_len(MIN_TOGETHER).map(|impact| crater(model, impact)).collect()
}

fn to_cells(model: &Model, position_m: [f32; 2]) -> Result<[f32; 2], LatticeError> {
    for v in position_m {
        in_range("position", f64::from(v), "m", &(-1.0e6..=1.0e6), 1.0, "-1e6 to 1e6 m")?;
    }
    Ok(position_m.map(|v| (f64::from(v) / model.cell()) as f32))
}

/// Length and depth, m, of the crater of a drop of a diameter (m) and a speed (m/s) on water of a law, of whose energy a part becomes
/// waves; the length is at least `min_length`.
pub(super) fn crater_shape(
    law: &Dispersion,
    wave_part: f64,
    [d, speed]: [f64; 2],
    min_length: f64,
) -> [f64; 2] {
    let water = &law.water;
    let weight = water.density * water.gravity;
    let energy = PI / 12.0 * water.density * d * d * d * speed * speed;
    // weight R^4 / 4 + sigma R^2 = fraction of the energy / pi
    let sigma = water.surface_tension;
    let square = 2.0 / weight * ((sigma * sigma + weight * CRATER_FRACTION * energy / PI).sqrt() - sigma);
    let length = (square.max(0.0).sqrt() / HOLLOW).max(min_length);
    let stiffness = PI * (3.0 / 16.0 * weight * length * length + 0.75 * sigma);
    [length, (wave_part * energy / stiffness).sqrt().min(0.5 * length).min(0.5 * law.depth)]
}

/// Diameter, m, and speed, m/s, of a drop that makes a crater.
pub(super) fn checked_drop(diameter_m: f64, speed_m_s: f64) -> Result<[f64; 2], LatticeError> {
    let d = in_range("diameter of a drop", diameter_m, "mm", &(1.0e-6..=9.001e-3), 1.0e3, "0.001 to 9 mm")?;
    let speed = in_range("speed of an impact", speed_m_s, "m/s", &(0.0..=30.0), 1.0, "0 to 30 m/s")?;
    Ok([d, speed])
}

fn crater(model: &Model, impact: &Impact) -> Result<PuddleSeed, LatticeError> {
    let center = to_cells(model, impact.position_m)?;
    let drop = checked_drop(f64::from(impact.diameter_m), f64::from(impact.speed_m_s))?;
    let wave_part = f64::from(model.options.wave_energy_fraction);
    let [length, amplitude] = crater_shape(&model.law, wave_part, drop, MIN_LENGTH_CELLS * model.cell());
    let length = length / model.cell();
    let mut seed = PuddleSeed {
        center,
        per_length: (1.0 / length) as f32,
        amplitude: -amplitude as f32,
        lift: 0.0,
        reach: (REACH * length) as f32,
    };
    let [shape, lift] = seed.sums(&model.links);
    if lift > 0.0 {
        seed.lift = (-shape / lift) as f32;
    }
    Ok(seed)
}

/// Bump at the old position of an object, and hollow at the new one, of the same volume.
pub(crate) fn footprints(model: &Model, wake: &Wake) -> Result<Vec<PuddleSeed>, LatticeError> {
    let (from, to) = (to_cells(model, wake.from_m)?, to_cells(model, wake.to_m)?);
    let radius = f64::from(wake.radius_m) / model.cell();
    let radius = in_range("radius of a footprint", radius, "cells", &(2.0..=4096.0), 1.0, "2 to 4096 cells")?;
    let draft = f64::from(wake.draft_m);
    in_range("draft", draft, "mm", &(0.0..=model.law.depth), 1.0e3, "0 to the depth of the water")?;
    let bump = |center, amplitude: f64| PuddleSeed {
        center,
        per_length: (1.0 / radius) as f32,
        amplitude: amplitude as f32,
        lift: 0.0,
        reach: -radius as f32,
    };
    let (left, made) = (bump(from, draft), bump(to, -draft));
    let (up, down) = (left.sums(&model.links)[0], made.sums(&model.links)[0]);
    if !(up > 0.0 && down > 0.0) {
        // The object enters or leaves the water: its displaced volume is not on the lattice, and no seed is made.
        return Ok(Vec::new());
    }
    Ok(vec![left, bump(to, -draft * up / down)])
}

/// Seeds sorted by squares of cells, in the layout of the shader.
#[cfg(feature = "wgpu")]
#[derive(Clone, Debug)]
pub(crate) struct SeedSquares {
    /// Index of the first entry of each square, and the end.
    pub(crate) first: Vec<u32>,
    /// Indices of seeds, in their order in each square.
    pub(crate) entries: Vec<u32>,
}

#[cfg(feature = "wgpu")]
impl SeedSquares {
    pub(crate) fn new(links: &Links, seeds: &[PuddleSeed]) -> Self {
        let edge = downpour_shaders::lattice::puddle::PUDDLE_SEED_SQUARE as usize;
        let across = links.stride().div_ceil(edge);
        let squares = across * links.size[1].div_ceil(edge);
        let Bins { starts, items } = Bins::new(squares, seeds.len() as u32, |number, touches| {
            let [columns, rows] = seeds[number as usize].cells(links.size);
            if columns.is_empty() || rows.is_empty() {
                return;
            }
            for y in rows.start / edge..=(rows.end - 1) / edge {
                for x in columns.start / edge..=(columns.end - 1) / edge {
                    touches(y * across + x);
                }
            }
        });
        Self { first: starts, entries: items }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_profile_of_a_crater_is_its_shape() {
        for k in 0..6000u16 {
            let q = f32::from(k) * 1.0e-3;
            let [height, fall] = CRATER_PROFILE.at(q);
            let exact = [puddle_seed_shape(PUDDLE_SEED_CRATER, q), ops::exp(-q)];
            let off = (height - exact[0]).abs().max((fall - exact[1]).abs());
            assert!(off < 1.0e-6, "{q}: {height} and {fall} in place of {exact:?}");
        }
    }
}
