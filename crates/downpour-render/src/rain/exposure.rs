//! How long the shutter is open, how the eye moves meanwhile, and how what passes it is averaged.

use downpour_drop::oscillation::{Amplitudes, Fluids};
use downpour_scene::weather::{StreakLook, Weather};
use downpour_shaders::render::rain::{STREAK_REFRACTED, STREAK_WHITE};
use glam::Vec3;

/// The longest exposure, s.
pub const LONGEST_EXPOSURE_S: f64 = 1.0;

/// The most samples along the chord of a streak.
pub const MOST_STREAK_SAMPLES: u32 = 4096;

/// How long the eye keeps what it has seen: the middle of the 60 to 90 ms of Rousseau 2006, s.
pub const PERSISTENCE_S: f64 = 0.075;

/// How the light of a streak is averaged over the time in which its drop passes a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StreakSamples {
    /// By a table that is made once per frame: one lookup, whatever the number of samples.
    #[default]
    Table,
    /// By a loop over so many samples, 1 to [`MOST_STREAK_SAMPLES`] (Rousseau 2006, section 5).
    Loop(u32),
}

/// What colour a streak has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum StreakColour {
    /// What its drop refracts and reflects.
    #[default]
    Refracted = STREAK_REFRACTED,
    /// One colour for all, the mean of the surroundings: the static streaks of Rousseau 2006, figure 9.
    White = STREAK_WHITE,
}

/// How the eye moves in the middle of the exposure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeMotion {
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// The axis about which it turns, right-handed, of the length of its angular speed, rad/s.
    pub turning: Vec3,
}

/// The time in which light is gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Seconds, 0 (drops stand still) to [`LONGEST_EXPOSURE_S`]; half of it is before the time of the picture.
    pub shutter_s: f64,
    /// The time of the picture, s: the phases of the drops' oscillation count from 0.
    pub time_s: f64,
    /// How the eye moves.
    pub eye: EyeMotion,
    /// How streaks are averaged.
    pub samples: StreakSamples,
    /// Their colour.
    pub colour: StreakColour,
    /// How far drops oscillate.
    pub oscillation: Amplitudes,
    /// The drops' water and the air, on which their frequencies depend.
    pub fluids: Fluids,
    /// Seed of the drops' phases.
    pub seed: u64,
    /// Diameter of the lens's pupil, m; 0: everything is in focus.
    pub aperture_m: f64,
    /// Distance in focus, m; infinite for the far.
    pub focus_m: f64,
}

impl Exposure {
    /// What a weather says of it, for a picture at `time_s` whose eye moves.
    #[must_use]
    pub fn of_weather(weather: &Weather, eye: EyeMotion, time_s: f64) -> Self {
        let (camera, streaks) = (&weather.camera, &weather.streaks);
        let [a20, a31] = streaks.oscillation;
        Self {
            shutter_s: camera.shutter,
            time_s,
            eye,
            samples: streaks.samples.map_or(StreakSamples::Table, StreakSamples::Loop),
            colour: match streaks.look {
                StreakLook::White => StreakColour::White,
                _ => StreakColour::Refracted,
            },
            // A weather holds none that are out of range.
            oscillation: Amplitudes::new(a20, a31).unwrap_or(Amplitudes::NONE),
            fluids: Fluids::in_air(&weather.rain.air),
            seed: weather.rain.seed,
            aperture_m: camera.aperture,
            focus_m: camera.focus.unwrap_or(f64::INFINITY),
        }
    }
}

impl Default for Exposure {
    /// Frozen drops that do not oscillate, through a pinhole.
    fn default() -> Self {
        Self {
            shutter_s: 0.0,
            time_s: 0.0,
            eye: EyeMotion::default(),
            samples: StreakSamples::default(),
            colour: StreakColour::default(),
            oscillation: Amplitudes::NONE,
            fluids: Fluids::AT_20_C,
            seed: 0,
            aperture_m: 0.0,
            focus_m: f64::INFINITY,
        }
    }
}
