//! `[streaks]`.

use super::quantity::{Amplitude, Exactly, In};
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};
use std::fmt;

/// The most samples along a streak.
const MOST_SAMPLES: u32 = 4096;

/// What colour streaks have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StreakLook {
    /// What their drops refract and reflect.
    #[default]
    Refracted,
    /// One colour for all.
    White,
    /// What their drops refract and reflect, and the light of lamps out of a streak atlas, by the directions of lamp and viewer. Its
    /// drops oscillate with the amplitudes of Garg & Nayar 2006: 40 to 75 degrees from straight behind the drop, lamps aside give 1 to
    /// 1.7 times the light of a sphere, lamps above 0.3 to 1.1 times (a test of `downpour-mask`, `oscillation_takes_light_aside`).
    Atlas,
    /// The same, each drop with any of the atlas' streaks.
    AtlasRandom,
}

/// How drops that move while the shutter is open are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Streaks {
    /// Samples along a streak's chord, 1 to 4096; `None`: a table that is made beforehand.
    pub samples: Option<u32>,
    /// Their colour.
    pub look: StreakLook,
    /// Amplitudes of the oscillation modes (2,0) and (3,1), in radii, 0 to 0.3.
    pub oscillation: [f64; 2],
}

impl Default for Streaks {
    /// By the table, refracted, with the first amplitudes of Garg & Nayar 2006.
    fn default() -> Self {
        Self { samples: None, look: StreakLook::default(), oscillation: [0.1; 2] }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StreaksTable {
    samples: Option<Samples>,
    colour: Option<StreakLook>,
    oscillation: Option<Exactly<In<Amplitude>, 2>>,
}

impl StreaksTable {
    pub(super) fn checked(&self) -> Streaks {
        let usual = Streaks::default();
        Streaks {
            samples: self.samples.map_or(usual.samples, |Samples(samples)| samples),
            look: self.colour.unwrap_or_default(),
            oscillation: self.oscillation.map_or(usual.oscillation, Exactly::numbers),
        }
    }
}

/// A number of samples, or none for a table.
#[derive(Clone, Copy, Debug)]
struct Samples(Option<u32>);

impl<'de> Deserialize<'de> for Samples {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Written;
        impl Visitor<'_> for Written {
            type Value = Samples;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "\"table\" or a whole number, 1 to {MOST_SAMPLES}")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Samples, E> {
                if text == "table" {
                    return Ok(Samples(None));
                }
                Err(E::custom(format_args!("{text:?}; allowed: \"table\", or 1 to {MOST_SAMPLES}")))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Samples, E> {
                let fits = u32::try_from(value).ok().filter(|value| (1..=MOST_SAMPLES).contains(value));
                let samples = fits.map(|samples| Samples(Some(samples)));
                samples.ok_or_else(|| {
                    E::custom(format_args!("{value}; allowed: \"table\", or 1 to {MOST_SAMPLES}"))
                })
            }
        }
        deserializer.deserialize_any(Written)
    }
}
