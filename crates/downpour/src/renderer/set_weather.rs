//! Another weather for a renderer, while somebody changes it by hand.

use std::sync::Arc;

use downpour_math::ops;
use downpour_render::rain::DropMasks;
use downpour_scene::Budget;
use downpour_scene::sandbox::Files;
use downpour_trace::frame_scene::FrameScene;
use downpour_weather::Weather;

use super::{Renderer, RendererError, RendererOptions, atlas_of, forget_meshes};
use crate::shower::Shower;

impl Renderer {
    /// Sets another weather, whose files are read through `files` where they are not those of the present one. Scene, masks and pipelines
    /// stay as far as they are the same, so that a change of rain, wind, light, camera or size costs about a frame.
    ///
    /// Rain in closed form is that of the new weather at once. Rain that goes step by step keeps its drops, which the new wind takes on
    /// from the next step, as long as `[rain]` is the same; to have the frames of a renderer that was opened with the new weather, open
    /// one. So it is with lamps whose glass is in a model: a lamp that is moved keeps its glass, a new one has none. The exposure stays,
    /// but for `camera.exposure_ev`.
    ///
    /// # Errors
    /// [`RendererError`]: what is wrong with the weather or its files. The renderer keeps the weather that it had.
    pub fn set_weather(&mut self, weather: Weather, files: &dyn Files) -> Result<(), RendererError> {
        let before = &self.weather;
        let (mut loaded, reloaded) = self.loaded.reload(before, &weather, files, &mut Budget::default())?;
        let atlas = atlas_of(&weather, self.atlas.clone())?;
        let options = RendererOptions { atlas, ..self.options.clone() };
        let first = if reloaded.models {
            FrameScene::new(&weather, &loaded, options.first_s)?
        } else if loaded.is_animated() {
            self.first.moved(&weather, &loaded, options.first_s)?
        } else {
            self.first.in_weather(before, &weather, &loaded, reloaded, options.first_s)?
        };
        let mut shower = Shower::new(&weather)?;
        if reloaded.models {
            if loaded.is_animated() && shower.has_drips() {
                shower.find_drips(&FrameScene::new(&weather, &loaded, 0.0)?)?;
            }
        } else {
            shower = shower.going_on_from(&self.shower);
        }
        let masks = self.masks_of(&weather, &loaded, &shower, &options)?;
        if !loaded.is_animated() {
            forget_meshes(&mut loaded.scene);
        }
        // All is well: from here on nothing fails.
        let is_water_alike = !reloaded.models && holds_water_alike(before, &weather);
        let stops = weather.camera.exposure_ev - before.camera.exposure_ev;
        self.exposure = self.exposure.map(|exposure| exposure * ops::exp2(stops as f32));
        if !is_water_alike {
            self.water = None;
        }
        self.drawer.forget_light();
        (self.weather, self.loaded, self.options) = (weather, loaded, options);
        (self.first, self.shower, self.masks) = (first, shower, masks);
        Ok(())
    }

    /// Masks of the drops of a weather: those that are there, if they are the same.
    fn masks_of(
        &self,
        weather: &Weather,
        loaded: &downpour_weather::Loaded,
        shower: &Shower,
        options: &RendererOptions,
    ) -> Result<Arc<DropMasks>, RendererError> {
        let before = &self.weather;
        let alike = before.rain.air == weather.rain.air
            && before.rain.drop_shape == weather.rain.drop_shape
            && before.drop_model == weather.drop_model
            && self.shower.has_splashes() == shower.has_splashes()
            && self.options.atlas.is_some() == options.atlas.is_some()
            && before.streaks.look == weather.streaks.look
            && before.rain.seed == weather.rain.seed;
        if alike { Ok(Arc::clone(&self.masks)) } else { masks(weather, loaded, shower, options) }
    }
}

/// Traces the masks of the drops of a weather, with those of its splashes and its streak atlas.
pub(super) fn masks(
    weather: &Weather,
    loaded: &downpour_weather::Loaded,
    shower: &Shower,
    options: &RendererOptions,
) -> Result<Arc<DropMasks>, RendererError> {
    let masks = DropMasks::of_weather(weather, loaded)?;
    let masks = if shower.has_splashes() { masks.with_splashes_of(weather)? } else { masks };
    let masks = if let Some(atlas) = &options.atlas { masks.with_atlas(atlas) } else { masks };
    Ok(Arc::new(masks))
}

/// True if water on ground and pane goes on from one weather to the other.
fn holds_water_alike(before: &Weather, weather: &Weather) -> bool {
    // A pane has the shape of the picture and feels how the eye moves.
    let sees_alike = before.size == weather.size && before.camera == weather.camera;
    before.puddles == weather.puddles
        && before.glass == weather.glass
        && before.rain == weather.rain
        && before.wetness == weather.wetness
        && before.wind == weather.wind
        && before.keys == weather.keys
        && (weather.glass.is_none() || sees_alike)
}
