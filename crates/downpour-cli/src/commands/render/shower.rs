//! The rain of a picture, and of all pictures of a clip.

use downpour::drop::air::Air;
use downpour::drop::distribution::{DistributionOptions, DropSizeDistribution};
use downpour::drop::optics::water_index_in_air;
use downpour::render::rain::DropMasks;
use downpour::render::stage::Stage;
use downpour::scene::weather::Rain;
use downpour::sim::field::{RainField, VisibleDrops};

use crate::failure::Failure;

/// The line of sodium, in metres: the wavelength at which water's index is taken.
const SODIUM_M: f64 = 589.3e-9;

/// The coldest air, in Celsius, in which water's index is known.
const COLDEST_INDEX_C: f64 = -12.0;

/// The rain of a picture.
pub(super) struct Shower {
    pub(super) visible: VisibleDrops,
    /// Measured for those alone who are told of it.
    pub(super) measured_rate_mm_h: Option<f64>,
}

/// A rain, at any time.
pub(super) struct Showers {
    field: RainField,
    /// What drops do to light.
    pub(super) masks: DropMasks,
}

impl Showers {
    pub(super) fn new(rain: &Rain) -> Result<Self, Failure> {
        let options = DistributionOptions { air: rain.air, ..DistributionOptions::default() };
        let law = DropSizeDistribution::with_options(rain.law, rain.rate_mm_h, &options)?;
        let field = RainField::new(&law, rain.seed)?;
        let temperature = rain.air.temperature_c().max(COLDEST_INDEX_C);
        let air = Air::new(temperature, rain.air.pressure_pa())?;
        let masks = DropMasks::trace(water_index_in_air(SODIUM_M, &air)?)?;
        Ok(Self { field, masks })
    }

    /// The drops that a picture can show at a time in seconds.
    pub(super) fn at(&self, stage: &Stage, time_s: f64, measure: bool) -> Result<Shower, Failure> {
        let view = stage.view()?;
        let visible = self.field.visible(&view, time_s)?;
        let measured = || self.field.measured_rate_mm_h(view.eye, time_s);
        Ok(Shower { visible, measured_rate_mm_h: measure.then(measured).transpose()? })
    }
}
