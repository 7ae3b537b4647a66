//! Oscillation of a drop of any shape.
//!
//! The radius of the shape is multiplied by the factor of equation 2 and divided by the cube root of the
//! resulting volume. With `rho = r / a` of the shape, that volume is the mean over the sphere of `rho^3
//! (1 + a + b cos(phi))^3`, a polynomial in s2 and s3 whose five coefficients are moments of the shape.

use downpour_math::ops;
use downpour_math::quadrature::GaussLegendre;

use super::{
    Oscillation, drop_oscillation_legendre_20, drop_oscillation_legendre_31,
    drop_oscillation_state_rousseau_2008,
};
use crate::DropError;
use crate::mesh::DropSurface;
use crate::shape::{DropShape, drop_shape_radius, drop_shape_radius_slope};

/// A shape and its oscillation.
///
/// ```
/// use downpour_drop::mesh::DropSurface;
/// use downpour_drop::oscillation::{Amplitudes, Fluids, FrequencyLaw, OscillatingDrop, Oscillation};
/// use downpour_drop::shape::DropShape;
/// let shape = DropShape::new(3.0e-3)?;
/// let oscillation =
///     Oscillation::new(3.0e-3, Amplitudes::GARG_NAYAR_EVEN, &Fluids::AT_20_C, FrequencyLaw::default())?;
/// let drop = OscillatingDrop::new(shape, oscillation);
/// let instant = drop.at(0.004, 0.0);
/// let [left, right] = instant.outline(0.0);
/// assert!(left > 0.0 && right > 0.0 && left != right);
/// assert!(instant.radius_along([0.0, -1.0, 0.0]) > 0.0);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OscillatingDrop {
    shape: DropShape,
    oscillation: Oscillation,
    moments: Moments,
}

/// Means over the sphere: of rho^3 P20^k for k = 1, 2, 3, and of rho^3 P20^k P31^2 for k = 0, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moments {
    p20: [f64; 3],
    p31: [f64; 2],
}

impl Moments {
    fn of(shape: &DropShape) -> Self {
        let c = shape.coefficients();
        // The integrands are polynomials of degree 38 at most.
        let rule = GaussLegendre::new(20);
        let mean = |weight: fn(f64, f64) -> f64| {
            rule.integrate(-1.0, 1.0, |x| {
                let r = drop_shape_radius(&c, x);
                let (p20, p31) = (drop_oscillation_legendre_20(x), drop_oscillation_legendre_31(x));
                0.5 * r * r * r * weight(p20, p31)
            })
        };
        Self {
            p20: [mean(|p, _| p), mean(|p, _| p * p), mean(|p, _| p * p * p)],
            p31: [mean(|_, q| q * q), mean(|p, q| p * q * q)],
        }
    }

    /// Volume over that of the shape at rest.
    fn volume(&self, [s2, s3]: [f64; 2]) -> f64 {
        let [m1, m2, m3] = self.p20;
        let [n0, n1] = self.p31;
        1.0 + s2 * (3.0 * m1 + s2 * (3.0 * m2 + s2 * m3)) + 1.5 * s3 * s3 * (n0 + s2 * n1)
    }

    /// Coefficients of the volume polynomial.
    fn polynomial(&self) -> [f64; 5] {
        let [m1, m2, m3] = self.p20;
        let [n0, n1] = self.p31;
        [3.0 * m1, 3.0 * m2, m3, 1.5 * n0, 1.5 * n1]
    }
}

impl OscillatingDrop {
    /// Creates an oscillating shape. The diameters of the two should be the same.
    #[must_use]
    pub fn new(shape: DropShape, oscillation: Oscillation) -> Self {
        Self { shape, oscillation, moments: Moments::of(&shape) }
    }

    /// Creates an oscillating sphere, as in equation 2 (but with constant volume).
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm.
    pub fn about_sphere(diameter_m: f64, oscillation: Oscillation) -> Result<Self, DropError> {
        Ok(Self::new(DropShape::sphere(diameter_m)?, oscillation))
    }

    /// Shape at rest.
    #[must_use]
    pub fn shape(&self) -> &DropShape {
        &self.shape
    }

    /// Oscillation of the shape.
    #[must_use]
    pub fn oscillation(&self) -> &Oscillation {
        &self.oscillation
    }

    /// `[a, b, c, d, e]`, with which the volume over that of the shape at rest is
    /// `1 + s2 (a + s2 (b + s2 c)) + s3^2 (d + s2 e)` before the correction.
    #[must_use]
    pub fn volume_polynomial(&self) -> [f64; 5] {
        self.moments.polynomial()
    }

    /// Factor on the radius that keeps the volume, for displacements (s2, s3).
    #[must_use]
    pub fn scale(&self, displacement: [f64; 2]) -> f64 {
        1.0 / ops::f64::cbrt(self.moments.volume(displacement))
    }

    /// The drop at a time in s; `age` is the time in s since the disturbance, used by a damped oscillation.
    #[must_use]
    pub fn at(&self, time: f64, age: f64) -> DropInstant {
        let displacement = self.oscillation.displacement(time, age);
        let scale = self.scale(displacement);
        DropInstant { shape: self.shape, state: [displacement[0], displacement[1], scale] }
    }

    /// The same with equation 2 as printed, which does not keep the volume.
    #[must_use]
    pub fn at_rousseau_2008(&self, time: f64, age: f64) -> DropInstant {
        let displacement = self.oscillation.displacement(time, age);
        DropInstant { shape: self.shape, state: drop_oscillation_state_rousseau_2008(displacement) }
    }
}

/// An oscillating drop at one time. phi = 0 is toward +X; phi counts from there about +Y, toward -Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropInstant {
    shape: DropShape,
    state: [f64; 3],
}

impl DropInstant {
    /// `[s2, s3, scale]`: displacements, and the factor on the radius that keeps the volume.
    #[must_use]
    pub fn state(&self) -> [f64; 3] {
        self.state
    }

    /// Distance from the origin to the surface in meters, at `theta` radians from the downward axis and `phi`
    /// about it.
    #[must_use]
    pub fn radius(&self, theta: f64, phi: f64) -> f64 {
        let (away, down) = (ops::f64::sin(theta), ops::f64::cos(theta));
        self.radius_along([away * ops::f64::cos(phi), -down, -away * ops::f64::sin(phi)])
    }

    /// Distances in meters from the axis to the left (phi) and right (phi + pi) outline at theta = pi / 2.
    #[must_use]
    pub fn outline(&self, phi: f64) -> [f64; 2] {
        let half = std::f64::consts::FRAC_PI_2;
        [self.radius(half, phi), self.radius(half, phi + std::f64::consts::PI)]
    }

    /// Factor of equation 2 without the scale, and its derivatives by x and by the horizontal part h =
    /// sin(theta) cos(phi) of the direction: 1 + s2 P20(x) + 3/2 s3 (1 - 5 x^2) h. No square root is
    /// involved, so the poles are smooth.
    fn factor(&self, x: f64, h: f64) -> [f64; 3] {
        let [s2, s3, _] = self.state;
        let lobe = 1.5 * s3 * (1.0 - 5.0 * x * x);
        [1.0 + s2 * drop_oscillation_legendre_20(x) + lobe * h, 3.0 * s2 * x - 15.0 * s3 * x * h, lobe]
    }
}

impl DropSurface for DropInstant {
    fn radius_along(&self, direction: [f64; 3]) -> f64 {
        let x = -direction[1];
        let rho = drop_shape_radius(&self.shape.coefficients(), x);
        self.shape.equivalent_radius() * rho * self.factor(x, direction[0])[0] * self.state[2]
    }

    fn normal_along(&self, direction: [f64; 3]) -> [f64; 3] {
        let x = -direction[1];
        let [rho, slope] = drop_shape_radius_slope(&self.shape.coefficients(), x);
        let [f, by_x, by_h] = self.factor(x, direction[0]);
        // With r = rho(x) f(x, h), the gradient of |P| - r is p minus the part of grad(ln r) across p, and
        // across p the gradient of x is -(up + x p), that of h is (+X) - h p.
        let (q, k) = (slope / rho + by_x / f, by_h / f);
        let along = 1.0 + x * q + direction[0] * k;
        let gradient = [direction[0] * along - k, direction[1] * along + q, direction[2] * along];
        let length = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        gradient.map(|g| g / length)
    }
}
