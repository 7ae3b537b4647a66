//! Octahedral map: a unit vector as two numbers in [-1, 1]. Twin of `shaders/wgsl/common/packing.wgsl`.
//!
//! Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010; Z. Cigolle et al., JCGT 3(2), 2014.

use downpour_shaders::common::PACKING_MIN_NORM;
use half::f16;

/// Sign of `x` as 1 or -1; zero counts as positive.
#[inline]
#[must_use]
pub fn packing_sign(x: f32) -> f32 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

/// Maps a direction (any length above 0) to the square [-1, 1]^2.
///
/// ```
/// use downpour_math::packing::{packing_octahedral_decode, packing_octahedral_encode};
/// let down = packing_octahedral_decode(packing_octahedral_encode([0.0, -1.0, 0.0]));
/// assert_eq!(down, [0.0, -1.0, 0.0]);
/// ```
#[inline]
#[must_use]
pub fn packing_octahedral_encode(direction: [f32; 3]) -> [f32; 2] {
    let norm = direction[0].abs() + direction[1].abs() + direction[2].abs();
    let inverse = 1.0 / norm.max(PACKING_MIN_NORM);
    let x = direction[0] * inverse;
    let y = direction[1] * inverse;
    if direction[2] >= 0.0 {
        return [x, y];
    }
    [(1.0 - y.abs()) * packing_sign(x), (1.0 - x.abs()) * packing_sign(y)]
}

/// Maps a point of the square [-1, 1]^2 to a unit vector.
#[inline]
#[must_use]
pub fn packing_octahedral_decode(square: [f32; 2]) -> [f32; 3] {
    let z = 1.0 - square[0].abs() - square[1].abs();
    let fold = (-z).max(0.0);
    let x = square[0] - fold * packing_sign(square[0]);
    let y = square[1] - fold * packing_sign(square[1]);
    let inverse = 1.0 / (x * x + y * y + z * z).sqrt();
    [x * inverse, y * inverse, z * inverse]
}

/// Texel of an octahedral map of `size` texels along an edge. Beyond an edge, the map continues mirrored about the edge's middle.
///
/// ```
/// use downpour_math::packing::packing_octahedral_texel;
/// assert_eq!(packing_octahedral_texel(8, 3, 5), [3, 5]);
/// assert_eq!(packing_octahedral_texel(8, -1, 2), [0, 5]);
/// assert_eq!(packing_octahedral_texel(8, 8, 8), [0, 0]);
/// ```
#[inline]
#[must_use]
pub fn packing_octahedral_texel(size: u32, column: i32, row: i32) -> [u32; 2] {
    let edge = size as i32;
    let (mut x, mut y) = (column, row);
    if x < 0 || x >= edge {
        x = x.clamp(0, edge - 1);
        y = edge - 1 - y;
    }
    if y < 0 || y >= edge {
        y = y.clamp(0, edge - 1);
        x = edge - 1 - x;
    }
    [x.clamp(0, edge - 1) as u32, y.clamp(0, edge - 1) as u32]
}

/// Packs two numbers in [-1, 1] into 16 bits each, as WGSL's `pack2x16snorm`.
#[inline]
#[must_use]
pub fn packing_pack_snorm(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|v| u32::from((0.5 + 32767.0 * v.clamp(-1.0, 1.0)).floor() as i16 as u16));
    low | high << 16
}

/// Unpacks the result of [`packing_pack_snorm`], as WGSL's `unpack2x16snorm`.
#[inline]
#[must_use]
pub fn packing_unpack_snorm(word: u32) -> [f32; 2] {
    [word as u16, (word >> 16) as u16].map(|half| (f32::from(half as i16) / 32767.0).max(-1.0))
}

/// Packs two numbers in [0, 1] into 16 bits each, as WGSL's `pack2x16unorm`.
#[inline]
#[must_use]
pub fn packing_pack_unorm(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|v| u32::from((0.5 + 65535.0 * v.clamp(0.0, 1.0)).floor() as u16));
    low | high << 16
}

/// Unpacks the result of [`packing_pack_unorm`], as WGSL's `unpack2x16unorm`.
#[inline]
#[must_use]
pub fn packing_unpack_unorm(word: u32) -> [f32; 2] {
    [word as u16, (word >> 16) as u16].map(|half| f32::from(half) / 65535.0)
}

/// Unpacks both 16-bit floats of a word, as WGSL's `unpack2x16float`.
#[must_use]
pub fn packing_unpack_half(word: u32) -> [f32; 2] {
    [f16::from_bits(word as u16).to_f32(), f16::from_bits((word >> 16) as u16).to_f32()]
}

/// Packs two numbers as 16-bit floats, rounded to the nearest, as WGSL's `pack2x16float`.
#[must_use]
pub fn packing_pack_half(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| u32::from(f16::from_f32(x).to_bits()));
    low | high << 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_trip_over_the_sphere() {
        let n = 5000;
        for i in 0..n {
            // Fibonacci sphere.
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
            let phi = f64::from(i) * 2.399_963_229_728_653;
            let r = (1.0 - z * z).sqrt();
            let v = [r * crate::ops::f64::cos(phi), r * crate::ops::f64::sin(phi), z].map(|c| c as f32);
            let back = packing_octahedral_decode(packing_octahedral_encode(v));
            for k in 0..3 {
                assert!((back[k] - v[k]).abs() < 3.0e-7, "{v:?} -> {back:?}");
            }
        }
    }

    #[test]
    fn sixteen_bits_keep_the_ends_and_the_middle() {
        for pair in [[-1.0, 1.0], [0.0, 0.5], [-0.25, 2.0]] {
            let back = packing_unpack_snorm(packing_pack_snorm(pair));
            let whole = packing_unpack_unorm(packing_pack_unorm(pair));
            for k in 0..2 {
                assert!((back[k] - pair[k].clamp(-1.0, 1.0)).abs() <= 0.5 / 32767.0, "{pair:?} -> {back:?}");
                assert!((whole[k] - pair[k].clamp(0.0, 1.0)).abs() <= 0.5 / 65535.0, "{pair:?} -> {whole:?}");
            }
        }
        assert_eq!(packing_unpack_snorm(packing_pack_snorm([0.0, -1.0])), [0.0, -1.0]);
    }
}
