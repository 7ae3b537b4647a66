//! Landing rain: number of drops per block of cells and tick, and their masses.

use std::f64::consts::PI;

use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::ops::f64 as ops;
use downpour_shaders::lattice::glass::{GLASS_LANDING_QUADS, GLASS_MAX_MASS};

use super::error::GlassError;
use super::lattice::UNIT_M3;
use super::options::GlassOptions;

/// Number of cells along an edge of a block in which landings are counted.
pub(super) const BLOCK: f64 = 16.0;

/// Mean number of drops per block and tick beyond which the count would be truncated.
pub(super) const MAX_PER_BLOCK: f64 = 0.5;

const STEPS: usize = 4000;
const MIN_DIAMETER_M: f64 = 0.2e-3;
const MAX_DIAMETER_M: f64 = 7.5e-3;

impl GlassOptions {
    /// Number of drops that land on a square meter of the pane per second, from rain, tilt and speed.
    ///
    /// # Errors
    /// [`GlassError::Rain`] if the rain is not valid.
    pub fn landings(&self) -> Result<f64, GlassError> {
        Ok(Landing::new(self)?.number)
    }
}

/// Rain that reaches the pane.
#[derive(Clone, Debug)]
pub(super) struct Landing {
    /// Number of drops per m^2 of the pane and s.
    pub(super) number: f64,
    /// Masses at 4096 equal steps of the cumulative number, in units.
    pub(super) masses: Vec<u32>,
}

impl Landing {
    /// Computes the landing rain. Drops of diameter D land at a rate of `N(D) (v(D) cos(tilt) + u sin(tilt))`: they
    /// fall at v while the air moves at u.
    pub(super) fn new(options: &GlassOptions) -> Result<Self, GlassError> {
        let fractions = 4 * GLASS_LANDING_QUADS as usize;
        let [least, most] = options.rain.diameters_m;
        let (smallest, largest) = (least.max(MIN_DIAMETER_M), most.min(MAX_DIAMETER_M));
        let diameters = DistributionOptions {
            min_diameter_m: smallest,
            max_diameter_m: largest,
            fall_speed: options.rain.fall_speed,
            air: options.rain.air,
        };
        let rain = DropSizeDistribution::with_options(options.rain.law, options.rain.rate_mm_h, &diameters)?;
        let speed = TerminalSpeed::new(options.rain.fall_speed, &options.rain.air);
        let (sin, cos) = (ops::sin(options.tilt_rad), ops::cos(options.tilt_rad));
        let width = (largest - smallest) / STEPS as f64;
        // Cumulative number and volume of landing drops up to a diameter.
        let mut sums = vec![(0.0, 0.0)];
        let (mut number, mut volume) = (0.0, 0.0);
        for step in 0..STEPS {
            let d = smallest + (step as f64 + 0.5) * width;
            let flux = rain.concentration(d)
                * (speed.at(d)? * cos + options.rain.towards_m_s * sin).max(0.0)
                * width;
            number += flux;
            volume += flux * PI / 6.0 * d * d * d;
            sums.push((number, volume));
        }
        let volume_to = |fraction: f64| {
            let at = fraction * number;
            let k = sums.partition_point(|&(n, _)| n < at).clamp(1, STEPS);
            match sums.get(k - 1..=k) {
                Some(&[(n0, v0), (n1, v1)]) if n1 > n0 => {
                    v0 + (v1 - v0) * ((at - n0) / (n1 - n0)).clamp(0.0, 1.0)
                }
                _ => volume,
            }
        };
        let mut masses = vec![1; fractions];
        if number > 0.0 {
            for (k, mass) in masses.iter_mut().enumerate() {
                let fraction = |k: usize| volume_to(k as f64 / fractions as f64);
                let mean = (fraction(k + 1) - fraction(k)) * fractions as f64 / number;
                *mass = (mean / UNIT_M3).round().clamp(1.0, f64::from(GLASS_MAX_MASS)) as u32;
            }
        }
        Ok(Self { number, masses })
    }

    /// Probability, in units of 2^-32, that a block gets at least 1 to 8 drops in a tick (Poisson).
    pub(super) fn limits(&self, cell_m: f64, tick_s: f64) -> [u32; 8] {
        let edge = BLOCK * cell_m;
        let mean = self.number * edge * edge * tick_s;
        let mut term = ops::exp(-mean);
        let mut below = term;
        std::array::from_fn(|k| {
            let at_least = (1.0 - below).max(0.0);
            term *= mean / (k as f64 + 1.0);
            below += term;
            (at_least * 4_294_967_296.0).round().min(4_294_967_295.0) as u32
        })
    }
}
