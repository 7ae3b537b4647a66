//! Tables of Gunn & Kinzer 1949 and of Rousseau 2006, linearly interpolated.
//!
//! Both are declared in whole micrometers and cm/s, which f32 and f64 hold exactly.

use downpour_shaders::drop::fall_speed::{
    FALL_SPEED_GUNN_KINZER_DIAMETERS_UM, FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S,
    FALL_SPEED_ROUSSEAU_DIAMETERS_UM, FALL_SPEED_ROUSSEAU_SPEEDS_CM_S,
};

use super::FallSpeedAir;

/// Gunn & Kinzer 1949 in standard air, f64, diameter in mm.
pub(super) fn gunn_kinzer(d: f64) -> f64 {
    between(d, &FALL_SPEED_GUNN_KINZER_DIAMETERS_UM, &FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S)
}

/// Rousseau 2006 in standard air, f64, diameter in mm.
pub(super) fn rousseau(d: f64) -> f64 {
    between(d, &FALL_SPEED_ROUSSEAU_DIAMETERS_UM, &FALL_SPEED_ROUSSEAU_SPEEDS_CM_S)
}

/// Diameters of Gunn & Kinzer's table in mm.
pub(super) fn gunn_kinzer_diameters() -> Vec<f64> {
    FALL_SPEED_GUNN_KINZER_DIAMETERS_UM.iter().map(|&d| f64::from(d) / 1.0e3).collect()
}

/// Diameters of Rousseau's table in mm.
pub(super) fn rousseau_diameters() -> Vec<f64> {
    FALL_SPEED_ROUSSEAU_DIAMETERS_UM.iter().map(|&d| f64::from(d) / 1.0e3).collect()
}

fn between<const N: usize>(d: f64, diameters: &[f32; N], speeds: &[f32; N]) -> f64 {
    let point = |i: usize| (f64::from(diameters[i]) / 1.0e3, f64::from(speeds[i]) / 100.0);
    let (first, slowest) = point(0);
    if d < first {
        return slowest * (d / first) * (d / first);
    }
    let above = (1..N).find(|&i| d <= point(i).0).unwrap_or(N - 1);
    let ((d0, v0), (d1, v1)) = (point(above - 1), point(above));
    let fraction = ((d - d0) / (d1 - d0)).min(1.0);
    // In this form both ends give exactly the number of the table.
    v0 * (1.0 - fraction) + v1 * fraction
}

/// Gunn & Kinzer 1949, table 2, in m/s. Diameter in meters, 0 to 9e-3. As d^2 below 0.078 mm, constant above 5.8 mm.
#[must_use]
pub fn fall_speed_gunn_kinzer_1949(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1.0e6).clamp(0.0, FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[34]);
    if d < FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[0] {
        let fraction = d / FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[0];
        return FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S[0] * fraction * fraction * 0.01 * air.density_factor;
    }
    let mut i = 1;
    while i < 34 && d > FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[i] {
        i += 1;
    }
    let d0 = FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[i - 1];
    let v0 = FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S[i - 1];
    let fraction = (d - d0) / (FALL_SPEED_GUNN_KINZER_DIAMETERS_UM[i] - d0);
    (v0 + (FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S[i] - v0) * fraction) * 0.01 * air.density_factor
}

/// Rousseau 2006, table 2, in m/s. Diameter in meters, 0 to 9e-3. As d^2 below 0.2 mm, constant above 8 mm.
#[must_use]
pub fn fall_speed_rousseau_2006(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1.0e6).clamp(0.0, FALL_SPEED_ROUSSEAU_DIAMETERS_UM[22]);
    if d < FALL_SPEED_ROUSSEAU_DIAMETERS_UM[0] {
        let fraction = d / FALL_SPEED_ROUSSEAU_DIAMETERS_UM[0];
        return FALL_SPEED_ROUSSEAU_SPEEDS_CM_S[0] * fraction * fraction * 0.01 * air.density_factor;
    }
    let mut i = 1;
    while i < 22 && d > FALL_SPEED_ROUSSEAU_DIAMETERS_UM[i] {
        i += 1;
    }
    let d0 = FALL_SPEED_ROUSSEAU_DIAMETERS_UM[i - 1];
    let v0 = FALL_SPEED_ROUSSEAU_SPEEDS_CM_S[i - 1];
    let fraction = (d - d0) / (FALL_SPEED_ROUSSEAU_DIAMETERS_UM[i] - d0);
    (v0 + (FALL_SPEED_ROUSSEAU_SPEEDS_CM_S[i] - v0) * fraction) * 0.01 * air.density_factor
}
