//! Equilibrium shape of a falling drop: `r(theta) = a (1 + sum over n = 0..10 of c_n cos(n theta))`.
//!
//! Source: C. Chuang, K. V. Beard, "A numerical model for the equilibrium shape of electrified raindrops",
//! J. Atmos. Sci. 47(11), 1990, table 1 (uncharged drops); equation 1 of P. Rousseau et al., "Realistic
//! real-time rain rendering", 2006.
//!
//! `a` is the radius of the sphere of equal volume and `theta` the angle from the downward axis. Surface
//! tension, hydrostatic pressure and the air's pressure balance: drops above 1 mm are wider than high, and
//! flatter below than above.
//!
//! Everything is a function of `x = cos(theta)`: `cos(n theta)` is the Chebyshev polynomial `T_n(x)`, so the
//! sum is Clenshaw's recurrence, with no trigonometry and no special case at the poles.
//!
//! Limits: diameters of 1 um to 9 mm ([`MIN_DIAMETER`], [`MAX_DIAMETER`]). Between the rows of the
//! table the coefficients are interpolated; below 1 mm the deformation falls with the Bond number, as d^2.
//! Raindrops above about 7 mm break up in nature. The sum ends at n = 10: above 6 mm this leaves a ripple of
//! some thousandths of `a` on the flat bottom, whose pole is then more curved than its surroundings. Oscillations
//! are in [`oscillation`](crate::oscillation).
//!
//! Twin of `shaders/wgsl/drop/shape.wgsl`. The functions here are generic: with `f32` (or its lanes) the
//! coefficients are rounded to what the shader holds, with `f64` they are the reference above it.

mod equilibrium;
mod table;

use bytemuck::{Pod, Zeroable};
use downpour_math::in_range;
use downpour_math::real::Real;

use crate::DropError;

pub use equilibrium::DropShape;
pub use table::{Correction, ShapeRow, ShapeTable};

/// Number of coefficients: n = 0 to 10.
pub const COEFFICIENTS: usize = 11;

/// Smallest diameter with a shape, in meters: a cloud droplet of 1 um, a sphere for every purpose.
pub const MIN_DIAMETER: f64 = 1.0e-6;

/// Largest diameter with a shape, in meters: the last row of the table.
pub const MAX_DIAMETER: f64 = 9.0e-3;

/// Coefficients as a shader reads them: the WGSL struct of the same name, 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DropShapeCoefficients {
    /// `c_0` to `c_3`.
    pub c0: [f32; 4],
    /// `c_4` to `c_7`.
    pub c1: [f32; 4],
    /// `c_8` to `c_10`, and 0.
    pub c2: [f32; 4],
}

impl From<[f64; COEFFICIENTS]> for DropShapeCoefficients {
    fn from(c: [f64; COEFFICIENTS]) -> Self {
        let c = c.map(|c| c as f32);
        Self { c0: [c[0], c[1], c[2], c[3]], c1: [c[4], c[5], c[6], c[7]], c2: [c[8], c[9], c[10], 0.0] }
    }
}

impl From<DropShapeCoefficients> for [f64; COEFFICIENTS] {
    fn from(c: DropShapeCoefficients) -> Self {
        let all = [c.c0, c.c1, c.c2];
        std::array::from_fn(|n| f64::from(all[n / 4][n % 4]))
    }
}

/// Checks that a diameter (in meters) is within the range, which `allowed` states in millimeters. The ends have a
/// relative tolerance of 1e-9: 9.0 * 1.0e-3 is above 9.0e-3.
pub(crate) fn check_diameter(
    diameter_m: f64,
    range: std::ops::RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), DropError> {
    // A NaN is in no range.
    let range = range.start() * (1.0 - 1.0e-9)..=range.end() * (1.0 + 1.0e-9);
    in_range("diameter", diameter_m, "mm", &range, 1.0e3, allowed)?;
    Ok(())
}

/// Checks that a diameter has a shape.
pub(crate) fn check_shape_diameter(diameter_m: f64) -> Result<(), DropError> {
    check_diameter(diameter_m, MIN_DIAMETER..=MAX_DIAMETER, "0.001 to 9")
}

/// `rho = r / a` at `x = cos(theta)`, with theta from the downward axis.
///
/// ```
/// use downpour_drop::shape::{DropShape, drop_shape_radius};
/// let c = DropShape::new(4.0e-3)?.coefficients();
/// let (down, up) = (drop_shape_radius(&c, 1.0f64), drop_shape_radius(&c, -1.0f64));
/// assert!(down < up, "the bottom is flatter");
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[inline(always)]
#[must_use]
pub fn drop_shape_radius<R: Real>(c: &[f64; COEFFICIENTS], x: R) -> R {
    let two_x = x + x;
    let b10 = x.constant(c[10]);
    let b9 = x.constant(c[9]) + two_x * b10;
    let b8 = x.constant(c[8]) + two_x * b9 - b10;
    let b7 = x.constant(c[7]) + two_x * b8 - b9;
    let b6 = x.constant(c[6]) + two_x * b7 - b8;
    let b5 = x.constant(c[5]) + two_x * b6 - b7;
    let b4 = x.constant(c[4]) + two_x * b5 - b6;
    let b3 = x.constant(c[3]) + two_x * b4 - b5;
    let b2 = x.constant(c[2]) + two_x * b3 - b4;
    let b1 = x.constant(c[1]) + two_x * b2 - b3;
    // The 1 is added last: the deformation keeps all its digits.
    x.constant(1.0) + (x.constant(c[0]) + x * b1 - b2)
}

/// `d rho / d x` at `x = cos(theta)`. The derivative of `T_n` is `n U_(n-1)`: the same recurrence for
/// Chebyshev's second kind.
#[inline(always)]
#[must_use]
pub fn drop_shape_slope<R: Real>(c: &[f64; COEFFICIENTS], x: R) -> R {
    let two_x = x + x;
    let b9 = x.constant(10.0) * x.constant(c[10]);
    let b8 = x.constant(9.0) * x.constant(c[9]) + two_x * b9;
    let b7 = x.constant(8.0) * x.constant(c[8]) + two_x * b8 - b9;
    let b6 = x.constant(7.0) * x.constant(c[7]) + two_x * b7 - b8;
    let b5 = x.constant(6.0) * x.constant(c[6]) + two_x * b6 - b7;
    let b4 = x.constant(5.0) * x.constant(c[5]) + two_x * b5 - b6;
    let b3 = x.constant(4.0) * x.constant(c[4]) + two_x * b4 - b5;
    let b2 = x.constant(3.0) * x.constant(c[3]) + two_x * b3 - b4;
    let b1 = x.constant(2.0) * x.constant(c[2]) + two_x * b2 - b3;
    x.constant(c[1]) + two_x * b1 - b2
}

/// `[rho, d rho / d x]` at `x = cos(theta)`.
#[inline(always)]
#[must_use]
pub fn drop_shape_radius_slope<R: Real>(c: &[f64; COEFFICIENTS], x: R) -> [R; 2] {
    [drop_shape_radius(c, x), drop_shape_slope(c, x)]
}

/// Outward unit normal at the point where the ray from the origin along the unit vector `direction` leaves the
/// drop, whose axis points up along the unit vector `up`.
///
/// The surface is `|P| - rho(x) = 0` with `x = -P.up / |P|`. Its gradient is `p + (rho' / rho) (up + x p)`,
/// where `p` is the direction; at the poles it is along the axis, without a limit.
#[inline(always)]
#[must_use]
pub fn drop_shape_normal<R: Real>(c: &[f64; COEFFICIENTS], direction: [R; 3], up: [R; 3]) -> [R; 3] {
    let x = -(direction[0] * up[0] + direction[1] * up[1] + direction[2] * up[2]);
    let [radius, slope] = drop_shape_radius_slope(c, x);
    let q = slope / radius;
    let along = x.constant(1.0) + x * q;
    let gradient = [
        direction[0] * along + up[0] * q,
        direction[1] * along + up[1] * q,
        direction[2] * along + up[2] * q,
    ];
    let squared = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
    let inverse = x.constant(1.0) / squared.sqrt();
    gradient.map(|g| g * inverse)
}
