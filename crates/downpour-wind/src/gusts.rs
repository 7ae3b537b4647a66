//! Gusts: fluctuations of the mean wind in speed and direction, the same everywhere.
//!
//! The fluctuation along the mean wind has Kaimal's spectrum (Kaimal et al. 1972, in the form of IEC 61400-1, annex B):
//!
//! ```text
//! f S(f) / sigma^2 = 4 x / (1 + 6 x)^(5/3),   x = f L / U
//! ```
//!
//! with sigma = intensity times the mean speed U, and the length scale L. The level component across the wind has the
//! same form with 0.8 sigma and L / 3, as in the standard. The spectrum is proportional to f^(-5/3) for large x, and
//! its integral is 1 - (1 + 6 x)^(-2/3), so each of [`WIND_GUST_MODES`] bands of frequency has exactly its fraction of
//! the variance; in each there is one sinusoid, at a random frequency with a random phase. The variance below and
//! above all bands, 0.7 % together, is in the first and the last.
//!
//! The sum is a function of (seed, time): any time in closed form, without steps. Amplitudes scale with the mean wind
//! of the time, so a calm has no gusts; the frequencies are those of its mean speed from the first key to the last.

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, seed_words};

use crate::error::WindError;

/// Number of sinusoids in each direction.
pub const WIND_GUST_MODES: usize = 32;

/// Lowest and highest x = f L / U of the bands.
const BANDS: (f64, f64) = (1.0e-3, 1.0e3);

/// sigma across the wind relative to sigma along it (IEC 61400-1).
pub const WIND_GUST_ACROSS: f64 = 0.8;

/// Length scale across the wind relative to that along it (IEC 61400-1: 2.7 / 8.1).
const LENGTH_ACROSS: f64 = 1.0 / 3.0;

/// Random stream, different from that of the turbulence.
const STREAM: u32 = 0x6775_7374;

/// Parameters of gusts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gusts {
    /// Turbulence intensity: standard deviation along the wind over the mean speed, 0 to 1.
    pub intensity: f64,
    /// Length scale L of the spectrum, 1 to 1e4 m.
    pub length: f64,
    /// Random seed; the same seed gives the same gusts.
    pub seed: u64,
}

impl Default for Gusts {
    /// 20 % and 100 m: open terrain, some meters above the ground.
    fn default() -> Self {
        Self { intensity: 0.2, length: 100.0, seed: 0 }
    }
}

/// A sinusoid of the gusts, relative to the mean wind: the real part of `along e^(i omega t)`, likewise across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GustMode {
    /// Angular frequency, rad/s.
    pub(crate) omega: f64,
    /// Real and imaginary part of the amplitude along, then across.
    pub(crate) amplitude: [f64; 4],
}

impl Gusts {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// [`WindError::OutOfRange`].
    pub fn check(&self) -> Result<(), WindError> {
        in_range("intensity of the gusts", self.intensity, "(a fraction)", &(0.0..=1.0), 1.0, "0 to 1")?;
        in_range("length of the gusts", self.length, "m", &(1.0..=1.0e4), 1.0, "1 to 1e4")?;
        Ok(())
    }

    /// S(f) of the fluctuation along the wind, m^2/s, at a frequency in Hz, for a mean speed in m/s.
    #[must_use]
    pub fn spectrum_along(&self, frequency: f64, mean_speed: f64) -> f64 {
        kaimal(frequency, mean_speed, self.intensity * mean_speed, self.length)
    }

    /// S(f) of the fluctuation across the wind, as [`Gusts::spectrum_along`].
    #[must_use]
    pub fn spectrum_across(&self, frequency: f64, mean_speed: f64) -> f64 {
        let sigma = WIND_GUST_ACROSS * self.intensity * mean_speed;
        kaimal(frequency, mean_speed, sigma, LENGTH_ACROSS * self.length)
    }

    /// Sinusoids in a wind of this mean speed, m/s; none in still air.
    pub(crate) fn modes(&self, mean_speed: f64) -> Vec<GustMode> {
        if self.intensity <= 0.0 || mean_speed <= 0.0 {
            return Vec::new();
        }
        let (low, high) = (ops::ln(BANDS.0), ops::ln(BANDS.1));
        let step = (high - low) / WIND_GUST_MODES as f64;
        (0..WIND_GUST_MODES)
            .map(|band| {
                let [position, along, across, _] =
                    rng_draw(seed_words(self.seed), band as u32, 0, STREAM).map(unit);
                let edge = |n: usize| match n {
                    0 => 0.0,
                    WIND_GUST_MODES => f64::INFINITY,
                    _ => ops::exp(low + step * n as f64),
                };
                let (from, to) = (edge(band), edge(band + 1));
                let amplitude = |sigma: f64, length: f64, turns: f64| {
                    let fraction = below(to * length) - below(from * length);
                    let amplitude = sigma * (2.0 * fraction).sqrt();
                    let angle = std::f64::consts::TAU * turns;
                    [amplitude * ops::cos(angle), amplitude * ops::sin(angle)]
                };
                let x = ops::exp(low + step * (band as f64 + position));
                let [a, b] = amplitude(self.intensity, 1.0, along);
                let [c, d] = amplitude(WIND_GUST_ACROSS * self.intensity, LENGTH_ACROSS, across);
                let omega = std::f64::consts::TAU * x * mean_speed / self.length;
                GustMode { omega, amplitude: [a, b, c, d] }
            })
            .collect()
    }
}

/// Maps a word to a number in [0, 1), a multiple of 2^-32.
pub(crate) fn unit(word: u32) -> f64 {
    f64::from(word) / 4_294_967_296.0
}

/// Kaimal's spectrum, m^2/s.
fn kaimal(frequency: f64, mean_speed: f64, sigma: f64, length: f64) -> f64 {
    let per_hertz = length / mean_speed;
    4.0 * sigma * sigma * per_hertz / ops::pow(1.0 + 6.0 * frequency * per_hertz, 5.0 / 3.0)
}

/// Fraction of Kaimal's variance below x.
fn below(x: f64) -> f64 {
    1.0 - ops::pow(1.0 + 6.0 * x, -2.0 / 3.0)
}
