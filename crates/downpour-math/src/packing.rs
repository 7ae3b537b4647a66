//! Unit vectors in two numbers of [-1, 1]: the octahedral map. Twin of `shaders/wgsl/common/packing.wgsl`.
//!
//! Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010; Z. Cigolle et al., JCGT 3(2), 2014.

use downpour_shaders::common::PACKING_SMALLEST_NORM;

/// The sign of `x` as 1 or -1; zero counts as positive.
#[inline]
#[must_use]
pub fn packing_sign(x: f32) -> f32 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

/// Direction (any length above 0) to the square [-1, 1]^2.
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
    let inverse = 1.0 / norm.max(PACKING_SMALLEST_NORM);
    let x = direction[0] * inverse;
    let y = direction[1] * inverse;
    if direction[2] >= 0.0 {
        return [x, y];
    }
    [(1.0 - y.abs()) * packing_sign(x), (1.0 - x.abs()) * packing_sign(y)]
}

/// Square to unit vector.
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
}
