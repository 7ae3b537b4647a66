//! Liquid water at atmospheric pressure: density, surface tension, viscosity.
//!
//! Laws, with the temperature T:
//! - density: G. S. Kell, J. Chem. Eng. Data 20, 97 (1975), a rational function of T in Celsius;
//! - surface tension: IAPWS R1-76(2014), `sigma = B tau^mu (1 + b tau)`, `tau = 1 - T/Tc`;
//! - viscosity: IAPWS R12-08, the simplified form for 1000 hPa, `mu = sum a_i (T / 300 K)^b_i`, 253 to 383 K.
//!
//! Units: Celsius, kg/m^3, N/m, Pa s, m^2/s. Limits: -20 to 40 C. Below 0 C the water is supercooled, as in
//! freezing rain; there Kell's formula is extrapolated (it meets the tabulated 998.117 kg/m^3 at -10 C and 993.547
//! at -20 C), and so is the surface tension (IAPWS gives it from the triple point up).

use std::ops::RangeInclusive;

use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::error::in_rounded_range;

/// Range of temperatures, in Celsius, in which the properties are given.
pub const TEMPERATURE_RANGE_C: RangeInclusive<f64> = -20.0..=40.0;

/// 0 Celsius in kelvin.
pub(crate) const CELSIUS_ZERO_K: f64 = 273.15;

/// Density in kg/m^3 at `temperature_c` Celsius (Kell 1975).
///
/// ```
/// let rho = downpour_drop::water::density(20.0)?;
/// assert!((rho - 998.204).abs() < 0.001);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside [`TEMPERATURE_RANGE_C`].
pub fn density(temperature_c: f64) -> Result<f64, DropError> {
    Ok(density_at(liquid(temperature_c)?))
}

/// Surface tension against air in N/m at `temperature_c` Celsius (IAPWS R1-76(2014)).
///
/// ```
/// let sigma = downpour_drop::water::surface_tension(20.0)?;
/// assert!((sigma - 0.072736).abs() < 1e-6);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside [`TEMPERATURE_RANGE_C`].
pub fn surface_tension(temperature_c: f64) -> Result<f64, DropError> {
    Ok(surface_tension_at(liquid(temperature_c)?))
}

/// Viscosity in Pa s at `temperature_c` Celsius (IAPWS R12-08).
///
/// ```
/// let mu = downpour_drop::water::viscosity(20.0)?;
/// assert!((mu - 1.0016e-3).abs() < 1e-7);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside [`TEMPERATURE_RANGE_C`].
pub fn viscosity(temperature_c: f64) -> Result<f64, DropError> {
    Ok(viscosity_at(liquid(temperature_c)?))
}

/// Kinematic viscosity, viscosity over density, in m^2/s at `temperature_c` Celsius.
///
/// # Errors
/// [`DropError::OutOfRange`] outside [`TEMPERATURE_RANGE_C`].
pub fn kinematic_viscosity(temperature_c: f64) -> Result<f64, DropError> {
    Ok(viscosity(temperature_c)? / density(temperature_c)?)
}

/// Density as [`density`], for a temperature that was checked before.
pub(crate) fn density_at(t: f64) -> f64 {
    const C: [f64; 6] =
        [999.839_52, 16.945_176, -7.987_040_1e-3, -4.617_046_1e-5, 1.055_630_2e-7, -2.805_425_3e-10];
    C.iter().rev().fold(0.0, |sum, c| sum * t + c) / (1.0 + 1.687_985_0e-2 * t)
}

/// Surface tension as [`surface_tension`], for a temperature that was checked before.
pub(crate) fn surface_tension_at(t: f64) -> f64 {
    let tau = 1.0 - (t + CELSIUS_ZERO_K) / 647.096;
    0.2358 * ops::pow(tau, 1.256) * (1.0 - 0.625 * tau)
}

fn viscosity_at(t: f64) -> f64 {
    const TERMS: [(f64, f64); 4] = [(280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.459_03, -40.0)];
    let reduced = (t + CELSIUS_ZERO_K) / 300.0;
    1.0e-6 * TERMS.iter().map(|&(a, b)| a * ops::pow(reduced, b)).sum::<f64>()
}

fn liquid(temperature_c: f64) -> Result<f64, DropError> {
    in_rounded_range("water temperature", temperature_c, "C", &TEMPERATURE_RANGE_C, 1.0, "-20 to 40 C")
}
