//! Frequency and damping of drop oscillations.

use downpour_math::in_range;
use std::f64::consts::TAU;

use crate::DropError;
use crate::air::Air;
use crate::shape::check_diameter;
use crate::water::kinematic_viscosity;

/// Properties of the water and the air of a drop. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluids {
    /// Surface tension, N/m.
    pub surface_tension: f64,
    /// Density of water, kg/m3.
    pub water_density: f64,
    /// Density of air, kg/m3; only [`FrequencyLaw::LambTwoFluid`] uses it.
    pub air_density: f64,
    /// Kinematic viscosity of water, m2/s.
    pub kinematic_viscosity: f64,
}

impl Fluids {
    /// Water in air at 20 C and 1013.25 hPa.
    pub const AT_20_C: Self = Self {
        surface_tension: 0.072736,
        water_density: 998.204,
        air_density: 1.204,
        kinematic_viscosity: 1.0034e-6,
    };

    /// Water at the temperature of the air that it falls through.
    #[must_use]
    pub fn in_air(air: &Air) -> Self {
        Self {
            surface_tension: air.water_surface_tension(),
            water_density: air.water_density(),
            air_density: air.density(),
            // Air is never outside the range of the laws of water.
            kinematic_viscosity: kinematic_viscosity(air.temperature_c())
                .unwrap_or(Self::AT_20_C.kinematic_viscosity),
        }
    }

    fn check(&self) -> Result<(), DropError> {
        in_range("surface tension", self.surface_tension, "N/m", &(1.0e-3..=1.0), 1.0, "0.001 to 1")?;
        in_range("density of water", self.water_density, "kg/m3", &(100.0..=20_000.0), 1.0, "100 to 20000")?;
        in_range("density of air", self.air_density, "kg/m3", &(0.0..=100.0), 1.0, "0 to 100")?;
        in_range("kinematic viscosity", self.kinematic_viscosity, "m2/s", &(1.0e-9..=1.0), 1.0, "1e-9 to 1")?;
        Ok(())
    }
}

/// Law of the frequency of a small oscillation of degree n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FrequencyLaw {
    /// Lord Rayleigh 1879, a drop in empty space: `omega^2 = n (n - 1) (n + 2) sigma / (rho r0^3)`.
    #[default]
    Rayleigh1879,
    /// Lamb, including the inertia of the air:
    /// `omega^2 = (n - 1) n (n + 1) (n + 2) sigma / (((n + 1) rho + n rho_air) r0^3)`; 0.04 % lower.
    LambTwoFluid,
}

impl FrequencyLaw {
    /// `omega_n` in rad/s.
    ///
    /// ```
    /// use downpour_drop::oscillation::{Fluids, FrequencyLaw};
    /// let omega = FrequencyLaw::Rayleigh1879.angular_frequency(2, 3.2e-3, &Fluids::AT_20_C)?;
    /// // The period of the streak database of Garg & Nayar is 1/60 s, at a radius of 1.6 mm.
    /// assert!((omega / std::f64::consts::TAU - 60.0).abs() < 0.1);
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if n is not 2 to 100, the diameter not 1 um to 9 mm, or a property of the fluids far
    /// from any liquid's.
    pub fn angular_frequency(self, n: u32, diameter_m: f64, fluids: &Fluids) -> Result<f64, DropError> {
        check_mode(n)?;
        check_diameter(diameter_m, 1.0e-6..=9.0e-3, "0.001 to 9")?;
        fluids.check()?;
        let (n, r0) = (f64::from(n), 0.5 * diameter_m);
        let stiffness = (n - 1.0) * n * (n + 2.0) * fluids.surface_tension;
        let density = match self {
            Self::Rayleigh1879 => fluids.water_density,
            Self::LambTwoFluid => fluids.water_density + n / (n + 1.0) * fluids.air_density,
        };
        Ok((stiffness / (density * r0 * r0 * r0)).sqrt())
    }

    /// Frequency in Hz.
    ///
    /// # Errors
    /// As [`FrequencyLaw::angular_frequency`].
    pub fn frequency(self, n: u32, diameter_m: f64, fluids: &Fluids) -> Result<f64, DropError> {
        Ok(self.angular_frequency(n, diameter_m, fluids)? / TAU)
    }
}

/// Lamb: `tau_n = r0^2 / ((n - 1) (2 n + 1) nu)`, the time in s in which viscosity reduces the amplitude of a
/// mode of degree n to 1/e.
///
/// # Errors
/// As [`FrequencyLaw::angular_frequency`].
pub fn lamb_damping_time(n: u32, diameter_m: f64, fluids: &Fluids) -> Result<f64, DropError> {
    check_mode(n)?;
    check_diameter(diameter_m, 1.0e-6..=9.0e-3, "0.001 to 9")?;
    fluids.check()?;
    let (n, r0) = (f64::from(n), 0.5 * diameter_m);
    Ok(r0 * r0 / ((n - 1.0) * (2.0 * n + 1.0) * fluids.kinematic_viscosity))
}

/// Checks the degree of a mode: degrees 0 and 1 change the volume and move the drop, and do not oscillate.
fn check_mode(n: u32) -> Result<(), DropError> {
    in_range("degree of the mode", n, "(a whole number)", &(2..=100), 1.0, "2 to 100")?;
    Ok(())
}
