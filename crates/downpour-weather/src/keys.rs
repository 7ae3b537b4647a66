//! Values of a weather that change over time.

use super::camera::CameraKeys;
use super::effect_keys::EffectKeys;
use super::lamps::LampKeys;
use super::look::{LookKeys, drop_exposure_s};
use super::models::ModelKeys;
use super::rain::most;
use super::sky::{SkyKeys, SunKeys};
use super::wind::keys::moving;
use super::{Look, Model, PuddleFill, PuddleShape, Rain, Weather, WetnessAt};
use downpour_wind::Keyed;
use std::borrow::Cow;

/// Values of a weather that change over time; empty for a weather without keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeatherKeys {
    /// Rain rate, mm/h.
    rate: Option<Keyed<f64>>,
    camera: CameraKeys,
    sky: Option<SkyKeys>,
    sun: Option<SunKeys>,
    /// Index of each model that changes its place.
    models: Vec<(usize, ModelKeys)>,
    /// Index of each lamp that changes.
    lamps: Vec<(usize, LampKeys)>,
    /// Index of each puddle whose fill changes.
    fills: Vec<(usize, Keyed<f64>)>,
    look: Option<LookKeys>,
    pub(super) effects: EffectKeys,
}

impl WeatherKeys {
    pub(super) fn new(
        rate: Option<Keyed<f64>>,
        camera: CameraKeys,
        (sky, sun): (SkyKeys, Option<SunKeys>),
        (models, lamps): (Vec<ModelKeys>, Vec<LampKeys>),
        fills: Vec<Option<Keyed<f64>>>,
        look: LookKeys,
        effects: EffectKeys,
    ) -> Self {
        let (models, lamps) = (models.into_iter().enumerate(), lamps.into_iter().enumerate());
        let fills = fills.into_iter().enumerate();
        Self {
            rate,
            camera: camera.moving(),
            sky: sky.moving(),
            sun: sun.and_then(SunKeys::moving),
            models: models.filter_map(|(i, model)| Some((i, model.moving()?))).collect(),
            lamps: lamps.filter_map(|(i, lamp)| Some((i, lamp.moving()?))).collect(),
            fills: fills.filter_map(|(i, fill)| Some((i, moving(fill)?))).collect(),
            look: look.moving(),
            effects: effects.moving(),
        }
    }

    /// True if no value changes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Rain rate over time, mm/h, if it changes.
    #[must_use]
    pub fn rate(&self) -> Option<&Keyed<f64>> {
        self.rate.as_ref()
    }

    /// True if the light of the sky or the sun changes.
    #[must_use]
    pub fn has_sky(&self) -> bool {
        self.sky.is_some() || self.sun.is_some()
    }

    /// True if the field of view changes.
    #[must_use]
    pub fn has_fov(&self) -> bool {
        self.camera.fov_deg.is_some()
    }

    /// Indices of the models that change their place.
    pub fn models(&self) -> impl Iterator<Item = usize> {
        self.models.iter().map(|&(index, _)| index)
    }

    /// True if models move in the same way as in another weather.
    pub(super) fn has_models_of(&self, other: &Self) -> bool {
        self.models == other.models
    }

    /// Indices of the lamps that change.
    pub fn lamps(&self) -> impl Iterator<Item = usize> {
        self.lamps.iter().map(|&(index, _)| index)
    }

    /// True if the fill of a puddle changes.
    #[must_use]
    pub fn has_fill(&self, puddle: usize) -> bool {
        self.fills.iter().any(|&(index, _)| index == puddle)
    }

    /// Largest vertical field of view at any time, in radians, if it changes.
    #[must_use]
    pub fn max_fov(&self) -> Option<f64> {
        let fov = self.camera.fov_deg.as_ref()?;
        Some(fov.keys().iter().fold(0.0, |most: f64, &(_, fov)| most.max(fov)).to_radians())
    }
}

impl Weather {
    /// The weather at a time in seconds: all values are those of the time. The weather itself if none changes.
    ///
    /// ```
    /// use downpour_weather::Weather;
    /// let weather = Weather::parse("dusk.toml", "[sky]\nintensity = [[0, 1], [60, 0.1]]")?;
    /// assert_eq!([0.0, 30.0, 90.0].map(|time| weather.at(time).sky.scale), [1.0, 0.55, 0.1]);
    /// # Ok::<(), downpour_scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn at(&self, time_s: f64) -> Cow<'_, Self> {
        if self.keys.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut weather = self.clone();
        weather.rain = self.rain_at(time_s);
        weather.camera = weather.camera.at(&self.keys.camera, time_s);
        weather.look = self.look_at(time_s);
        weather.set_effects(&self.keys.effects, time_s);
        if let Some(sky) = &self.keys.sky {
            weather.sky = weather.sky.at(sky, time_s);
        }
        if let Some(sun) = &self.keys.sun {
            weather.sun = sun.at(time_s);
        }
        for (index, model) in self.models_at(time_s) {
            if let Some(place) = weather.models.get_mut(index) {
                *place = model;
            }
        }
        for (index, keys) in &self.keys.lamps {
            if let Some(lamp) = weather.lights.get_mut(*index) {
                *lamp = lamp.at(keys, time_s);
            }
        }
        for (index, keys) in &self.keys.fills {
            if let Some(PuddleShape::Found { fill, .. }) =
                weather.puddles.get_mut(*index).map(|p| &mut p.shape)
            {
                *fill = PuddleFill::Part(keys.at(time_s));
            }
        }
        Cow::Owned(weather)
    }

    /// Models that change their place, by their index, at a time in seconds.
    pub fn models_at(&self, time_s: f64) -> impl Iterator<Item = (usize, Model)> {
        let keys = self.keys.models.iter();
        keys.filter_map(move |(index, keys)| {
            Some((*index, self.models.get(*index)?.clone().at(keys, time_s)))
        })
    }

    /// Artistic multipliers at a time in seconds.
    #[must_use]
    pub fn look_at(&self, time_s: f64) -> Look {
        self.keys.look.as_ref().map_or(self.look, |keys| self.look.at(keys, time_s))
    }

    /// Time for which drops move in a picture at a time in seconds, s: [`drop_exposure_s`] of the shutter's or the persistence's.
    #[must_use]
    pub fn drop_exposure_s(&self, time_s: f64) -> f64 {
        drop_exposure_s(self.camera.shutter, self.look_at(time_s).streak_length)
    }

    /// The longest [`Weather::drop_exposure_s`] of any time, s.
    #[must_use]
    pub fn longest_drop_exposure_s(&self) -> f64 {
        let keys = self.keys.look.as_ref().and_then(|keys| keys.streak_length.as_ref());
        drop_exposure_s(self.camera.shutter, keys.map_or(self.look.streak_length, most))
    }

    /// The rain at a time in seconds.
    #[must_use]
    pub fn rain_at(&self, time_s: f64) -> Rain {
        let rate_mm_h = self.keys.rate.as_ref().map_or(self.rain.rate_mm_h, |rate| rate.at(time_s));
        Rain { rate_mm_h, ..self.rain }
    }

    /// The rain at its largest rate.
    #[must_use]
    pub fn heaviest_rain(&self) -> Rain {
        Rain { rate_mm_h: self.keys.rate.as_ref().map_or(self.rain.rate_mm_h, most), ..self.rain }
    }

    /// Rain rate over time, mm/h: one key for a rate that does not change.
    #[must_use]
    pub fn rates_mm_h(&self) -> Cow<'_, Keyed<f64>> {
        self.keys.rate.as_ref().map_or_else(|| Cow::Owned(self.rain.rate_mm_h.into()), Cow::Borrowed)
    }

    /// Sets a rain rate in mm/h for all times.
    pub fn set_rate(&mut self, rate_mm_h: f64) {
        self.rain.rate_mm_h = rate_mm_h;
        self.keys.rate = None;
    }

    /// Wetness of surfaces at a time in s. `None`: all is dry. Before time 0 it is that of time 0.
    #[must_use]
    pub fn wetness_at(&self, time_s: f64) -> Option<WetnessAt> {
        self.wetness.at(&self.rates_mm_h(), time_s)
    }

    /// Water that has run off level ground at a time in s, m: before the last time in which nothing fell, lost by drying and by seepage
    /// (m/s) in that time, and after it, less what seeped away. `None` where no law says: hollows have been filled since long.
    #[must_use]
    pub fn runoff(&self, seepage_m_s: f64, time_s: f64) -> Option<[f64; 3]> {
        self.wetness.runoff(&self.rates_mm_h(), seepage_m_s, time_s)
    }

    /// Depth of water that runs off level ground at a time in s, m/s, less what seeps away (m/s): the mean of five minutes, which is about
    /// how long water is on its way. 0 where no law says.
    #[must_use]
    pub fn runoff_rate(&self, seepage_m_s: f64, time_s: f64) -> f64 {
        self.wetness.runoff_rate(&self.rates_mm_h(), seepage_m_s, time_s)
    }

    /// Factor of the exposure of a picture at a time in seconds, over that of the automatic exposure with
    /// `camera.exposure_ev`: 1 without keys.
    #[must_use]
    pub fn exposure_factor(&self, time_s: f64) -> f32 {
        let Some(keys) = &self.keys.camera.exposure_ev else { return 1.0 };
        downpour_math::ops::exp2(stops(keys.at(time_s) - self.camera.exposure_ev))
    }
}

/// Stops in single precision.
#[expect(clippy::cast_possible_truncation, reason = "within 60 stops")]
fn stops(value: f64) -> f32 {
    value as f32
}
