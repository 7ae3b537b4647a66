//! `downpour rain`: properties of a rain of a given rate.

use clap::{Args, ValueEnum};
use downpour::drop::air::Air;
use downpour::drop::distribution::{
    DistributionOptions, DropSizeDistribution, DropSizeLaw, MIN_SHAPE_RATE_MM_H,
};

use super::FallSpeedArgument;
use crate::failure::{Failure, INPUT};
use crate::listing::{Datum, Entry};
use crate::{listing, quantity, stream};

/// Default shape of the gamma law.
const GAMMA_SHAPE: f64 = 3.0;

/// A published drop size distribution, by the name of its law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Distribution {
    /// Marshall & Palmer 1948: exponential.
    MarshallPalmer,
    /// Best 1950.
    Best,
    /// Gamma (Ulbrich 1983): see --gamma-shape, --median-diameter, --intercept.
    Gamma,
    /// Feingold & Levin 1986: lognormal.
    #[value(alias = "lognormal")]
    FeingoldLevin,
    /// Joss et al. 1968: drizzle.
    JossDrizzle,
    /// Joss et al. 1968: widespread rain.
    JossWidespread,
    /// Joss et al. 1968: thunderstorm.
    JossThunderstorm,
}

/// Print the properties of a rain: drops, water, extinction, visibility.
#[derive(Debug, Args)]
pub(crate) struct RainArguments {
    /// Rain rate, 0 to 500 mm/h.
    #[arg(long, value_name = "MM_H", value_parser = quantity::rate_mm_h, allow_hyphen_values = true)]
    rate: f64,
    /// Drop size distribution.
    #[arg(long, value_name = "NAME", value_enum, default_value = "marshall-palmer")]
    distribution: Distribution,
    /// Gamma: shape mu, -3 to 8 [default: 3].
    #[arg(long, value_name = "MU", value_parser = quantity::gamma_shape, allow_hyphen_values = true)]
    gamma_shape: Option<f64>,
    /// Gamma: median volume diameter, 0.2 to 5 mm [default: that of Marshall & Palmer at this rate].
    #[arg(long, value_name = "MM", value_parser = quantity::median_diameter_mm, allow_hyphen_values = true)]
    median_diameter: Option<f64>,
    /// Gamma: N0 in m^-3 mm^-(1 + mu), instead of the median volume diameter.
    #[arg(long, value_name = "N0", value_parser = quantity::intercept, allow_hyphen_values = true)]
    #[arg(conflicts_with = "median_diameter")]
    intercept: Option<f64>,
    /// Leave the law as it was printed: it carries about, not exactly, the rate.
    #[arg(long)]
    published: bool,
    /// Temperature of air and water, -20 to 40 C.
    #[arg(long, value_name = "C", default_value = "20", value_parser = quantity::temperature_c)]
    #[arg(allow_hyphen_values = true)]
    temperature: f64,
    /// Pressure of the air, 300 to 1100 hPa.
    #[arg(long, value_name = "HPA", default_value = "1013.25", value_parser = quantity::pressure_hpa)]
    #[arg(allow_hyphen_values = true)]
    pressure: f64,
    #[command(flatten)]
    fall_speed: FallSpeedArgument,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

impl RainArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let entries = self.entries()?;
        stream::print(&if self.json { listing::json(&entries) } else { listing::text(&entries) })
    }

    fn law(&self) -> Result<DropSizeLaw, Failure> {
        let gamma_only = [
            ("--gamma-shape", self.gamma_shape.is_some()),
            ("--median-diameter", self.median_diameter.is_some()),
            ("--intercept", self.intercept.is_some()),
        ];
        if self.distribution != Distribution::Gamma
            && let Some((name, _)) = gamma_only.iter().find(|(_, given)| *given)
        {
            return Err(Failure::new(INPUT, format!("{name} is of --distribution gamma only")));
        }
        Ok(match self.distribution {
            Distribution::MarshallPalmer => DropSizeLaw::MarshallPalmer1948,
            Distribution::Best => DropSizeLaw::Best1950,
            Distribution::FeingoldLevin => DropSizeLaw::FeingoldLevin1986,
            Distribution::JossDrizzle => DropSizeLaw::Joss1968Drizzle,
            Distribution::JossWidespread => DropSizeLaw::Joss1968Widespread,
            Distribution::JossThunderstorm => DropSizeLaw::Joss1968Thunderstorm,
            Distribution::Gamma => {
                let mu = self.gamma_shape.unwrap_or(GAMMA_SHAPE);
                match (self.intercept, self.median_diameter) {
                    (Some(intercept_m3_mm), _) => DropSizeLaw::GammaByIntercept { mu, intercept_m3_mm },
                    (None, Some(mm)) => {
                        DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m: mm * 1.0e-3 }
                    }
                    (None, None) => {
                        DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m: self.usual_median()? }
                    }
                }
            }
        })
    }

    /// The median volume diameter, in meters, of Marshall & Palmer's drops at this rate.
    fn usual_median(&self) -> Result<f64, Failure> {
        let rate = self.rate.max(MIN_SHAPE_RATE_MM_H);
        Ok(DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate)?.median_volume_diameter())
    }

    fn entries(&self) -> Result<Vec<Entry>, Failure> {
        use Datum::{Computed, Given, Word};
        let options = DistributionOptions {
            fall_speed: self.fall_speed.model,
            air: Air::new(self.temperature, self.pressure * 100.0)?,
            ..DistributionOptions::default()
        };
        let law = self.law()?;
        let rain = if self.published {
            DropSizeDistribution::published(law, self.rate, &options)?
        } else {
            DropSizeDistribution::with_options(law, self.rate, &options)?
        };
        let entry = Entry::new;
        let mut entries = vec![
            entry("rate_mm_h", "rain rate", Given(self.rate), "mm/h"),
            entry("distribution", "distribution", Word(law.name().to_owned()), ""),
        ];
        if let DropSizeLaw::GammaByMedian { mu, .. } | DropSizeLaw::GammaByIntercept { mu, .. } = law {
            entries.push(entry("gamma_shape", "its shape mu", Given(mu), ""));
        }
        let visibility_km = rain.visibility() * 1.0e-3;
        entries.extend([
            entry("temperature_c", "temperature", Given(self.temperature), "C"),
            entry("pressure_hpa", "pressure", Given(self.pressure), "hPa"),
            entry("fall_speed_model", "law of fall speed", Word(options.fall_speed.name().to_owned()), ""),
            entry(
                "integrated_rate_mm_h",
                "rate that the drops carry",
                Computed(rain.integrated_rate_mm_h(), 4),
                "mm/h",
            ),
            entry("scale", "law multiplied by", Computed(rain.scale(), 4), ""),
            entry("number_m3", "drops", Computed(rain.number_density(), 4), "per m^3"),
            entry("impacts_m2_s", "impacts", Computed(rain.impact_rate(), 4), "per m^2 and s"),
            entry("liquid_water_g_m3", "liquid water", Computed(1.0e3 * rain.liquid_water(), 4), "g/m^3"),
            entry("mean_diameter_mm", "mean diameter", Computed(1.0e3 * rain.mean_diameter(), 4), "mm"),
            entry(
                "median_volume_diameter_mm",
                "median volume diameter",
                Computed(1.0e3 * rain.median_volume_diameter(), 4),
                "mm",
            ),
            entry("extinction_km", "extinction", Computed(1.0e3 * rain.extinction(), 4), "per km"),
            entry("visibility_km", "visibility", Datum::bounded(visibility_km, 3, "unlimited"), "km"),
        ]);
        Ok(entries)
    }
}
