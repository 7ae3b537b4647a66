//! A scene over time, as step-by-step rain asks for it between pictures: its eye and its obstacles.

use std::borrow::Cow;

use downpour_sim::view::View;
use downpour_weather::{Loaded, Weather};

use downpour_trace::frame_scene::{FrameScene, FrameSceneError};

/// A scene over time.
pub trait Scenery {
    /// True if all of it stands still, the eye included.
    fn is_still(&self) -> bool;

    /// True if all but the eye and the light stands still.
    fn has_still_things(&self) -> bool {
        self.is_still()
    }

    /// The part of space that a picture at a time in seconds shows.
    ///
    /// # Errors
    /// As [`FrameScene::new`].
    fn view(&self, time_s: f64) -> Result<View, FrameSceneError>;

    /// The scene at a time in seconds.
    ///
    /// # Errors
    /// As [`FrameScene::new`].
    fn frame_scene(&self, time_s: f64) -> Result<Cow<'_, FrameScene>, FrameSceneError>;
}

/// A scene that stands still.
#[derive(Clone, Copy, Debug)]
pub struct Still<'a>(pub &'a FrameScene);

impl Scenery for Still<'_> {
    fn is_still(&self) -> bool {
        true
    }

    fn view(&self, _: f64) -> Result<View, FrameSceneError> {
        Ok(self.0.view()?)
    }

    fn frame_scene(&self, _: f64) -> Result<Cow<'_, FrameScene>, FrameSceneError> {
        Ok(Cow::Borrowed(self.0))
    }
}

/// A scene that moves.
#[derive(Clone, Copy, Debug)]
pub struct MovingScenery<'a> {
    /// The scene at any time.
    pub frame_scene: &'a FrameScene,
    /// Its weather.
    pub weather: &'a Weather,
    /// Its files.
    pub loaded: &'a Loaded,
}

impl Scenery for MovingScenery<'_> {
    fn is_still(&self) -> bool {
        false
    }

    fn view(&self, time_s: f64) -> Result<View, FrameSceneError> {
        FrameScene::view_at(self.weather, self.loaded, time_s)
    }

    fn frame_scene(&self, time_s: f64) -> Result<Cow<'_, FrameScene>, FrameSceneError> {
        Ok(Cow::Owned(self.frame_scene.moved(self.weather, self.loaded, time_s)?))
    }
}

/// A scene that stands still, before an eye that moves or in a light that changes.
#[derive(Clone, Copy, Debug)]
pub struct MovingEye<'a> {
    /// The scene, seen at any time.
    pub frame_scene: &'a FrameScene,
    /// Its weather.
    pub weather: &'a Weather,
    /// Its files.
    pub loaded: &'a Loaded,
}

impl Scenery for MovingEye<'_> {
    fn is_still(&self) -> bool {
        false
    }

    fn has_still_things(&self) -> bool {
        true
    }

    fn view(&self, time_s: f64) -> Result<View, FrameSceneError> {
        self.frame_scene.seen_view_at(self.weather, self.loaded, time_s)
    }

    fn frame_scene(&self, time_s: f64) -> Result<Cow<'_, FrameScene>, FrameSceneError> {
        Ok(Cow::Owned(self.frame_scene.seen_at(self.weather, self.loaded, time_s)?))
    }
}
