//! `[splashes]`: crowns of the splashes of drops.

use downpour_drop::splash::FILM_M;
use downpour_scene::error::SceneError;
use serde::Deserialize;

use super::fault::Positions;
use super::quantity::{FilmMm, In, SplashSize};
use super::wind::keys::{Given, NumberKeys, number_given};

/// Splashes where drops hit surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splashes {
    /// True if drops splash.
    pub is_enabled: bool,
    /// Factor of the size of their crowns, 0.1 to 10; 1 is that of the law.
    pub size: f64,
    /// Depth of the film of water that they fall on, m.
    pub film_m: f64,
}

impl Default for Splashes {
    /// Splashes of the size of the law, on half a millimeter of water.
    fn default() -> Self {
        Self { is_enabled: true, size: 1.0, film_m: FILM_M }
    }
}

impl Splashes {
    /// The splashes of time 0, and the size of crowns over time if it is given. Rejects keys of splashes where there are none.
    pub(super) fn checked(
        table: &SplashesTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, Given), SceneError> {
        let is_enabled = table.enabled.unwrap_or(true);
        let given = [("splashes.size", table.size.is_some()), ("splashes.film_mm", table.film_mm.is_some())];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given && !is_enabled) {
            return Err(positions.bad(key, "beside enabled = false".to_owned(), "enabled = false alone"));
        }
        let default = Self::default();
        let size = number_given(table.size.as_ref(), "splashes.size", positions)?;
        let splashes = Self {
            is_enabled,
            size: size.as_ref().map_or(default.size, |size| size.at(0.0)),
            film_m: table.film_mm.map_or(default.film_m, |depth| depth.0 * 1.0e-3),
        };
        Ok((splashes, size))
    }
}

/// Table of the file.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SplashesTable {
    enabled: Option<bool>,
    size: Option<NumberKeys<SplashSize>>,
    film_mm: Option<In<FilmMm>>,
}
