//! The rain of a weather before an eye, at one time after the other: in closed form, or step by step.

mod error;
mod stepped;

use downpour_drop::DropError;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution, ExtinctionEfficiency};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_drop::optics::water_index_in_air;
use downpour_scene::weather::{Rain, RainExtinction, RainVolume, Weather};
use downpour_sim::field::{RainField, VisibleDrops};
use downpour_sim::shelter::Obstacles;
use glam::DVec3;

use crate::glass::pane_plane;
use crate::rain::{DropMasks, MediumOptions, RainMedium};
use crate::stage::Stage;
pub use error::ShowerError;
use stepped::Stepped;

/// The line of sodium, in metres: the wavelength at which water's index is taken.
const SODIUM_M: f64 = 589.3e-9;

/// The coldest air, in Celsius, in which water's index is known.
const COLDEST_INDEX_C: f64 = -12.0;

/// How the drops are found.
#[derive(Clone, Debug)]
enum Form {
    Closed(Box<RainField>),
    Stepped(Box<Stepped>),
}

/// The rain of a weather.
#[derive(Clone, Debug)]
pub struct Shower {
    law: DropSizeDistribution,
    weather: Weather,
    form: Form,
}

impl Shower {
    /// The rain of a weather.
    ///
    /// # Errors
    /// [`ShowerError::NotUniform`] if closed form is asked for in a wind that differs from place to place;
    /// [`ShowerError::Sim`], [`ShowerError::Drop`] for a rain that is none.
    pub fn new(weather: &Weather) -> Result<Self, ShowerError> {
        let rain = &weather.rain;
        let law = law(rain)?;
        let form = match (rain.volume, weather.wind.uniform()) {
            (RainVolume::Auto | RainVolume::ClosedForm, Some(wind)) => {
                Form::Closed(Box::new(RainField::new(&law, rain.seed)?.with_wind(wind)))
            }
            (RainVolume::ClosedForm, None) => return Err(ShowerError::NotUniform),
            _ => Form::Stepped(Box::new(Stepped::new(law.clone(), weather))),
        };
        Ok(Self { law, weather: weather.clone(), form })
    }

    /// Whether a picture of any time can be made by itself. If not, pictures of a clip are made in order of time, and each
    /// of them has to be asked for.
    #[must_use]
    pub fn is_closed_form(&self) -> bool {
        matches!(self.form, Form::Closed(_))
    }

    /// The drops that the stage's picture shows at a time in seconds.
    ///
    /// # Errors
    /// As [`RainField::visible`] and [`Simulation::advance`](downpour_sim::simulation::Simulation::advance);
    /// [`ShowerError::Wind`] for a wind field that is none.
    pub fn at(&mut self, stage: &Stage, time_s: f64) -> Result<VisibleDrops, ShowerError> {
        let view = stage.view()?;
        let mut visible = match &mut self.form {
            Form::Closed(field) => {
                let obstacles = Obstacles {
                    nodes: &stage.data.nodes,
                    triangles: &stage.data.triangles,
                    origin: stage.origin,
                };
                field.visible_among(&obstacles, &view, time_s)?
            }
            Form::Stepped(stepped) => stepped.at(stage, &view, time_s)?,
        };
        // A pane keeps the rain outside.
        if let Some(pane) = pane_plane(&self.weather, stage)? {
            visible.drops.retain(|drop| !pane.is_before((drop.position - view.eye).as_vec3()));
        }
        Ok(visible)
    }

    /// The drops that were not listed for a picture at a time in seconds: `visible` is what [`Shower::at`] gave.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn medium(
        &self,
        stage: &Stage,
        visible: &VisibleDrops,
        masks: &DropMasks,
        time_s: f64,
    ) -> Result<RainMedium, ShowerError> {
        let speeds = TerminalSpeed::new(self.law.options().fall_speed, &self.law.options().air);
        let speed = speeds.at(self.law.effective_diameter()).unwrap_or_default();
        let options = MediumOptions {
            efficiency: match self.weather.rain.extinction {
                RainExtinction::Total => ExtinctionEfficiency::Total,
                _ => ExtinctionEfficiency::Camera,
            },
            velocity: (self.weather.wind.air().velocity(time_s) - DVec3::Y * speed).as_vec3(),
            origin: stage.origin,
            pane: pane_plane(&self.weather, stage)?,
        };
        Ok(RainMedium::new(&self.law, &visible.resolved, masks, &options)?)
    }

    /// The rate, mm/h, of the drops about the eye (in closed form) or in the simulated volume, with those that something
    /// hides.
    ///
    /// # Errors
    /// As [`Shower::at`].
    pub fn measured_rate_mm_h(&self, stage: &Stage, time_s: f64) -> Result<f64, ShowerError> {
        match &self.form {
            Form::Closed(field) => Ok(field.measured_rate_mm_h(stage.view()?.eye, time_s)?),
            Form::Stepped(stepped) => Ok(stepped.measured_rate_mm_h()),
        }
    }
}

/// The sizes of the drops of a rain.
///
/// # Errors
/// [`DropError`] for a rain that is none.
pub fn law(rain: &Rain) -> Result<DropSizeDistribution, DropError> {
    let options = DistributionOptions { air: rain.air, ..DistributionOptions::default() };
    DropSizeDistribution::with_options(rain.law, rain.rate_mm_h, &options)
}

/// What drops do to light in the air of a weather.
///
/// # Errors
/// [`ShowerError::Drop`], [`ShowerError::Render`] if the air is outside what the laws know.
pub fn masks(weather: &Weather) -> Result<DropMasks, ShowerError> {
    let air = &weather.rain.air;
    let air = Air::new(air.temperature_c().max(COLDEST_INDEX_C), air.pressure_pa())?;
    Ok(DropMasks::trace(water_index_in_air(SODIUM_M, &air)?)?)
}
