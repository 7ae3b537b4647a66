//! The streak atlas, of a weather that takes the light of lamps on streaks from one.

use std::path::PathBuf;

use clap::Args;
use downpour::RendererError;
use downpour::atlas::StreakAtlas;
use downpour::render::rain::light::{DropLightForm, DropLightOptions};
use downpour::weather::Weather;

use crate::failure::Failure;

/// Path of the streak atlas.
#[derive(Debug, Args)]
pub(crate) struct StreaksArgument {
    /// Folder of the streak atlas, for a weather whose [streaks] color is atlas or atlas-random: the project's is
    /// assets/streaks.
    #[arg(long, value_name = "FOLDER")]
    streaks: Option<PathBuf>,
}

/// Streak atlas of a run.
#[derive(Debug)]
pub(crate) enum Streaks {
    /// The weather does not use it.
    Unwanted,
    /// The weather needs it, but no path is given.
    Nowhere,
    /// The loaded atlas.
    Atlas(Box<StreakAtlas>),
}

impl StreaksArgument {
    /// Reads the atlas, if the weather wants it.
    ///
    /// # Errors
    /// Errors of reading.
    pub(crate) fn read(&self, weather: &Weather) -> Result<Streaks, Failure> {
        if DropLightOptions::of_weather(weather).form != DropLightForm::Atlas {
            return Ok(Streaks::Unwanted);
        }
        let Some(folder) = &self.streaks else { return Ok(Streaks::Nowhere) };
        Ok(Streaks::Atlas(Box::new(StreakAtlas::load(folder)?)))
    }
}

impl Streaks {
    /// The atlas to render with.
    ///
    /// # Errors
    /// [`RendererError::NoAtlas`].
    pub(crate) fn atlas(self) -> Result<Option<StreakAtlas>, Failure> {
        match self {
            Self::Unwanted => Ok(None),
            Self::Nowhere => Err(RendererError::NoAtlas.into()),
            Self::Atlas(atlas) => Ok(Some(*atlas)),
        }
    }

    /// The atlas in one line.
    pub(crate) fn text(&self) -> String {
        let Self::Atlas(atlas) = self else {
            let nowhere = matches!(self, Self::Nowhere);
            return if nowhere { "asked for, but no --streaks: render ends" } else { "not asked for" }
                .to_owned();
        };
        let mut sizes: Vec<String> =
            atlas.sets().iter().map(|set| format!("{}", (set.diameter * 1.0e6).round() / 1.0e3)).collect();
        // They are in order of their diameters.
        sizes.dedup();
        let (files, sizes) = (atlas.sets().len(), sizes.join(", "));
        format!("{} streaks of drops of {sizes} mm in {files} files, {} bytes", atlas.layers(), self.bytes())
    }

    /// Its memory.
    pub(crate) fn bytes(&self) -> u64 {
        let Self::Atlas(atlas) = self else { return 0 };
        let data = atlas.data();
        let numbers = size_of_val(data.texels) + size_of_val(data.amounts);
        (size_of_val(data.frame) + size_of_val(data.triangles) + numbers) as u64
    }
}
