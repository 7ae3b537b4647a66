//! Drops that are too small on the picture, or too far, to be drawn one by one: how much they take out of what is behind them.

use downpour_drop::DropError;
use downpour_drop::distribution::DropSizeDistribution;
use downpour_math::ops::f64 as ops;
use downpour_shaders::render::rain::{DROPS_VEIL_NEAR, DROPS_VEIL_QUARTERS};

/// Entries of the table.
const ENTRIES: usize = 4 * DROPS_VEIL_QUARTERS as usize;

/// Bins of diameter per factor of two.
const BINS_PER_OCTAVE: f64 = 8.0;

/// The optical depth of such drops, by distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Veil {
    /// At 0.25 m, then a factor of 2^(1/3) farther each.
    depths: [f32; ENTRIES],
    /// What it grows by beyond, 1/m.
    pub(super) beyond: f32,
}

impl Veil {
    /// The veil of a rain whose drops are drawn up to a distance that depends on their diameter, both in metres.
    ///
    /// Law: a drop takes out twice its cross-section ([`DropSizeDistribution::extinction`]).
    ///
    /// # Errors
    /// [`DropError`] if the distribution cannot be cut.
    pub fn new(rain: &DropSizeDistribution, drawn_to: impl Fn(f64) -> f64) -> Result<Self, DropError> {
        if rain.rate_mm_h() <= 0.0 {
            return Ok(Self::default());
        }
        let options = rain.options();
        let (smallest, largest) = (options.smallest_diameter_m.max(1.0e-6), options.largest_diameter_m);
        let count = (ops::log2(largest / smallest) * BINS_PER_OCTAVE).ceil().max(1.0) as u32;
        let edge = |k: u32| {
            if k == count { largest } else { smallest * ops::pow(2.0, f64::from(k) / BINS_PER_OCTAVE) }
        };
        let mut depths = [0.0f64; ENTRIES];
        let mut beyond = 0.0;
        // A last sliver would be too thin a bin.
        for k in (0..count).filter(|&k| edge(k + 1) - edge(k) > 1.0e-6) {
            let part = rain.restricted_to(edge(k), edge(k + 1))?;
            let extinction = part.extinction();
            let drawn = drawn_to((edge(k) * edge(k + 1)).sqrt());
            beyond += extinction;
            for (entry, depth) in depths.iter_mut().enumerate() {
                let distance = f64::from(DROPS_VEIL_NEAR) * ops::pow(2.0, entry as f64 / 3.0);
                *depth += extinction * (distance - drawn).max(0.0);
            }
        }
        Ok(Self { depths: depths.map(|depth| depth as f32), beyond: beyond as f32 })
    }

    /// The table as the shader takes it.
    pub(super) fn table(&self) -> [[f32; 4]; DROPS_VEIL_QUARTERS as usize] {
        let mut table = [[0.0; 4]; DROPS_VEIL_QUARTERS as usize];
        for (entry, depth) in table.as_flattened_mut().iter_mut().zip(self.depths) {
            *entry = depth;
        }
        table
    }
}
