//! Drips of the scene of a weather: where water drips is found once, of the scene as it is first.

use std::sync::{Arc, Mutex, PoisonError};

use downpour_drop::drip::{BROAD_RADIUS_M, Drip};
use downpour_drop::fall_speed::TerminalSpeed;
use downpour_sim::drips::{DripOptions, DripPoints, DripRain, DripRegion, Drips, SetDrip};
use downpour_sim::field::FallingDrop;
use downpour_sim::impacts::{Impact, SplashOptions};
use downpour_sim::shelter::Obstacles;
use downpour_sim::view::View;
use downpour_trace::data::SceneData;
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::puddle::Rings;
use downpour_weather::{RAINED_S, Weather};
use glam::DVec3;

#[cfg(feature = "wgpu")]
use super::DripView;
use super::ShowerError;

/// Maximum number of drips of a picture.
const MAX_LISTED: u32 = 1 << 18;

/// Drips of a scene.
#[derive(Clone, Debug)]
pub(super) struct Dripping {
    /// Points of the scene are looked for.
    finds: bool,
    rain: Option<DripRain>,
    set: Vec<SetDrip>,
    options: DripOptions,
    known: Arc<Mutex<Option<Known>>>,
}

/// Drips that have been found.
#[derive(Debug)]
struct Known {
    /// The scene in which they were.
    data: SceneData,
    origin: DVec3,
    region: Option<DripRegion>,
    drips: Arc<Drips>,
}

impl Dripping {
    /// The drips of a weather; `None` where nothing may drip.
    pub(super) fn new(weather: &Weather) -> Result<Option<Self>, ShowerError> {
        let rain = Some(weather).filter(|weather| weather.drips.is_enabled).and_then(rain_of);
        if rain.is_none() && weather.drips.points.is_empty() {
            return Ok(None);
        }
        let air = &weather.rain.air;
        let broad = Drip::new(BROAD_RADIUS_M, air.temperature_c())?.diameter_m;
        let set = weather.drips.points.iter().map(|point| SetDrip {
            position: point.position,
            per_s: point.per_s,
            diameter_m: point.diameter_m.unwrap_or(broad),
        });
        let options = DripOptions {
            seed: weather.rain.seed,
            temperature_c: air.temperature_c(),
            wind: weather.wind.air().clone(),
            speed: TerminalSpeed::new(weather.rain.fall_speed, air),
        };
        let (finds, set) = (rain.is_some(), set.collect());
        Ok(Some(Self { finds, rain, set, options, known: Arc::default() }))
    }

    /// Finds the drips of a scene.
    pub(super) fn find(&self, frame_scene: &FrameScene) -> Result<(), ShowerError> {
        self.drips(frame_scene)?;
        Ok(())
    }

    /// The drips that a picture shows at a time in seconds, from so many pixels on, and their splashes.
    pub(super) fn visible(
        &self,
        frame_scene: &FrameScene,
        (view, least_pixels): (&View, f64),
        time_s: f64,
        splashes: Option<&SplashOptions>,
    ) -> Result<Vec<FallingDrop>, ShowerError> {
        let view = View { max_drops: view.max_drops.min(MAX_LISTED), ..*view };
        let obstacles = super::obstacles(frame_scene);
        let drips = self.drips(frame_scene)?;
        let mut drops = drips.visible(&obstacles, &view, least_pixels, time_s)?;
        if let Some(splashes) = splashes {
            drops.extend(drips.splashes(&obstacles, &view, time_s, splashes)?);
        }
        Ok(drops)
    }

    /// Those that have landed near the eye of a picture, in places, m, where they make rings on puddles.
    pub(super) fn landed(
        &self,
        frame_scene: &FrameScene,
        time_s: f64,
        is_water: &(dyn Fn(DVec3) -> bool + Sync),
    ) -> Result<Vec<Impact>, ShowerError> {
        let eye = frame_scene.origin + frame_scene.viewpoint.eye.as_dvec3();
        let ([low, high], span_s) = Rings::asked(eye, time_s);
        let obstacles = super::obstacles(frame_scene);
        Ok(self.drips(frame_scene)?.impacts_where(&obstacles, [low, high], span_s, 0.0, is_water)?)
    }

    /// The drips that a device finds for a picture, from so many pixels on, and their splashes; `None` where it cannot.
    #[cfg(feature = "wgpu")]
    pub(super) fn of_device(
        &self,
        frame_scene: &FrameScene,
        (view, least_pixels): (&View, f64),
        splashes: Option<SplashOptions>,
    ) -> Result<Option<DripView>, ShowerError> {
        let view = View { max_drops: view.max_drops.min(MAX_LISTED), ..*view };
        let drips = Some(self.drips(frame_scene)?).filter(|drips| drips.fits_device());
        Ok(drips.map(|drips| DripView { drips, view, least_pixels, splashes }))
    }

    /// The drips near the eye of a frame, in the scene that was seen first.
    fn drips(&self, frame_scene: &FrameScene) -> Result<Arc<Drips>, ShowerError> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let eye = frame_scene.origin + frame_scene.viewpoint.eye.as_dvec3();
        let (data, origin) = match &*known {
            Some(known) => {
                if known.region == region(&known.data, known.origin, eye) {
                    return Ok(Arc::clone(&known.drips));
                }
                (known.data.clone(), known.origin)
            }
            None => (frame_scene.data.clone(), frame_scene.origin),
        };
        let obstacles =
            Obstacles { nodes: &data.nodes, triangles: &data.triangles, holes: Some(&data), origin };
        let region = region(&data, origin, eye);
        let found = match region {
            Some(region) if self.finds => DripPoints::find(&obstacles, region)?.points,
            _ => Vec::new(),
        };
        let drips = Arc::new(Drips::new(&obstacles, &found, self.rain.as_ref(), &self.set, &self.options)?);
        *known = Some(Known { data, origin, region, drips: Arc::clone(&drips) });
        Ok(drips)
    }
}

/// Part of a scene in which drips are looked for; `None` without a scene.
fn region(data: &SceneData, origin: DVec3, eye: DVec3) -> Option<DripRegion> {
    if data.triangles.is_empty() {
        return None;
    }
    let (low, high) = data.bounds();
    DripRegion::around(origin + low.as_dvec3(), origin + high.as_dvec3(), eye)
}

/// The rain that runs off: what falls, or what has fallen before time 0. `None` where none did.
fn rain_of(weather: &Weather) -> Option<DripRain> {
    let wetness = &weather.wetness;
    let storage_m = wetness.storage_m;
    let rate_m_s = weather.rain.rate_mm_h * 1.0e-3 / 3600.0;
    if rate_m_s > 0.0 {
        let rained_s = wetness.rained_m.map_or(RAINED_S, |depth| depth / rate_m_s);
        // What was before a time without rain has run off.
        let begin_s = if wetness.dried_s > 0.0 { 0.0 } else { -rained_s };
        return Some(DripRain { rate_m_s, begin_s, end_s: f64::INFINITY, storage_m });
    }
    let rained_m = wetness.rained_m.filter(|&depth| depth > storage_m)?;
    let end_s = -wetness.dried_s;
    Some(DripRain { rate_m_s: rained_m / RAINED_S, begin_s: end_s - RAINED_S, end_s, storage_m })
}
