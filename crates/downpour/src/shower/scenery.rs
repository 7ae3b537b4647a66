//! A scene over time, as step-by-step rain asks for it between pictures: its eye and its obstacles.

use std::borrow::Cow;

use downpour_sim::view::View;
use downpour_weather::{Loaded, Weather};

use downpour_trace::stage::{Stage, StageError};

/// A scene over time.
pub trait Scenery {
    /// True if all of it stands still, the eye included.
    fn is_still(&self) -> bool;

    /// The part of space that a picture at a time in seconds shows.
    ///
    /// # Errors
    /// As [`Stage::new`].
    fn view(&self, time_s: f64) -> Result<View, StageError>;

    /// The scene at a time in seconds.
    ///
    /// # Errors
    /// As [`Stage::new`].
    fn stage(&self, time_s: f64) -> Result<Cow<'_, Stage>, StageError>;
}

/// A scene that stands still.
#[derive(Clone, Copy, Debug)]
pub struct Still<'a>(pub &'a Stage);

impl Scenery for Still<'_> {
    fn is_still(&self) -> bool {
        true
    }

    fn view(&self, _: f64) -> Result<View, StageError> {
        Ok(self.0.view()?)
    }

    fn stage(&self, _: f64) -> Result<Cow<'_, Stage>, StageError> {
        Ok(Cow::Borrowed(self.0))
    }
}

/// A scene that moves.
#[derive(Clone, Copy, Debug)]
pub struct MovingScenery<'a> {
    /// Its weather.
    pub weather: &'a Weather,
    /// Its files.
    pub loaded: &'a Loaded,
}

impl Scenery for MovingScenery<'_> {
    fn is_still(&self) -> bool {
        false
    }

    fn view(&self, time_s: f64) -> Result<View, StageError> {
        Stage::view_at(self.weather, self.loaded, time_s)
    }

    fn stage(&self, time_s: f64) -> Result<Cow<'_, Stage>, StageError> {
        Ok(Cow::Owned(Stage::new(self.weather, self.loaded, time_s)?))
    }
}

/// A scene that stands still, before an eye that moves or in a light that changes.
#[derive(Clone, Copy, Debug)]
pub struct MovingEye<'a> {
    /// The scene, seen at any time.
    pub stage: &'a Stage,
    /// Its weather.
    pub weather: &'a Weather,
    /// Its files.
    pub loaded: &'a Loaded,
}

impl Scenery for MovingEye<'_> {
    fn is_still(&self) -> bool {
        false
    }

    fn view(&self, time_s: f64) -> Result<View, StageError> {
        self.stage.seen_view_at(self.weather, self.loaded, time_s)
    }

    fn stage(&self, time_s: f64) -> Result<Cow<'_, Stage>, StageError> {
        Ok(Cow::Owned(self.stage.seen_at(self.weather, self.loaded, time_s)?))
    }
}
