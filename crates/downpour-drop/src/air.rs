//! Air that drops fall through: density, viscosity, mean free path.
//!
//! Laws, with the absolute temperature T and the pressure p:
//! - density: dry ideal gas, `rho = p / (287.04 T)`. Moist air is lighter by 0.378 times the ratio of vapor pressure
//!   to pressure (1.6 % if saturated at 30 C): neglected;
//! - viscosity: H. R. Pruppacher, J. D. Klett, Microphysics of Clouds and Precipitation, after Beard 1976:
//!   `(1.718 + 0.0049 t) e-5 Pa s` in Celsius, less `1.2e-10 t^2` below 0 C. By name, the straight line
//!   `(1.721 + 0.00487 t) e-5` that disdrometer software uses (0.2 % higher at 0 C);
//! - mean free path: K. V. Beard, J. Atmos. Sci. 33, 851 (1976):
//!   `6.62e-8 m (eta / 1.818e-5) (101325 / p) sqrt(T / 293.15)`.
//!
//! Units: Celsius, Pa, kg/m^3, Pa s, meters. Limits: -20 to 40 C, where drops are liquid and the laws of water
//! hold too; 300 to 1100 hPa, from the top of rain clouds to the lowest lands. A drop has the temperature of the air
//! here; real rain is a few degrees colder, at the wet-bulb temperature.

use std::ops::RangeInclusive;

use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::error::in_rounded_range;
use crate::water::{self, CELSIUS_ZERO_K};

/// Standard gravity, m/s^2.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Range of pressures, in Pa, in which the laws hold.
pub const PRESSURE_RANGE_PA: RangeInclusive<f64> = 30_000.0..=110_000.0;

/// Temperature and pressure of the air, both in range.
///
/// ```
/// use downpour_drop::air::Air;
/// let air = Air::new(10.0, 70_000.0)?;
/// assert!(air.density() < Air::standard().density());
/// assert!(Air::new(-60.0, 101_325.0).is_err());
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    temperature_c: f64,
    pressure_pa: f64,
}

impl Default for Air {
    fn default() -> Self {
        Self::standard()
    }
}

impl Air {
    /// Air at 20 C and 1013.25 hPa: that of Gunn & Kinzer's measurements and of the fits to them.
    #[must_use]
    pub const fn standard() -> Self {
        Self { temperature_c: 20.0, pressure_pa: 101_325.0 }
    }

    /// Creates air of a temperature in Celsius and a pressure in Pa.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] outside -20 to 40 C or 300 to 1100 hPa.
    pub fn new(temperature_c: f64, pressure_pa: f64) -> Result<Self, DropError> {
        let temperature_c = in_rounded_range(
            "air temperature",
            temperature_c,
            "C",
            &water::TEMPERATURE_RANGE_C,
            1.0,
            "-20 to 40 C",
        )?;
        let pressure_pa = in_rounded_range(
            "air pressure",
            pressure_pa,
            "hPa",
            &PRESSURE_RANGE_PA,
            0.01,
            "300 to 1100 hPa",
        )?;
        Ok(Self { temperature_c, pressure_pa })
    }

    /// Temperature in Celsius.
    #[must_use]
    pub const fn temperature_c(&self) -> f64 {
        self.temperature_c
    }

    /// Pressure in Pa.
    #[must_use]
    pub const fn pressure_pa(&self) -> f64 {
        self.pressure_pa
    }

    /// Absolute temperature in kelvin.
    #[must_use]
    pub fn temperature_k(&self) -> f64 {
        self.temperature_c + CELSIUS_ZERO_K
    }

    /// Density in kg/m^3.
    #[must_use]
    pub fn density(&self) -> f64 {
        self.pressure_pa / (287.04 * self.temperature_k())
    }

    /// Viscosity in Pa s: [`viscosity_pruppacher_klett`].
    #[must_use]
    pub fn viscosity(&self) -> f64 {
        viscosity_pruppacher_klett(self.temperature_c)
    }

    /// Mean free path of the molecules in meters.
    #[must_use]
    pub fn mean_free_path(&self) -> f64 {
        let warmth = (self.temperature_k() / 293.15).sqrt();
        6.62e-8 * (self.viscosity() / 1.818e-5) * (101_325.0 / self.pressure_pa) * warmth
    }

    /// (rho0 / rho)^0.4, with rho0 the density of standard air: ratio of the fall speed of a drop to that in standard
    /// air (G. B. Foote, P. S. du Toit, J. Appl. Meteor. 8, 249, 1969). 1 in standard air.
    #[must_use]
    pub fn speed_factor(&self) -> f64 {
        ops::pow(Self::standard().density() / self.density(), 0.4)
    }

    /// Density of the drops' water in kg/m^3, at the temperature of the air.
    #[must_use]
    pub fn water_density(&self) -> f64 {
        water::density_at(self.temperature_c)
    }

    /// Surface tension of the drops in N/m, at the temperature of the air.
    #[must_use]
    pub fn water_surface_tension(&self) -> f64 {
        water::surface_tension_at(self.temperature_c)
    }
}

/// Viscosity of air in Pa s at a temperature in Celsius, after Beard 1976 and Pruppacher & Klett.
#[must_use]
pub fn viscosity_pruppacher_klett(temperature_c: f64) -> f64 {
    let t = temperature_c;
    let cold = if t < 0.0 { 1.2e-5 * t * t } else { 0.0 };
    (1.718 + 0.0049 * t - cold) * 1.0e-5
}

/// Viscosity of air in Pa s at a temperature in Celsius, as disdrometer software computes it: the expansion of
/// `1.832e-5 (1 + 0.00266 (T - 296 K))`. The original paper was not seen.
#[must_use]
pub fn viscosity_linear(temperature_c: f64) -> f64 {
    (1.721 + 0.004_87 * temperature_c) * 1.0e-5
}
