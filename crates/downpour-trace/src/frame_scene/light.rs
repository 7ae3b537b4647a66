//! Light of a weather that changes over time: sky, sun and lamps, in the buffers of a scene that are there already.

use std::sync::Arc;

use downpour_render::light::LightSource;
use downpour_scene::sky::SkyMap;
use downpour_weather::{Loaded, Weather, lamps_at};
use glam::{DVec3, Vec3};

use super::sky;
use crate::assemble::light_source;
use crate::data::SceneData;

/// A sun as a light.
pub(super) fn sun_light(sun: &downpour_scene::sky::Sun) -> LightSource {
    LightSource::Directional { direction: -Vec3::from(sun.direction), irradiance: sun.irradiance_rgb.into() }
}

/// Sets sky, sun and lamps to those of another weather over the same models; wetness and all that comes after it in the table are
/// removed. `others` of the lights were not the models' own. A lamp that stays where it is in the list keeps the glass that it has
/// in the model; one that is new has none.
pub(super) fn set_light(
    data: &mut SceneData,
    weather: &Weather,
    loaded: &Loaded,
    has_new_sky: bool,
    others: u32,
    origin: DVec3,
) {
    if has_new_sky {
        set_sky(data, &loaded.sky);
    }
    let of_models = data.light_count.saturating_sub(others);
    let scene = lamps_at(weather, 0.0);
    let pose = scene.pose_of(&[]);
    let pairs = scene.lights.iter().zip(&pose.lights);
    let mut lights: Vec<LightSource> =
        pairs.map(|(light, placed)| light_source(light, placed, &pose, origin)).collect();
    let known = data.light_rows(of_models..data.light_count);
    lights.extend(loaded.sun.iter().map(sun_light));
    data.set_lights_from(of_models, &lights);
    for (index, rows) in (of_models..).zip(&known).take(weather.lights.len()) {
        data.keep_lamp_glass(index, rows);
    }
    if let Some(sun) = loaded.sun {
        data.set_light_radius(data.light_count - 1, sun.angular_radius);
    }
}

fn set_sky(data: &mut SceneData, map: &SkyMap) {
    let light = sky::light(map);
    data.sky = Arc::new(light.texels);
    data.sky_levels = light.levels;
    data.sky_irradiance = light.irradiance;
}

/// Sets sky, sun and lamps that change over time to a time in seconds. Glass of the model belongs to the lamps that were beside
/// it at time 0, and has the radius of then. Lights come in the order of [`FrameScene::new`](super::FrameScene::new): those of the models,
/// the lamps of the weather, the sun.
pub(super) fn relight(data: &mut SceneData, weather: &Weather, loaded: &Loaded, origin: DVec3, time_s: f64) {
    let keys = &weather.keys;
    if keys.is_empty() {
        return;
    }
    if let Some((map, sun)) = loaded.sky_at(weather, time_s) {
        set_sky(data, &map);
        if let (Some(sun), Some(index)) = (sun, data.light_count.checked_sub(1)) {
            data.replace_light(index, &sun_light(&sun));
            data.set_light_radius(index, sun.angular_radius);
        }
    }
    let others = u32::from(loaded.sun.is_some()) + weather.lights.len() as u32;
    let Some(first) = data.light_count.checked_sub(others) else { return };
    let mut moving = keys.lamps().peekable();
    if moving.peek().is_none() {
        return;
    }
    let scene = lamps_at(weather, time_s);
    let pose = scene.pose_of(&[]);
    for index in moving {
        if let (Some(light), Some(placed)) = (scene.lights.get(index), pose.lights.get(index)) {
            data.replace_light(first + index as u32, &light_source(light, placed, &pose, origin));
        }
    }
}
