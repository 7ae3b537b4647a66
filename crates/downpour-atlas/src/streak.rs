//! The streaks of one drop from one elevation, for any number of lights.
//!
//! Law: with G(x, Y) the radiance of the picture at a fixed point Y along the streak, integrated over the passage of
//! the drop, a texel is G over the time of a fall by two equivalent radii. A point y of the drop is at
//! Y when the center is y beyond it, so the row of its center's phase takes the shape at the phase
//! y a / (v cos(elevation) T) later. a: equivalent radius, v: fall speed, T: period of the mode (2,0).
//!
//! The amount of a streak is its light without its pattern: the radiance of a disk of the equivalent radius that sends as much
//! light to the viewer as the drop does. With the mean m of the texels and the half extent h it is 4 h m / pi.

use downpour_math::{OutOfRange, in_range};
use std::f64::consts::{PI, TAU};

use downpour_drop::DropShape;
use downpour_drop::air::Air;
use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
use downpour_drop::oscillation::{DropInstant, Fluids, FrequencyLaw, OscillatingDrop, Oscillation};
use downpour_math::ops::f64 as ops;
use downpour_math::vector::dot;
use rayon::prelude::*;

use crate::AtlasError;
use crate::path::follow;
use crate::streak_frame;
use crate::surface::Surface;
use crate::{StreakOptions, StreakOscillation};

/// Number of instants per turn at which the shape is known.
const INSTANTS: u32 = 2048;
/// The R2 sequence: times of a texel's rays, spread over its row.
const TIME_STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The streaks of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Streaks {
    /// For each light, `rows * columns` texels, rows in time, columns from left to right.
    pub radiance: Vec<Vec<f32>>,
    /// Fraction of the time of two equivalent radii in which the drop covers the texel.
    pub coverage: Vec<f32>,
}

/// A drop that is ready to be traced.
#[derive(Clone, Debug)]
pub struct StreakTracer {
    options: StreakOptions,
    oscillation: StreakOscillation,
    instants: Vec<DropInstant>,
    inverse_radius: f64,
    /// Turns of the mode (2,0) in which the drop falls by its equivalent radius.
    turns_per_radius: f64,
}

impl StreakTracer {
    /// A drop of this diameter in meters.
    ///
    /// # Errors
    /// If the diameter is not in 0.05 to 9 mm, an amplitude not in 0 to 0.3, an angle not finite, or an option out of
    /// its range.
    pub fn new(
        diameter: f64,
        oscillation: &StreakOscillation,
        options: &StreakOptions,
    ) -> Result<Self, AtlasError> {
        options.check()?;
        for (quantity, found, unit) in [
            ("phase of an oscillation", oscillation.phase, "turns"),
            ("azimuth of an oscillation", oscillation.azimuth, "radians"),
        ] {
            if !found.is_finite() {
                return Err(AtlasError::OutOfRange(OutOfRange {
                    quantity,
                    found,
                    unit,
                    allowed: "a finite number".into(),
                }));
            }
        }
        let shape = DropShape::new(diameter)?;
        let rule = Oscillation::new(
            diameter,
            oscillation.amplitudes()?,
            &Fluids::AT_20_C,
            FrequencyLaw::Rayleigh1879,
        )?;
        let instants = (0..INSTANTS)
            .map(|k| {
                let turn = (f64::from(k) + 0.5) / f64::from(INSTANTS);
                let phases = [turn, 2.0 * turn + oscillation.phase];
                OscillatingDrop::new(shape, rule.with_phases(phases)).at(0.0, 0.0)
            })
            .collect();
        let speed = terminal_speed(FallSpeedModel::Beard1976, diameter, &Air::standard())?;
        let radius = 0.5 * diameter;
        Ok(Self {
            options: *options,
            oscillation: *oscillation,
            instants,
            inverse_radius: 1.0 / shape.equivalent_radius(),
            turns_per_radius: rule.frequency()[0] * radius / speed,
        })
    }

    /// Its streaks for a viewer `elevation` radians above the drop's horizontal plane, one for each direction toward
    /// the light, a unit vector in the frame of the streak. The same bits for any number of threads.
    ///
    /// # Errors
    /// If the elevation is more than 80 degrees up or down: the drop then hardly moves in the picture.
    pub fn trace(&self, elevation: f64, lights: &[[f64; 3]]) -> Result<Streaks, AtlasError> {
        Ok(self.rays(elevation, lights, &[])?.0)
    }

    /// Amounts of its streaks, in 1/sr for an irradiance of 1 across the light: one for each direction toward the light, as in
    /// [`StreakTracer::trace`] and by the same rays. It is far faster for many lights.
    ///
    /// # Errors
    /// As [`StreakTracer::trace`].
    pub fn amounts(&self, elevation: f64, lights: &[[f64; 3]]) -> Result<Vec<f64>, AtlasError> {
        Ok(self.rays(elevation, &[], lights)?.1)
    }

    /// Streaks for `lights`, and amounts for `amount_lights`, by one set of rays.
    fn rays(
        &self,
        elevation: f64,
        lights: &[[f64; 3]],
        amount_lights: &[[f64; 3]],
    ) -> Result<(Streaks, Vec<f64>), AtlasError> {
        let degrees = elevation.to_degrees();
        in_range("elevation of a streak", degrees, "degrees", &(-80.0..=80.0), 1.0, "-80 to 80")?;
        let frame = self.frame(elevation);
        let lights: Vec<[f64; 3]> = lights.iter().map(|&light| turned(&frame, light)).collect();
        let amount_lights: Vec<[f64; 3]> = amount_lights.iter().map(|&light| turned(&frame, light)).collect();
        let near = NearLights::new(&amount_lights, self.options.light_radius);
        let rows: Vec<(Vec<f64>, Vec<f64>)> = (0..self.options.rows)
            .into_par_iter()
            .map(|row| self.row(row, elevation, &lights, &near))
            .collect();
        let columns = self.options.columns as usize;
        let part = |k: usize| -> Vec<f32> {
            let of_row = |(row, _): &(Vec<f64>, Vec<f64>)| row[k * columns..(k + 1) * columns].to_vec();
            rows.iter().flat_map(of_row).map(|v| v as f32).collect()
        };
        let mut amounts = vec![0.0; amount_lights.len()];
        let texels = f64::from(self.options.columns) * f64::from(self.options.rows);
        let scale = 4.0 * self.options.half_extent / PI / texels;
        for (_, sums) in &rows {
            for (&light, sum) in near.numbers.iter().zip(sums) {
                amounts[light] += scale * sum;
            }
        }
        let radiance = (0..lights.len()).map(part).collect();
        Ok((Streaks { radiance, coverage: part(lights.len()) }, amounts))
    }

    /// A row of each light's streak, then one of the coverage; and the sums of the row for the lights of amounts.
    fn row(&self, row: u32, elevation: f64, lights: &[[f64; 3]], near: &NearLights) -> (Vec<f64>, Vec<f64>) {
        let StreakOptions { columns, rows, rays, half_extent, light_radius, refractive_index } = self.options;
        let across = columns * rays;
        let cell = 2.0 * half_extent / f64::from(across);
        let frame = self.frame(elevation);
        let lag = self.turns_per_radius / ops::cos(elevation);
        // A light with the radiance (1 - q / edge)^2, q = 1 - cos(angle), and the irradiance 1.
        let edge = 1.0 - ops::cos(light_radius);
        let peak = 3.0 / (TAU * edge);
        // Half of the integral over y, mean over the columns' rays.
        let weight = 0.5 * cell / f64::from(rays);
        let width = columns as usize;
        let mut sums = vec![0.0; (lights.len() + 1) * width];
        let mut amounts = vec![0.0; near.lights.len()];
        let towards = frame[2].map(|c| -c);
        for j in 0..across {
            let y = (f64::from(j) + 0.5) * cell - half_extent;
            for i in 0..across {
                let x = (f64::from(i) + 0.5) * cell - half_extent;
                let spread = f64::from(i) * TIME_STEPS[0] + f64::from(j) * TIME_STEPS[1];
                let turn = (f64::from(row) + spread.fract()) / f64::from(rows) + y * lag;
                let instant = ((turn - turn.floor()) * f64::from(INSTANTS)) as usize % INSTANTS as usize;
                let surface =
                    Surface { instant: &self.instants[instant], inverse_radius: self.inverse_radius };
                let column = (i / rays) as usize;
                let origin = turned(&frame, [x, y, 0.0]);
                let met = follow(&surface, refractive_index, origin, towards, |direction, fraction| {
                    for (k, light) in lights.iter().enumerate() {
                        let left = 1.0 - (1.0 - dot(direction, *light)) / edge;
                        if left > 0.0 {
                            sums[k * width + column] += weight * fraction * peak * left * left;
                        }
                    }
                    let (first, within) = near.about(direction);
                    for (light, amount) in within.iter().zip(&mut amounts[first..]) {
                        let left = 1.0 - (1.0 - dot(direction, *light)) / edge;
                        if left > 0.0 {
                            *amount += weight * fraction * peak * left * left;
                        }
                    }
                });
                if met {
                    sums[lights.len() * width + column] += weight;
                }
            }
        }
        (sums, amounts)
    }

    /// Frame of the streak in the drop's axes; +X is the direction of the lobes of the mode (3,1).
    fn frame(&self, elevation: f64) -> [[f64; 3]; 3] {
        let (sine, cosine) = (ops::sin(self.oscillation.azimuth), ops::cos(self.oscillation.azimuth));
        streak_frame(elevation).map(|[x, y, z]| [x * cosine - z * sine, y, x * sine + z * cosine])
    }
}

/// Lights in the order of their second coordinate, so that those near a direction are one range.
struct NearLights {
    lights: Vec<[f64; 3]>,
    /// For each of them its index in the caller's list.
    numbers: Vec<usize>,
    /// The longest chord from a direction to a light that it meets.
    reach: f64,
}

impl NearLights {
    fn new(lights: &[[f64; 3]], radius: f64) -> Self {
        let mut numbers: Vec<usize> = (0..lights.len()).collect();
        numbers.sort_by(|&a, &b| lights[a][1].total_cmp(&lights[b][1]));
        let lights = numbers.iter().map(|&k| lights[k]).collect();
        Self { lights, numbers, reach: 2.0 * ops::sin(0.5 * radius) }
    }

    /// The lights that may be within reach of a direction, and the index of the first.
    fn about(&self, direction: [f64; 3]) -> (usize, &[[f64; 3]]) {
        let first = self.lights.partition_point(|light| light[1] < direction[1] - self.reach);
        let rest = &self.lights[first..];
        let count = rest.partition_point(|light| light[1] <= direction[1] + self.reach);
        (first, &rest[..count])
    }
}

/// A vector of the frame among the axes in which the frame is given.
fn turned(frame: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| frame[0][k] * v[0] + frame[1][k] * v[1] + frame[2][k] * v[2])
}
