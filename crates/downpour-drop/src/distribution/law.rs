//! Published drop size distributions.
//!
//! In the field's units: N in 1/(m^3 mm), D in mm, R in mm/h.
//! - Marshall & Palmer 1948: `N = 8000 exp(-4.1 R^-0.21 D)`.
//! - Best 1950: the fraction of liquid water in drops below D is `1 - exp(-(D/a)^2.25)`, `a = 1.30 R^0.232`, of
//!   `67 R^0.846` mm^3 of water per m^3; so `N ~ D^-1.75` for small drops.
//! - Gamma, Ulbrich 1983: `N = N0 D^mu exp(-Lambda D)`, with `Lambda D0 = 3.67 + mu`. Its rate, with the speeds
//!   3.78 D^0.67 of Atlas & Ulbrich 1977 and all diameters, is `6 pi 1e-4 3.78 N0 Gamma(4.67 + mu) / Lambda^(4.67 + mu)`:
//!   which gives the missing parameter.
//! - Feingold & Levin 1986: lognormal, `N_T = 172 R^0.22`, `D_g = 0.72 R^0.23`, `s = 1.43 - 3.0e-4 R`.
//! - Joss et al. 1968: `N = N0 exp(-Lambda D)` for drizzle, widespread rain and thunderstorms.

use std::f64::consts::{PI, TAU};

use downpour_math::ops::f64 as ops;

use crate::DropError;
use crate::error::in_rounded_range;

/// A published drop size distribution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum DropSizeLaw {
    /// J. S. Marshall, W. M. Palmer, J. Meteor. 5, 165 (1948): exponential.
    #[default]
    MarshallPalmer1948,
    /// A. C. Best, Q. J. R. Meteor. Soc. 76, 16 (1950): fraction of liquid water in drops below a size.
    Best1950,
    /// Gamma (C. W. Ulbrich, J. Climate Appl. Meteor. 22, 1764, 1983), by its median volume diameter.
    GammaByMedian {
        /// Shape mu, -3 to 8. 0 is the exponential law; larger is narrower.
        mu: f64,
        /// Median volume diameter D0 in meters, 0.2e-3 to 5e-3.
        median_volume_diameter_m: f64,
    },
    /// Gamma (Ulbrich 1983), by its intercept; the slope follows from the rate.
    GammaByIntercept {
        /// Shape mu, -3 to 8.
        mu: f64,
        /// N0 as published, in m^-3 mm^-(1 + mu), 1e-2 to 1e10, with a slope of at most 100 per mm.
        intercept_m3_mm: f64,
    },
    /// G. Feingold, Z. Levin, J. Climate Appl. Meteor. 25, 1346 (1986): lognormal. UNVERIFIED: the constants were not
    /// seen in print; they reproduce the rate to 9 %.
    FeingoldLevin1986,
    /// Joss et al. 1968, drizzle. UNVERIFIED: the constants were not seen in print.
    Joss1968Drizzle,
    /// Joss et al. 1968, widespread rain. UNVERIFIED: the constants were not seen in print.
    Joss1968Widespread,
    /// Joss et al. 1968, thunderstorm. UNVERIFIED: the constants were not seen in print.
    Joss1968Thunderstorm,
}

impl DropSizeLaw {
    /// Name in files and arguments. Both forms of the gamma law are `gamma`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::MarshallPalmer1948 => "marshall-palmer",
            Self::Best1950 => "best",
            Self::GammaByMedian { .. } | Self::GammaByIntercept { .. } => "gamma",
            Self::FeingoldLevin1986 => "feingold-levin",
            Self::Joss1968Drizzle => "joss-drizzle",
            Self::Joss1968Widespread => "joss-widespread",
            Self::Joss1968Thunderstorm => "joss-thunderstorm",
        }
    }

    /// Size distribution of the law at a rate above 0.
    pub(super) fn spectrum(&self, rate_mm_h: f64) -> Result<Spectrum, DropError> {
        let r = rate_mm_h;
        let joss = |n0: f64, slope: f64| Spectrum::Gamma { n0, mu: 0.0, slope: slope * ops::pow(r, -0.21) };
        Ok(match *self {
            Self::MarshallPalmer1948 => joss(8000.0, 4.1),
            Self::Joss1968Drizzle => joss(30_000.0, 5.7),
            Self::Joss1968Widespread => joss(7000.0, 4.1),
            Self::Joss1968Thunderstorm => joss(1400.0, 3.0),
            Self::Best1950 => {
                Spectrum::Best { a: 1.30 * ops::pow(r, 0.232), water_mm3: 67.0 * ops::pow(r, 0.846) }
            }
            Self::FeingoldLevin1986 => Spectrum::Lognormal {
                number: 172.0 * ops::pow(r, 0.22),
                median: 0.72 * ops::pow(r, 0.23),
                ln_s: ops::ln(1.43 - 3.0e-4 * r),
            },
            Self::GammaByMedian { mu, median_volume_diameter_m } => {
                let mu = checked_mu(mu)?;
                let median = in_rounded_range(
                    "median volume diameter",
                    median_volume_diameter_m,
                    "mm",
                    &(0.2e-3..=5.0e-3),
                    1.0e3,
                    "0.2 to 5 mm",
                )?;
                let slope = (3.67 + mu) / (median * 1.0e3);
                Spectrum::Gamma { n0: r * ops::pow(slope, 4.67 + mu) / gamma_rate(mu), mu, slope }
            }
            Self::GammaByIntercept { mu, intercept_m3_mm } => {
                let mu = checked_mu(mu)?;
                let n0 = in_rounded_range(
                    "gamma intercept",
                    intercept_m3_mm,
                    "m^-3 mm^-(1 + mu)",
                    &(1.0e-2..=1.0e10),
                    1.0,
                    "1e-2 to 1e10",
                )?;
                let slope = in_rounded_range(
                    "slope of the gamma law, from its intercept and the rate,",
                    ops::pow(gamma_rate(mu) * n0 / r, 1.0 / (4.67 + mu)),
                    "per mm",
                    &(0.0..=1.0e2),
                    1.0,
                    "at most 100 per mm (a smaller intercept has a smaller slope)",
                )?;
                Spectrum::Gamma { n0, mu, slope }
            }
        })
    }
}

/// Rate of a gamma law with N0 = 1 and Lambda = 1.
fn gamma_rate(mu: f64) -> f64 {
    6.0e-4 * PI * 3.78 * ops::gamma(4.67 + mu)
}

fn checked_mu(mu: f64) -> Result<f64, DropError> {
    in_rounded_range("gamma shape mu", mu, "", &(-3.0..=8.0), 1.0, "-3 to 8")
}

/// Parameters of a law at one rate, in the field's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spectrum {
    /// `n0 D^mu exp(-slope D)`.
    Gamma { n0: f64, mu: f64, slope: f64 },
    /// Best 1950.
    Best { a: f64, water_mm3: f64 },
    /// Lognormal in number.
    Lognormal { number: f64, median: f64, ln_s: f64 },
}

impl Spectrum {
    /// N in m^-4 for a diameter in meters above 0.
    pub(super) fn concentration(&self, diameter_m: f64) -> f64 {
        let d = diameter_m * 1.0e3;
        let per_m3_mm = match *self {
            Self::Gamma { n0, mu, slope } => {
                let power = if mu == 0.0 { 1.0 } else { ops::pow(d, mu) };
                n0 * power * ops::exp(-slope * d)
            }
            Self::Best { a, water_mm3 } => {
                let n = 2.25;
                let x = ops::pow(d / a, n);
                // W dF/dD over the volume of a drop.
                water_mm3 * (n / d) * x * ops::exp(-x) / (PI / 6.0 * d * d * d)
            }
            Self::Lognormal { number, median, ln_s } => {
                let x = ops::ln(d / median) / ln_s;
                number / (TAU.sqrt() * ln_s * d) * ops::exp(-0.5 * x * x)
            }
        };
        per_m3_mm * 1.0e3
    }

    /// True if the number of drops is finite without a smallest diameter.
    pub(super) fn has_finite_number(&self) -> bool {
        match *self {
            Self::Gamma { mu, .. } => mu > -1.0,
            Self::Best { .. } => false,
            Self::Lognormal { .. } => true,
        }
    }

    /// Slope in 1/m, if the law is exponential.
    pub(super) fn exponential_slope(&self) -> Option<f64> {
        match *self {
            Self::Gamma { mu: 0.0, slope, .. } => Some(slope * 1.0e3),
            _ => None,
        }
    }
}
