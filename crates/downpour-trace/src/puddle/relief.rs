//! Unevenness of paved ground, which models of streets do not have.
//!
//! Law: the power of the heights of roads falls as the square of the wavenumber (ISO 8608, waviness 2), so that each octave
//! has half of the variance of the one that is twice as long. Between 0.5 and 8 m the standard's class A (very good) has
//! an rms of 1.1 mm, B (good) 2.2 mm, C (average) 4.4 mm.

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit, seed_words};
use glam::Vec2;

/// The longest wave, m.
const MAX_WAVELENGTH_M: f32 = 8.0;

/// Octaves: the shortest wave is 0.5 m.
const OCTAVES: u32 = 5;

/// Variance of noise of uniform values between -1 and 1 at the corners of squares, mixed by quintic weights.
const SQUARE_MEAN: f32 = 0.204_6;

/// Dimension of the random numbers.
const DIMENSION: u32 = 4_300;

/// Unevenness of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// Root mean square of the height, m.
    pub rms_m: f32,
    /// Seed: another seed gives another ground.
    pub seed: u64,
}

impl Relief {
    /// Height at a position of the horizontal plane, m.
    #[must_use]
    pub fn height(&self, position_m: Vec2) -> f32 {
        if self.rms_m <= 0.0 {
            return 0.0;
        }
        let seed = seed_words(self.seed);
        // 1 + 1/2 + 1/4 + ...
        let whole = 2.0 - ops::exp2(1.0 - OCTAVES as f32);
        let mut sum = 0.0;
        let mut wave = MAX_WAVELENGTH_M;
        let mut fraction = 1.0;
        for octave in 0..OCTAVES {
            // Turned from octave to octave, so that the squares do not show.
            let angle = 0.9 * octave as f32 + 0.3;
            let turned = Vec2::new(ops::cos(angle), ops::sin(angle)).rotate(position_m);
            // A square is half a wave.
            sum += (fraction / SQUARE_MEAN).sqrt() * noise(turned / (0.5 * wave), seed, octave);
            wave *= 0.5;
            fraction *= 0.5;
        }
        sum * self.rms_m / whole.sqrt()
    }
}

/// Values between -1 and 1 at integer positions, interpolated between them.
fn noise(at: Vec2, seed: [u32; 2], octave: u32) -> f32 {
    let corner = at.floor();
    let part = at - corner;
    let weight = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let value = |dx: i32, dy: i32| {
        let cell = [(corner.x as i32).wrapping_add(dx), (corner.y as i32).wrapping_add(dy)];
        let [word, ..] = rng_draw(seed, cell[0] as u32, cell[1] as u32, DIMENSION + octave);
        2.0 * rng_unit(word) - 1.0
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    mix(mix(value(0, 0), value(1, 0), weight.x), mix(value(0, 1), value(1, 1), weight.x), weight.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variance(values: impl Iterator<Item = f32>) -> f64 {
        let (sum, count) =
            values.fold((0.0, 0u32), |(sum, count), v| (sum + f64::from(v) * f64::from(v), count + 1));
        sum / f64::from(count)
    }

    #[test]
    fn heights_have_the_rms_that_is_asked() {
        let relief = Relief { rms_m: 2.2e-3, seed: 5 };
        let heights =
            (0..90_000).map(|i| relief.height(Vec2::new((i % 300) as f32, (i / 300) as f32) * 1.37));
        let rms = variance(heights).sqrt();
        assert!((rms / 2.2e-3 - 1.0).abs() < 0.05, "{rms}");
        assert_eq!(Relief { rms_m: 0.0, seed: 5 }.height(Vec2::new(3.0, 4.0)), 0.0);
    }

    /// Of a power that falls as the square of the wavenumber the mean square of differences grows as the distance.
    #[test]
    fn differences_grow_as_the_root_of_the_distance() {
        let relief = Relief { rms_m: 1.0, seed: 11 };
        let differences = |apart: f32| {
            variance((0..40_000).map(|i| {
                let position = Vec2::new((i % 200) as f32, (i / 200) as f32) * 0.731;
                relief.height(position + Vec2::new(apart, 0.0)) - relief.height(position)
            }))
        };
        let growth = differences(1.6) / differences(0.4);
        assert!((3.0..5.2).contains(&growth), "{growth}");
    }
}
