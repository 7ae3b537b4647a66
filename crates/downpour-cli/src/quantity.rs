//! Numbers from arguments: finite, in range, in the unit that the argument names.

use std::ops::RangeInclusive;

use downpour::ClipLight;
use downpour::drop::air::PRESSURE_RANGE_PA;
use downpour::drop::distribution::RATE_RANGE_MM_H;
use downpour::drop::oscillation::Amplitudes;
use downpour::drop::shape::{MAX_DIAMETER, MIN_DIAMETER};
use downpour::drop::water::TEMPERATURE_RANGE_C;
use downpour::mask::SIZES;
use downpour::specimen::{MAX_EXPOSURE_S, SpecimenLamp};
use downpour::trace::data::MAX_RAY_SPACING;
use downpour::trace::frame_scene::LATEST_S;

/// Minimum temperature of water, in Celsius, with a known refractive index.
const MIN_INDEX_C: f64 = -12.0;

/// Diameter of a drop, in mm.
pub(crate) fn diameter_mm(text: &str) -> Result<f64, String> {
    read(text, &(MIN_DIAMETER * 1.0e3..=MAX_DIAMETER * 1.0e3), "0.001 to 9 mm")
}

/// Temperature of air and water, in Celsius.
pub(crate) fn temperature_c(text: &str) -> Result<f64, String> {
    read(text, &TEMPERATURE_RANGE_C, "-20 to 40 C")
}

/// Temperature, in Celsius, of water for its refractive index.
pub(crate) fn temperature_of_index_c(text: &str) -> Result<f64, String> {
    read(text, &(MIN_INDEX_C..=*TEMPERATURE_RANGE_C.end()), "-12 to 40 C")
}

/// Pressure, in hPa.
pub(crate) fn pressure_hpa(text: &str) -> Result<f64, String> {
    read(text, &(PRESSURE_RANGE_PA.start() * 0.01..=PRESSURE_RANGE_PA.end() * 0.01), "300 to 1100 hPa")
}

/// Rain rate, in mm/h. A rate that is not 0, but would be in single precision, is refused: it is a slip of the pen, and
/// no rain.
pub(crate) fn rate_mm_h(text: &str) -> Result<f64, String> {
    let rate = read(text, &RATE_RANGE_MM_H, "0 to 500 mm/h")?;
    if rate > 0.0 && rate < f64::from(f32::MIN_POSITIVE) {
        return Err("too small to differ from 0; allowed: 0 to 500 mm/h".to_owned());
    }
    Ok(rate)
}

/// Elevation of a view, in degrees.
pub(crate) fn elevation_deg(text: &str) -> Result<f64, String> {
    read(text, &(-90.0..=90.0), "-90 to 90 degrees")
}

/// Any angle of a view, in degrees.
pub(crate) fn yaw_deg(text: &str) -> Result<f64, String> {
    read(text, &(-36_000.0..=36_000.0), "-36000 to 36000 degrees")
}

/// Vertical field of view, in degrees.
pub(crate) fn fov_deg(text: &str) -> Result<f64, String> {
    read(text, &(1.0e-4..=170.0), "0.0001 to 170 degrees")
}

/// Distance of a camera, in meters.
pub(crate) fn distance_m(text: &str) -> Result<f64, String> {
    read(text, &(1.0e-4..=1.0e4), "0.0001 to 10000 m")
}

/// Width and height of a picture, as `WxH`. Any integers are parsed: larger ones are over a limit.
pub(crate) fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let allowed = "WxH, for example 960x540, each from 1 to 16384";
    let edge = |part: &str| -> Result<u32, String> {
        let digits = !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
        match part.parse::<u32>() {
            Ok(n @ 1..) => Ok(n),
            Err(_) if digits => Ok(u32::MAX),
            _ => Err(format!("allowed: {allowed}")),
        }
    };
    let (width, height) = text.split_once('x').ok_or_else(|| format!("allowed: {allowed}"))?;
    Ok([edge(width)?, edge(height)?])
}

/// Time since the rain began, in seconds.
pub(crate) fn time_s(text: &str) -> Result<f64, String> {
    read(text, &(0.0..=LATEST_S), "0 to 1000000 s")
}

/// Exposure of a streak, in seconds.
pub(crate) fn exposure_s(text: &str) -> Result<f64, String> {
    read(text, &(0.0..=MAX_EXPOSURE_S), "0 to 1 s")
}

/// Sampling of a specimen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpecimenSamples {
    /// Exactly: samples along an edge of a pixel for a drop at rest, instants for each sample for a streak.
    Number(u32),
    /// As the renderer of rain draws a streak, by its table.
    Table,
}

/// Samples of a specimen, or `table`. Any integer is parsed: larger ones are over a limit.
pub(crate) fn specimen_samples(text: &str) -> Result<SpecimenSamples, String> {
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    match text.parse::<u32>() {
        _ if text == "table" => Ok(SpecimenSamples::Table),
        Ok(n @ 1..) => Ok(SpecimenSamples::Number(n)),
        Err(_) if digits => Ok(SpecimenSamples::Number(u32::MAX)),
        _ => Err("allowed: a whole number from 1 to 4096 (of a drop at rest: to 16), or table".to_owned()),
    }
}

/// Amplitudes of an oscillation: `none`, or those of the modes (2,0) and (3,1).
pub(crate) fn oscillation(text: &str) -> Result<Amplitudes, String> {
    if text == "none" {
        return Ok(Amplitudes::NONE);
    }
    let [a20, a31] = pair(text, &(0.0..=0.3), "none, or two numbers from 0 to 0.3, as 0.2,0.1")?;
    Amplitudes::new(a20, a31).map_err(|error| error.to_string())
}

/// A lamp far away: yaw, pitch and angular radius in degrees, and radiance, gray or as red, green, blue.
pub(crate) fn lamp(text: &str) -> Result<SpecimenLamp, String> {
    const ALLOWED: &str = "YAW,PITCH,RADIUS,L or YAW,PITCH,RADIUS,R,G,B, as 160,5,2,500";
    let number = |part: &str, low: f64, high: f64, what: &str| {
        read(part.trim(), &(low..=high), what).map_err(|error| format!("\"{part}\" in {ALLOWED}: {error}"))
    };
    let parts: Vec<&str> = text.split(',').collect();
    let (yaw, pitch, radius, colors) = match parts[..] {
        [yaw, pitch, radius, gray] => (yaw, pitch, radius, [gray; 3]),
        [yaw, pitch, radius, red, green, blue] => (yaw, pitch, radius, [red, green, blue]),
        _ => return Err(format!("allowed: {ALLOWED}")),
    };
    let yaw = number(yaw, -36_000.0, 36_000.0, "YAW -36000 to 36000 degrees")?;
    let pitch = number(pitch, -90.0, 90.0, "PITCH -90 to 90 degrees")?;
    let radius = number(radius, 0.01, 90.0, "RADIUS 0.01 to 90 degrees")?;
    let mut radiance = [0.0; 3];
    for (color, part) in radiance.iter_mut().zip(colors) {
        *color = number(part, 0.0, 1.0e9, "radiance 0 to 1e9")? as f32;
    }
    SpecimenLamp::new(yaw.to_radians(), pitch.to_radians(), radius.to_radians(), radiance)
        .map_err(|error| error.to_string())
}

/// Phases of the modes (2,0) and (3,1), in turns.
pub(crate) fn phase(text: &str) -> Result<[f64; 2], String> {
    pair(text, &(-1000.0..=1000.0), "two numbers from -1000 to 1000, as 0.25,0")
}

fn pair(text: &str, range: &RangeInclusive<f64>, allowed: &str) -> Result<[f64; 2], String> {
    let (first, second) = text.split_once(',').ok_or_else(|| format!("allowed: {allowed}"))?;
    Ok([read(first, range, allowed)?, read(second, range, allowed)?])
}

/// Edge of a cell of a lattice, in mm.
pub(crate) fn cell_mm(text: &str) -> Result<f64, String> {
    read(text, &(0.1..=1000.0), "0.1 to 1000 mm")
}

/// Depth of water, in mm.
pub(crate) fn depth_mm(text: &str) -> Result<f64, String> {
    read(text, &(0.1..=1.0e6), "0.1 to 1000000 mm")
}

/// Tilt of a pane from the horizontal, in degrees.
pub(crate) fn tilt_deg(text: &str) -> Result<f64, String> {
    read(text, &(0.0..=90.0), "0 to 90 degrees")
}

/// Speed of air, in m/s.
pub(crate) fn speed_m_s(text: &str) -> Result<f64, String> {
    read(text, &(0.0..=100.0), "0 to 100 m/s")
}

/// A time step, in seconds.
pub(crate) fn step_s(text: &str) -> Result<f64, String> {
    read(text, &(1.0e-6..=1.0), "0.000001 to 1 s")
}

/// Number of steps of a lattice.
pub(crate) fn steps(text: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|steps| (1..=1_000_000_000).contains(steps));
    number.ok_or_else(|| "allowed: a whole number from 1 to 1000000000".to_owned())
}

/// Samples along an edge of a pixel.
pub(crate) fn samples(text: &str) -> Result<u32, String> {
    whole(text, 1..=8)
}

/// Rays to the sky per sample.
pub(crate) fn sky_rays(text: &str) -> Result<u32, String> {
    whole(text, 0..=64)
}

/// Pixels between those whose rays look for light.
pub(crate) fn ray_spacing(text: &str) -> Result<u32, String> {
    whole(text, 1..=MAX_RAY_SPACING)
}

/// Frames over which light is averaged.
pub(crate) fn light_frames(text: &str) -> Result<u32, String> {
    whole(text, 1..=ClipLight::MAX_FRAMES)
}

/// Seed of random numbers.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("allowed: a whole number from 0 to {}", u64::MAX))
}

fn whole(text: &str, range: RangeInclusive<u32>) -> Result<u32, String> {
    let (start, end) = (*range.start(), *range.end());
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("allowed: a whole number from {start} to {end}"))
}

/// Refractive index relative to air.
pub(crate) fn refractive_index(text: &str) -> Result<f64, String> {
    let allowed = "above 1, up to 4";
    let index = read(text, &(1.0..=4.0), allowed)?;
    if index > 1.0 { Ok(index) } else { Err(out_of_range(allowed)) }
}

/// Wavelength of light, in nm.
pub(crate) fn wavelength_nm(text: &str) -> Result<f64, String> {
    read(text, &(200.0..=1100.0), "200 to 1100 nm")
}

/// Shape of a gamma distribution.
pub(crate) fn gamma_shape(text: &str) -> Result<f64, String> {
    read(text, &(-3.0..=8.0), "-3 to 8")
}

/// Median volume diameter, in mm.
pub(crate) fn median_diameter_mm(text: &str) -> Result<f64, String> {
    read(text, &(0.2..=5.0), "0.2 to 5 mm")
}

/// Intercept of a gamma distribution, in m^-3 mm^-(1 + mu).
pub(crate) fn intercept(text: &str) -> Result<f64, String> {
    read(text, &(1.0e-2..=1.0e10), "0.01 to 1e10 m^-3 mm^-(1 + mu)")
}

/// Edge of a mask in pixels. Any integer is parsed: one that is too large is over a limit, not a bad argument.
pub(crate) fn size(text: &str) -> Result<u64, String> {
    let least = u64::from(*SIZES.start());
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    match text.parse::<u64>() {
        Ok(size) if size >= least => Ok(size),
        // More digits than a u64 has.
        Err(_) if digits => Ok(u64::MAX),
        _ => Err(format!("allowed: a whole number from {least} to {}", SIZES.end())),
    }
}

fn read(text: &str, range: &RangeInclusive<f64>, allowed: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("not a number; allowed: {allowed}"))?;
    if !number.is_finite() {
        return Err(format!("not finite; allowed: {allowed}"));
    }
    // The bounds come from numbers in other units, so they are met up to rounding; the libraries do the same.
    const ROUNDING: f64 = 1.0e-12;
    let (start, end) = (*range.start(), *range.end());
    if number < start - ROUNDING * start.abs() || number > end + ROUNDING * end.abs() {
        return Err(out_of_range(allowed));
    }
    // 0 has no sign here.
    Ok(number + 0.0)
}

fn out_of_range(allowed: &str) -> String {
    format!("out of range; allowed: {allowed}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!(diameter_mm("2"), Ok(2.0));
        assert_eq!(diameter_mm("9"), Ok(9.0));
        assert_eq!(diameter_mm("0.001"), Ok(0.001));
        for (text, words) in [
            ("NaN", "not finite"),
            ("inf", "not finite"),
            ("-inf", "not finite"),
            ("1e400", "not finite"),
            ("1e39", "out of range"),
            ("1e-46", "out of range"),
            ("-1", "out of range"),
            ("0", "out of range"),
            ("9.00001", "out of range"),
            ("2 mm", "not a number"),
            ("", "not a number"),
        ] {
            assert_eq!(diameter_mm(text), Err(format!("{words}; allowed: 0.001 to 9 mm")), "{text}");
        }
    }

    #[test]
    fn a_dry_rate_has_no_sign_and_a_vanishing_one_is_refused() {
        assert!(rate_mm_h("-0").is_ok_and(|rate| rate.to_bits() == 0));
        assert_eq!(rate_mm_h("500"), Ok(500.0));
        assert_eq!(rate_mm_h("1e-30"), Ok(1.0e-30));
        assert!(rate_mm_h("1e-46").is_err() && rate_mm_h("500.1").is_err() && rate_mm_h("-1e-300").is_err());
    }

    #[test]
    fn a_picture_has_two_edges() {
        assert_eq!(picture_size("960x540"), Ok([960, 540]));
        assert_eq!(picture_size("16385x1"), Ok([16_385, 1]));
        assert_eq!(picture_size("99999999999x1"), Ok([u32::MAX, 1]));
        for text in ["0x0", "5x0", "960", "x", "1x-1", "1.5x2", "axb", "1x2x3", ""] {
            assert!(picture_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn whole_numbers_are_whole() {
        assert_eq!((samples("1"), samples("8"), sky_rays("0")), (Ok(1), Ok(8), Ok(0)));
        assert!(light_frames("8") == Ok(8) && light_frames("0").is_err() && light_frames("9").is_err());
        assert!(ray_spacing("4") == Ok(4) && ray_spacing("0").is_err() && ray_spacing("5").is_err());
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        for text in ["0", "9", "-1", "2.0", "", "nan", "99999999999"] {
            assert_eq!(samples(text), Err("allowed: a whole number from 1 to 8".to_owned()), "{text}");
        }
        assert!(seed("-1").is_err() && seed("18446744073709551616").is_err() && sky_rays("65").is_err());
        assert!(time_s("1e6").is_ok() && time_s("0").is_ok());
        assert!(time_s("-1").is_err() && time_s("nan").is_err() && time_s("1e39").is_err());
    }

    #[test]
    fn a_size_may_be_too_large_but_not_too_small() {
        assert_eq!(size("512"), Ok(512));
        assert_eq!(size("1000000"), Ok(1_000_000));
        assert_eq!(size("99999999999999999999999"), Ok(u64::MAX));
        for text in ["0", "3", "-1", "4.5", "", "1e3", "nan"] {
            assert_eq!(size(text), Err("allowed: a whole number from 4 to 4096".to_owned()), "{text}");
        }
    }
}
