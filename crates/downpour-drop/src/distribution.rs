//! Drop size distributions: number of drops by diameter for a rain of a given rate.
//!
//! Law: N(D) dD drops per volume have diameters from D to D + dD. They carry the rate
//! `R = pi/6 Int N v D^3 dD` (in the field's units `R = 6 pi 1e-4 Int N v D^3 dD`, N in 1/(m^3 mm), v in m/s, D in
//! mm, R in mm/h), with v the terminal speed. The published laws do not reproduce their own R: Marshall & Palmer's
//! carries 18 % more at 1 mm/h, 5 % more at 100 mm/h. Here N is therefore multiplied by one factor, [`scale`], so
//! that the integral over the included diameters is the requested rate;
//! [`published`](DropSizeDistribution::published) keeps the law as it was printed.
//!
//! [`scale`]: DropSizeDistribution::scale
//!
//! Laws ([`DropSizeLaw`]): Marshall & Palmer 1948, Best 1950, gamma (Ulbrich 1983), Feingold & Levin 1986, Joss 1968.
//!
//! Limits: rates from 0 (dry: everything is 0) to 500 mm/h; the laws were found between about 1 and 100 mm/h. Below
//! 0.1 mm/h, the lowest rate that differs from dew, the shape is that of 0.1 mm/h and only the number falls.
//! Diameters from 0.1 to 8 mm are included by default. Above, drops break up; at 100 mm/h the cut removes 0.2 %
//! (Marshall & Palmer) or 0.6 % (Best) of the rate, at 500 mm/h 2.7 % and 10.7 %. Below, drops drift rather than fall;
//! the cut removes 22 % of Marshall & Palmer's drops at 10 mm/h, but 0.02 % of their water and 5e-6 of the rate; at
//! 0.1 mm/h it removes 0.06 % of the rate by Best's law. Best's law has no finite number of drops without a cut.
//!
//! Units: SI, so N is in m^-4 (1 per m^3 and mm = 1000 m^-4); rates in mm/h. Extinction is geometric: Q = 2.
//!
//! Diameters are drawn from a [`SampleTable`] of quantiles, or from the closed form of the exponential law.
//! Functions whose names begin with `distribution_` are the twins of `shaders/wgsl/drop/distribution.wgsl`, in f32.

mod extinction;
mod grid;
mod law;
mod sampling;

use downpour_math::OutOfRange;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::air::Air;
use crate::error::in_rounded_range;
use crate::fall_speed::{FallSpeedModel, MAX_DIAMETER_M, TerminalSpeed};

pub use extinction::{ExtinctionEfficiency, ExtinctionLaw, KOSCHMIEDER, visibility};
pub use law::DropSizeLaw;
pub use sampling::{
    DistributionPosition, SampleTable, SampledBy, distribution_lerp, distribution_probability,
    distribution_sample_exponential, distribution_table_position,
};

use grid::Grid;
use law::Spectrum;

/// Range of accepted rates, in mm/h.
pub const RATE_RANGE_MM_H: RangeInclusive<f64> = 0.0..=500.0;

/// Rate, in mm/h, below which the shape of a distribution stays constant and only the number falls.
pub const MIN_SHAPE_RATE_MM_H: f64 = 0.1;

/// 1 mm/h in m/s.
const MM_H: f64 = 1.0e-3 / 3600.0;

/// Range of diameters of a distribution, and the fall speed of its drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistributionOptions {
    /// Smallest diameter, in meters: 0 (if the law has a finite number of drops), or from 1e-6.
    pub min_diameter_m: f64,
    /// Largest diameter, in meters: at most 9e-3.
    pub max_diameter_m: f64,
    /// Model of terminal speed.
    pub fall_speed: FallSpeedModel,
    /// Air that the drops fall through.
    pub air: Air,
}

impl Default for DistributionOptions {
    /// 0.1 to 8 mm, Beard 1976, standard air.
    fn default() -> Self {
        Self {
            min_diameter_m: 0.1e-3,
            max_diameter_m: 8.0e-3,
            fall_speed: FallSpeedModel::default(),
            air: Air::standard(),
        }
    }
}

/// Drop size distribution of a rain.
///
/// ```
/// use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
/// let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 10.0)?;
/// assert!((rain.integrated_rate_mm_h() - 10.0).abs() < 1e-9);
/// println!("{:.0} drops per m^3, half of the water in drops above {:.2} mm, sight {:.1} km",
///     rain.number_density(), rain.median_volume_diameter() * 1e3, rain.visibility() * 1e-3);
/// # assert!((1800.0..2400.0).contains(&rain.number_density()));
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DropSizeDistribution {
    law: DropSizeLaw,
    rate_mm_h: f64,
    spectrum: Spectrum,
    scale: f64,
    options: DistributionOptions,
    speed: TerminalSpeed,
    grid: Grid,
}

impl DropSizeDistribution {
    /// Creates the distribution of a rain of `rate_mm_h` with the default [`DistributionOptions`]. It carries exactly
    /// that rate.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the rate is not 0 to 500 mm/h, or a parameter of the law is out of its range.
    pub fn new(law: DropSizeLaw, rate_mm_h: f64) -> Result<Self, DropError> {
        Self::with_options(law, rate_mm_h, &DistributionOptions::default())
    }

    /// Creates the distribution of a rain of `rate_mm_h` over the diameters of `options`. It carries exactly that rate.
    ///
    /// # Errors
    /// As [`new`](Self::new), and if the diameters are not in order or out of range.
    pub fn with_options(
        law: DropSizeLaw,
        rate_mm_h: f64,
        options: &DistributionOptions,
    ) -> Result<Self, DropError> {
        let mut rain = Self::unscaled(law, rate_mm_h, options)?;
        let carried = rain.integrated_rate_mm_h();
        if !(carried.is_normal() && carried > 0.0) {
            // A range of diameters in which the law has no drop at all, to the last digit of f64.
            return Err(DropError::OutOfRange(OutOfRange {
                quantity: "rate that the law carries between these diameters",
                found: carried,
                unit: "mm/h",
                allowed: "above 0: choose diameters between which the law has drops that fall".into(),
            }));
        }
        rain.scale = rate_mm_h / carried;
        Ok(rain)
    }

    /// Creates the distribution of a law as published, which carries about, but not exactly, `rate_mm_h`.
    ///
    /// ```
    /// use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution, DropSizeLaw};
    /// let options = DistributionOptions::default();
    /// let rain = DropSizeDistribution::published(DropSizeLaw::MarshallPalmer1948, 10.0, &options)?;
    /// assert!((rain.integrated_rate_mm_h() - 11.6).abs() < 0.1);
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    ///
    /// # Errors
    /// As [`with_options`](Self::with_options).
    pub fn published(
        law: DropSizeLaw,
        rate_mm_h: f64,
        options: &DistributionOptions,
    ) -> Result<Self, DropError> {
        let mut rain = Self::unscaled(law, rate_mm_h, options)?;
        rain.scale = rate_mm_h.min(MIN_SHAPE_RATE_MM_H) / MIN_SHAPE_RATE_MM_H;
        Ok(rain)
    }

    /// Creates the published distribution. Its shape is that of [`MIN_SHAPE_RATE_MM_H`] for lower rates.
    fn unscaled(law: DropSizeLaw, rate_mm_h: f64, options: &DistributionOptions) -> Result<Self, DropError> {
        let rate_mm_h =
            in_rounded_range("rain rate", rate_mm_h, "mm/h", &RATE_RANGE_MM_H, 1.0, "0 to 500 mm/h")?;
        let spectrum = law.spectrum(rate_mm_h.max(MIN_SHAPE_RATE_MM_H))?;
        check_diameters(options, &spectrum)?;
        let speed = TerminalSpeed::new(options.fall_speed, &options.air);
        let grid = Grid::new(options.min_diameter_m, options.max_diameter_m, &speed.kinks());
        Ok(Self { law, rate_mm_h, spectrum, scale: 1.0, options: *options, speed, grid })
    }

    /// Restricts the distribution to a range of diameters, without scaling. All results (number, rate, extinction,
    /// samples) are then of these drops alone.
    ///
    /// ```
    /// use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
    /// let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 25.0)?;
    /// let large = rain.restricted_to(2.0e-3, 8.0e-3)?;
    /// assert!(large.number_density() < 0.05 * rain.number_density());
    /// # Ok::<(), downpour_drop::DropError>(())
    /// ```
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameters are not in order or not within those of this rain.
    pub fn restricted_to(&self, min_diameter_m: f64, max_diameter_m: f64) -> Result<Self, DropError> {
        let range = self.options.min_diameter_m..=self.options.max_diameter_m;
        for d in [min_diameter_m, max_diameter_m] {
            in_rounded_range("diameter", d, "mm", &range, 1.0e3, "the diameters of the whole rain")?;
        }
        let options = DistributionOptions { min_diameter_m, max_diameter_m, ..self.options };
        check_diameters(&options, &self.spectrum)?;
        let grid = Grid::new(min_diameter_m, max_diameter_m, &self.speed.kinks());
        Ok(Self { options, grid, ..self.clone() })
    }

    /// Bounds of diameter classes in meters, `per_octave` classes per factor of two, from the smallest diameter
    /// (0.001 mm if that is 0). The last class ends at the largest diameter and may be narrow.
    #[must_use]
    pub fn diameter_classes(&self, per_octave: f64) -> Vec<[f64; 2]> {
        let (smallest, largest) = (self.options.min_diameter_m.max(1.0e-6), self.options.max_diameter_m);
        let count = (ops::log2(largest / smallest) * per_octave).ceil().max(1.0) as u32;
        let edge = |k: u32| {
            if k == count { largest } else { smallest * ops::pow(2.0, f64::from(k) / per_octave) }
        };
        (0..count).map(|k| [edge(k), edge(k + 1)]).collect()
    }

    /// Law of the distribution.
    #[must_use]
    pub fn law(&self) -> DropSizeLaw {
        self.law
    }

    /// Requested rate, in mm/h.
    #[must_use]
    pub fn rate_mm_h(&self) -> f64 {
        self.rate_mm_h
    }

    /// Factor between this distribution and the published law. 0 in dry weather.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Range of diameters, model of fall speed and air.
    #[must_use]
    pub fn options(&self) -> &DistributionOptions {
        &self.options
    }

    /// N(D) in m^-4: drops per m^3 and per meter of diameter (1 per m^3 and mm = 1000 m^-4). 0 outside the range of
    /// diameters.
    #[must_use]
    pub fn concentration(&self, diameter_m: f64) -> f64 {
        let range = self.options.min_diameter_m..=self.options.max_diameter_m;
        // Some laws have no value at 0 itself; no drop has that size.
        if range.contains(&diameter_m) && diameter_m > 0.0 {
            self.scale * self.spectrum.concentration(diameter_m)
        } else {
            0.0
        }
    }

    /// Moment `Int N D^order dD`, in m^(order - 3).
    #[must_use]
    pub fn moment(&self, order: f64) -> f64 {
        self.integrate(|d| ops::pow(d, order))
    }

    /// Number of drops per m^3.
    #[must_use]
    pub fn number_density(&self) -> f64 {
        self.integrate(|_| 1.0)
    }

    /// Liquid water content in kg per m^3 of air, with the density of water at the air's temperature.
    #[must_use]
    pub fn liquid_water(&self) -> f64 {
        PI / 6.0 * self.options.air.water_density() * self.integrate(cube)
    }

    /// Rate that the drops carry, in m/s: volume of water per area and time.
    #[must_use]
    pub fn integrated_rate(&self) -> f64 {
        PI / 6.0 * self.integrate(|d| cube(d) * self.speed.unchecked(d))
    }

    /// Rate that the drops carry, in mm/h.
    #[must_use]
    pub fn integrated_rate_mm_h(&self) -> f64 {
        self.integrated_rate() / MM_H
    }

    /// Number of drops that hit a horizontal m^2 per second.
    #[must_use]
    pub fn impact_rate(&self) -> f64 {
        self.integrate(|d| self.speed.unchecked(d))
    }

    /// Geometric cross-section of the drops per volume, 1/m: spheres of their diameters.
    #[must_use]
    pub fn cross_section(&self) -> f64 {
        PI / 4.0 * self.integrate(|d| d * d)
    }

    /// Extinction of light in 1/m: cross-sections of the drops times the efficiency of all light that leaves a beam,
    /// including diffracted light ([`ExtinctionEfficiency::Total`]).
    #[must_use]
    pub fn extinction(&self) -> f64 {
        ExtinctionEfficiency::Total.factor() * self.cross_section()
    }

    /// Meteorological visibility in meters (Koschmieder); infinite in dry weather.
    #[must_use]
    pub fn visibility(&self) -> f64 {
        visibility(self.extinction())
    }

    /// Radar reflectivity factor `Int N D^6 dD` in m^3 (1 mm^6/m^3 = 1e-18 m^3).
    #[must_use]
    pub fn reflectivity(&self) -> f64 {
        self.integrate(|d| cube(d) * cube(d))
    }

    /// Mean diameter in meters: ratio of the moments 1 and 0. 0 in dry weather, as the following diameters.
    #[must_use]
    pub fn mean_diameter(&self) -> f64 {
        ratio(self.integrate(|d| d), self.number_density())
    }

    /// Effective diameter in meters: ratio of the moments 3 and 2.
    #[must_use]
    pub fn effective_diameter(&self) -> f64 {
        ratio(self.integrate(cube), self.integrate(|d| d * d))
    }

    /// Mass-weighted mean diameter in meters: ratio of the moments 4 and 3.
    #[must_use]
    pub fn mass_weighted_diameter(&self) -> f64 {
        ratio(self.integrate(|d| d * cube(d)), self.integrate(cube))
    }

    /// Median volume diameter D0 in meters: half of the liquid water is in larger drops.
    #[must_use]
    pub fn median_volume_diameter(&self) -> f64 {
        if self.scale > 0.0 {
            self.grid.cumulate(|d| self.spectrum.concentration(d) * cube(d)).at_fraction_below(0.5)
        } else {
            0.0
        }
    }

    /// Slope of an exponential law in 1/m, as [`distribution_sample_exponential`] takes it; `None` for other laws.
    #[must_use]
    pub fn exponential_slope(&self) -> Option<f64> {
        self.spectrum.exponential_slope()
    }

    /// Table of quantiles from which diameters are drawn. In dry weather it is the table of the lightest rain.
    #[must_use]
    pub fn sample_table(&self, by: SampledBy) -> SampleTable {
        match by {
            SampledBy::Number => SampleTable::new(by, &self.grid, |d| self.spectrum.concentration(d)),
            SampledBy::Flux => {
                SampleTable::new(by, &self.grid, |d| self.spectrum.concentration(d) * self.speed.unchecked(d))
            }
        }
    }

    /// Rate, m/s, of the water of which a drop of each diameter (m) and fall speed (m/s) gives a share.
    pub(crate) fn rate_of_share(&self, mut share: impl FnMut(f64, f64) -> f64) -> f64 {
        PI / 6.0
            * self.integrate(|d| {
                let speed = self.speed.unchecked(d);
                cube(d) * speed * share(d, speed)
            })
    }

    fn integrate(&self, mut f: impl FnMut(f64) -> f64) -> f64 {
        // Dry: the law's shape has no effect, not even by an overflow.
        if self.scale > 0.0 {
            self.scale * self.grid.integrate(|d| self.spectrum.concentration(d) * f(d))
        } else {
            0.0
        }
    }
}

fn cube(d: f64) -> f64 {
    d * d * d
}

fn ratio(above: f64, below: f64) -> f64 {
    if below > 0.0 { above / below } else { 0.0 }
}

fn check_diameters(options: &DistributionOptions, spectrum: &Spectrum) -> Result<(), DropError> {
    let (smallest, largest) = (options.min_diameter_m, options.max_diameter_m);
    let range = 1.0e-6..=MAX_DIAMETER_M;
    if !(smallest == 0.0 && spectrum.has_finite_number()) {
        let allowed = "0.001 to 9 mm (0 too, where the law has a finite number of drops)";
        in_rounded_range("smallest diameter", smallest, "mm", &range, 1.0e3, allowed)?;
    }
    let above = smallest + 1.0e-6..=MAX_DIAMETER_M;
    let allowed = "at most 9 mm, and at least 0.001 mm above the smallest";
    in_rounded_range("largest diameter", largest, "mm", &above, 1.0e3, allowed)?;
    Ok(())
}
