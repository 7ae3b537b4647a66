//! Impacts of rain on a surface, drawn from the rate and the sizes of the drops.
//!
//! Drops cross a horizontal plane as N(D) v(D) (`downpour_drop::distribution`); on an area A in a time dt their number
//! is Poisson distributed with the mean A dt Int N v dD, and their positions are uniform. Numbers are hashes of (seed,
//! step): any step can be drawn alone, in any order.

use downpour_drop::distribution::{DropSizeDistribution, SampleTable, SampledBy};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::in_range;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};

use super::seed::Impact;
use crate::error::LatticeError;

/// Maximum mean of a single Poisson draw, whose probability of 0 is far above the smallest number.
const MAX_MEAN: f64 = 8.0;

/// Classes of diameters in a factor of two, for the energy of the smallest drops.
const CLASSES_PER_OCTAVE: f64 = 32.0;

/// Maximum number of impacts of one call.
const MAX_IMPACTS: f64 = 1.0e6;

/// Impacts of a rain.
#[derive(Clone, Debug)]
pub struct PuddleRain {
    seed: [u32; 2],
    sizes: SampleTable,
    speed: TerminalSpeed,
    /// Impacts per m^2 and s.
    rate: f64,
    /// Smallest drop whose impact is told, m.
    smallest_m: f32,
}

impl PuddleRain {
    /// Creates the impacts of a rain.
    ///
    /// ```
    /// use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
    /// use downpour_lattice::puddle::PuddleRain;
    /// let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0)?;
    /// let rain = PuddleRain::new(&rain, 7);
    /// let impacts = rain.impacts([0.5, 0.5], 0, 1.0 / 60.0)?;
    /// assert!(impacts.iter().all(|impact| impact.position_m[0] < 0.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn new(rain: &DropSizeDistribution, seed: u64) -> Self {
        Self {
            seed: seed_words(seed),
            sizes: rain.sample_table(SampledBy::Flux),
            speed: TerminalSpeed::new(rain.options().fall_speed, &rain.options().air),
            rate: rain.impact_rate(),
            smallest_m: 0.0,
        }
    }

    /// The same impacts of a rain without those of its smallest drops, which together bring no more than a part of the kinetic energy, 0
    /// to 1: they are most of all drops.
    #[must_use]
    pub fn without_weakest(self, rain: &DropSizeDistribution, part: f64) -> Self {
        let energy = |[low, high]: [f64; 2]| {
            let diameter = 0.5 * (low + high);
            let speed = self.speed.at(diameter).unwrap_or(0.0);
            let [cubed, speed_cubed] = [diameter, speed].map(|x| x * x * x);
            rain.concentration(diameter) * cubed * speed_cubed * (high - low)
        };
        let classes = rain.diameter_classes(CLASSES_PER_OCTAVE);
        let whole: f64 = classes.iter().copied().map(energy).sum();
        let mut sum = 0.0;
        let first_told = classes.iter().find(|class| {
            sum += energy(**class);
            sum > part * whole
        });
        Self { smallest_m: first_told.map_or(0.0, |class| class[0] as f32), ..self }
    }

    /// Impacts per m^2 and s, those that are left out among them.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Impacts of step `step`, `dt_s` long, on an area of `extent_m`. The same step has the same impacts.
    ///
    /// # Errors
    /// [`LatticeError::OutOfRange`] if the extent or the time is not finite or below 0, or more than a million impacts
    /// are expected.
    pub fn impacts(&self, extent_m: [f32; 2], step: u64, dt_s: f32) -> Result<Vec<Impact>, LatticeError> {
        let [width, height] = extent_m.map(f64::from);
        for edge in [width, height] {
            in_range("extent of a puddle", edge, "m", &(0.0..=1.0e5), 1.0, "0 to 1e5 m")?;
        }
        let dt = in_range("time step", f64::from(dt_s), "s", &(0.0..=1.0e3), 1.0, "0 to 1000 s")?;
        let mean = self.rate * width * height * dt;
        in_range("expected number of impacts", mean, "", &(0.0..=MAX_IMPACTS), 1.0, "up to 1e6 in a step")?;
        // The high word of the step is added to the seed.
        let [low, high] = [step as u32, (step >> 32) as u32];
        let [a, b, ..] = rng_draw(self.seed, high, 0, 0);
        let seed = [a, b];
        let parts = (mean / MAX_MEAN).ceil().max(1.0) as u32;
        let each = mean / f64::from(parts);
        let count: u32 = (0..parts).map(|part| poisson(each, rng_draw(seed, part, low, 1))).sum();
        Ok((0..count).filter_map(|id| self.impact(extent_m, rng_draw(seed, id, low, 2))).collect())
    }

    fn impact(&self, extent_m: [f32; 2], words: [u32; 4]) -> Option<Impact> {
        let diameter_m = self.sizes.sample(words[2]);
        if diameter_m < self.smallest_m {
            return None;
        }
        let speed = self.speed.at(f64::from(diameter_m)).ok()?;
        let position_m = [rng_unit(words[0]) * extent_m[0], rng_unit(words[1]) * extent_m[1]];
        Some(Impact { position_m, speed_m_s: speed as f32, diameter_m })
    }
}

/// Draws a Poisson number by inversion.
fn poisson(mean: f64, words: [u32; 4]) -> u32 {
    // 53 bits in [0, 1).
    let bits = u64::from(words[0]) << 21 | u64::from(words[1]) >> 11;
    let unit = bits as f64 / (1u64 << 53) as f64;
    let mut probability = ops::exp(-mean);
    let mut below = probability;
    let mut count = 0;
    // The probability falls below rounding long before 100 for means up to 8.
    while unit >= below && count < 100 {
        count += 1;
        probability *= mean / f64::from(count);
        below += probability;
    }
    count
}
