//! `[look]`: artistic multipliers of the rain, beside its physical values.

use downpour_scene::error::SceneError;
use downpour_wind::Keyed;
use serde::Deserialize;

use super::MAX_EXPOSURE_S;
use super::fault::Positions;
use super::quantity::{StreakLength, Visibility};
use super::spray::Spray;
use super::wind::keys::{NumberKeys, moving, number_given};

/// Artistic multipliers of the rain in a picture: 1 is what physics gives. The rain that falls, wets and splashes is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Contrast of drops, droplets, splashes and unresolved rain against what is behind them, 0 to 20: a multiple of the light that each
    /// takes out and of the light that it gives. A drop that hides nearly all behind it is not made brighter by it.
    pub visibility: f64,
    /// Length of streaks, 0 to 20: a multiple of the time for which drops move in a picture, whose light is then spread over it.
    pub streak_length: f64,
    /// Extinction by spray, 0 to 20: a multiple of what its droplets take out. Visibility is another.
    pub spray: f64,
}

impl Look {
    /// The look that physics gives.
    pub const PHYSICAL: Self = Self { visibility: 1.0, streak_length: 1.0, spray: 1.0 };
}

/// Time for which drops move in a picture, s, at most [`MAX_EXPOSURE_S`]: that of the shutter, times the length of streaks.
#[must_use]
pub fn drop_exposure_s(shutter_s: f64, streak_length: f64) -> f64 {
    (shutter_s * streak_length).clamp(0.0, MAX_EXPOSURE_S)
}

impl Default for Look {
    fn default() -> Self {
        Self::PHYSICAL
    }
}

/// Multipliers over time, of those that a file gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LookKeys {
    visibility: Option<Keyed<f64>>,
    pub(super) streak_length: Option<Keyed<f64>>,
    spray: Option<Keyed<f64>>,
}

impl Look {
    /// The multipliers at a time in seconds.
    pub(super) fn at(self, keys: &LookKeys, time_s: f64) -> Self {
        let of = |keys: &Option<Keyed<f64>>, value| keys.as_ref().map_or(value, |keys| keys.at(time_s));
        Self {
            visibility: of(&keys.visibility, self.visibility),
            streak_length: of(&keys.streak_length, self.streak_length),
            spray: of(&keys.spray, self.spray),
        }
    }
}

impl LookKeys {
    /// The same without constant values.
    pub(super) fn moving(self) -> Option<Self> {
        let moving = Self {
            visibility: moving(self.visibility),
            streak_length: moving(self.streak_length),
            spray: moving(self.spray),
        };
        (moving != Self::default()).then_some(moving)
    }
}

/// Table of the file.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LookTable {
    visibility: Option<NumberKeys<Visibility>>,
    streak_length: Option<NumberKeys<StreakLength>>,
    spray: Option<NumberKeys<Visibility>>,
}

impl LookTable {
    /// The multipliers of time 0, and over time. That of spray is rejected where there is none.
    pub(super) fn checked(
        &self,
        spray: &Spray,
        positions: &Positions<'_>,
    ) -> Result<(Look, LookKeys), SceneError> {
        if self.spray.is_some() && !spray.is_enabled {
            let allowed = "beside spray.enabled = true";
            return Err(positions.bad("look.spray", "of spray that is not enabled", allowed));
        }
        let keys = LookKeys {
            visibility: number_given(self.visibility.as_ref(), "look.visibility", positions)?,
            streak_length: number_given(self.streak_length.as_ref(), "look.streak_length", positions)?,
            spray: number_given(self.spray.as_ref(), "look.spray", positions)?,
        };
        Ok((Look::default().at(&keys, 0.0), keys))
    }
}
