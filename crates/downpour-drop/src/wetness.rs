//! Wetness of a surface in rain: the fraction of what it can hold that it holds.
//!
//! A surface stores a depth `s` of water in its pores and as a film before more runs off. Where a part `w` of it is wet already,
//! rain that falls there runs off, so that the storage fills by `dw/dx = (1 - w) / s` with the depth `x` of rain:
//! `w = 1 - (1 - w0) exp(-x / s)`. It is the law of interception of A. J. Rutter et al. (Agricultural Meteorology 9, 1971) and of
//! R. A. Merriam (Water Resources Research, 1960) for a surface from which what is over the storage runs off.
//!
//! Storage: initial losses of asphalt and concrete are 0.2 to 0.6 mm before the first runoff (A. Kidd, Rainfall-runoff processes over
//! urban surfaces, 1978); 0.3 mm by default.
//!
//! After rain the loss is in proportion to what is wet: `w = w0 exp(-t / tau)`. `tau` is the storage over the evaporation of an open
//! surface of water, by H. L. Penman's law of mass transfer (Proc. R. Soc. A 193, 1948): `E = 0.26 (1 + 0.54 u) (es - e)` mm per day
//! with the wind `u` at 2 m in m/s and the vapor pressures in hPa. At 15 C, 70 % of humidity and 2 m/s, `es - e` is 5.1 hPa and
//! `E` 0.115 mm/h: 2.6 hours for 0.3 mm. In sunshine it is 0.5 mm/h and more: half an hour.
//!
//! Units: m, s. Everything is a function of time alone: nothing is stepped.

use std::ops::RangeInclusive;

use downpour_math::in_range;
use downpour_math::ops::f64 as ops;

use crate::DropError;

/// Range of the storage, in m.
pub const STORAGE_RANGE_M: RangeInclusive<f64> = 1.0e-5..=0.01;

/// Range of the time constant of drying, in s.
pub const DRYING_RANGE_S: RangeInclusive<f64> = 1.0..=1.0e7;

/// Storage of asphalt, in m.
pub const STORAGE_M: f64 = 0.3e-3;

/// Time constant of drying at 15 C, 70 % of humidity and a wind of 2 m/s, in s.
pub const DRYING_S: f64 = 9400.0;

/// Evaporation of an open surface of water without sunshine, in m/s, for a wind at 2 m in m/s and a deficit of vapor pressure in
/// Pa (Penman 1948).
#[must_use]
pub fn evaporation(wind_m_s: f64, deficit_pa: f64) -> f64 {
    let mm_per_day = 0.26 * (1.0 + 0.54 * wind_m_s) * (deficit_pa * 0.01);
    mm_per_day * 1.0e-3 / 86_400.0
}

/// Storage and drying of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wetting {
    storage_m: f64,
    drying_s: f64,
}

impl Default for Wetting {
    /// Asphalt: [`STORAGE_M`] and [`DRYING_S`].
    fn default() -> Self {
        Self { storage_m: STORAGE_M, drying_s: DRYING_S }
    }
}

impl Wetting {
    /// A surface that stores a depth of water in m and dries with a time constant in s.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] outside [`STORAGE_RANGE_M`] or [`DRYING_RANGE_S`].
    pub fn new(storage_m: f64, drying_s: f64) -> Result<Self, DropError> {
        in_range("storage of a surface", storage_m, "mm", &STORAGE_RANGE_M, 1.0e3, "0.01 to 10")?;
        in_range("drying time of a surface", drying_s, "s", &DRYING_RANGE_S, 1.0, "1 to 1e7")?;
        Ok(Self { storage_m, drying_s })
    }

    /// Depth of rain in m as a number of storages.
    #[must_use]
    pub fn dose(&self, depth_m: f64) -> f64 {
        depth_m.max(0.0) / self.storage_m
    }

    /// Wetness after a depth of rain in m, from a wetness in [0, 1].
    #[must_use]
    pub fn after_rain(&self, wetness: f64, depth_m: f64) -> f64 {
        1.0 - (1.0 - wetness.clamp(0.0, 1.0)) * ops::exp(-self.dose(depth_m))
    }

    /// Fraction of its wetness that a surface keeps after a time without rain in s.
    #[must_use]
    pub fn kept(&self, time_s: f64) -> f64 {
        ops::exp(-time_s.max(0.0) / self.drying_s)
    }

    /// Wetness after a time without rain in s, from a wetness in [0, 1].
    #[must_use]
    pub fn after_drying(&self, wetness: f64, time_s: f64) -> f64 {
        wetness.clamp(0.0, 1.0) * self.kept(time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed forms solve their differential equations, integrated here in small steps.
    #[test]
    fn wetness_solves_its_equation() {
        let wetting = Wetting::new(0.4e-3, 1800.0).unwrap();
        // 5 mm/h for 6 minutes, then half an hour of drying.
        let (mut w, steps) = (0.1, 200_000);
        let rate = 5.0e-3 / 3600.0;
        for _ in 0..steps {
            w += (1.0 - w) * rate / 0.4e-3 * (360.0 / f64::from(steps));
        }
        let found = wetting.after_rain(0.1, rate * 360.0);
        assert!((found - w).abs() < 1.0e-5, "{found} {w}");
        for _ in 0..steps {
            w -= w / 1800.0 * (1800.0 / f64::from(steps));
        }
        let found = wetting.after_drying(found, 1800.0);
        assert!((found - w).abs() < 1.0e-5, "{found} {w}");
    }

    /// A storage of rain wets 1 - 1/e; two rains after each other are one of their sum.
    #[test]
    fn rain_adds_up() {
        let wetting = Wetting::default();
        assert!((wetting.after_rain(0.0, STORAGE_M) - 0.632_120_558_8).abs() < 1.0e-9);
        let twice = wetting.after_rain(wetting.after_rain(0.0, 1.0e-4), 2.5e-4);
        assert!((twice - wetting.after_rain(0.0, 3.5e-4)).abs() < 1.0e-12);
    }

    /// Ten cycles of rain and drying: it rises in each rain, falls in each pause, stays in [0, 1], and each peak is at least the
    /// one before.
    #[test]
    fn ten_cycles_are_monotone() {
        let wetting = Wetting::default();
        let (mut w, mut last_peak) = (0.0, 0.0);
        for _ in 0..10 {
            for _ in 0..20 {
                let next = wetting.after_rain(w, 2.0e-5);
                assert!(next > w && next <= 1.0, "{w} {next}");
                w = next;
            }
            assert!(w >= last_peak, "{w} {last_peak}");
            last_peak = w;
            for _ in 0..20 {
                let next = wetting.after_drying(w, 300.0);
                assert!(next < w && next >= 0.0, "{w} {next}");
                w = next;
            }
        }
    }

    /// Penman 1948 at 15 C (saturation 17.04 hPa), 70 % of humidity, 2 m/s: 2.76 mm per day, and the default time constant.
    #[test]
    fn drying_is_that_of_evaporation() {
        let rate = evaporation(2.0, 0.3 * 1704.0);
        assert!((rate * 8.64e7 - 2.765).abs() < 0.01, "{rate}");
        assert!((STORAGE_M / rate / DRYING_S - 1.0).abs() < 0.01, "{}", STORAGE_M / rate);
    }

    #[test]
    fn surfaces_out_of_range_are_refused() {
        assert!(Wetting::new(0.0, 100.0).is_err());
        assert!(Wetting::new(3.0e-4, 0.5).is_err());
        assert!(Wetting::new(f64::NAN, 100.0).is_err());
    }
}
