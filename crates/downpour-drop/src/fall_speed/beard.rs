//! Beard 1976: terminal speed in three regimes.
//!
//! With `drho` the difference of the densities of water and air, `eta` the viscosity of air, `sigma` the surface
//! tension, `l` the mean free path, `C = 1 + 2.51 l/d` the slip correction:
//! 1. d < 19 um, Stokes flow: `v = C drho g d^2 / (18 eta)`;
//! 2. d < 1.07 mm, spheres: `N_Da = 4 rho drho g d^3 / (3 eta^2)`, `Re = C exp(polynomial of ln N_Da)`;
//! 3. d <= 7 mm, flattened drops: `Bo = 4 drho g d^2 / (3 sigma)`, `N_P = sigma^3 rho^2 / (eta^4 drho g)`,
//!    `Re = N_P^(1/6) exp(polynomial of ln(Bo N_P^(1/6)))`;
//!
//! and `v = eta Re / (rho d)`. All terms that do not depend on d are computed once, for a drop of 1 mm.

use bytemuck::{Pod, Zeroable};
use downpour_math::ops;
use downpour_shaders::drop::fall_speed::{
    FALL_SPEED_BEARD_FLATTENED, FALL_SPEED_BEARD_MAX_MM, FALL_SPEED_BEARD_SPHERE, FALL_SPEED_BEARD_SPHERE_MM,
    FALL_SPEED_BEARD_STOKES_MM,
};

use crate::air::{Air, STANDARD_GRAVITY};

const SPHERE: [f64; 7] =
    [-3.186_57, 0.992_696, -1.531_93e-3, -9.870_59e-4, -5.788_78e-4, 8.551_76e-5, -3.278_15e-6];
const FLATTENED: [f64; 6] = [-5.000_15, 5.237_78, -2.049_14, 0.475_294, -0.054_281_9, 2.384_49e-3];

/// Expansion point of the polynomial in `ln(Bo N_P^(1/6))` in f32.
const CENTER: f64 = 5.0;

/// Joints of the regimes, and the upper end of the law, in mm.
pub(super) const JOINTS_MM: [f64; 3] = [0.019, 1.07, 7.0];

/// Constants of the law in one kind of air, for a drop of 1 mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beard {
    stokes: f64,
    slip_mm: f64,
    davies_log: f64,
    davies_speed: f64,
    bond_log: f64,
    bond_speed: f64,
}

impl Beard {
    pub(super) fn new(air: &Air) -> Self {
        let (rho, eta) = (air.density(), air.viscosity());
        let sigma = air.water_surface_tension();
        let weight = (air.water_density() - rho) * STANDARD_GRAVITY;
        let mm = 1.0e-3;
        let unit_speed = eta / (rho * mm);
        let davies = 4.0 * rho * weight * (mm * mm * mm) / (3.0 * eta * eta);
        let bond = 4.0 * weight * (mm * mm) / (3.0 * sigma);
        let property =
            ops::f64::ln(sigma * sigma * sigma * rho * rho / (eta * eta * eta * eta * weight)) / 6.0;
        Self {
            stokes: weight * (mm * mm) / (18.0 * eta),
            slip_mm: 2.51 * air.mean_free_path() / mm,
            davies_log: ops::f64::ln(davies),
            davies_speed: unit_speed,
            bond_log: ops::f64::ln(bond) + property,
            bond_speed: unit_speed * ops::f64::exp(property),
        }
    }

    /// Speed in m/s of a drop of `diameter_mm`, which may be 0.
    pub(super) fn speed(&self, diameter_mm: f64) -> f64 {
        let [stokes_end, sphere_end, largest] = JOINTS_MM;
        let d = diameter_mm.min(largest);
        if d < stokes_end {
            return self.stokes * d * (d + self.slip_mm);
        }
        if d < sphere_end {
            let y = polynomial(&SPHERE, self.davies_log + 3.0 * ops::f64::ln(d));
            return self.davies_speed * (1.0 + self.slip_mm / d) / d * ops::f64::exp(y);
        }
        let y = polynomial(&FLATTENED, self.bond_log + 2.0 * ops::f64::ln(d));
        self.bond_speed / d * ops::f64::exp(y)
    }
}

fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Properties of air and water that the models need, for shaders and their twins. Eight numbers, 32 bytes.
///
/// ```
/// use downpour_drop::air::Air;
/// use downpour_drop::fall_speed::{FallSpeedAir, fall_speed_beard_1976};
/// let air = FallSpeedAir::new(&Air::standard());
/// assert!((fall_speed_beard_1976(4.0e-3, air) - 8.811).abs() < 0.001);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FallSpeedAir {
    /// Speed of a drop of 1 mm in Stokes flow, m/s.
    pub stokes: f32,
    /// 2.51 mean free paths, mm.
    pub slip_mm: f32,
    /// ln of the Davies number of a drop of 1 mm.
    pub davies_log: f32,
    /// Speed at Re = 1 of a drop of 1 mm, m/s.
    pub davies_speed: f32,
    /// ln(Bo `N_P`^(1/6)) of a drop of 1 mm, minus 5.
    pub bond_log: f32,
    /// Speed at Re = `N_P`^(1/6) of a drop of 1 mm, m/s.
    pub bond_speed: f32,
    /// (rho0/rho)^0.4, for the tables and the fits.
    pub density_factor: f32,
    /// Padding, 0.
    pub unused: f32,
}

impl FallSpeedAir {
    /// Computes the constants of `air` in f64.
    #[must_use]
    pub fn new(air: &Air) -> Self {
        let beard = Beard::new(air);
        Self {
            stokes: beard.stokes as f32,
            slip_mm: beard.slip_mm as f32,
            davies_log: beard.davies_log as f32,
            davies_speed: beard.davies_speed as f32,
            bond_log: (beard.bond_log - CENTER) as f32,
            bond_speed: beard.bond_speed as f32,
            density_factor: air.speed_factor() as f32,
            unused: 0.0,
        }
    }
}

/// Terminal speed in m/s by Beard 1976. Diameter in meters, 0 to 9e-3.
#[must_use]
pub fn fall_speed_beard_1976(diameter_m: f32, air: FallSpeedAir) -> f32 {
    let d = (diameter_m * 1000.0).clamp(0.0, FALL_SPEED_BEARD_MAX_MM);
    if d < FALL_SPEED_BEARD_STOKES_MM {
        return air.stokes * d * (d + air.slip_mm);
    }
    if d < FALL_SPEED_BEARD_SPHERE_MM {
        return fall_speed_beard_sphere(d, air);
    }
    fall_speed_beard_flattened(d, air)
}

/// Beard 1976, second regime, 0.019 to 1.07 mm: spheres, by the Davies number. Diameter in mm.
#[must_use]
pub fn fall_speed_beard_sphere(diameter_mm: f32, air: FallSpeedAir) -> f32 {
    let x = air.davies_log + 3.0 * ops::ln(diameter_mm);
    let mut y = FALL_SPEED_BEARD_SPHERE[6];
    y = y * x + FALL_SPEED_BEARD_SPHERE[5];
    y = y * x + FALL_SPEED_BEARD_SPHERE[4];
    y = y * x + FALL_SPEED_BEARD_SPHERE[3];
    y = y * x + FALL_SPEED_BEARD_SPHERE[2];
    y = y * x + FALL_SPEED_BEARD_SPHERE[1];
    y = y * x + FALL_SPEED_BEARD_SPHERE[0];
    let inverse = 1.0 / diameter_mm;
    air.davies_speed * (1.0 + air.slip_mm * inverse) * inverse * ops::exp(y)
}

/// Beard 1976, third regime, 1.07 to 7 mm: flattened drops, by Bond and physical property number. Diameter in mm. The
/// polynomial is expanded about 5, the middle of its range: about 0 its terms of either sign would cost a digit.
#[must_use]
pub fn fall_speed_beard_flattened(diameter_mm: f32, air: FallSpeedAir) -> f32 {
    let x = air.bond_log + 2.0 * ops::ln(diameter_mm);
    let mut y = FALL_SPEED_BEARD_FLATTENED[5];
    y = y * x + FALL_SPEED_BEARD_FLATTENED[4];
    y = y * x + FALL_SPEED_BEARD_FLATTENED[3];
    y = y * x + FALL_SPEED_BEARD_FLATTENED[2];
    y = y * x + FALL_SPEED_BEARD_FLATTENED[1];
    y = y * x + FALL_SPEED_BEARD_FLATTENED[0];
    air.bond_speed / diameter_mm * ops::exp(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_precisions_have_the_same_coefficients() {
        assert_eq!(SPHERE.map(|c| c as f32), FALL_SPEED_BEARD_SPHERE);
        // The published polynomial about 5: repeated synthetic division by x - 5.
        let mut shifted = FLATTENED;
        for first in 0..shifted.len() {
            for i in (first..shifted.len() - 1).rev() {
                shifted[i] += CENTER * shifted[i + 1];
            }
        }
        assert_eq!(shifted.map(|c| c as f32), FALL_SPEED_BEARD_FLATTENED);
        let joints = [FALL_SPEED_BEARD_STOKES_MM, FALL_SPEED_BEARD_SPHERE_MM, FALL_SPEED_BEARD_MAX_MM];
        assert_eq!(JOINTS_MM.map(|d| d as f32), joints);
    }
}
