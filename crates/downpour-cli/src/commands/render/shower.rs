//! The rain of a picture, and of all pictures of a clip, for the command.

use downpour::mask::atlas::StreakAtlas;
use downpour::render::rain::{DropMasks, RainMedium};
use downpour::render::shower::{self, Shower};
use downpour::render::stage::Stage;
use downpour::scene::weather::Weather;
use downpour::sim::field::VisibleDrops;

use crate::failure::Failure;

/// The rain of a picture.
pub(super) struct Seen {
    pub(super) visible: VisibleDrops,
    /// The drops that are not among them.
    pub(super) medium: RainMedium,
    /// Measured for those alone who are told of it.
    pub(super) measured_rate_mm_h: Option<f64>,
}

/// A rain, from picture to picture, and what its drops do to light.
pub(super) struct Showers {
    shower: Shower,
    pub(super) masks: DropMasks,
}

impl Showers {
    pub(super) fn new(weather: &Weather, atlas: Option<&StreakAtlas>) -> Result<Self, Failure> {
        let masks = shower::masks(weather)?;
        let masks = if let Some(atlas) = atlas { masks.with_atlas(atlas) } else { masks };
        Ok(Self { shower: Shower::new(weather)?, masks })
    }

    /// Whether any picture can be made without those before it.
    pub(super) fn is_closed_form(&self) -> bool {
        self.shower.is_closed_form()
    }

    /// The drops that a picture can show at a time in seconds.
    pub(super) fn at(&mut self, stage: &Stage, time_s: f64, measure: bool) -> Result<Seen, Failure> {
        let visible = self.shower.at(stage, time_s)?;
        let measured = || self.shower.measured_rate_mm_h(stage, time_s);
        let medium = self.shower.medium(stage, &visible, &self.masks, time_s)?;
        Ok(Seen { visible, medium, measured_rate_mm_h: measure.then(measured).transpose()? })
    }
}
