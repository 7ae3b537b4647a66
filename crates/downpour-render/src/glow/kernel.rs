//! Laws of the angles by which light goes beside its image, as sums of Gaussians.

/// A sum of Gaussians over the angle from the image: standard deviation per axis, radians, and fraction of light.
#[derive(Clone, Debug, PartialEq)]
pub struct GlowKernel(pub Vec<[f64; 2]>);

/// Least standard deviation of glare, degrees, and the number of octaves from there on: 0.1 to 25.6.
const GLARE_DEG: f64 = 0.1;
const GLARE_OCTAVES: i32 = 9;

/// Standard deviations in the pattern of a disk, in units of wavelength / (pi diameter), and their fractions: fitted to `J0^2 + J1^2`,
/// the light beyond an angle (Rayleigh), with its mean `2 / (pi x)` beyond 6, within 0.06 of the light, and 5 % of itself from 7 to 300.
const DISK: [[f64; 2]; 6] =
    [[1.3, 0.81], [3.9, 0.1037], [11.7, 0.0518], [35.1, 0.0160], [105.3, 0.0046], [315.9, 0.0031]];

impl GlowKernel {
    /// Glare of lens or eye; `width` is a factor of its angles. The fractions sum to 1.
    ///
    /// A power law is a sum of Gaussians: with the weight `w(s)` per logarithm of the standard deviation `s`, in units of a solid angle,
    /// `angle^-3` needs `w = 2 pi / (sqrt 2 Gamma(3/2)) / s` and `angle^-2` needs `w = 2 pi`.
    #[must_use]
    pub fn glare(width: f64) -> Self {
        let cubic = std::f64::consts::TAU / (std::f64::consts::SQRT_2 * 0.886_226_925_452_758);
        let all: Vec<[f64; 2]> = (0..GLARE_OCTAVES)
            .map(|k| {
                let deviation = GLARE_DEG * f64::from(1u32 << k);
                [deviation, 10.0 * cubic / deviation + 5.0 * std::f64::consts::TAU]
            })
            .collect();
        let sum: f64 = all.iter().map(|[_, weight]| weight).sum();
        Self(
            all.into_iter()
                .map(|[deviation, weight]| [(deviation * width).to_radians(), weight / sum])
                .collect(),
        )
    }

    /// Diffraction by disks; `angle` is the wavelength over pi times their diameter, radians.
    #[must_use]
    pub fn disk(angle: f64) -> Self {
        let sum: f64 = DISK.iter().map(|[_, weight]| weight).sum();
        Self(DISK.map(|[deviation, weight]| [deviation * angle, weight / sum]).to_vec())
    }

    /// Standard deviation per axis, radians.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.0.iter().map(|[deviation, weight]| deviation * deviation * weight).sum::<f64>().sqrt()
    }

    /// Fractions of the light in kernels of given variances, above 0 and rising, per axis in pixels; `pixel` is the angle of a pixel, radians.
    /// A Gaussian between two of them is mixed from both, so that its variance is exact; one below the first is mixed with the image, and
    /// that part is left out.
    #[must_use]
    pub fn fractions(&self, variances: &[f64], pixel: f64) -> Vec<f64> {
        let mut fractions = vec![0.0; variances.len()];
        for [deviation, weight] in &self.0 {
            let variance = (deviation / pixel) * (deviation / pixel);
            let above = variances.partition_point(|&known| known <= variance);
            let below = if above == 0 { 0.0 } else { variances[above - 1] };
            let part = variances.get(above).map_or(0.0, |&known| (variance - below) / (known - below));
            if above > 0 {
                fractions[above - 1] += weight * (1.0 - part);
            }
            if let Some(fraction) = fractions.get_mut(above) {
                *fraction += weight * part;
            }
        }
        fractions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_math::ops::f64 as ops;

    /// Against the law of the CIE itself: ratios of luminance at pairs of angles.
    #[test]
    fn glare_follows_the_law_of_the_cie() {
        let kernel = GlowKernel::glare(1.0);
        let found = |angle_deg: f64| -> f64 {
            let angle = angle_deg.to_radians();
            let of = |[s, w]: &[f64; 2]| w * ops::exp(-0.5 * angle * angle / (s * s)) / (s * s);
            kernel.0.iter().map(of).sum()
        };
        let law = |angle: f64| 10.0 / (angle * angle * angle) + 5.0 / (angle * angle);
        for angle in [0.3, 0.5, 1.0, 2.0, 5.0, 10.0] {
            let ratio = found(angle) / found(1.0) / (law(angle) / law(1.0));
            assert!((ratio - 1.0).abs() < 0.06, "{angle} degrees: {ratio}");
        }
        assert!((kernel.0.iter().map(|[_, w]| w).sum::<f64>() - 1.0).abs() < 1.0e-12);
    }

    /// Against the integrals of Bessel's functions: the light beyond x is `J0^2 + J1^2`.
    #[test]
    fn the_pattern_of_a_disk_has_the_light_of_airys() {
        let bessel = |n: f64, x: f64| {
            let at = |k: i32| {
                let t = (f64::from(k) + 0.5) * std::f64::consts::PI / 4000.0;
                ops::cos(n * t - x * ops::sin(t))
            };
            (0..4000).map(at).sum::<f64>() / 4000.0
        };
        let kernel = GlowKernel::disk(1.0);
        let beyond =
            |x: f64| -> f64 { kernel.0.iter().map(|[s, w]| w * ops::exp(-0.5 * x * x / (s * s))).sum() };
        for x in [0.5, 1.0, 2.0, 3.0, 3.83, 5.0, 7.0, 12.0, 40.0] {
            let exact = bessel(0.0, x) * bessel(0.0, x) + bessel(1.0, x) * bessel(1.0, x);
            assert!((beyond(x) - exact).abs() < 0.05, "{x}: {} for {exact}", beyond(x));
        }
        // The first dark ring, 1.22 wavelengths over the diameter, has 83.8 % of the light within.
        assert!((beyond(1.22 * std::f64::consts::PI) - 0.162).abs() < 0.03);
    }

    #[test]
    fn fractions_keep_light_and_variance() {
        let kernel = GlowKernel(vec![[0.02, 0.5], [0.003, 0.25], [0.0001, 0.25]]);
        let variances = [1.5, 7.5, 31.5, 127.5, 511.5];
        let fractions = kernel.fractions(&variances, 0.001);
        let sum: f64 = fractions.iter().sum();
        let image = 0.25 * (1.0 - 0.01 / 1.5);
        assert!((sum - (1.0 - image)).abs() < 1.0e-12, "{sum}");
        let found: f64 = fractions.iter().zip(variances).map(|(w, v)| w * v).sum();
        assert!((found - 1.0e6 * kernel.deviation() * kernel.deviation()).abs() < 1.0e-9, "{found}");
    }
}
