//! `rain.layers` and `[layers]`: rainfall as layers of a texture, in place of drops.

use downpour_scene::error::SceneError;
use serde::Deserialize;

use super::fault::Positions;
use super::quantity::{Fraction, In, Parallax};
use super::rain::{RainUnresolved, RainVolume};

/// Form of rainfall as layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) enum LayersForm {
    /// Section 3.1 of Tatarchuk & Isidoro 2006.
    #[serde(rename = "tatarchuk-2006")]
    Tatarchuk2006,
}

/// Layers of rainfall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainLayers {
    /// Distance of the farthest layer over that of the nearest, which is 1 m away: 1.1 to 50; the paper's `p_r`.
    pub parallax: f64,
    /// Fraction of white in a streak, 0 to 1: the paper's milk.
    pub milk: f64,
}

impl Default for RainLayers {
    /// Up to 12 m away, with a tenth of white.
    fn default() -> Self {
        Self { parallax: 12.0, milk: 0.1 }
    }
}

/// Table of the file.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LayersTable {
    parallax: Option<In<Parallax>>,
    milk: Option<In<Fraction>>,
}

impl LayersTable {
    /// The layers, if `form` asks for some. Keys that layers do not have are rejected beside them, and those of layers without.
    pub(super) fn checked(
        &self,
        form: Option<LayersForm>,
        (volume, unresolved): (RainVolume, Option<RainUnresolved>),
        positions: &Positions<'_>,
    ) -> Result<Option<RainLayers>, SceneError> {
        let given = [("layers.parallax", self.parallax.is_some()), ("layers.milk", self.milk.is_some())];
        let Some(LayersForm::Tatarchuk2006) = form else {
            return match given.iter().find(|(_, given)| *given) {
                Some((key, _)) => {
                    Err(positions.bad(key, "of rain that is drops", "with rain.layers = \"tatarchuk-2006\""))
                }
                None => Ok(None),
            };
        };
        let found = "layers, which are no drops";
        if !matches!(volume, RainVolume::Auto | RainVolume::ClosedForm) {
            return Err(positions.bad("rain.volume", found, "without rain.layers"));
        }
        if unresolved == Some(RainUnresolved::Streaks) {
            return Err(positions.bad("rain.unresolved", found, "\"even\", or without rain.layers"));
        }
        let usual = RainLayers::default();
        Ok(Some(RainLayers {
            parallax: self.parallax.map_or(usual.parallax, |parallax| parallax.0),
            milk: self.milk.map_or(usual.milk, |milk| milk.0),
        }))
    }
}
