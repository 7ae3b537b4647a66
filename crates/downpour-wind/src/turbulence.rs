//! Turbulence: eddies carried by the mean wind. Twin of `shaders/wgsl/wind/turbulence.wgsl`.
//!
//! A sum of [`WIND_TURBULENCE_MODES`] plane waves with random phases (Kraichnan 1970), each with its velocity at right
//! angles to its wave vector, so that the sum has no divergence anywhere. Their energies are those of von Karman's
//! spectrum (von Karman 1948; constants as in Bailly, Juve 1999):
//!
//! ```text
//! E(k) = A sigma^2 / k_e (k / k_e)^4 / (1 + (k / k_e)^2)^(17/6)
//! k_e  = sqrt(pi) Gamma(5/6) / Gamma(1/3) / L                      = 0.7468 / L
//! A    = 55 Gamma(5/6) / (9 sqrt(pi) Gamma(1/3))                   = 1.4528
//! ```
//!
//! with sigma the standard deviation of each component and L the longitudinal integral length: the integral of E is 3/2
//! sigma^2, and above `k_e` it is proportional to k^(-5/3). The wave numbers are random within equal steps of log k,
//! from 0.1 to 1000 `k_e`, in directions spread evenly over the sphere. The field is frozen (Taylor 1938): at time t
//! it is that of time 0, translated by the displacement of the mean wind. Without mean wind it is static.
//!
//! A grid resolves waves of two cells or more: [`Turbulence::modes`] leaves out the shorter ones and their energy.

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, seed_words};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

use crate::error::WindError;
use crate::grid::WindGrid;
use crate::gusts::unit;

/// Number of waves.
pub const WIND_TURBULENCE_MODES: usize = 48;

/// Lowest and highest `k / k_e`.
const BANDS: (f64, f64) = (0.1, 1.0e3);

/// `k_e L`.
const PEAK: f64 = 0.746_834_200_222_186_6;

/// Random stream, different from that of the gusts.
const STREAM: u32 = 0x7475_7262;

/// Irrational steps that fill a cube evenly: the inverse powers of the root of x^4 = x + 1.
const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_9];

/// Parameters of turbulence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// Standard deviation of each component of the velocity, 0 to 50 m/s.
    pub speed: f64,
    /// Longitudinal integral length, 0.1 to 1e4 m.
    pub length: f64,
    /// Random seed; the same seed gives the same eddies.
    pub seed: u64,
}

impl Default for Turbulence {
    /// 1 m/s, 20 m.
    fn default() -> Self {
        Self { speed: 1.0, length: 20.0, seed: 0 }
    }
}

/// A wave in the layout of the shader, as `WindTurbulenceMode` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct WindTurbulenceMode {
    /// Wave vector, waves per meter along each axis.
    pub wave: [f32; 3],
    /// Phase in turns, 0 to 1, at the lower corner of the box.
    pub phase: f32,
    /// Velocity at the crest, m/s.
    pub amplitude: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding: u32,
}

/// A wave, independent of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurbulenceWave {
    /// Wave vector, waves per meter along each axis.
    pub wave: DVec3,
    /// Phase in turns at the origin at time 0, 0 to 1.
    pub phase: f64,
    /// Velocity at the crest, m/s, perpendicular to the wave vector.
    pub amplitude: DVec3,
}

impl Turbulence {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`].
    pub fn check(&self) -> Result<(), WindError> {
        in_range("speed of the turbulence", self.speed, "m/s", &(0.0..=50.0), 1.0, "0 to 50")?;
        in_range("length of the turbulence", self.length, "m", &(0.1..=1.0e4), 1.0, "0.1 to 1e4")?;
        Ok(())
    }

    /// E(k), m^3/s^2, at a wave number in rad/m.
    #[must_use]
    pub fn spectrum(&self, wave_number: f64) -> f64 {
        let peak = PEAK / self.length;
        let constant = 55.0 * ops::gamma(5.0 / 6.0) / (9.0 * PI.sqrt() * ops::gamma(1.0 / 3.0));
        constant * self.speed * self.speed / peak * shape(wave_number / peak)
    }

    /// All waves, from the longest to the shortest.
    #[must_use]
    pub fn waves(&self) -> Vec<TurbulenceWave> {
        let (low, high) = (ops::ln(BANDS.0), ops::ln(BANDS.1));
        let step = (high - low) / WIND_TURBULENCE_MODES as f64;
        let energies: Vec<f64> = (0..WIND_TURBULENCE_MODES)
            .map(|band| energy(low + step * band as f64, low + step * (band as f64 + 1.0)))
            .collect();
        let all: f64 = energies.iter().sum();
        let seed = seed_words(self.seed);
        let [u, v, w, _] = rng_draw(seed, u32::MAX, 0, STREAM).map(unit);
        energies
            .into_iter()
            .enumerate()
            .map(|(band, energy)| {
                let [position, phase, _, _] = rng_draw(seed, band as u32, 0, STREAM).map(unit);
                let number = ops::exp(low + step * (band as f64 + position)) * PEAK / self.length;
                let spread = |start: f64, k: usize| {
                    let x = start + band as f64 * STEPS.get(k).copied().unwrap_or(0.0);
                    x - x.floor()
                };
                let up = 2.0 * spread(u, 0) - 1.0;
                let (turn, side) = (TAU * spread(v, 1), TAU * spread(w, 2));
                let flat = (1.0 - up * up).max(0.0).sqrt();
                let direction = DVec3::new(flat * ops::cos(turn), up, flat * ops::sin(turn));
                let (a, b) = direction.any_orthonormal_pair();
                // Half of the squared amplitude is the wave's variance; all together have 3 sigma^2.
                let crest = self.speed * (6.0 * energy / all).sqrt();
                let amplitude = (a * ops::cos(side) + b * ops::sin(side)) * crest;
                TurbulenceWave { wave: direction * (number / TAU), phase, amplitude }
            })
            .collect()
    }

    /// Waves that a grid resolves, of two of its longest cells or more, displaced by the mean wind by `carried`, m.
    #[must_use]
    pub fn modes(&self, grid: &WindGrid, carried: DVec3) -> Vec<WindTurbulenceMode> {
        let shortest = 2.0 * f64::from(grid.cell().max_element());
        let corner = grid.low().as_dvec3() - carried;
        self.waves()
            .into_iter()
            .filter(|wave| wave.wave.length() * shortest <= 1.0)
            .map(|wave| {
                // In double precision here, so that neither a distant box nor a long time loses digits.
                let turns = wave.phase + wave.wave.dot(corner);
                WindTurbulenceMode {
                    wave: wave.wave.as_vec3().to_array(),
                    phase: (turns - turns.floor()) as f32,
                    amplitude: wave.amplitude.as_vec3().to_array(),
                    padding: 0,
                }
            })
            .collect()
    }
}

/// s^4 / (1 + s^2)^(17/6).
fn shape(s: f64) -> f64 {
    let squared = s * s;
    squared * squared / ops::pow(1.0 + squared, 17.0 / 6.0)
}

/// Integral of the shape between two values of ln s, by Simpson's rule on 8 steps: relative error 1e-6.
fn energy(from: f64, to: f64) -> f64 {
    let step = (to - from) / 8.0;
    let sum: f64 = (0..=8)
        .map(|k| {
            let weight = match k {
                0 | 8 => 1.0,
                _ => 2.0 + 2.0 * f64::from(k % 2),
            };
            let s = ops::exp(from + step * f64::from(k));
            weight * s * shape(s)
        })
        .sum();
    sum * step / 3.0
}

/// Cosine of an angle in turns.
#[must_use]
pub fn wind_turbulence_wave(turns: f32) -> f32 {
    // Half of the angle, -pi / 2 to pi / 2.
    let half = (turns - (turns + 0.5).floor()) * std::f32::consts::PI;
    let x = half * half;
    // Series of the sine: the next term is 6e-8 at most.
    let sine = half
        * (1.0
            - x * (0.16666667
                - x * (8.333_333e-3 - x * (1.984_127e-4 - x * (2.755_731_9e-6 - x * 2.505_210_8e-8)))));
    1.0 - 2.0 * sine * sine
}

/// Velocity of a wave, m/s; `offset` is from the lower corner of the box, m.
#[must_use]
pub fn wind_turbulence_velocity(mode: &WindTurbulenceMode, offset: Vec3) -> Vec3 {
    Vec3::from(mode.amplitude) * wind_turbulence_wave(Vec3::from(mode.wave).dot(offset) + mode.phase)
}
