//! The water on the ground of a picture, and of all pictures of a clip, for the command.

use std::borrow::Cow;

use downpour::render::puddle::WetGround;
use downpour::render::stage::Stage;
use downpour::scene::weather::{Loaded, Weather};

use crate::failure::Failure;

/// The ground with the water that stands on it, if the weather has any.
pub(super) struct Puddles(Option<WetGround>);

impl Puddles {
    /// Where the water is; `first_s` is the time of the first picture.
    ///
    /// # Errors
    /// Exit code 2 for a rain that is none.
    pub(super) fn new(
        weather: &Weather,
        loaded: &Loaded,
        stage: &Stage,
        first_s: f64,
    ) -> Result<Self, Failure> {
        Ok(Self(WetGround::new(weather, loaded, stage, first_s)?))
    }

    /// Lets the rain go on past a picture that is there.
    ///
    /// # Errors
    /// As [`Puddles::new`].
    pub(super) fn pass(&mut self, time_s: f64) -> Result<(), Failure> {
        Ok(self.0.as_mut().map_or(Ok(()), |ground| ground.advance(time_s))?)
    }

    /// The stage with the water as it is at a time in seconds; times rise.
    ///
    /// # Errors
    /// As [`Puddles::new`].
    pub(super) fn lay<'a>(
        &mut self,
        mut stage: Cow<'a, Stage>,
        time_s: f64,
    ) -> Result<Cow<'a, Stage>, Failure> {
        if let Some(ground) = &mut self.0 {
            ground.advance(time_s)?;
            ground.lay(stage.to_mut());
        }
        Ok(stage)
    }
}
