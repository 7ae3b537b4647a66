//! `[sky]` and `[sun]`.

use super::fault::Positions;
use super::file::path;
use super::quantity::{Brightness, DiskDeg, ElevationDeg, In, Lux, Stops, Tint, TurnDeg};
use super::wind::keys::{NumberKeys, VectorKeys, number_or, vector_or};
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_scene::uri::RelativePath;
use downpour_wind::Keyed;
use glam::DVec3;
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SkyTable {
    file: Option<String>,
    color: Option<VectorKeys<Brightness>>,
    zenith_color: Option<VectorKeys<Brightness>>,
    yaw_deg: Option<In<TurnDeg>>,
    exposure_ev: Option<NumberKeys<Stops>>,
    intensity: Option<NumberKeys<Brightness>>,
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SunTable {
    from_sky: Option<bool>,
    azimuth_deg: Option<NumberKeys<TurnDeg>>,
    elevation_deg: Option<NumberKeys<ElevationDeg>>,
    illuminance_lux: Option<NumberKeys<Lux>>,
    color: Option<VectorKeys<Tint>>,
    diameter_deg: Option<In<DiskDeg>>,
}

/// Values of a sky over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SkyKeys {
    intensity: Keyed<f64>,
    stops: Keyed<f64>,
    color: Option<Keyed<DVec3>>,
}

impl SkyKeys {
    /// The same, if any value changes.
    pub(super) fn moving(self) -> Option<Self> {
        let colors = self.color.as_ref().map_or(1, |color| color.keys().len());
        (self.intensity.keys().len().max(self.stops.keys().len()).max(colors) > 1).then_some(self)
    }
}

/// Values of a sun over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SunKeys {
    azimuth_deg: Keyed<f64>,
    elevation_deg: Keyed<f64>,
    illuminance_lux: Keyed<f64>,
    color: Keyed<DVec3>,
    angular_radius: f64,
}

impl SunKeys {
    /// The sun at a time in seconds.
    pub(super) fn at(&self, time_s: f64) -> SunSource {
        let azimuth = self.azimuth_deg.at(time_s).to_radians();
        let elevation = self.elevation_deg.at(time_s).to_radians();
        SunSource::Directional {
            towards: towards(azimuth, elevation),
            illuminance_lux: self.illuminance_lux.at(time_s),
            color: self.color.at(time_s).to_array(),
            angular_radius: self.angular_radius,
        }
    }

    /// The same, if any value changes.
    pub(super) fn moving(self) -> Option<Self> {
        let numbers = [&self.azimuth_deg, &self.elevation_deg, &self.illuminance_lux];
        let moves = numbers.iter().any(|keyed| keyed.keys().len() > 1) || self.color.keys().len() > 1;
        moves.then_some(self)
    }
}

impl Sky {
    /// The sky at a time in seconds, with the values of some keys.
    pub(super) fn at(self, keys: &SkyKeys, time_s: f64) -> Self {
        let color = keys.color.as_ref().map(|color| color.at(time_s).to_array());
        let source = match (self.source, color) {
            (SkySource::Uniform(_), Some(color)) => SkySource::Uniform(color),
            (SkySource::Overcast(_), Some(color)) => SkySource::Overcast(color),
            (source, _) => source,
        };
        Self { source, scale: keys.intensity.at(time_s) * ops::pow(2.0, keys.stops.at(time_s)) }
    }

    /// The sky at time 0, and its values over time.
    pub(super) fn checked(
        table: &SkyTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, SkyKeys), SceneError> {
        let default = Self::default();
        let one = "one of file, color and zenith_color";
        let source = match (&table.file, &table.color, &table.zenith_color) {
            (Some(file), None, None) => {
                let yaw = table.yaw_deg.map_or(0.0, |yaw| yaw.0).to_radians();
                SkySource::File { file: path(file, "sky.file", positions)?, yaw }
            }
            (None, Some(_), None) => SkySource::Uniform([0.0; 3]),
            (None, None, Some(_)) => SkySource::Overcast([0.0; 3]),
            (None, None, None) => default.source,
            (_, Some(_), Some(_)) => return Err(positions.bad("sky.zenith_color", "beside color", one)),
            (_, Some(_), None) => return Err(positions.bad("sky.color", "beside file", one)),
            (_, None, Some(_)) => return Err(positions.bad("sky.zenith_color", "beside file", one)),
        };
        if table.yaw_deg.is_some() && !matches!(source, SkySource::File { .. }) {
            return Err(positions.bad("sky.yaw_deg", "a turn of no map", "with file only"));
        }
        let color = match (&table.color, &table.zenith_color) {
            (Some(color), _) => Some(color.keyed("sky.color", positions)?),
            (None, Some(zenith)) => Some(zenith.keyed("sky.zenith_color", positions)?),
            (None, None) => None,
        };
        let keys = SkyKeys {
            intensity: number_or(table.intensity.as_ref(), 1.0, "sky.intensity", positions)?,
            stops: number_or(table.exposure_ev.as_ref(), 0.0, "sky.exposure_ev", positions)?,
            color,
        };
        let sky = Self { source, ..default };
        Ok((sky.at(&keys, 0.0), keys))
    }
}

impl SunSource {
    /// The sun at time 0, and its values over time.
    pub(super) fn checked(
        table: Option<&SunTable>,
        sky: &Sky,
        positions: &Positions<'_>,
    ) -> Result<(Self, Option<SunKeys>), SceneError> {
        let mapped = matches!(sky.source, SkySource::File { .. });
        let Some(table) = table else {
            return Ok((if mapped { Self::FromSkyIfAny } else { Self::None }, None));
        };
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
            (Some(true), None) => Ok((Self::FromSky, None)),
            (Some(false), None) => Ok((Self::None, None)),
            (None, None) => {
                Err(positions.bad("sun", "nothing", "from_sky, or azimuth_deg and elevation_deg"))
            }
            (Some(false) | None, Some(_)) => {
                let keys = table.directional(positions)?;
                Ok((keys.at(0.0), Some(keys)))
            }
        }
    }
}

/// Unit direction of an azimuth and an elevation in radians: azimuth 0 is +X, 90 degrees is +Z.
pub(super) fn towards(azimuth: f64, elevation: f64) -> [f64; 3] {
    let flat = ops::cos(elevation);
    [flat * ops::cos(azimuth), ops::sin(elevation), flat * ops::sin(azimuth)]
}

impl SunTable {
    fn directional(&self, positions: &Positions<'_>) -> Result<SunKeys, SceneError> {
        let (Some(azimuth), Some(elevation)) = (&self.azimuth_deg, &self.elevation_deg) else {
            let missing = if self.azimuth_deg.is_none() { "azimuth_deg" } else { "elevation_deg" };
            return Err(positions.bad("sun", format!("no {missing}"), "both azimuth_deg and elevation_deg"));
        };
        let lux = self.illuminance_lux.as_ref();
        Ok(SunKeys {
            azimuth_deg: azimuth.keyed("sun.azimuth_deg", positions)?,
            elevation_deg: elevation.keyed("sun.elevation_deg", positions)?,
            illuminance_lux: number_or(lux, SUN_LUX, "sun.illuminance_lux", positions)?,
            color: vector_or(self.color.as_ref(), DVec3::ONE, "sun.color", positions)?,
            angular_radius: self.diameter_deg.map_or(SUN_DEG, |diameter| diameter.0).to_radians() / 2.0,
        })
    }
}
