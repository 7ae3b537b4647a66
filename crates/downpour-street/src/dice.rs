//! Random choices that depend on nothing but a seed and a name.

use downpour_math::rng::{rng_pcg4d, rng_unit};

use crate::noise::mix;

/// A stream of random numbers, counted: the same for a seed and a stream on every machine.
#[derive(Clone, Debug)]
pub(crate) struct Dice {
    key: [u32; 3],
    next: u32,
}

impl Dice {
    /// The stream of a number, such as that of a house, under a seed.
    pub(crate) fn new(seed: u64, stream: u32) -> Self {
        Self { key: [seed as u32, (seed >> 32) as u32, stream], next: 0 }
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        let [a, b, c] = self.key;
        self.next += 1;
        rng_unit(rng_pcg4d([self.next, a, b, c ^ 0x57EE7])[0])
    }

    /// A number in [low, high).
    pub(crate) fn range(&mut self, low: f32, high: f32) -> f32 {
        mix(low, high, self.unit())
    }

    /// True with a probability.
    pub(crate) fn chance(&mut self, probability: f32) -> bool {
        self.unit() < probability
    }

    /// A whole number below a count of at least 1.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f32) as usize).min(count.saturating_sub(1))
    }

    /// One of a list that is not empty.
    pub(crate) fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// A color, lighter or darker by a fraction, and slightly shifted in hue.
    pub(crate) fn vary(&mut self, color: [f32; 3], fraction: f32) -> [f32; 3] {
        let tone = self.range(1.0 - fraction, 1.0 + fraction);
        let warm = self.range(-0.25, 0.25) * fraction;
        [color[0] * tone * (1.0 + warm), color[1] * tone, color[2] * tone * (1.0 - warm)]
            .map(|c| c.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_is_that_of_its_seed() {
        let throw = |seed, stream| {
            let mut dice = Dice::new(seed, stream);
            [0; 8].map(|_| dice.unit().to_bits())
        };
        assert_eq!(throw(7, 1), throw(7, 1));
        assert_ne!(throw(7, 1), throw(8, 1));
        assert_ne!(throw(7, 1), throw(7, 2));
        assert_ne!(throw(7, 1), throw(7 + (1 << 32), 1));
        let mut dice = Dice::new(3, 3);
        assert!((0..1000).all(|_| dice.below(5) < 5));
    }
}
