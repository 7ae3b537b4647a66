//! The weather of a bare model: one in which rain is seen.
//!
//! Drops show what is round them, so that before an even sky they are all but invisible. Photographers wait for what is set up
//! here: a heavy shower below dark clouds, with the sun under them behind what stands there, and a short exposure. The light
//! that drops scatter forwards is then many times that of the clouds behind them.

use downpour_math::ops::f64 as ops;
use downpour_trace::frame_scene::{FrameScene, FrameSceneError};
use downpour_weather::{Loaded, SkySource, SunSource, Weather};
use glam::DVec3;

/// A heavy shower, mm/h.
const RATE_MM_H: f64 = 50.0;

/// The shutter, s: streaks of 2 to 4 cm.
const SHUTTER_S: f64 = 1.0 / 250.0;

/// Radiance of the clouds at the zenith.
const CLOUDS: [f64; 3] = [0.3, 0.33, 0.38];

/// Of the sun on what faces it, in the unit of the clouds: three times what they give to level ground.
const SUN: f64 = 1.5;

/// Tint of a sun that is low.
const SUN_COLOR: [f64; 3] = [1.0, 0.93, 0.82];

/// Elevation of the sun, and its azimuth to the right of the view, degrees. It is outside the picture.
const ELEVATION_DEG: f64 = 22.0;
const ASIDE_DEG: f64 = 24.0;

/// Diameter of its disc, degrees.
const DIAMETER_DEG: f64 = 0.53;

/// A shower over dark clouds, without a sun.
pub(super) fn shower(name: String) -> Weather {
    let mut weather = Weather { name, ..Weather::default() };
    weather.rain.rate_mm_h = RATE_MM_H;
    weather.camera.shutter = SHUTTER_S;
    weather.sky.source = SkySource::Overcast(CLOUDS);
    weather
}

/// The sun below the clouds, behind what the camera looks at. A model that brings lamps is lit by them.
///
/// # Errors
/// As [`FrameScene::view_at`].
pub(super) fn sun(weather: &Weather, loaded: &Loaded) -> Result<SunSource, FrameSceneError> {
    if !loaded.scene.lights.is_empty() {
        return Ok(SunSource::None);
    }
    // Where no camera is, all is looked at along -Z.
    let forward = match loaded.scene.cameras.first() {
        Some(_) => FrameScene::view_at(weather, loaded, 0.0)?.forward,
        None => DVec3::NEG_Z,
    };
    let ahead = DVec3::new(forward.x, 0.0, forward.z).try_normalize().unwrap_or(DVec3::NEG_Z);
    let right = DVec3::new(-ahead.z, 0.0, ahead.x);
    let (aside, elevation) = (ASIDE_DEG.to_radians(), ELEVATION_DEG.to_radians());
    let level = ahead * ops::cos(aside) + right * ops::sin(aside);
    let towards = level * ops::cos(elevation) + DVec3::Y * ops::sin(elevation);
    Ok(SunSource::Directional {
        towards: towards.to_array(),
        illuminance_lux: SUN,
        color: SUN_COLOR,
        angular_radius: (0.5 * DIAMETER_DEG).to_radians(),
    })
}
