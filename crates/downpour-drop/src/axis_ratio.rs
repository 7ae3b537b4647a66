//! Axis ratio, height over width, of a falling drop by published fits.
//!
//! d is the diameter of the sphere of equal volume: meters in the functions, millimeters in the formulas
//! here. The ratio is 1 for a sphere and falls with the size. [`DropShape`](crate::shape::DropShape) gives
//! the ratio of the whole shape; these are fits to models and measurements, for comparison and for users who
//! need a specific one.
//!
//! | model | formula | range here |
//! |---|---|---|
//! | K. V. Beard, C. Chuang, J. Atmos. Sci. 44, 1987 | `1.0048 + 5.7e-4 d - 2.628e-2 d^2 + 3.682e-3 d^3 - 1.677e-4 d^4` | 0.5 to 7 mm |
//! | K. Andsager, K. V. Beard, N. F. Laird, J. Atmos. Sci. 56, 1999 | `1.012 - 1.44e-2 d - 1.03e-2 d^2` in 1.1 to 4.4 mm, else the one above | 0.5 to 7 mm |
//! | M. Thurai et al., J. Atmos. Oceanic Technol. 24, 2007 | 1 below 0.7 mm, one polynomial to 1.5 mm, another above | 0.001 to 8 mm |
//! | E. A. Brandes, G. Zhang, J. Vivekanandan, J. Appl. Meteor. 41, 2002 | `0.9951 + 0.0251 d - 0.03644 d^2 + 0.005303 d^3 - 0.0002492 d^4` | 0.1 to 8 mm |
//! | H. R. Pruppacher, K. V. Beard, Q. J. R. Meteorol. Soc. 96, 1970 | `1.03 - 0.062 d` | 0.5 to 9 mm |
//! | A. W. Green, J. Appl. Meteor. 14, 1975 | a spheroid in balance, see [`green_1975`] | 0.001 to 9 mm |
//!
//! The first two were fitted to shapes of 1 to 7 mm; at 0.5 mm they meet the sphere within 0.2 %, above 7 mm
//! they fall too low. The branches of Andsager and Thurai do not meet at their joints: the steps, up to 0.6
//! %, are in the papers.

use downpour_math::in_range;
use downpour_math::ops;

use crate::DropError;
use crate::shape::check_diameter;

/// Surface tension of water at 20 C, in N/m (IAPWS R1-76).
const SURFACE_TENSION_20_C: f64 = 0.072736;
/// Density of water (998.204) minus that of air (1.204) at 20 C, in kg/m3.
const DENSITY_DIFFERENCE_20_C: f64 = 997.0;

/// A published model of the axis ratio.
///
/// ```
/// use downpour_drop::axis_ratio::AxisRatioModel;
/// let ratio = AxisRatioModel::Thurai2007.axis_ratio(3.0e-3)?;
/// assert!((ratio - 0.85896).abs() < 1e-5);
/// assert!(AxisRatioModel::BeardChuang1987.axis_ratio(8.0e-3).is_err());
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AxisRatioModel {
    /// Polynomial fit to the equilibrium shapes of Beard & Chuang.
    BeardChuang1987,
    /// Drops oscillating in a laboratory, 1.1 to 4.4 mm; Beard & Chuang elsewhere.
    Andsager1999,
    /// Measurements of artificial rain that fell 80 m.
    Thurai2007,
    /// Fit to several measurements. The paper prints 0.005030 for the cubic term; 0.005303 is meant.
    Brandes2002,
    /// Straight line fitted to wind tunnel measurements.
    PruppacherBeard1970,
    /// Oblate spheroid whose surface tension balances its weight, for water and air at 20 C.
    Green1975,
}

impl AxisRatioModel {
    /// All models.
    pub const ALL: [Self; 6] = [
        Self::BeardChuang1987,
        Self::Andsager1999,
        Self::Thurai2007,
        Self::Brandes2002,
        Self::PruppacherBeard1970,
        Self::Green1975,
    ];

    /// Axis ratio of a drop whose sphere of equal volume has this diameter in meters.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is outside [the model's range](self).
    pub fn axis_ratio(self, diameter_m: f64) -> Result<f64, DropError> {
        let (range, allowed) = match self {
            Self::BeardChuang1987 | Self::Andsager1999 => (0.5e-3..=7.0e-3, "0.5 to 7"),
            Self::Thurai2007 => (1.0e-6..=8.0e-3, "0.001 to 8"),
            Self::Brandes2002 => (0.1e-3..=8.0e-3, "0.1 to 8"),
            Self::PruppacherBeard1970 => (0.5e-3..=9.0e-3, "0.5 to 9"),
            Self::Green1975 => (1.0e-6..=9.0e-3, "0.001 to 9"),
        };
        check_diameter(diameter_m, range, allowed)?;
        let d = diameter_m * 1.0e3;
        Ok(match self {
            Self::BeardChuang1987 => beard_chuang_1987(d),
            Self::Andsager1999 if (1.1..=4.4).contains(&d) => {
                polynomial(d, [1.012, -1.44e-2, -1.03e-2, 0.0, 0.0])
            }
            Self::Andsager1999 => beard_chuang_1987(d),
            Self::Thurai2007 if d < 0.7 => 1.0,
            Self::Thurai2007 if d < 1.5 => polynomial(d, [1.173, -0.5165, 0.4698, -0.1317, -8.5e-3]),
            Self::Thurai2007 => polynomial(d, [1.065, -6.25e-2, -3.99e-3, 7.66e-4, -4.095e-5]),
            Self::Brandes2002 => polynomial(d, [0.9951, 0.0251, -0.03644, 0.005303, -0.0002492]),
            Self::PruppacherBeard1970 => 1.03 - 0.062 * d,
            Self::Green1975 => green_root(diameter_m, SURFACE_TENSION_20_C, DENSITY_DIFFERENCE_20_C),
        })
    }
}

fn beard_chuang_1987(d: f64) -> f64 {
    polynomial(d, [1.0048, 5.7e-4, -2.628e-2, 3.682e-3, -1.677e-4])
}

fn polynomial(d: f64, c: [f64; 5]) -> f64 {
    c[0] + d * (c[1] + d * (c[2] + d * (c[3] + d * c[4])))
}

/// Axis ratio by Green 1975: the ratio q for which
/// `d / 2 = sqrt(sigma / (g drho)) q^(-1/6) sqrt(q^-2 - 2 q^(-1/3) + 1)`,
/// with the surface tension sigma (N/m), the density of water minus that of air drho (kg/m3) and g = 9.80665
/// m/s2. (The power of sigma is as corrected by later authors.)
///
/// # Errors
/// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm, the surface tension not 1e-3 to 1 N/m, or the
/// difference of densities not 100 to 20000 kg/m3.
pub fn green_1975(diameter_m: f64, surface_tension: f64, density_difference: f64) -> Result<f64, DropError> {
    check_diameter(diameter_m, 1.0e-6..=9.0e-3, "0.001 to 9")?;
    in_range("surface tension", surface_tension, "N/m", &(1.0e-3..=1.0), 1.0, "0.001 to 1")?;
    let densities = &(100.0..=20_000.0);
    in_range("difference of densities", density_difference, "kg/m3", densities, 1.0, "100 to 20000")?;
    Ok(green_root(diameter_m, surface_tension, density_difference))
}

fn green_root(diameter_m: f64, surface_tension: f64, density_difference: f64) -> f64 {
    let gravity = 9.806_65;
    let target = 0.25 * diameter_m * diameter_m * gravity * density_difference / surface_tension;
    // With q = exp(-s), the square of the radius in capillary lengths is exp(s/3) (exp(2 s) - 2 exp(s/3) +
    // 1), which rises from 0 with s. In this form a small s keeps its digits.
    let square = |s: f64| {
        let third = ops::f64::exp_m1(s / 3.0);
        (1.0 + third) * (ops::f64::exp_m1(2.0 * s) - 2.0 * third)
    };
    // A ratio of exp(-8) is far below any drop that the arguments allow.
    let (mut low, mut high) = (0.0, 8.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if square(middle) < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    ops::f64::exp(-0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::DropShape;

    /// d in mm, then BC87, Andsager, Thurai, Brandes, Pruppacher-Beard; NaN outside the range of a model.
    const TABLE: [[f64; 6]; 16] = [
        [0.5, 0.99896, 0.99896, 1.0, 0.99919, 0.999],
        [1.0, 0.9826, 0.9826, 0.9861, 0.98881, 0.968],
        [1.5, 0.9581, 0.96723, 0.96465, 0.9674, 0.937],
        [2.0, 0.92759, 0.942, 0.92951, 0.93798, 0.906],
        [2.5, 0.89296, 0.91163, 0.89418, 0.90323, 0.875],
        [3.0, 0.85582, 0.8761, 0.85896, 0.86544, 0.844],
        [3.5, 0.81757, 0.83543, 0.82407, 0.82653, 0.813],
        [4.0, 0.77932, 0.7896, 0.7897, 0.78806, 0.782],
        [4.5, 0.74195, 0.74195, 0.75596, 0.75119, 0.751],
        [5.0, 0.70609, 0.70609, 0.72291, 0.71673, 0.72],
        [5.5, 0.6721, 0.6721, 0.69052, 0.68509, 0.689],
        [6.0, 0.64011, 0.64011, 0.65874, 0.65634, 0.658],
        [6.5, 0.60999, 0.60999, 0.62744, 0.63016, 0.627],
        [7.0, 0.58135, 0.58135, 0.59641, 0.60584, 0.596],
        [7.5, f64::NAN, f64::NAN, 0.5654, 0.58232, 0.565],
        [8.0, f64::NAN, f64::NAN, 0.5341, 0.55815, 0.534],
    ];

    #[test]
    fn the_published_fits() {
        for row in TABLE {
            for (model, &expected) in AxisRatioModel::ALL.iter().zip(&row[1..]) {
                let found = model.axis_ratio(row[0] * 1.0e-3);
                if expected.is_nan() {
                    assert!(found.is_err(), "{model:?} at {}", row[0]);
                } else {
                    let found = found.expect("in range");
                    assert!((found - expected).abs() < 6.0e-6, "{model:?} at {}: {found}", row[0]);
                }
            }
        }
    }

    #[test]
    fn green_solves_its_equation() {
        let expected = [0.9761, 0.9170, 0.8446, 0.7732, 0.7084, 0.6515];
        for (d, expected) in (1..).map(|d| f64::from(d) * 1.0e-3).zip(expected) {
            let q = AxisRatioModel::Green1975.axis_ratio(d).expect("in range");
            assert!((q - expected).abs() < 6.0e-5, "{d}: {q}");
        }
        for (d, sigma, drho) in [(1.0e-6, 0.07, 997.0), (9.0e-3, 0.07, 997.0), (2.0e-3, 0.47, 13_500.0)] {
            let q = green_1975(d, sigma, drho).expect("in range");
            let pow = downpour_math::ops::f64::pow;
            let right = (sigma / (9.806_65 * drho)).sqrt()
                * pow(q, -1.0 / 6.0)
                * (pow(q, -2.0) - 2.0 * pow(q, -1.0 / 3.0) + 1.0).max(0.0).sqrt();
            // At 1 um the bracket of the check loses its digits: the ratio itself is 1 - 2.5e-8.
            let tolerance = if d < 1.0e-5 { 1.0e-2 } else { 1.0e-12 };
            assert!((right / (0.5 * d) - 1.0).abs() < tolerance, "{d}: {right}");
        }
    }

    #[test]
    fn ranges_are_kept() {
        for model in AxisRatioModel::ALL {
            for d in [0.0, -1.0e-3, 1.0e-46, f64::NAN, f64::INFINITY, 9.1e-3] {
                assert!(model.axis_ratio(d).is_err(), "{model:?} at {d}");
            }
            for i in 0..=900 {
                if let Ok(q) = model.axis_ratio(f64::from(i) * 1.0e-5) {
                    assert!((0.4..=1.0).contains(&q), "{model:?} at {i}: {q}");
                }
            }
        }
        for model in [AxisRatioModel::BeardChuang1987, AxisRatioModel::Andsager1999] {
            let q = model.axis_ratio(0.5e-3).expect("in range");
            assert!((0.998..1.0).contains(&q));
        }
        let error = AxisRatioModel::Brandes2002.axis_ratio(9.0e-3).expect_err("out of range");
        assert_eq!(error.to_string(), "diameter is 9 mm; allowed: 0.1 to 8");
        assert!(green_1975(2.0e-3, 0.0, 997.0).is_err());
        assert!(green_1975(2.0e-3, 0.07, f64::NAN).is_err());
    }

    /// The branches of Andsager join on the side that the paper gives, and steps stay below 0.6 %.
    #[test]
    fn joints() {
        let at = |model: AxisRatioModel, mm: f64| model.axis_ratio(mm * 1.0e-3).expect("in range");
        let (andsager, other) = (AxisRatioModel::Andsager1999, AxisRatioModel::BeardChuang1987);
        for mm in [1.0, 1.05, 4.45, 6.0] {
            assert_eq!(at(andsager, mm), at(other, mm));
        }
        for mm in [1.15, 2.0, 4.0] {
            assert!(at(andsager, mm) > at(other, mm));
        }
        for (model, joint) in [
            (andsager, 1.1),
            (andsager, 4.4),
            (AxisRatioModel::Thurai2007, 0.7),
            (AxisRatioModel::Thurai2007, 1.5),
        ] {
            let step = at(model, joint + 1.0e-6) - at(model, joint - 1.0e-6);
            assert!(step.abs() < 0.006, "{model:?} at {joint}: {step}");
        }
    }

    #[test]
    fn the_shape_agrees_with_thurai() {
        for i in 10..=70 {
            let mm = f64::from(i) * 0.1;
            let shape = DropShape::new(mm * 1.0e-3).expect("in range").axis_ratio();
            let thurai = AxisRatioModel::Thurai2007.axis_ratio(mm * 1.0e-3).expect("in range");
            let tolerance = if mm < 3.0 { 0.02 } else { 0.035 };
            assert!((shape / thurai - 1.0).abs() < tolerance, "{mm}: {shape} for {thurai}");
        }
    }
}
