//! Chains of drops in integers: how many a column holds, the size and the speed of each, and how far it has fallen. Twin of the
//! functions of these names in `shaders/wgsl/sim/field.wgsl`, where the units are described.

use downpour_drop::distribution::{SampleTable, distribution_table_position};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::rng_draw;
use downpour_shaders::sim::field::{
    FIELD_CHAIN_COUNT, FIELD_DIAMETER_STEP, FIELD_PORTION_MEAN, FIELD_RATE_STEP, FIELD_THRESHOLDS,
};

/// Number of chains in a column: a Poisson number, as the sum of portions of a mean of 16 and a rest.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainCount {
    /// Number of whole portions.
    pub(crate) portions: u32,
    /// Cumulative probabilities of a whole portion and of the rest, in units of 2^-64.
    pub(crate) thresholds: [Vec<u64>; 2],
}

impl ChainCount {
    pub(crate) fn new(mean: f64) -> Self {
        let portions = (mean / f64::from(FIELD_PORTION_MEAN)).floor();
        let rest = mean - portions * f64::from(FIELD_PORTION_MEAN);
        let thresholds = [f64::from(FIELD_PORTION_MEAN), rest].map(thresholds);
        Self { portions: portions as u32, thresholds }
    }

    /// The number for a key. A larger mean gives no smaller number for the same key: heavier rain adds drops and moves none.
    pub(crate) fn field_count(&self, key: [u32; 2]) -> u32 {
        (0..=self.portions)
            .map(|portion| {
                let [high, low, ..] = rng_draw(key, portion, 0, FIELD_CHAIN_COUNT);
                let kind = usize::from(portion == self.portions);
                field_reached(&self.thresholds[kind], [high, low])
            })
            .sum()
    }
}

/// Cumulative probabilities of the Poisson numbers of a mean, in units of 2^-64.
fn thresholds(mean: f64) -> Vec<u64> {
    let mut probability = ops::exp(-mean);
    let mut cumulative = 0.0;
    (1..=FIELD_THRESHOLDS)
        .map(|count| {
            cumulative += probability;
            probability *= mean / f64::from(count);
            // A cast of what is too large gives the largest number.
            (cumulative * 18_446_744_073_709_551_616.0) as u64
        })
        .collect()
}

/// Number of thresholds below a number of two words, the high one first.
#[must_use]
pub fn field_reached(thresholds: &[u64], [high, low]: [u32; 2]) -> u32 {
    let word = u64::from(high) << 32 | u64::from(low);
    thresholds.partition_point(|&threshold| threshold < word) as u32
}

/// A part of a number, in units of 2^-16, rounded down in two pieces.
#[must_use]
pub fn field_part(whole: u32, part: u32) -> u32 {
    (whole >> 16) * part + (((whole & 0xffff) * part) >> 16)
}

/// A number between two others, by a fraction in units of 2^-16.
#[must_use]
pub fn field_between(a: u32, b: u32, part: u32) -> u32 {
    if b >= a { a + field_part(b - a, part) } else { a - field_part(a - b, part) }
}

/// Fraction of the distance from a node of the sizes to the next, in units of 2^-16.
#[must_use]
pub fn field_fraction(word: u32) -> u32 {
    // Exact: the fraction has no more bits than a number of f32.
    (distribution_table_position(word).fraction * 65536.0) as u32
}

/// Diameters and rates of fall of a class, at the nodes of its distribution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChainSizes {
    pub(crate) nodes: Vec<[u32; 2]>,
}

impl ChainSizes {
    pub(crate) fn new(sizes: &SampleTable, law: &TerminalSpeed, period: f64) -> Self {
        let node = |&diameter: &f32| {
            let units = (f64::from(diameter) / f64::from(FIELD_DIAMETER_STEP)).round();
            let speed = law.at(units * f64::from(FIELD_DIAMETER_STEP)).unwrap_or(0.0);
            [units as u32, (speed / period / f64::from(FIELD_RATE_STEP)).round() as u32]
        };
        Self { nodes: sizes.nodes().iter().map(node).collect() }
    }

    /// Diameter and rate of fall of a chain, by a random word.
    pub(crate) fn field_size(&self, word: u32) -> [u32; 2] {
        let index = distribution_table_position(word).index as usize;
        let part = field_fraction(word);
        match self.nodes.get(index..index + 2) {
            Some(&[a, b]) => [0, 1].map(|k| field_between(a[k], b[k], part)),
            _ => [0; 2],
        }
    }
}

/// A time as the shader has it: whole seconds and a fraction in units of 2^-32 s, of the absolute value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldTime {
    /// Whole seconds.
    pub seconds: u32,
    /// Fraction of a second, in units of 2^-32 s.
    pub fraction: u32,
    /// 1 for a time before 0.
    pub is_before: u32,
}

impl FieldTime {
    /// Converts a time in seconds, at most a million either way.
    #[must_use]
    pub fn new(time_s: f64) -> Self {
        let units = (time_s.abs() * 4_294_967_296.0).round() as u64;
        Self { seconds: (units >> 32) as u32, fraction: units as u32, is_before: u32::from(time_s < 0.0) }
    }
}

/// What goes on at a rate, in units of 2^-shift per second, up to a time: whole ones in two words, the high one first, and a fraction in
/// units of 2^-32. `shift`: 1 to 31.
#[must_use]
pub fn field_moved(rate: u32, shift: u32, time: FieldTime) -> [u32; 3] {
    let units = u128::from(u64::from(time.seconds) << 32 | u64::from(time.fraction));
    // In units of 2^-(32 + shift).
    let moved = (u128::from(rate) * units) >> shift;
    let moved = if time.is_before == 1 { moved.wrapping_neg() } else { moved };
    [(moved >> 64) as u32, (moved >> 32) as u32, moved as u32]
}

/// Difference of two numbers of three words, the high one first.
#[must_use]
pub fn field_difference(a: [u32; 3], b: [u32; 3]) -> [u32; 3] {
    let number = |words: [u32; 3]| words.iter().fold(0u128, |number, &word| number << 32 | u128::from(word));
    let difference = number(a).wrapping_sub(number(b));
    [(difference >> 64) as u32, (difference >> 32) as u32, difference as u32]
}

/// Periods that a chain has fallen at a time: whole ones, and a fraction in units of 2^-32.
#[must_use]
pub fn field_fallen(rate: u32, time: FieldTime) -> [u32; 2] {
    let [_, whole, fraction] = field_moved(rate, 29, time);
    [whole, fraction]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poisson::poisson_at;
    use downpour_drop::air::Air;
    use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw, SampledBy};
    use downpour_drop::fall_speed::FallSpeedModel;
    use downpour_shaders::sim::field::FIELD_FRACTION_STEP;

    #[test]
    fn units_are_powers_of_two() {
        let power = |exponent: u32| f32::from_bits((127 - exponent) << 23);
        let units = [FIELD_DIAMETER_STEP, FIELD_RATE_STEP, FIELD_FRACTION_STEP];
        assert_eq!(units, [power(30), power(29), power(32)]);
    }

    #[test]
    fn numbers_of_chains_are_poisson_numbers() {
        for mean in [1.0e-3, 0.3, 7.5, 15.99, 16.0, 33.0, 200.0] {
            let count = ChainCount::new(mean);
            for key in 0..2000 {
                let expected = poisson_at(mean, [key, 5], 0, FIELD_CHAIN_COUNT);
                assert_eq!(count.field_count([key, 5]), expected, "{mean}, {key}");
            }
        }
    }

    #[test]
    fn chains_fall_at_their_rate() {
        let rate = 0x2345_6789;
        for time_s in [0.0, 1.0e-9, 0.25, -0.25, 12.345, -12.345, 999_999.75, -999_999.75] {
            let [whole, part] = field_fallen(rate, FieldTime::new(time_s));
            let found = f64::from(whole as i32) + f64::from(part) / 4_294_967_296.0;
            let expected = f64::from(rate) / f64::from(1 << 29) * time_s;
            assert!(
                (found - expected).abs() < 3.0e-10 + 1.0e-15 * expected.abs(),
                "{time_s}: {found}, {expected}"
            );
        }
    }

    #[test]
    fn sizes_are_those_of_the_table_and_speeds_those_of_the_law() {
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0).unwrap();
        let law = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
        for [lower, upper] in rain.diameter_classes(4.0) {
            let table = rain.restricted_to(lower, upper).unwrap().sample_table(SampledBy::Number);
            let sizes = ChainSizes::new(&table, &law, 8.0);
            for k in 0..4096u32 {
                let word = k.wrapping_mul(0x9e37_79b9);
                let [units, rate] = sizes.field_size(word);
                let diameter = units as f32 * FIELD_DIAMETER_STEP;
                assert!((diameter - table.sample(word)).abs() < 3.0e-9, "{diameter}");
                let speed = f64::from(rate) * f64::from(FIELD_RATE_STEP) * 8.0;
                let expected = law.at(f64::from(diameter)).unwrap();
                // 1 nm of diameter, and a straight line between two nodes; at 1.07 mm the law jumps by 0.012 %.
                let tolerance = if (diameter - 1.07e-3).abs() < 5.0e-6 { 2.0e-4 } else { 3.0e-5 };
                assert!((speed / expected - 1.0).abs() < tolerance, "{diameter}: {speed}, {expected}");
            }
        }
    }
}
