//! Ring of waves that one drop makes on open water, in closed form.
//!
//! Waves of low amplitude do not disturb one another, so that the water in the rain is the sum of the rings of its drops. The height
//! of one, at a distance r from its middle and a time t after the impact, is the Hankel transform
//!
//! > eta(r, t) = Int A(k) cos(omega(k) t) exp(-gamma(k) t) J0(k r) k dk
//!
//! of the crater that the drop opens (`seed`, whose transform at t = 0 is A), with the frequencies and the damping of the water
//! ([`PuddleOptions`]). This is the solution of A. L. Cauchy and S. D. Poisson for a surface that is let go (H. Lamb,
//! "Hydrodynamics", 6th edition, section 255), with surface tension, a ground and damping. The slope is its derivative along r.
//!
//! Errors: waves below 5 mm are left out, those below 7 mm in part. A drop from 1.5 mm on has less than 2 % of its waves there.

use std::f64::consts::TAU;

use downpour_math::ops::f64 as ops;
use downpour_shaders::lattice::puddle::{PUDDLE_SEED_HEIGHT, PUDDLE_SEED_TURN};

use super::model::PuddleOptions;
use super::seed::{checked_drop, crater_shape};
use crate::error::LatticeError;

/// Shortest wave, and the length from which waves are whole, m.
const MIN_WAVE_M: [f64; 2] = [5.0e-3, 7.0e-3];

/// Number of wave numbers.
const WAVES: u32 = 400;

/// A wave of a ring.
#[derive(Clone, Copy, Debug)]
struct Wave {
    /// Wave number, 1/m.
    number: f64,
    /// Angular frequency, 1/s.
    frequency: f64,
    /// Rate at which its amplitude decays, 1/s.
    decay: f64,
    /// A(k) k dk, m.
    amplitude: f64,
}

/// Ring of waves of a drop on open water.
///
/// ```
/// use downpour_lattice::puddle::{DropRing, PuddleOptions};
/// let ring = DropRing::new(&PuddleOptions::default(), 3.0e-3, 8.1)?;
/// // A drop leaves a hollow; a fifth of a second later the waves are on their way.
/// assert!(ring.height(0.0, 0.0) < -1.0e-3);
/// assert!(ring.height(0.06, 0.2).abs() > 1.0e-5 && ring.height(0.3, 0.2).abs() < 1.0e-5);
/// # Ok::<(), downpour_lattice::LatticeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DropRing {
    waves: Vec<Wave>,
    /// Step of the wave numbers, 1/m.
    step: f64,
}

impl DropRing {
    /// Creates the ring of a drop of a diameter (m, up to 9e-3) that falls with a speed (m/s, up to 30) on the water of `options`, whose
    /// lattice does not matter.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] names what is out of range.
    pub fn new(options: &PuddleOptions, diameter_m: f64, speed_m_s: f64) -> Result<Self, LatticeError> {
        options.check()?;
        let drop = checked_drop(diameter_m, speed_m_s)?;
        let law = options.law();
        let (drag, viscosity) = options.damping_rates(&law);
        let [length, depth] = crater_shape(&law, f64::from(options.wave_energy_fraction), drop, 1.0e-6);
        let last = TAU / MIN_WAVE_M[0];
        let step = last / f64::from(WAVES);
        let wave = |n: u32| {
            let k = step * (f64::from(n) + 0.5);
            let wavelength = TAU / k;
            let kept = ((wavelength - MIN_WAVE_M[0]) / (MIN_WAVE_M[1] - MIN_WAVE_M[0])).clamp(0.0, 1.0);
            let kept = kept * kept * (3.0 - 2.0 * kept);
            Wave {
                number: k,
                frequency: law.squared_frequency(k).sqrt(),
                decay: drag + 2.0 * viscosity * k * k,
                amplitude: -depth * crater_transform(k, length) * kept * k * step,
            }
        };
        Ok(Self { waves: (0..WAVES).map(wave).collect(), step })
    }

    /// Height over the level, m, at a distance from the middle (m) and a time after the impact (s).
    #[must_use]
    pub fn height(&self, distance_m: f64, time_s: f64) -> f64 {
        self.waves.iter().map(|wave| wave.at(time_s) * ops::bessel_j0(wave.number * distance_m)).sum()
    }

    /// Slope away from the middle at a distance from it (m) and a time after the impact (s).
    #[must_use]
    pub fn slope(&self, distance_m: f64, time_s: f64) -> f64 {
        let slope = |wave: &Wave| -wave.at(time_s) * wave.number * ops::bessel_j1(wave.number * distance_m);
        self.waves.iter().map(slope).sum()
    }

    /// Slopes at some times (s), and for each at whole multiples, below `count`, of a distance (m), in this order.
    #[must_use]
    pub fn slopes(&self, times_s: &[f64], step_m: f64, count: usize) -> Vec<f32> {
        let kernel: Vec<Vec<f64>> = (0..count)
            .map(|n| {
                let distance = n as f64 * step_m;
                self.waves.iter().map(|wave| -wave.number * ops::bessel_j1(wave.number * distance)).collect()
            })
            .collect();
        let of_time = |&time: &f64| -> Vec<f32> {
            let waves: Vec<f64> = self.waves.iter().map(|wave| wave.at(time)).collect();
            let slope = |row: &Vec<f64>| row.iter().zip(&waves).map(|(a, b)| a * b).sum::<f64>() as f32;
            kernel.iter().map(slope).collect()
        };
        times_s.iter().flat_map(of_time).collect()
    }

    /// Integral of the square of the slope over the surface, m^2, at a time after the impact (s).
    #[must_use]
    pub fn squared_slope(&self, time_s: f64) -> f64 {
        self.squared(|wave| wave.at(time_s))
    }

    /// The same in the mean over the periods of the waves.
    #[must_use]
    pub fn mean_squared_slope(&self, time_s: f64) -> f64 {
        0.5 * self.squared(|wave| wave.amplitude * ops::exp(-wave.decay * time_s))
    }

    /// Integral of the square of the slope over the surface, m^2, by the amplitudes of the waves.
    fn squared(&self, amplitude: impl Fn(&Wave) -> f64) -> f64 {
        // Parseval: Int S^2 r dr = Int (k A)^2 k dk.
        let square = |wave: &Wave| {
            let amplitude = amplitude(wave);
            amplitude * amplitude * wave.number / self.step
        };
        TAU * self.waves.iter().map(square).sum::<f64>()
    }
}

impl Wave {
    /// Its amplitude at a time.
    fn at(&self, time_s: f64) -> f64 {
        self.amplitude * ops::cos(self.frequency * time_s) * ops::exp(-self.decay * time_s)
    }
}

/// Hankel transform, m^2, of a crater 1 deep with a length L (m), for a wave number (1/m): Int shape(r / L) J0(k r) r dr.
///
/// The crater is the imaginary part of an exponential, whose transform is L^2 p / (p^2 + (k L)^2)^(3/2) with
/// p = 1 - i sqrt(3) (I. S. Gradshteyn and I. M. Ryzhik, "Table of Integrals", 6.623.2).
fn crater_transform(k: f64, length: f64) -> f64 {
    let root = f64::from(PUDDLE_SEED_TURN);
    let x = k * length;
    let [real, imaginary] = [1.0 - root * root + x * x, -2.0 * root];
    let (radius, angle) = (ops::hypot(real, imaginary), ops::atan2(imaginary, real));
    // p exp(i pi / 3) = 2.
    let transform = 2.0 * ops::pow(radius, -1.5) * ops::sin(-1.5 * angle);
    f64::from(PUDDLE_SEED_HEIGHT) * transform * length * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puddle::puddle_seed_shape;
    use downpour_shaders::lattice::puddle::PUDDLE_SEED_CRATER;

    #[test]
    fn the_transform_of_a_crater_is_its_integral() {
        let (length, step) = (4.0e-3, 0.01);
        for x in [0.0, 0.3, 1.0, 2.2, 5.0] {
            let at = |n: u32| {
                let q = (f64::from(n) + 0.5) * step;
                f64::from(puddle_seed_shape(PUDDLE_SEED_CRATER, q as f32)) * ops::bessel_j0(x * q) * q * step
            };
            let expected: f64 = (0..2000).map(at).sum();
            let found = crater_transform(x / length, length) / (length * length);
            assert!((found - expected).abs() < 1.0e-4, "{x}: {found}, {expected}");
        }
    }

    #[test]
    fn the_square_of_the_slope_is_that_of_its_values() {
        let ring = DropRing::new(&PuddleOptions::default(), 3.0e-3, 8.1).unwrap();
        for time in [0.0, 0.05, 0.2] {
            let step = 5.0e-4;
            let slopes = ring.slopes(&[time], step, 800);
            let sum: f64 = (0..)
                .zip(&slopes)
                .map(|(n, slope)| f64::from(n) * step * f64::from(slope * slope) * step)
                .sum();
            let ratio = TAU * sum / ring.squared_slope(time);
            assert!((ratio - 1.0).abs() < 0.01, "{time}: {ratio}");
            assert!((slopes[40] - ring.slope(0.02, time) as f32).abs() < 1.0e-6);
            assert!(time > 0.0 || ring.mean_squared_slope(time) * 2.0 == ring.squared_slope(time));
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_height() {
        let ring = DropRing::new(&PuddleOptions::default(), 2.0e-3, 6.5).unwrap();
        for (distance, time) in [(0.005, 0.0), (0.01, 0.04), (0.05, 0.15), (0.12, 0.4)] {
            let step = 1.0e-5;
            let slope =
                (ring.height(distance + step, time) - ring.height(distance - step, time)) / (2.0 * step);
            assert!((ring.slope(distance, time) - slope).abs() < 1.0e-5, "{distance}, {time}: {slope}");
        }
        assert!(DropRing::new(&PuddleOptions::default(), 0.02, 6.5).is_err());
        assert!(DropRing::new(&PuddleOptions::default(), 2.0e-3, f64::NAN).is_err());
    }
}
