//! `[streaks]`.

use super::RainDropLight;
use super::fault::Positions;
use super::quantity::{Amplitude, Exactly, In};
use downpour_scene::error::SceneError;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use std::fmt;

/// Maximum number of samples along a streak.
pub(super) const MAX_SAMPLES: u32 = 4096;

/// Color of streaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StreakLook {
    /// Light refracted and reflected by the drops.
    #[default]
    Refracted,
    /// One color for all.
    White,
    /// Light refracted and reflected by the drops, and the light of lamps from a streak atlas, by the directions of lamp and viewer. Its
    /// drops oscillate with the amplitudes of Garg & Nayar 2006: 40 to 75 degrees from straight behind the drop, lamps beside give 1 to
    /// 1.7 times the light of a sphere, lamps above 0.3 to 1.1 times (a test of `downpour-atlas`, `oscillation_takes_light_aside`).
    Atlas,
    /// The same, each drop with a random streak of the atlas.
    AtlasRandom,
}

/// Options for drops that move during the exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Streaks {
    /// Samples along a streak's chord, 1 to 4096; `None`: a precomputed table.
    pub samples: Option<u32>,
    /// Color of the streaks.
    pub look: StreakLook,
    /// Amplitudes of the oscillation modes (2,0) and (3,1), in radii, 0 to 0.3.
    pub oscillation: [f64; 2],
}

impl Default for Streaks {
    /// Table, refracted, with the first amplitudes of Garg & Nayar 2006.
    fn default() -> Self {
        Self { samples: None, look: StreakLook::default(), oscillation: [0.1; 2] }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct StreaksTable {
    samples: Option<Samples>,
    color: Option<StreakLook>,
    oscillation: Option<Exactly<In<Amplitude>, 2>>,
}

impl StreaksTable {
    /// Rejects an atlas of the light of lamps beside another form of that light.
    pub(super) fn checked(
        &self,
        drop_light: RainDropLight,
        positions: &Positions<'_>,
    ) -> Result<Streaks, SceneError> {
        let usual = Streaks::default();
        let of_atlas = matches!(self.color, Some(StreakLook::Atlas | StreakLook::AtlasRandom));
        if of_atlas && drop_light != RainDropLight::Traced {
            let found = "the light of lamps from an atlas, beside another rain.drop_light";
            let allowed = "\"refracted\" or \"white\", or an atlas with rain.drop_light = \"traced\"";
            return Err(positions.bad("streaks.color", found, allowed));
        }
        Ok(Streaks {
            samples: self.samples.map_or(usual.samples, |Samples(samples)| samples),
            look: self.color.unwrap_or_default(),
            oscillation: self.oscillation.map_or(usual.oscillation, Exactly::numbers),
        })
    }
}

/// Number of samples, or `None` for a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples(Option<u32>);

impl<'de> Deserialize<'de> for Samples {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Written;
        impl Visitor<'_> for Written {
            type Value = Samples;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "\"table\" or a whole number, 1 to {MAX_SAMPLES}")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Samples, E> {
                if text == "table" {
                    return Ok(Samples(None));
                }
                Err(E::custom(format_args!("{text:?}; allowed: \"table\", or 1 to {MAX_SAMPLES}")))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Samples, E> {
                let fits = u32::try_from(value).ok().filter(|value| (1..=MAX_SAMPLES).contains(value));
                let samples = fits.map(|samples| Samples(Some(samples)));
                samples.ok_or_else(|| {
                    E::custom(format_args!("{value}; allowed: \"table\", or 1 to {MAX_SAMPLES}"))
                })
            }
        }
        deserializer.deserialize_any(Written)
    }
}
