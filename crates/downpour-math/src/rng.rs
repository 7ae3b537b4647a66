//! Counter-based random numbers: a number is a hash of (seed, id, step, dimension).
//!
//! There is no state, so numbers can be drawn in any order, by any number of threads, on a CPU or a GPU,
//! and at any time step, with the same bits. Twin of `shaders/wgsl/common/rng.wgsl`.
//!
//! Source: M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg4d).

use downpour_shaders::common::{RNG_PCG_INCREMENT, RNG_PCG_MULTIPLIER, RNG_UNIT_STEP};

/// Mixes four words: each bit of the result depends on each bit of the argument.
#[inline]
#[must_use]
pub fn rng_pcg4d(words: [u32; 4]) -> [u32; 4] {
    let v = words.map(|v| v.wrapping_mul(RNG_PCG_MULTIPLIER).wrapping_add(RNG_PCG_INCREMENT));
    rng_pcg4d_stir(rng_pcg4d_stir(v).map(|v| v ^ (v >> 16)))
}

/// One round of products between the words.
#[inline]
#[must_use]
pub fn rng_pcg4d_stir([mut x, mut y, mut z, mut w]: [u32; 4]) -> [u32; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// Four words for (64-bit seed as low and high word, id, step, dimension).
#[inline]
#[must_use]
pub fn rng_draw(seed: [u32; 2], id: u32, step: u32, dimension: u32) -> [u32; 4] {
    let [x, y, z, w] = rng_pcg4d([id, step, dimension, seed[0]]);
    let second = rng_pcg4d([x.wrapping_add(seed[1]), y, z, w.wrapping_add(dimension)]);
    // The high bits of the high seed word have passed through one hash only: one more round spreads them.
    rng_pcg4d_stir(second.map(|v| v ^ (v >> 16)))
}

/// Maps a word to a number in [0, 1), a multiple of 2^-24.
#[inline]
#[must_use]
pub fn rng_unit(word: u32) -> f32 {
    (word >> 8) as f32 * RNG_UNIT_STEP
}

/// Maps a word to a number in (0, 1], a multiple of 2^-24: safe under a logarithm.
#[inline]
#[must_use]
pub fn rng_unit_positive(word: u32) -> f32 {
    ((word >> 8) + 1) as f32 * RNG_UNIT_STEP
}

/// Splits a 64-bit seed into the low and high words that [`rng_draw`] takes.
///
/// ```
/// use downpour_math::rng::{rng_draw, rng_unit, seed_words};
/// let [x, y, z, _] = rng_draw(seed_words(7), 42, 0, 0).map(rng_unit);
/// assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y) && (0.0..1.0).contains(&z));
/// ```
#[inline]
#[must_use]
pub const fn seed_words(seed: u64) -> [u32; 2] {
    [seed as u32, (seed >> 32) as u32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stay_in_their_range() {
        assert_eq!(rng_unit(0), 0.0);
        assert!(rng_unit(u32::MAX) < 1.0);
        assert!(rng_unit_positive(0) > 0.0);
        assert_eq!(rng_unit_positive(u32::MAX), 1.0);
    }

    /// Each of the four outputs, over consecutive ids, steps, dimensions or seeds, is uniform: chi-square with
    /// 255 degrees of freedom stays below 340 (probability of exceeding it by chance: 3e-4 each).
    #[test]
    fn every_axis_is_uniform() {
        type Axis = fn(u32) -> [u32; 4];
        let axes: [Axis; 5] = [
            |i| rng_draw([1, 2], i, 3, 4),
            |i| rng_draw([1, 2], 3, i, 4),
            |i| rng_draw([1, 2], 3, 4, i),
            |i| rng_draw([i, 2], 3, 4, 5),
            |i| rng_draw([1, i], 3, 4, 5),
        ];
        for (a, axis) in axes.iter().enumerate() {
            for word in 0..4 {
                for shift in [24, 8] {
                    let mut bins = [0u32; 256];
                    let n = 1 << 18;
                    for i in 0..n {
                        bins[((axis(i)[word] >> shift) & 255) as usize] += 1;
                    }
                    let expected = f64::from(n) / 256.0;
                    let chi2: f64 = bins
                        .iter()
                        .map(|&b| (f64::from(b) - expected) * (f64::from(b) - expected) / expected)
                        .sum();
                    assert!(chi2 < 340.0, "axis {a}, word {word}, shift {shift}: chi2 = {chi2}");
                }
            }
        }
    }

    #[test]
    fn a_flipped_input_bit_flips_half_of_the_output() {
        for bit in 0..160 {
            let mut flipped = 0;
            let n = 400;
            for i in 0..n {
                let base = [i, i ^ 0x55, 7 * i, 11, 13];
                let mut other = base;
                other[bit / 32] ^= 1 << (bit % 32);
                let draw = |v: [u32; 5]| rng_draw([v[0], v[1]], v[2], v[3], v[4]);
                flipped += draw(base).iter().zip(draw(other)).map(|(a, b)| (a ^ b).count_ones()).sum::<u32>();
            }
            let mean = f64::from(flipped) / f64::from(n);
            assert!((55.0..73.0).contains(&mean), "input bit {bit}: {mean} of 128 bits change");
        }
    }
}
