//! Angles of rays through a sphere, and its mean reflectance.
//!
//! Law: a ray that meets a sphere at the angle i (impact parameter b = sin i in radii) continues inside at r, with
//! sin i = n sin r. Without internal reflection it leaves deflected by 2 (i - r), at most 180 - 2 asin(1/n) degrees at
//! grazing incidence, so a drop shows a field of twice that: 165.57 degrees for n = 1.333. (The 150 degrees of
//! Rousseau 2006, 4.3.1, come from rounding asin(1/1.33) = 48.75 to 48.) With k internal reflections it is deflected
//! by k pi + 2 i - 2 (k + 1) r, which is stationary, a rainbow, at cos i = sqrt((n^2 - 1) / (k (k + 2))).
//! Angles in radians; n is the index of water against air.

use std::f64::consts::{PI, TAU};

use downpour_math::ops::f64 as ops;
use downpour_math::quadrature::GaussLegendre;

use super::optics_fresnel;
use crate::DropError;
use crate::error::in_rounded_range;

/// Critical angle of total reflection within water, to the normal: asin(1/n).
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4.
pub fn critical_angle(index: f64) -> Result<f64, DropError> {
    Ok(ops::asin(1.0 / checked_index(index)?))
}

/// Brewster angle, the angle of incidence in air without reflection within the plane of incidence: atan(n).
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4.
pub fn brewster_angle(index: f64) -> Result<f64, DropError> {
    Ok(ops::atan(checked_index(index)?))
}

/// Largest deviation of a ray by a sphere without reflection: pi - 2 asin(1/n).
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4.
pub fn maximal_deviation(index: f64) -> Result<f64, DropError> {
    Ok(PI - 2.0 * critical_angle(index)?)
}

/// Full angle of the scene that is seen through a spherical drop: twice the maximal deviation.
///
/// ```
/// let field = downpour_drop::optics::field_of_view(1.333)?;
/// assert!((field.to_degrees() - 165.57).abs() < 0.01);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4.
pub fn field_of_view(index: f64) -> Result<f64, DropError> {
    Ok(2.0 * maximal_deviation(index)?)
}

/// Deviation of a ray that passes a sphere without reflection, at `impact` radii from its axis.
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4, or the impact parameter not 0 to 1.
pub fn deviation(impact: f64, index: f64) -> Result<f64, DropError> {
    let index = checked_index(index)?;
    let b = in_rounded_range("impact parameter", impact, "radii", &(0.0..=1.0), 1.0, "0 to 1 radii")?;
    Ok(2.0 * (ops::asin(b) - ops::asin(b / index)))
}

/// A rainbow: the stationary deviation of rays with k internal reflections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rainbow {
    /// Angle of incidence of these rays.
    pub incidence: f64,
    /// Total deviation; more than half a turn from the second order.
    pub deviation: f64,
    /// Radius of the bow around the antisolar point.
    pub radius: f64,
}

/// Computes the rainbow of `reflections` internal reflections: 1 for the primary, 2 for the secondary.
///
/// ```
/// let bow = downpour_drop::optics::rainbow(4.0 / 3.0, 1)?;
/// assert!((bow.radius.to_degrees() - 42.03).abs() < 0.01);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] if `reflections` is 0, or the index is not from 1 to `reflections` + 1 (at most 4):
/// then there is no bow.
pub fn rainbow(index: f64, reflections: u32) -> Result<Rainbow, DropError> {
    let k = f64::from(reflections);
    in_rounded_range("reflections of a rainbow", k, "", &(1.0..=f64::from(u32::MAX)), 1.0, "1 or more")?;
    let n = in_rounded_range(
        "refractive index",
        index,
        "",
        &(1.0..=(k + 1.0).min(4.0)),
        1.0,
        "1 to the number of reflections plus 1, at most 4",
    )?;
    let incidence = ops::acos(((n * n - 1.0) / (k * (k + 2.0))).sqrt());
    let refraction = ops::asin(ops::sin(incidence) / n);
    let deviation = k * PI + 2.0 * incidence - 2.0 * (k + 1.0) * refraction;
    let turned = deviation - TAU * (deviation / TAU).floor();
    Ok(Rainbow { incidence, deviation, radius: (PI - turned).abs() })
}

/// Fraction of diffuse light that water reflects, which is also the fraction of parallel light that a sphere reflects
/// at its first surface: the mean of Fresnel's reflectance over the disk. 0.0664 for n = 1.333.
///
/// # Errors
/// [`DropError::OutOfRange`] if the index is not 1 to 4.
pub fn diffuse_reflectance(index: f64) -> Result<f64, DropError> {
    let n = checked_index(index)?;
    Ok(GaussLegendre::new(64).integrate(0.0, 1.0, |c| 2.0 * c * optics_fresnel(c, n)))
}

fn checked_index(index: f64) -> Result<f64, DropError> {
    in_rounded_range("refractive index", index, "", &(1.0..=4.0), 1.0, "1 to 4")
}
