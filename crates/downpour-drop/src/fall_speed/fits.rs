//! Fits to measured speeds in standard air: diameters in mm, speeds in m/s.

use downpour_math::ops;
use downpour_shaders::drop::fall_speed::{
    FALL_SPEED_BRANDES, FALL_SPEED_VAN_DIJK, FALL_SPEED_VAN_DIJK_MAX_MM,
};

use super::FallSpeedAir;

const BRANDES: [f64; 5] = [-0.1021, 4.932, -0.9551, 0.079_34, -0.002_362];
const VAN_DIJK: [f64; 4] = [-0.254, 5.03, -0.912, 0.0561];

/// Diameter, in mm, beyond which van Dijk's cubic diverges.
pub(super) const VAN_DIJK_MAX_MM: f64 = 6.0;

/// Atlas 1973, f64.
pub(super) fn atlas(d: f64) -> f64 {
    (9.65 - 10.3 * ops::f64::exp(-0.6 * d)).max(0.0)
}

/// Diameter in mm below which Atlas 1973 is 0.
pub(super) fn atlas_zero() -> f64 {
    ops::f64::ln(10.3 / 9.65) / 0.6
}

/// Atlas & Ulbrich 1977, f64.
pub(super) fn atlas_ulbrich(d: f64) -> f64 {
    3.78 * ops::f64::pow(d, 0.67)
}

/// Brandes 2002, f64.
pub(super) fn brandes(d: f64) -> f64 {
    BRANDES.iter().rev().fold(0.0, |sum, c| sum * d + c).max(0.0)
}

/// van Dijk 2002, f64.
pub(super) fn van_dijk(d: f64) -> f64 {
    let d = d.min(VAN_DIJK_MAX_MM);
    VAN_DIJK.iter().rev().fold(0.0, |sum, c| sum * d + c).max(0.0)
}

/// Lhermitte 1988, corrected, f64.
pub(super) fn lhermitte(d: f64) -> f64 {
    -9.25 * ops::f64::exp_m1(-((0.068 * d + 0.488) * d))
}

/// Atlas, Srivastava & Sekhon 1973, in m/s. Diameter in meters, 0 to 9e-3; 0 below 0.109 mm.
#[must_use]
pub fn fall_speed_atlas_1973(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).max(0.0);
    (9.65 - 10.3 * ops::exp(-0.6 * d)).max(0.0) * air.density_factor
}

/// Atlas & Ulbrich 1977, in m/s: a power law, rough, for 0.5 to 5 mm. Diameter in meters, 0 to 9e-3.
#[must_use]
pub fn fall_speed_atlas_ulbrich_1977(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).max(0.0);
    3.78 * ops::pow(d, 0.67) * air.density_factor
}

/// Brandes, Zhang & Vivekanandan 2002, in m/s. Diameter in meters, 0 to 9e-3; 0 below 0.021 mm.
#[must_use]
pub fn fall_speed_brandes_2002(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).max(0.0);
    let mut v = FALL_SPEED_BRANDES[4];
    v = v * d + FALL_SPEED_BRANDES[3];
    v = v * d + FALL_SPEED_BRANDES[2];
    v = v * d + FALL_SPEED_BRANDES[1];
    v = v * d + FALL_SPEED_BRANDES[0];
    v.max(0.0) * air.density_factor
}

/// van Dijk, Bruijnzeel & Rosewell 2002, in m/s. Diameter in meters, 0 to 9e-3; 0 below 0.051 mm, constant above 6 mm.
#[must_use]
pub fn fall_speed_van_dijk_2002(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).clamp(0.0, FALL_SPEED_VAN_DIJK_MAX_MM);
    let mut v = FALL_SPEED_VAN_DIJK[3];
    v = v * d + FALL_SPEED_VAN_DIJK[2];
    v = v * d + FALL_SPEED_VAN_DIJK[1];
    v = v * d + FALL_SPEED_VAN_DIJK[0];
    v.max(0.0) * air.density_factor
}

/// Lhermitte 1988, as corrected, in m/s. Diameter in meters, 0 to 9e-3.
#[must_use]
pub fn fall_speed_lhermitte_1988(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).max(0.0);
    9.25 * (1.0 - ops::exp(-((0.068 * d + 0.488) * d))) * air.density_factor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_precisions_have_the_same_coefficients() {
        assert_eq!(BRANDES.map(|c| c as f32), FALL_SPEED_BRANDES);
        assert_eq!(VAN_DIJK.map(|c| c as f32), FALL_SPEED_VAN_DIJK);
        assert_eq!(VAN_DIJK_MAX_MM as f32, FALL_SPEED_VAN_DIJK_MAX_MM);
    }
}
