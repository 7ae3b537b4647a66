//! The weather file: rain, lights, camera and models of a scene.
//!
#![doc = include_str!("KEYS.md")]
//!
//! In a file, keys carry their units (`rate_mm_h`, `fov_deg`); in a [`Weather`] all is SI but for the names that say
//! otherwise. Radiance 1 is 1 cd/m^2 where lamps are concerned: a lamp of `I` candela at a distance `r` lights a
//! surface that faces it with `I / r^2` lux.
//!
//! A file has at most 4 MiB and is nested at most 32 deep. An unknown key is an error, with the most similar known key.
//! Each error names line, column and key.

#![forbid(unsafe_code)]
#![cfg_attr(
    not(test),
    deny(
        clippy::arithmetic_side_effects,
        clippy::cast_possible_truncation,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::unwrap_used,
    )
)]

mod camera;
mod drips;
mod effect_keys;
mod fault;
mod file;
mod fog;
mod glass;
mod glow;
mod keys;
mod lamps;
mod layers;
mod lightning;
mod load;
mod look;
mod material_names;
mod materials;
mod models;
mod pane_map;
mod pose;
mod presets;
mod puddle;
mod quantity;
mod rain;
mod ripples;
mod scene_panes;
#[cfg(feature = "schema")]
mod schema;
mod sky;
mod splashes;
mod spray;
mod streaks;
mod wetness;
mod wind;
mod words;

use downpour_scene::Budget;
use downpour_scene::error::{SceneError, shown_path};
use downpour_scene::sandbox::open_named;
use downpour_wind::Wind;
use std::path::Path;

pub use camera::{
    Camera, CameraPath, CameraPose, FAR_M, FOV_RAD, NEAR_M, Observer, PERSISTENCE_S, ToneCurve, ToneEdges,
};
pub use downpour_scene::uri::RelativePath;
pub use drips::{DripPoint, Drips};
pub use fog::{FOG_ASYMMETRY, Fog, VisibilityLaw};
pub use glass::{Pane, PaneFocus, PaneFresnel, PaneShadow};
pub use glow::{GLARE, Glow, GlowFilter};
pub use keys::WeatherKeys;
pub use lamps::Lamp;
pub use layers::RainLayers;
pub use lightning::{
    Flash, FlashExposure, FlashLight, Lightning, MAX_FLASHES, MAX_STROKES, MAX_STROKES_PER_SECOND, Storm,
    Stroke, StrokePulse,
};
pub use load::{Loaded, Reloaded, Roots, lamps_at, load};
pub use look::{Look, drop_exposure_s};
pub use materials::MaterialOverride;
pub use models::{Model, Repeat};
pub use pane_map::PaneMap;
pub use presets::PRESETS;
pub use puddle::{MAX_ALL_PUDDLE_CELLS, MAX_PUDDLE_CELLS, Puddle, PuddleFill, PuddleRings, PuddleShape};
pub use rain::{
    RAIN_BOX_M, Rain, RainBounce, RainCylinder, RainDrag, RainDropLight, RainDropShape, RainExtinction,
    RainRefraction, RainUnresolved, RainVolume,
};
pub use ripples::Waves;
pub use scene_panes::{ScenePane, SceneRectangle};
#[cfg(feature = "schema")]
pub use schema::json_schema;
pub use sky::{Sky, SkySource, SunSource};
pub use splashes::Splashes;
pub use spray::Spray;
pub use streaks::{StreakLook, Streaks};
pub use wetness::{RAINED_S, WetReflections, Wetness, WetnessAt};
pub use wind::WindBox;

/// Maximum size of a weather file, in bytes: 4 MiB.
pub const MAX_FILE: u64 = 4 << 20;

/// Maximum nesting depth of tables and arrays.
pub const MAX_DEPTH: u32 = 32;

/// Maximum exposure time, s.
pub const MAX_EXPOSURE_S: f64 = 1.0;

/// Maximum number of entries `[[model]]`.
pub const MAX_MODELS: usize = 4096;

/// Maximum number of entries `[[material]]`.
pub const MAX_MATERIALS: usize = 1024;

/// Maximum number of entries `[[light]]`.
pub const MAX_LIGHTS: usize = 1024;

/// Maximum number of entries `[[puddle]]`.
pub const MAX_PUDDLES: usize = 16;

/// Maximum number of entries `[[pane]]`.
pub const MAX_PANES: usize = 16;

/// Maximum number of entries `[[drip]]`.
pub const MAX_DRIPS: usize = 4096;

/// Contents of a weather file, checked: all numbers are finite and in the ranges of [the table](self).
///
/// The default is the weather of a bare glTF: 10 mm/h by Marshall & Palmer's law under an overcast sky, no sun, the
/// model's camera, no wind, 1280 x 720 pixels.
///
/// ```
/// use downpour_weather::Weather;
/// let text = r#"
///     [rain]
///     rate_mm_h = 25
///     [camera]
///     position_m = [0, 1.7, 5]
///     look_at_m = [0, 2, 0]
///     [[light]]
///     point = { position_m = [2, 3, 0], intensity_cd = 800 }
/// "#;
/// let weather = Weather::parse("storm.toml", text)?;
/// assert_eq!(weather.rain.rate_mm_h, 25.0);
///
/// let error = Weather::parse("storm.toml", "[rain]\nrate_mmh = 25").unwrap_err();
/// assert!(error.to_string().starts_with(
///     "storm.toml: line 2, column 1: rain.rate_mmh: unknown key \"rate_mmh\", perhaps rate_mm_h"));
/// # Ok::<(), downpour_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Name of the file in messages; empty for the default.
    pub name: String,
    /// Rain.
    pub rain: Rain,
    /// Model that all drops are drawn as, instead of their shapes.
    pub drop_model: Option<RelativePath>,
    /// Sky.
    pub sky: Sky,
    /// Source of the sun.
    pub sun: SunSource,
    /// Camera or eye.
    pub camera: Camera,
    /// Models, in the order of the file.
    pub models: Vec<Model>,
    /// Overrides of the models' materials, in the order of the file.
    pub materials: Vec<MaterialOverride>,
    /// Lamps, in the order of the file.
    pub lights: Vec<Lamp>,
    /// Lightning.
    pub lightning: Lightning,
    /// Wind: parts, gusts, turbulence.
    pub wind: Wind,
    /// Box of cells in which a non-uniform wind is computed.
    pub wind_box: WindBox,
    /// Options for moving drops.
    pub streaks: Streaks,
    /// Pane in front of the camera.
    pub glass: Option<Pane>,
    /// Fog.
    pub fog: Option<Fog>,
    /// Light that goes beside its image.
    pub glow: Glow,
    /// Artistic multipliers of the rain.
    pub look: Look,
    /// Water on the ground, in the order of the file.
    pub puddles: Vec<Puddle>,
    /// Law of the waves on that water.
    pub waves: Waves,
    /// Wetness of the surfaces.
    pub wetness: Wetness,
    /// Glass of the scene on which rain is seen, in the order of the file.
    pub panes: Vec<ScenePane>,
    /// Splashes where drops hit surfaces.
    pub splashes: Splashes,
    /// Mist of droplets over what rain hits.
    pub spray: Spray,
    /// Water that drips from edges.
    pub drips: Drips,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Values that change over time: [`Weather::at`]. The other fields hold those of time 0. Wind, speed of the air at a pane,
    /// wipers and the path of the camera have their own keys.
    pub keys: WeatherKeys,
}

impl Default for Weather {
    fn default() -> Self {
        Self {
            name: String::new(),
            rain: Rain::default(),
            drop_model: None,
            sky: Sky::default(),
            sun: SunSource::None,
            camera: Camera::default(),
            models: Vec::new(),
            materials: Vec::new(),
            lights: Vec::new(),
            lightning: Lightning::default(),
            wind: Wind::default(),
            wind_box: WindBox::default(),
            streaks: Streaks::default(),
            glass: None,
            fog: None,
            glow: Glow::default(),
            look: Look::PHYSICAL,
            puddles: Vec::new(),
            waves: Waves::Water,
            wetness: Wetness::default(),
            panes: Vec::new(),
            splashes: Splashes::default(),
            spray: Spray::default(),
            drips: Drips::default(),
            size: [1280, 720],
            keys: WeatherKeys::default(),
        }
    }
}

impl Weather {
    /// Reads a weather file.
    ///
    /// The budget must allow the size of the text; nothing is deducted, since a `Weather` is small.
    ///
    /// # Errors
    /// [`SceneError::Unreadable`]: the file cannot be read; [`SceneError::BadInput`]: it is no regular file, no UTF-8 or no valid
    /// weather; [`SceneError::OverLimit`]: it is too long.
    pub fn read(path: &Path, budget: &mut Budget) -> Result<Self, SceneError> {
        let name = shown_path(path);
        let read = || {
            let file = open_named(path)?;
            if file.size > MAX_FILE {
                let found = format!("a file of {} bytes", file.size);
                return Err(SceneError::limit("", found, format!("at most {MAX_FILE} bytes")));
            }
            file.read_all(budget)
        };
        let bytes = read().map_err(|error| error.in_file(&name))?;
        let text = str::from_utf8(&bytes).map_err(|error| {
            let found = format!("byte {} is not UTF-8", error.valid_up_to());
            SceneError::bad("", found, "text in UTF-8").in_file(&name)
        })?;
        Self::parse(&name, text)
    }

    /// Reads the text of a weather file; `name` is its name in messages. A byte order mark is ignored.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        let parsed = file::parse(text.strip_prefix('\u{feff}').unwrap_or(text));
        let mut weather = parsed.map_err(|error| error.in_file(name))?;
        name.clone_into(&mut weather.name);
        Ok(weather)
    }
}

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
