//! Skies by a formula.
//!
//! Overcast: P. Moon, D. E. Spencer, "Illumination from a non-uniform sky", Illuminating Engineering 37 (1942),
//! taken over by the CIE: at an elevation e the radiance is `Z (1 + 2 sin e) / 3`, with Z that of the zenith. It
//! lights the ground with `7 pi Z / 9`. Nothing comes from below the horizon.

use super::SkyMap;
use downpour_math::ops::f64 as ops;

/// Rows of a sky by a formula.
const ROWS: u32 = 256;

impl SkyMap {
    /// The same radiance from everywhere, below the horizon too. Numbers that are not finite or below 0 become 0.
    ///
    /// ```
    /// use downpour_scene::sky::SkyMap;
    /// let white = SkyMap::uniform([1.0, 1.0, 1.0]);
    /// assert_eq!(white.radiance([0.2, -0.3, 0.9]), [1.0; 3]);
    /// ```
    #[must_use]
    pub fn uniform(rgb: [f32; 3]) -> Self {
        let radiance =
            rgb.map(|value| if value.is_finite() { value.clamp(0.0, super::BRIGHTEST) } else { 0.0 });
        Self { width: 1, height: 1, radiance: vec![radiance], warnings: Vec::new() }
    }

    /// The overcast sky of Moon & Spencer, with this radiance at the zenith.
    ///
    /// Each of its 256 rows has the mean of the law over its band, so the mean over the sphere is exact.
    #[must_use]
    pub fn overcast(zenith: [f32; 3]) -> Self {
        let Self { radiance, .. } = Self::uniform(zenith);
        let [zenith] = radiance.as_slice() else { return Self::uniform(zenith) };
        let cosine = |row: u32| ops::cos(std::f64::consts::PI * f64::from(row) / f64::from(ROWS));
        let row = |row: u32| {
            // The mean of sin e = cos(polar angle) over a band is the mean of the cosines of its edges.
            let middle = f64::midpoint(cosine(row), cosine(row.saturating_add(1)));
            let share = if row < ROWS / 2 { (1.0 + 2.0 * middle) / 3.0 } else { 0.0 };
            zenith.map(|value| narrowed(f64::from(value) * share))
        };
        Self { width: 1, height: ROWS, radiance: (0..ROWS).map(row).collect(), warnings: Vec::new() }
    }
}

/// The nearest `f32`.
#[expect(clippy::cast_possible_truncation, reason = "rounding is meant; the value is below BRIGHTEST")]
pub(super) fn narrowed(value: f64) -> f32 {
    value as f32
}
