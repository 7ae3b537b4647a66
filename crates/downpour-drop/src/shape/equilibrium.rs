//! Equilibrium shape of one drop, and its measures.

use downpour_math::{OutOfRange, in_range};
use std::f64::consts::PI;

use downpour_math::ops;
use downpour_math::quadrature::GaussLegendre;

use super::{
    COEFFICIENTS, DropShapeCoefficients, ShapeTable, check_shape_diameter, drop_shape_normal,
    drop_shape_radius, drop_shape_radius_slope,
};
use crate::DropError;

/// Number of nodes that integrates a polynomial of degree 47 exactly: the fourth power of the radius has degree 40.
const NODES: usize = 24;

/// Shape of a drop: radius as a function of the angle from the downward axis.
///
/// Lengths are in meters, heights are positive upwards, and the origin is that of the table: the center of
/// mass within 1.4 % of the radius ([`DropShape::centroid_height`]). The volume is that of the sphere of the
/// diameter: the coefficients are scaled to it, by less than 0.02 % at the rows of the table.
///
/// ```
/// use downpour_drop::shape::DropShape;
/// let drop = DropShape::new(5.0e-3)?;
/// assert!((drop.axis_ratio() - 0.700).abs() < 1e-4);
/// assert!((drop.volume() - 65.45e-9).abs() < 1e-11); // 65 microliters
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropShape {
    diameter: f64,
    coefficients: [f64; COEFFICIENTS],
}

impl DropShape {
    /// Creates the equilibrium shape of Chuang & Beard 1990.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter (of the sphere of equal volume) is not 1 um to 9 mm.
    pub fn new(diameter_m: f64) -> Result<Self, DropError> {
        Self::with_table(ShapeTable::ChuangBeard1990, diameter_m)
    }

    /// Creates the shape of a table, scaled to the volume of the sphere.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm.
    pub fn with_table(table: ShapeTable, diameter_m: f64) -> Result<Self, DropError> {
        // The tables need no validation: their smallest radius is above half of the sphere's.
        Ok(Self::scaled(diameter_m, table.coefficients(diameter_m)?))
    }

    /// Creates a sphere.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm.
    pub fn sphere(diameter_m: f64) -> Result<Self, DropError> {
        check_shape_diameter(diameter_m)?;
        Ok(Self { diameter: diameter_m, coefficients: [0.0; COEFFICIENTS] })
    }

    /// Creates a shape from coefficients: `c_0` to `c_10` of `1 + sum c_n cos(n theta)`, scaled to the volume of the
    /// sphere.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not 1 um to 9 mm, a coefficient is not -10 to 10, or the radius is
    /// not positive in every direction. (It is sampled at 2049 angles, and between two of them it cannot fall by
    /// more than half their distance times `sum n |c_n|`: a radius nearer to zero than that is rejected as
    /// well.)
    pub fn from_coefficients(diameter_m: f64, c: [f64; COEFFICIENTS]) -> Result<Self, DropError> {
        check_shape_diameter(diameter_m)?;
        for coefficient in c {
            in_range("shape coefficient", coefficient, "of the radius", &(-10.0..=10.0), 1.0, "-10 to 10")?;
        }
        let steepest: f64 = (0..).zip(&c).map(|(n, c)| f64::from(n) * c.abs()).sum();
        let steps = 2048;
        let smallest = (0..=steps)
            .map(|i| drop_shape_radius(&c, ops::f64::cos(PI * f64::from(i) / f64::from(steps))))
            .fold(f64::INFINITY, f64::min);
        let found = smallest - 0.5 * steepest * PI / f64::from(steps);
        if found <= 0.0 {
            let (quantity, unit, allowed) = ("smallest radius", "of the sphere's", "above 0");
            return Err(DropError::OutOfRange(OutOfRange { quantity, found, unit, allowed: allowed.into() }));
        }
        Ok(Self::scaled(diameter_m, c))
    }

    /// Scales the shape to the volume of the sphere.
    fn scaled(diameter: f64, c: [f64; COEFFICIENTS]) -> Self {
        let scale = 1.0 / ops::f64::cbrt(volume_ratio(&c));
        let mut coefficients = c.map(|c| c * scale);
        // scale (1 + c_0) - 1, without losing the digits of a small c_0.
        coefficients[0] += scale - 1.0;
        Self { diameter, coefficients }
    }

    /// Diameter of the sphere of equal volume, in meters.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        self.diameter
    }

    /// Radius of the sphere of equal volume, in meters: the `a` of the law.
    #[must_use]
    pub fn equivalent_radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// `c_0` to `c_10`, scaled so that the volume is that of the sphere.
    #[must_use]
    pub fn coefficients(&self) -> [f64; COEFFICIENTS] {
        self.coefficients
    }

    /// Coefficients for a shader.
    #[must_use]
    pub fn gpu_coefficients(&self) -> DropShapeCoefficients {
        self.coefficients.into()
    }

    /// Distance from the origin to the surface, in meters, at `theta` radians from the downward axis.
    #[must_use]
    pub fn radius(&self, theta: f64) -> f64 {
        self.equivalent_radius() * drop_shape_radius(&self.coefficients, ops::f64::cos(theta))
    }

    /// Point of the meridian at `theta`: distance from the axis and height above the origin, in meters.
    #[must_use]
    pub fn profile(&self, theta: f64) -> [f64; 2] {
        let r = self.radius(theta);
        [r * ops::f64::sin(theta), -r * ops::f64::cos(theta)]
    }

    /// Outward unit normal at `theta`, in the plane of the meridian: away from the axis, and up.
    #[must_use]
    pub fn normal(&self, theta: f64) -> [f64; 2] {
        let direction = [ops::f64::sin(theta), -ops::f64::cos(theta), 0.0];
        let [away, up, _] = drop_shape_normal(&self.coefficients, direction, [0.0, 1.0, 0.0]);
        [away, up]
    }

    /// Largest distance of the surface from the axis, in meters.
    #[must_use]
    pub fn max_half_width(&self) -> f64 {
        largest(|theta| self.profile(theta)[0])
    }

    /// Distance from the origin to the lowest point of the drop, in meters.
    #[must_use]
    pub fn extent_down(&self) -> f64 {
        largest(|theta| -self.profile(theta)[1])
    }

    /// Distance from the origin to the highest point of the drop, in meters.
    #[must_use]
    pub fn extent_up(&self) -> f64 {
        largest(|theta| self.profile(theta)[1])
    }

    /// Axis ratio: height over width.
    #[must_use]
    pub fn axis_ratio(&self) -> f64 {
        (self.extent_down() + self.extent_up()) / (2.0 * self.max_half_width())
    }

    /// Volume in cubic meters: pi d^3 / 6.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let a = self.equivalent_radius();
        4.0 / 3.0 * PI * a * a * a * volume_ratio(&self.coefficients)
    }

    /// Surface area in square meters.
    #[must_use]
    pub fn surface_area(&self) -> f64 {
        let a = self.equivalent_radius();
        // r sqrt(r^2 + (dr / d theta)^2) sin(theta) d theta, with dr / d theta = -sin(theta) dr / dx.
        let integrand = |x: f64| {
            let [r, slope] = drop_shape_radius_slope(&self.coefficients, x);
            r * (r * r + (1.0 - x * x) * slope * slope).sqrt()
        };
        2.0 * PI * a * a * GaussLegendre::new(64).integrate(-1.0, 1.0, integrand)
    }

    /// Height of the center of mass above the origin, in meters.
    #[must_use]
    pub fn centroid_height(&self) -> f64 {
        let moment = GaussLegendre::new(NODES).integrate(-1.0, 1.0, |x| {
            let r = drop_shape_radius(&self.coefficients, x);
            0.375 * -x * r * r * r * r
        });
        self.equivalent_radius() * moment / volume_ratio(&self.coefficients)
    }
}

/// Volume over that of the sphere of radius a.
fn volume_ratio(c: &[f64; COEFFICIENTS]) -> f64 {
    GaussLegendre::new(NODES).integrate(-1.0, 1.0, |x| {
        let r = drop_shape_radius(c, x);
        0.5 * r * r * r
    })
}

/// Largest value of a smooth function of theta in [0, pi].
fn largest(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 256;
    let step = PI / f64::from(steps);
    let best =
        (0..=steps).map(|i| step * f64::from(i)).max_by(|&a, &b| f(a).total_cmp(&f(b))).unwrap_or_default();
    // Golden section between the neighbors of the best sample.
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    let (mut a, mut b) = ((best - step).max(0.0), (best + step).min(PI));
    let (mut inner, mut outer) = (b - golden * (b - a), a + golden * (b - a));
    let (mut f_inner, mut f_outer) = (f(inner), f(outer));
    for _ in 0..40 {
        if f_inner > f_outer {
            (b, outer, f_outer) = (outer, inner, f_inner);
            inner = b - golden * (b - a);
            f_inner = f(inner);
        } else {
            (a, inner, f_inner) = (inner, outer, f_outer);
            outer = a + golden * (b - a);
            f_outer = f(outer);
        }
    }
    f_inner.max(f_outer).max(f(best))
}
