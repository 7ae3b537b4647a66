//! Exposure of a picture: shutter time, motion of the eye meanwhile, and average over moving drops.

use downpour_drop::oscillation::{Amplitudes, Fluids};
use downpour_shaders::render::rain::{STREAK_REFRACTED, STREAK_WHITE};
use downpour_weather::{Observer, StreakLook, Weather, drop_exposure_s};

use crate::camera::EyeMotion;

/// Maximum number of samples along the chord of a streak.
pub const MAX_STREAK_SAMPLES: u32 = 4096;

/// Method that averages the light of a streak over the time in which its drop passes a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StreakSamples {
    /// By a table that is computed once per frame: one lookup per ray.
    #[default]
    Table,
    /// By a loop over this number of samples, 1 to [`MAX_STREAK_SAMPLES`] (Rousseau 2006, section 5).
    Loop(u32),
}

/// Color of a streak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum StreakColor {
    /// Light that the drop refracts and reflects.
    #[default]
    Refracted = STREAK_REFRACTED,
    /// One color for all, the mean of the environment: the static streaks of Rousseau 2006, figure 9.
    White = STREAK_WHITE,
}

/// Weight of light over the time of the exposure. The mean weight over the exposure is 1, so that light which
/// does not change is the same in all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TemporalResponse {
    /// A camera's shutter: constant weight over the exposure.
    #[default]
    Shutter,
    /// An eye: what it sees takes the time of the exposure to fade away, evenly. Light of age `a` has the weight `2 (1 - a / T)`
    /// in an exposure of `T`; the age counts from its end. Source: Rousseau 2006, section 5, which has the time and that light
    /// fades away in it, but no form: a straight line is the simplest that begins with all of the light and has none after `T`.
    Fading,
}

impl TemporalResponse {
    /// The weight at a part of the exposure, 0 at its beginning to 1 at its end: 0 to 2.
    #[must_use]
    pub fn weight(self, part: f32) -> f32 {
        match self {
            Self::Shutter => 1.0,
            Self::Fading => 2.0 * part,
        }
    }
}

/// Exposure of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Exposure time, s, 0 (drops stand still) to [`MAX_EXPOSURE_S`](crate::camera::MAX_EXPOSURE_S); half of it is before
    /// the time of the picture.
    pub shutter_s: f64,
    /// Multiple of that time for which drops move: 1 is what physics gives, more has longer and fainter streaks.
    pub streak_length: f64,
    /// Weight of light over the exposure.
    pub response: TemporalResponse,
    /// Time of the picture, s: the phases of the drops' oscillation count from time 0.
    pub time_s: f64,
    /// Motion of the eye.
    pub eye: EyeMotion,
    /// Method that averages streaks.
    pub samples: StreakSamples,
    /// Color of streaks.
    pub color: StreakColor,
    /// Amplitudes of the oscillation of drops.
    pub oscillation: Amplitudes,
    /// Water and air, on which the frequencies of the oscillation depend.
    pub fluids: Fluids,
    /// Seed of the drops' phases.
    pub seed: u64,
    /// Diameter of the lens's pupil, m; 0: everything is in focus.
    pub aperture_m: f64,
    /// Distance in focus, m; may be infinite.
    pub focus_m: f64,
}

impl Exposure {
    /// Time for which drops move, s: [`drop_exposure_s`].
    #[must_use]
    pub fn drops_s(&self) -> f64 {
        drop_exposure_s(self.shutter_s, self.streak_length)
    }

    /// Returns the exposure of a weather, for a picture at `time_s` with a moving eye.
    #[must_use]
    pub fn of_weather(weather: &Weather, eye: EyeMotion, time_s: f64) -> Self {
        let (camera, streaks) = (&weather.camera, &weather.streaks);
        let [a20, a31] = streaks.oscillation;
        Self {
            shutter_s: camera.shutter,
            streak_length: weather.look.streak_length,
            response: match camera.observer {
                Observer::Camera => TemporalResponse::Shutter,
                Observer::Eye => TemporalResponse::Fading,
            },
            time_s,
            eye,
            samples: streaks.samples.map_or(StreakSamples::Table, StreakSamples::Loop),
            color: match streaks.look {
                StreakLook::White => StreakColor::White,
                _ => StreakColor::Refracted,
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
            streak_length: 1.0,
            response: TemporalResponse::default(),
            time_s: 0.0,
            eye: EyeMotion::default(),
            samples: StreakSamples::default(),
            color: StreakColor::default(),
            oscillation: Amplitudes::NONE,
            fluids: Fluids::AT_20_C,
            seed: 0,
            aperture_m: 0.0,
            focus_m: f64::INFINITY,
        }
    }
}
