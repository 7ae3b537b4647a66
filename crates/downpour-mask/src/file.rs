//! Masks as files: OpenEXR, KTX2, PNG.
//!
//! All functions work on bytes; opening, publishing and renaming files is up to the caller. The same masks give the
//! same bytes on every machine. Input is validated before memory is allocated for it.
//!
//! | format | holds | for |
//! |---|---|---|
//! | [`exr`] | one mask, all of it, f32 or half | measuring, compositing |
//! | [`ktx2`] | an array of masks over diameters, three half layers each | textures of an engine |
//! | [`texture_array`] | any texture array as KTX2 | other crates of textures |
//! | [`png`] | the directions as colors | preview |

pub mod exr;
pub mod ktx2;
pub mod png;
pub mod texture_array;

use crate::{MaskError, View};

/// Description of the masks in a file besides the texels: `key=value` pairs, separated by semicolons.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Description {
    /// Volume-equivalent diameters in meters.
    pub(crate) diameters: Vec<f64>,
    /// Half extents in equivalent radii, one per diameter.
    pub(crate) half_extents: Vec<f64>,
    pub(crate) view: View,
    pub(crate) refractive_index: f64,
}

/// Version of the description. Other versions are rejected.
const VERSION: &str = "2";

impl Description {
    pub(crate) fn write(&self) -> String {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let millimeters: Vec<f64> = self.diameters.iter().map(|d| d * 1.0e3).collect();
        format!(
            "version={VERSION};diameter_mm={};half_extent={};elevation_deg={};refractive_index={}",
            list(&millimeters),
            list(&self.half_extents),
            self.view.elevation().to_degrees(),
            self.refractive_index
        )
    }

    pub(crate) fn read(location: &'static str, text: &str) -> Result<Self, MaskError> {
        const ALLOWED: &str = "version=2;diameter_mm=..;half_extent=..;elevation_deg=..;refractive_index=..";
        let bad = || MaskError::File { location, found: shorten(text), allowed: ALLOWED };
        let value = |key: &str| {
            text.split(';').find_map(|pair| pair.split_once('=').filter(|(k, _)| *k == key)).map(|(_, v)| v)
        };
        let numbers = |key: &str| -> Result<Vec<f64>, MaskError> {
            value(key)
                .ok_or_else(bad)?
                .split(',')
                .map(|n| n.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(bad))
                .collect()
        };
        let one = |key: &str| numbers(key)?.first().copied().ok_or_else(bad);
        if value("version") != Some(VERSION) {
            return Err(bad());
        }
        let diameters: Vec<f64> = numbers("diameter_mm")?.iter().map(|d| d * 1.0e-3).collect();
        let half_extents = numbers("half_extent")?;
        let fits = |v: &[f64]| v.iter().all(|&x| x > 0.0);
        if diameters.len() != half_extents.len() || !fits(&diameters) || !fits(&half_extents) {
            return Err(bad());
        }
        Ok(Self {
            diameters,
            half_extents,
            view: View::from_elevation(one("elevation_deg")?.to_radians())?,
            refractive_index: one("refractive_index")?,
        })
    }
}

/// Shortens text from a file for a message and removes control characters.
#[must_use]
pub fn shorten(text: &str) -> String {
    let clean: String = text.chars().take(60).flat_map(char::escape_default).collect();
    if text.chars().count() > 60 { format!("\"{clean}...\"") } else { format!("\"{clean}\"") }
}
