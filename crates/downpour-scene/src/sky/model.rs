//! Skies by a formula.
//!
//! Overcast: P. Moon, D. E. Spencer, "Illumination from a non-uniform sky", Illuminating Engineering 37 (1942),
//! adopted by the CIE: at an elevation e the radiance is `Z (1 + 2 sin e) / 3`, with Z that of the zenith. Its
//! irradiance of the ground is `7 pi Z / 9`. Below the horizon it is black.

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
            rgb.map(|value| if value.is_finite() { value.clamp(0.0, super::MAX_RADIANCE) } else { 0.0 });
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
            let fraction = if row < ROWS / 2 { (1.0 + 2.0 * middle) / 3.0 } else { 0.0 };
            zenith.map(|value| narrowed(f64::from(value) * fraction))
        };
        Self { width: 1, height: ROWS, radiance: (0..ROWS).map(row).collect(), warnings: Vec::new() }
    }
}

impl SkyMap {
    /// The same sky above a ground with the albedo `albedo`, diffuse: below the
    /// horizon every pixel has `albedo E / pi`, with E the irradiance of a level surface.
    ///
    /// ```
    /// use downpour_scene::sky::SkyMap;
    /// let sky = SkyMap::overcast([9.0; 3]).with_ground(0.2);
    /// let ground = sky.radiance([0.3, -0.8, 0.1])[1];
    /// assert!((ground - 0.2 * 9.0 * 7.0 / 9.0).abs() < 1e-3); // Moon & Spencer: E = 7 pi Z / 9
    /// ```
    #[must_use]
    pub fn with_ground(mut self, albedo: f64) -> Self {
        let (columns, rows) = (self.width as usize, self.height);
        if columns == 0 {
            return self;
        }
        let mut irradiance = [0.0f64; 3];
        let polar = |row: u32| std::f64::consts::PI * f64::from(row) / f64::from(rows);
        let above =
            |row: u32| f64::midpoint(polar(row), polar(row.saturating_add(1))) < std::f64::consts::FRAC_PI_2;
        for (row, pixels) in (0u32..).zip(self.radiance.chunks(columns)) {
            if above(row) {
                // The integral of cos over a band of the sphere: half the difference of the squared sines of its edges.
                let square = |row: u32| {
                    let sine = ops::sin(polar(row).min(std::f64::consts::FRAC_PI_2));
                    sine * sine
                };
                let band =
                    std::f64::consts::PI * (square(row.saturating_add(1)) - square(row)) / columns as f64;
                for pixel in pixels {
                    for (sum, value) in irradiance.iter_mut().zip(pixel) {
                        *sum += f64::from(*value) * band;
                    }
                }
            }
        }
        let ground = irradiance.map(|e| narrowed(albedo.clamp(0.0, 1.0) * e / std::f64::consts::PI));
        for (row, pixels) in (0u32..).zip(self.radiance.chunks_mut(columns)) {
            if !above(row) {
                pixels.fill(ground);
            }
        }
        self
    }
}

/// The nearest `f32`.
#[expect(clippy::cast_possible_truncation, reason = "rounding is meant; the value is below MAX_RADIANCE")]
pub(super) fn narrowed(value: f64) -> f32 {
    value as f32
}
