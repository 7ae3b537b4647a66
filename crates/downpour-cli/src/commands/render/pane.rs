//! The pane of glass of a picture, and of all pictures of a clip, for the command.

use std::borrow::Cow;

use downpour::render::glass::{GlassPicture, WetPane};
use downpour::render::picture::Picture;
use downpour::render::picture::PictureOptions;
use downpour::render::rain::{CaptureFrame, RainOptions, RefractionForm};
use downpour::render::stage::Stage;
use downpour::scene::weather::Weather;

use crate::failure::Failure;
use crate::progress::Progress;

/// A pane with the rain on it, if the weather has one.
pub(super) struct Pane {
    wet: Option<WetPane>,
    quiet: bool,
}

/// What a picture through a pane is made of.
pub(super) struct Through {
    pub(super) glass: GlassPicture,
    pub(super) behind: Vec<[f32; 4]>,
    pub(super) capture: Vec<[f32; 4]>,
}

impl Pane {
    /// The dry pane; `first_s` is the time of the first picture. `quiet`: nothing is told of how far the rain on it is.
    ///
    /// # Errors
    /// Exit code 2 for a pane that cannot be.
    pub(super) fn new(weather: &Weather, stage: &Stage, first_s: f64, quiet: bool) -> Result<Self, Failure> {
        Ok(Self { wet: WetPane::new(weather, stage, first_s)?, quiet })
    }

    /// The stage with what the pane does to the light that falls through it at a time in seconds; times rise.
    ///
    /// # Errors
    /// As [`Pane::new`].
    pub(super) fn hang<'a>(
        &mut self,
        mut stage: Cow<'a, Stage>,
        time_s: f64,
    ) -> Result<Cow<'a, Stage>, Failure> {
        if let Some(pane) = &mut self.wet {
            rain(pane, time_s, self.quiet)?;
            if pane.is_before_lamps(&stage) {
                pane.hang(stage.to_mut())?;
            }
        }
        Ok(stage)
    }

    /// What a picture needs to be seen through the pane that [`Pane::hang`] has brought to its time.
    ///
    /// # Errors
    /// As [`Pane::new`].
    pub(super) fn before(
        &self,
        stage: &Stage,
        picture: &Picture,
        options: &PictureOptions,
    ) -> Result<Option<Through>, Failure> {
        let Some(pane) = &self.wet else { return Ok(None) };
        let (size, grid) = (options.size, options.grid);
        let frame = stage.viewpoint.frame(&stage.data, size, grid, options.sky_rays, options.seed)?;
        let capture = if options.rain.form == RefractionForm::Direction {
            picture.surroundings.clone()
        } else {
            // The papers' capture does not show all that is round the eye.
            CaptureFrame::new(&frame, &RainOptions::default()).trace(&stage.data).texels
        };
        let glass = pane.picture(stage, &frame, capture.len())?;
        Ok(Some(Through { glass, behind: picture.behind_glass(), capture }))
    }
}

/// Lets rain fall on a pane until a time in seconds. Of more than a second it tells how far it is.
fn rain(pane: &mut WetPane, time_s: f64, quiet: bool) -> Result<(), Failure> {
    let begin_s = pane.time_s();
    let seconds = (time_s - begin_s).floor().max(0.0);
    if seconds > 1.0 {
        let mut progress = Progress::new("second of rain on the glass", seconds as u32, quiet);
        for second in 1..=seconds as u32 {
            pane.advance(begin_s + f64::from(second))?;
            progress.step();
        }
    }
    Ok(pane.advance(time_s)?)
}
