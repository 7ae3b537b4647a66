//! Rain that lands: how many drops a block of cells gets in a tick, and how heavy they are.

use std::f64::consts::PI;

use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::ops::f64 as ops;
use downpour_shaders::lattice::glass::{GLASS_LANDING_QUADS, GLASS_LARGEST};

use super::error::GlassError;
use super::lattice::UNIT_M3;
use super::options::GlassOptions;

/// Cells along an edge of a block in which landings are counted.
pub(super) const BLOCK: f64 = 16.0;

/// Drops in a block and tick beyond which the count would be cut.
pub(super) const MOST_PER_BLOCK: f64 = 0.5;

const STEPS: usize = 4000;
const SMALLEST_M: f64 = 0.2e-3;
const LARGEST_M: f64 = 7.5e-3;

impl GlassOptions {
    /// Drops that land on a square metre of the pane in a second, as rain, tilt and speed have it.
    ///
    /// # Errors
    /// [`GlassError::Rain`] if the rain is not possible.
    pub fn landings(&self) -> Result<f64, GlassError> {
        Ok(Landing::new(self)?.number)
    }
}

/// Rain as the pane gets it.
#[derive(Clone, Debug)]
pub(super) struct Landing {
    /// Drops per m^2 of the pane and s.
    pub(super) number: f64,
    /// Masses at 4096 equal shares of the number, in units.
    pub(super) masses: Vec<u32>,
}

impl Landing {
    /// A drop of diameter D lands as often as `N(D) (v(D) cos(tilt) + u sin(tilt))`: it falls at v while the air that holds
    /// it comes at u.
    pub(super) fn new(options: &GlassOptions) -> Result<Self, GlassError> {
        let shares = 4 * GLASS_LANDING_QUADS as usize;
        let [least, most] = options.rain.diameters_m;
        let (smallest, largest) = (least.max(SMALLEST_M), most.min(LARGEST_M));
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
        // Number and volume that land of drops up to a diameter.
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
        let volume_to = |share: f64| {
            let at = share * number;
            let k = sums.partition_point(|&(n, _)| n < at).clamp(1, STEPS);
            match sums.get(k - 1..=k) {
                Some(&[(n0, v0), (n1, v1)]) if n1 > n0 => {
                    v0 + (v1 - v0) * ((at - n0) / (n1 - n0)).clamp(0.0, 1.0)
                }
                _ => volume,
            }
        };
        let mut masses = vec![1; shares];
        if number > 0.0 {
            for (k, mass) in masses.iter_mut().enumerate() {
                let share = |k: usize| volume_to(k as f64 / shares as f64);
                let mean = (share(k + 1) - share(k)) * shares as f64 / number;
                *mass = (mean / UNIT_M3).round().clamp(1.0, f64::from(GLASS_LARGEST)) as u32;
            }
        }
        Ok(Self { number, masses })
    }

    /// Probability, of 2^32, that a block gets at least 1 to 8 drops in a tick (Poisson).
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
