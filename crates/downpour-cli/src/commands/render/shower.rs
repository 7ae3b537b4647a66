//! The rain of a picture, and of all pictures of a clip, for the command.

use std::time::Instant;

use downpour::mask::atlas::StreakAtlas;
use downpour::render::rain::{DropMasks, RainMedium};
use downpour::render::shower::{self, Scenery, Shower};
use downpour::render::stage::Stage;
use downpour::scene::weather::{Loaded, Weather};
use downpour::sim::field::VisibleDrops;

use crate::failure::Failure;
use crate::progress::{PATIENCE, Progress, doing};

/// The rain of a picture.
pub(super) struct Seen {
    pub(super) visible: VisibleDrops,
    /// The drops that are not among them.
    pub(super) medium: RainMedium,
    /// Measured for those alone who are told of it.
    pub(super) measured_rate_mm_h: Option<f64>,
}

/// How a rain is asked for.
pub(super) struct Ask {
    /// Whether its rate is to be measured.
    pub(super) measure: bool,
    /// Whether nothing is said of how far it is.
    pub(super) quiet: bool,
}

/// Steps from which on somebody waits.
const LONG_STEPS: u32 = 120;

/// A rain, from picture to picture, and what its drops do to light.
pub(super) struct Showers {
    shower: Shower,
    pub(super) masks: DropMasks,
}

impl Showers {
    pub(super) fn new(
        weather: &Weather,
        loaded: &Loaded,
        atlas: Option<&StreakAtlas>,
        quiet: bool,
    ) -> Result<Self, Failure> {
        let masks = doing("tracing drops", quiet, || shower::masks(weather, loaded))?;
        let masks = if let Some(atlas) = atlas { masks.with_atlas(atlas) } else { masks };
        Ok(Self { shower: Shower::new(weather)?, masks })
    }

    /// Whether any picture can be made without those before it.
    pub(super) fn can_seek(&self) -> bool {
        self.shower.can_seek()
    }

    /// The drops that a picture can show at a time in seconds. Who waits for long is told how far the rain is.
    pub(super) fn at(
        &mut self,
        scenery: &dyn Scenery,
        stage: &Stage,
        time_s: f64,
        ask: &Ask,
    ) -> Result<Seen, Failure> {
        let mut progress: Option<Progress> = None;
        let begin = Instant::now();
        let visible = self.shower.at(scenery, stage, time_s, &mut |done, all| {
            if all >= LONG_STEPS || begin.elapsed() > PATIENCE {
                let progress = progress.get_or_insert_with(|| Progress::new("rain: step", all, ask.quiet));
                progress.set(done);
            }
        })?;
        drop(progress);
        let measured = || self.shower.measured_rate_mm_h(stage, time_s);
        let medium = self.shower.medium(stage, &visible, &self.masks, time_s)?;
        Ok(Seen { visible, medium, measured_rate_mm_h: ask.measure.then(measured).transpose()? })
    }
}
