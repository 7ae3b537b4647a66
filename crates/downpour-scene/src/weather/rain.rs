//! `[rain]`.

use super::fault::Places;
use super::quantity::{BoxM, GammaShape, In, MedianMm, PressureHpa, RateMmH, TemperatureC};
use crate::error::SceneError;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use serde::Deserialize;

/// Shape of the gamma law where none is given.
const GAMMA_SHAPE: f64 = 3.0;

/// The lightest rain whose drop sizes differ, in mm/h.
const LIGHTEST: f64 = downpour_drop::distribution::LIGHTEST_SHAPE_MM_H;

/// What rains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rain {
    /// Rain rate in mm/h: 0 (dry), or 0.001 to 500.
    pub rate_mm_h: f64,
    /// The law of the drop sizes.
    pub law: DropSizeLaw,
    /// Same seed, same drops.
    pub seed: u64,
    /// Temperature and pressure of the air.
    pub air: Air,
    /// Side of the box of rain round the eye, in metres, 1 to 1000; `None` leaves it to the renderer.
    pub box_m: Option<f64>,
}

impl Default for Rain {
    /// 10 mm/h by Marshall & Palmer's law in standard air, seed 0.
    fn default() -> Self {
        Self { rate_mm_h: 10.0, law: DropSizeLaw::default(), seed: 0, air: Air::standard(), box_m: None }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RainTable {
    rate_mm_h: Option<In<RateMmH>>,
    distribution: Option<Distribution>,
    gamma_shape: Option<In<GammaShape>>,
    median_diameter_mm: Option<In<MedianMm>>,
    seed: Option<u64>,
    temperature_c: Option<In<TemperatureC>>,
    pressure_hpa: Option<In<PressureHpa>>,
    box_m: Option<In<BoxM>>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
enum Distribution {
    MarshallPalmer,
    Best,
    Gamma,
    #[serde(alias = "lognormal")]
    FeingoldLevin,
    JossDrizzle,
    JossWidespread,
    JossThunderstorm,
}

impl Rain {
    pub(super) fn checked(table: &RainTable, places: &Places<'_>) -> Result<Self, SceneError> {
        let default = Self::default();
        let rate_mm_h = table.rate_mm_h.map_or(default.rate_mm_h, |rate| rate.0);
        let temperature_c = table.temperature_c.map_or(default.air.temperature_c(), |t| t.0);
        let pressure_pa = table.pressure_hpa.map_or(default.air.pressure_pa(), |p| p.0 * 100.0);
        let air = Air::new(temperature_c, pressure_pa);
        let air =
            air.map_err(|error| places.bad("rain", error.to_string(), "the air of the laws of fall"))?;
        let law = match table.distribution {
            None => default.law,
            Some(Distribution::MarshallPalmer) => DropSizeLaw::MarshallPalmer1948,
            Some(Distribution::Best) => DropSizeLaw::Best1950,
            Some(Distribution::Gamma) => table.gamma(rate_mm_h, places)?,
            Some(Distribution::FeingoldLevin) => DropSizeLaw::FeingoldLevin1986,
            Some(Distribution::JossDrizzle) => DropSizeLaw::Joss1968Drizzle,
            Some(Distribution::JossWidespread) => DropSizeLaw::Joss1968Widespread,
            Some(Distribution::JossThunderstorm) => DropSizeLaw::Joss1968Thunderstorm,
        };
        if table.distribution != Some(Distribution::Gamma) {
            for (key, given) in [
                ("rain.gamma_shape", table.gamma_shape.is_some()),
                ("rain.median_diameter_mm", table.median_diameter_mm.is_some()),
            ] {
                if given {
                    let found = format!("a parameter of the gamma law, with {}", law.name());
                    return Err(places.bad(key, found, "distribution = \"gamma\""));
                }
            }
        }
        let (seed, box_m) = (table.seed.unwrap_or(default.seed), table.box_m.map(|side| side.0));
        Ok(Self { rate_mm_h, law, seed, air, box_m })
    }
}

impl RainTable {
    fn gamma(&self, rate_mm_h: f64, places: &Places<'_>) -> Result<DropSizeLaw, SceneError> {
        let median_volume_diameter_m = match self.median_diameter_mm {
            Some(median) => median.0 * 1e-3,
            None => DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h.max(LIGHTEST))
                .map_err(|error| places.bad("rain.rate_mm_h", error.to_string(), "a rate of the laws"))?
                .median_volume_diameter(),
        };
        let mu = self.gamma_shape.map_or(GAMMA_SHAPE, |mu| mu.0);
        Ok(DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m })
    }
}
