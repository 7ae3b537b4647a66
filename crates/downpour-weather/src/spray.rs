//! `[spray]`: mist of droplets over everything that rain hits.

use downpour_drop::spray::{DROPLET_M, HEIGHT_M};
use downpour_scene::error::SceneError;
use serde::Deserialize;

use super::fault::Positions;
use super::quantity::{In, SprayDropletMm, SprayM};

/// Mist of droplets that the drops throw up where they hit something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spray {
    /// True if there is any.
    pub is_enabled: bool,
    /// Height over which it thins out by a factor of e, m.
    pub height_m: f64,
    /// Sauter mean diameter of its droplets, m.
    pub droplet_m: f64,
}

impl Default for Spray {
    /// None; else 5 cm of droplets of 0.3 mm.
    fn default() -> Self {
        Self { is_enabled: false, height_m: HEIGHT_M, droplet_m: DROPLET_M }
    }
}

impl Spray {
    /// Rejects keys of spray where there is none.
    pub(super) fn checked(table: &SprayTable, positions: &Positions<'_>) -> Result<Self, SceneError> {
        let is_enabled = table.enabled.unwrap_or_default();
        let given =
            [("spray.height_m", table.height_m.is_some()), ("spray.droplet_mm", table.droplet_mm.is_some())];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given && !is_enabled) {
            return Err(positions.bad(
                key,
                "of spray that is not enabled".to_owned(),
                "beside enabled = true",
            ));
        }
        let default = Self::default();
        Ok(Self {
            is_enabled,
            height_m: table.height_m.map_or(default.height_m, |height| height.0),
            droplet_m: table.droplet_mm.map_or(default.droplet_m, |diameter| diameter.0 * 1.0e-3),
        })
    }
}

/// Table of the file.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SprayTable {
    enabled: Option<bool>,
    height_m: Option<In<SprayM>>,
    droplet_mm: Option<In<SprayDropletMm>>,
}
