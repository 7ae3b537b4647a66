//! `[sky]` and `[sun]`.

use super::fault::Positions;
use super::file::path;
use super::quantity::{Brightness, DiskDeg, ElevationDeg, Exactly, In, Lux, Stops, Tint, TurnDeg};
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_scene::uri::RelativePath;
use serde::Deserialize;

/// Illuminance of the sun at noon on a clear day, in lux.
const SUN_LUX: f64 = 1e5;

/// Diameter of the sun's disk, in degrees.
const SUN_DEG: f64 = 0.53;

/// Light of the sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// Source of the light.
    pub source: SkySource,
    /// Factor of the radiance: `intensity * 2^exposure_ev`.
    pub scale: f64,
}

/// Source of the light of the sky.
#[derive(Clone, Debug, PartialEq)]
pub enum SkySource {
    /// An equirectangular map.
    File {
        /// Path, inside the folder of the weather file or an asset root.
        file: RelativePath,
        /// Rotation of the map about +Y, in radians, counter-clockwise seen from above.
        yaw: f64,
    },
    /// Uniform radiance.
    Uniform([f64; 3]),
    /// The overcast sky of Moon & Spencer, with this radiance at the zenith.
    Overcast([f64; 3]),
}

/// Source of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunSource {
    /// No sun, or it stays in the map.
    None,
    /// The brightest compact source of the sky map, if there is one.
    FromSky,
    /// The same, for a file without `[sun]`: a map without a sun is not warned of.
    FromSkyIfAny,
    /// A sun apart from the sky map.
    Directional {
        /// Unit direction toward the sun.
        towards: [f64; 3],
        /// Illuminance of a surface that faces it, in lux.
        illuminance_lux: f64,
        /// Tint, linear, 0 to 1.
        color: [f64; 3],
        /// Angular radius of its disk, in radians.
        angular_radius: f64,
    },
}

impl Default for Sky {
    /// Overcast, with the radiance (0.9, 0.95, 1.0) at the zenith.
    fn default() -> Self {
        Self { source: SkySource::Overcast([0.9, 0.95, 1.0]), scale: 1.0 }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyTable {
    file: Option<String>,
    color: Option<Exactly<In<Brightness>, 3>>,
    zenith_color: Option<Exactly<In<Brightness>, 3>>,
    yaw_deg: Option<In<TurnDeg>>,
    exposure_ev: Option<In<Stops>>,
    intensity: Option<In<Brightness>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SunTable {
    from_sky: Option<bool>,
    azimuth_deg: Option<In<TurnDeg>>,
    elevation_deg: Option<In<ElevationDeg>>,
    illuminance_lux: Option<In<Lux>>,
    color: Option<Exactly<In<Tint>, 3>>,
    diameter_deg: Option<In<DiskDeg>>,
}

impl Sky {
    pub(super) fn checked(table: &SkyTable, positions: &Positions<'_>) -> Result<Self, SceneError> {
        let default = Self::default();
        let one = "one of file, color and zenith_color";
        let source = match (&table.file, &table.color, &table.zenith_color) {
            (Some(file), None, None) => {
                let yaw = table.yaw_deg.map_or(0.0, |yaw| yaw.0).to_radians();
                SkySource::File { file: path(file, "sky.file", positions)?, yaw }
            }
            (None, Some(color), None) => SkySource::Uniform(color.numbers()),
            (None, None, Some(zenith)) => SkySource::Overcast(zenith.numbers()),
            (None, None, None) => default.source,
            (_, Some(_), Some(_)) => return Err(positions.bad("sky.zenith_color", "beside color", one)),
            (_, Some(_), None) => return Err(positions.bad("sky.color", "beside file", one)),
            (_, None, Some(_)) => return Err(positions.bad("sky.zenith_color", "beside file", one)),
        };
        if table.yaw_deg.is_some() && !matches!(source, SkySource::File { .. }) {
            return Err(positions.bad("sky.yaw_deg", "a turn of no map", "with file only"));
        }
        let stops = table.exposure_ev.map_or(0.0, |ev| ev.0);
        let scale = table.intensity.map_or(1.0, |intensity| intensity.0) * ops::pow(2.0, stops);
        Ok(Self { source, scale })
    }
}

impl SunSource {
    pub(super) fn checked(
        table: Option<&SunTable>,
        sky: &Sky,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let mapped = matches!(sky.source, SkySource::File { .. });
        let Some(table) = table else { return Ok(if mapped { Self::FromSkyIfAny } else { Self::None }) };
        let own = [
            ("azimuth_deg", table.azimuth_deg.is_some()),
            ("elevation_deg", table.elevation_deg.is_some()),
            ("illuminance_lux", table.illuminance_lux.is_some()),
            ("color", table.color.is_some()),
            ("diameter_deg", table.diameter_deg.is_some()),
        ];
        let first = own.into_iter().find_map(|(key, given)| given.then_some(key));
        match (table.from_sky, first) {
            (Some(true), Some(key)) => {
                let key = format!("sun.{key}");
                Err(positions.bad(
                    &key,
                    "beside from_sky = true",
                    "either from_sky or a direction of the sun",
                ))
            }
            (Some(true), None) if !mapped => {
                Err(positions.bad("sun.from_sky", "true without a map", "with sky.file only"))
            }
            (Some(true), None) => Ok(Self::FromSky),
            (Some(false), None) => Ok(Self::None),
            (None, None) => {
                Err(positions.bad("sun", "nothing", "from_sky, or azimuth_deg and elevation_deg"))
            }
            (Some(false) | None, Some(_)) => table.directional(positions),
        }
    }
}

/// Unit direction of an azimuth and an elevation in radians: azimuth 0 is +X, 90 degrees is +Z.
pub(super) fn towards(azimuth: f64, elevation: f64) -> [f64; 3] {
    let flat = ops::cos(elevation);
    [flat * ops::cos(azimuth), ops::sin(elevation), flat * ops::sin(azimuth)]
}

impl SunTable {
    fn directional(&self, positions: &Positions<'_>) -> Result<SunSource, SceneError> {
        let (Some(azimuth), Some(elevation)) = (self.azimuth_deg, self.elevation_deg) else {
            let missing = if self.azimuth_deg.is_none() { "azimuth_deg" } else { "elevation_deg" };
            return Err(positions.bad("sun", format!("no {missing}"), "both azimuth_deg and elevation_deg"));
        };
        Ok(SunSource::Directional {
            towards: towards(azimuth.0.to_radians(), elevation.0.to_radians()),
            illuminance_lux: self.illuminance_lux.map_or(SUN_LUX, |lux| lux.0),
            color: self.color.map_or([1.0; 3], Exactly::numbers),
            angular_radius: self.diameter_deg.map_or(SUN_DEG, |diameter| diameter.0).to_radians() / 2.0,
        })
    }
}
