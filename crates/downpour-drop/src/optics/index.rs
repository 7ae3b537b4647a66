//! Refractive indices of water and air by wavelength, temperature and density.
//!
//! Laws: water, IAPWS R9-97, "Release on the Refractive Index of Ordinary Water Substance" (1997), against vacuum,
//! 0.2 to 1.1 um and from -12 C; air, P. E. Ciddor, Applied Optics 35, 1566 (1996), dry with 450 ppm CO2 at 15 C and
//! 1013.25 hPa, the refractivity scaled with the density. Moisture would lower the index of air by 2e-6 at most.
//! The table of Hale & Querry 1973 is rounded, and too low in the blue: it is not used.

use std::ops::RangeInclusive;

use crate::DropError;
use crate::air::Air;
use crate::error::in_rounded_range;
use crate::water::{self, CELSIUS_ZERO_K};

/// Commonly used index of water in air: sodium light (589.3 nm) at 20 C, rounded from 1.33298.
pub const WATER_INDEX: f64 = 1.333;

/// Wavelengths, in meters, at which red, green and blue light is refracted: 611, 549 and 464 nm, the dominant
/// wavelengths of the primaries of ITU-R BT.709 (sRGB) against D65, for the CIE 1931 observer.
pub const RGB_WAVELENGTHS_M: [f64; 3] = [611.0e-9, 549.0e-9, 464.0e-9];

const WAVELENGTH_RANGE_M: RangeInclusive<f64> = 200.0e-9..=1100.0e-9;
const TEMPERATURE_RANGE_C: RangeInclusive<f64> = -12.0..=500.0;
const DENSITY_RANGE: RangeInclusive<f64> = 0.0..=1060.0;

/// Index of water against vacuum at a wavelength in meters, a temperature in Celsius, and a density in kg/m^3.
///
/// ```
/// let n = downpour_drop::optics::water_index_iapws_1997(226.5e-9, 25.0, 997.047435)?;
/// assert!((n - 1.39277824).abs() < 1e-8);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside 200 to 1100 nm, -12 to 500 C, 0 to 1060 kg/m^3.
pub fn water_index_iapws_1997(
    wavelength_m: f64,
    temperature_c: f64,
    density_kg_m3: f64,
) -> Result<f64, DropError> {
    const A: [f64; 8] = [
        0.244_257_733,
        9.746_344_76e-3,
        -3.732_349_96e-3,
        2.686_784_72e-4,
        1.589_205_70e-3,
        2.459_342_59e-3,
        0.900_704_920,
        -1.666_262_19e-2,
    ];
    const ULTRAVIOLET: f64 = 0.229_202;
    const INFRARED: f64 = 5.432_937;
    let wavelength =
        in_rounded_range("wavelength", wavelength_m, "nm", &WAVELENGTH_RANGE_M, 1.0e9, "200 to 1100 nm")?;
    let celsius =
        in_rounded_range("water temperature", temperature_c, "C", &TEMPERATURE_RANGE_C, 1.0, "-12 to 500 C")?;
    let density =
        in_rounded_range("water density", density_kg_m3, "kg/m^3", &DENSITY_RANGE, 1.0, "0 to 1060 kg/m^3")?;

    let t = (celsius + CELSIUS_ZERO_K) / CELSIUS_ZERO_K;
    let d = density / 1000.0;
    let squared = (wavelength / 589.0e-9) * (wavelength / 589.0e-9);
    let molar = d
        * (A[0]
            + A[1] * d
            + A[2] * t
            + A[3] * squared * t
            + A[4] / squared
            + A[5] / (squared - ULTRAVIOLET * ULTRAVIOLET)
            + A[6] / (squared - INFRARED * INFRARED)
            + A[7] * d * d);
    // Lorentz-Lorenz: molar = (n^2 - 1) / (n^2 + 2).
    Ok(((2.0 * molar + 1.0) / (1.0 - molar)).sqrt())
}

/// Index of water against vacuum at a wavelength in meters and a temperature in Celsius, at atmospheric pressure.
///
/// # Errors
/// [`DropError::OutOfRange`] outside 200 to 1100 nm and -12 to 40 C.
pub fn water_index(wavelength_m: f64, temperature_c: f64) -> Result<f64, DropError> {
    water_index_iapws_1997(wavelength_m, temperature_c, water::density(temperature_c)?)
}

/// Index of air against vacuum at a wavelength in meters (Ciddor 1996): 1.000272 for visible light at 20 C.
///
/// # Errors
/// [`DropError::OutOfRange`] outside 200 to 1100 nm.
pub fn air_index(wavelength_m: f64, air: &Air) -> Result<f64, DropError> {
    let wavelength =
        in_rounded_range("wavelength", wavelength_m, "nm", &WAVELENGTH_RANGE_M, 1.0e9, "200 to 1100 nm")?
            * 1.0e6;
    let squared = 1.0 / (wavelength * wavelength);
    let refractivity = 0.057_921_05 / (238.0185 - squared) + 0.001_679_17 / (57.362 - squared);
    let density = (air.pressure_pa() / 101_325.0) * (288.15 / air.temperature_k());
    Ok(1.0 + refractivity * density)
}

/// Index of water against the surrounding air, both at one temperature, at a wavelength in meters.
///
/// ```
/// use downpour_drop::{air::Air, optics::water_index_in_air};
/// let n = water_index_in_air(589.3e-9, &Air::standard())?;
/// assert!((n - 1.33298).abs() < 1e-5);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] outside 200 to 1100 nm, or in air below -12 C.
pub fn water_index_in_air(wavelength_m: f64, air: &Air) -> Result<f64, DropError> {
    Ok(water_index(wavelength_m, air.temperature_c())? / air_index(wavelength_m, air)?)
}

/// Indices of water against the surrounding air for red, green and blue ([`RGB_WAVELENGTHS_M`]).
///
/// ```
/// use downpour_drop::{air::Air, optics::rgb_indices};
/// let [red, green, blue] = rgb_indices(&Air::standard())?;
/// assert!(red < green && green < blue);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] in air below -12 C.
pub fn rgb_indices(air: &Air) -> Result<[f64; 3], DropError> {
    let [red, green, blue] = RGB_WAVELENGTHS_M;
    Ok([water_index_in_air(red, air)?, water_index_in_air(green, air)?, water_index_in_air(blue, air)?])
}
