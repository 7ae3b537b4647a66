//! A clear sky: Preetham, Shirley & Smits 1999, "A practical analytic model for daylight", and its sun.
//!
//! Luminance and chromaticity are each `F(theta, gamma) / F(0, theta_s)` times that of the zenith with Perez' distribution
//! `F = (1 + A exp(B / cos theta)) (1 + C exp(D gamma) + E cos^2 gamma)` (their equation 3); theta is the angle from the zenith, gamma that
//! from the sun, `theta_s` the sun's angle from the zenith. Coefficients and zenith values are those of their appendix A.2. Valid for
//! turbidity 2 to 6 and a sun above the horizon. Their zenith makes the sky about twice as bright as measured ones are; only its
//! distribution and colors are used.
//!
//! Illuminances are those of the Illuminating Engineering Society's daylight calculation for clear skies at a sun's height h:
//! `E = 127.5 klx exp(-0.21 / sin h)` by the sun on a surface that faces it, and `E = 0.8 klx + 15.5 klx sqrt(sin h)` by the sky on
//! level ground.

use downpour_math::ops::f64 as ops;

/// Radius of the sun's disk, radians.
pub(super) const SUN_RADIUS: f64 = 0.004_65;

/// A clear sky.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClearSky {
    turbidity: f64,
    /// Unit vector to the sun.
    sun: [f64; 3],
    /// Luminance over that of the model.
    scale: f64,
}

/// Coefficients of Perez' distribution for luminance and chromaticity: each a factor of the turbidity and a constant.
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
    [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
    [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
];
/// Chromaticity of the zenith: for each power of the turbidity from 2 to 0, factors of powers of `theta_s` from 3 to 0.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ],
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ],
];

impl ClearSky {
    /// A sky of a turbidity with the sun at an elevation and an azimuth (0 along +X, 90 along +Z), degrees.
    pub(super) fn new(turbidity: f64, elevation_deg: f64, azimuth_deg: f64) -> Self {
        let (h, a) = (elevation_deg.to_radians(), azimuth_deg.to_radians());
        let flat = ops::cos(h);
        let sun = [flat * ops::cos(a), ops::sin(h), flat * ops::sin(a)];
        let model = Self { turbidity, sun, scale: 1.0 };
        let measured = 800.0 + 15_500.0 * sun[1].max(0.0).sqrt();
        Self { scale: measured / model.diffuse_lux(), ..model }
    }

    /// Illuminance of level ground by the sky alone, lux.
    fn diffuse_lux(&self) -> f64 {
        let (rows, columns) = (90, 180);
        let mut sum = 0.0;
        for row in 0..rows {
            let theta = (f64::from(row) + 0.5) / f64::from(rows) * std::f64::consts::FRAC_PI_2;
            for column in 0..columns {
                let phi = f64::from(column) / f64::from(columns) * std::f64::consts::TAU;
                let flat = ops::sin(theta);
                let d = [flat * ops::cos(phi), ops::cos(theta), flat * ops::sin(phi)];
                sum += self.luminance_xy(d)[0] * ops::cos(theta) * flat;
            }
        }
        sum * std::f64::consts::FRAC_PI_2 / f64::from(rows) * std::f64::consts::TAU / f64::from(columns)
    }

    /// Luminance (cd/m^2) and chromaticity of the zenith.
    fn zenith(&self) -> [f64; 3] {
        let t = self.turbidity;
        let s = ops::acos(self.sun[1].clamp(-1.0, 1.0));
        let chi = (4.0 / 9.0 - t / 120.0) * (std::f64::consts::PI - 2.0 * s);
        let luminance = (4.0453 * t - 4.9710) * ops::tan(chi) - 0.2155 * t + 2.4192;
        let chromaticity = ZENITH.map(|rows| {
            let of = |row: [f64; 4]| ((row[0] * s + row[1]) * s + row[2]) * s + row[3];
            (of(rows[0]) * t + of(rows[1])) * t + of(rows[2])
        });
        [luminance * 1000.0 * self.scale, chromaticity[0], chromaticity[1]]
    }

    /// Luminance (cd/m^2) and chromaticity toward a unit direction above the horizon; the sun's disk is not in it.
    fn luminance_xy(&self, direction: [f64; 3]) -> [f64; 3] {
        let up = direction[1].max(0.01);
        let cosine: f64 = direction.iter().zip(self.sun).map(|(a, b)| a * b).sum();
        let gamma = ops::acos(cosine.clamp(-1.0, 1.0));
        let sun_angle = ops::acos(self.sun[1].clamp(-1.0, 1.0));
        let zenith = self.zenith();
        std::array::from_fn(|k| {
            let [a, b, c, d, e] = PEREZ[k].map(|[slope, constant]| slope * self.turbidity + constant);
            let f = |cos_theta: f64, gamma: f64| {
                let near = ops::cos(gamma);
                (1.0 + a * ops::exp(b / cos_theta)) * (1.0 + c * ops::exp(d * gamma) + e * near * near)
            };
            zenith[k] * f(up, gamma) / f(1.0, sun_angle)
        })
    }

    /// Linear sRGB radiance, scaled so that its luminance is in cd/m^2; the sun's disk is not in it.
    pub(super) fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        let [luminance, x, y] = self.luminance_xy(direction);
        let (tx, tz) = (x / y * luminance, (1.0 - x - y) / y * luminance);
        // IEC 61966-2-1.
        let rows = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        rows.map(|[a, b, c]| (a * tx + b * luminance + c * tz).max(0.0))
    }

    /// Unit vector to the sun.
    pub(super) fn sun(&self) -> [f64; 3] {
        self.sun
    }

    /// Illuminance of a surface that faces the sun, lux.
    pub(super) fn sun_lux(&self) -> f64 {
        127_500.0 * ops::exp(-0.21 / self.sun[1].max(0.02))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By other directions, with a density of the cosine, and with the red, green and blue of a map.
    #[test]
    fn clear_skies_give_the_light_of_the_daylight_tables() {
        // Klx by the sky on level ground with a sun of 15, 30 and 60 degrees.
        for (elevation, wanted) in [(15.0, 8.69), (30.0, 11.76), (60.0, 15.22)] {
            let sky = ClearSky::new(2.5, elevation, 40.0);
            let (mut sum, count) = (0.0, 40_000);
            for k in 0..count {
                let phi = f64::from(k) * 2.399_963_229_728_653;
                let flat = ((f64::from(k) + 0.5) / f64::from(count)).sqrt();
                let d = [flat * ops::cos(phi), (1.0 - flat * flat).sqrt(), flat * ops::sin(phi)];
                let [r, g, b] = sky.radiance(d);
                sum += 0.2126 * r + 0.7152 * g + 0.0722 * b;
            }
            let found = sum / f64::from(count) * std::f64::consts::PI / 1000.0;
            assert!((found / wanted - 1.0).abs() < 0.03, "{elevation}: {found} of {wanted}");
        }
    }

    #[test]
    fn it_is_bright_about_the_sun_and_blue_away_from_it() {
        let sky = ClearSky::new(3.0, 20.0, 90.0);
        let sun = sky.radiance(sky.sun());
        let away = sky.radiance([0.0, 0.8, -0.6]);
        assert!(sun[1] > 5.0 * away[1], "{sun:?} {away:?}");
        assert!(away[2] > 1.5 * away[0], "{away:?}");
    }
}
