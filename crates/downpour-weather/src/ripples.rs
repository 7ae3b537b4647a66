//! `[ripples]`: waves on the water of all puddles.

use downpour_scene::error::SceneError;
use serde::Deserialize;

use super::fault::Positions;
use super::quantity::{In, WaveMS};

/// Speed of the waves of a membrane where none is given, m/s: about that of the slowest waves on water, of 17 mm.
const SPEED_M_S: f64 = 0.25;

/// Law of the waves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Waves {
    /// Waves on water, by gravity and surface tension.
    #[default]
    Water,
    /// A membrane, as in Tatarchuk & Isidoro 2006, section 4: all waves have one speed, m/s, 0.05 to 2.
    Membrane(f64),
}

/// Name of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum WavesName {
    Water,
    Membrane,
}

/// Table of the file.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RipplesTable {
    waves: Option<WavesName>,
    speed_m_s: Option<In<WaveMS>>,
}

impl RipplesTable {
    /// The law. Rejects a speed of waves on water, which have many.
    pub(super) fn checked(&self, positions: &Positions<'_>) -> Result<Waves, SceneError> {
        match (self.waves, self.speed_m_s) {
            (Some(WavesName::Membrane), speed) => {
                Ok(Waves::Membrane(speed.map_or(SPEED_M_S, |speed| speed.0)))
            }
            (_, Some(_)) => {
                let found = "of waves on water, whose speed depends on their length";
                Err(positions.bad("ripples.speed_m_s", found, "with waves = \"membrane\""))
            }
            (_, None) => Ok(Waves::Water),
        }
    }
}
