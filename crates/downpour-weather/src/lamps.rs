//! `[[light]]`.

use super::fault::Positions;
use super::quantity::{Candela, ConeDeg, In, LampM, Lux, Part, PositionM, RangeM, Tint};
use super::wind::keys::{NumberKeys, VectorKeys, number_or, vector_or};
use downpour_scene::error::SceneError;
use downpour_wind::{Keyed, WindError};
use glam::DVec3;
use serde::Deserialize;

/// Default luminous intensity of a lamp, in candela.
const LAMP_CD: f64 = 100.0;

/// Default illuminance of parallel light, in lux.
const PARALLEL_LUX: f64 = 1000.0;

/// Default half angles of a cone, in degrees.
const CONE_DEG: (f64, f64) = (20.0, 30.0);

/// A lamp, as in `KHR_lights_punctual`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lamp {
    /// Shines in all directions.
    Point {
        /// Position, in meters.
        position: DVec3,
        /// Radius of its sphere, in meters; `None`: that of its glass in a model, or a point.
        radius: Option<f64>,
        /// Tint, linear, 0 to 1.
        color: DVec3,
        /// Luminous intensity in candela.
        intensity_cd: f64,
        /// Distance at which its light has faded to zero, in meters; `None` for an unlimited range.
        range: Option<f64>,
    },
    /// Shines in a cone.
    Spot {
        /// Position, in meters.
        position: DVec3,
        /// Radius of its sphere, in meters; `None`: that of its glass in a model, or a point.
        radius: Option<f64>,
        /// Unit direction of the light.
        direction: DVec3,
        /// Tint, linear, 0 to 1.
        color: DVec3,
        /// Luminous intensity in candela, in the inner cone.
        intensity_cd: f64,
        /// Half the angle of full intensity, in radians; below `outer`.
        inner: f64,
        /// Half the angle outside of which there is no light, in radians.
        outer: f64,
        /// Distance at which its light has faded to zero, in meters; `None` for an unlimited range.
        range: Option<f64>,
    },
    /// Parallel light from far away.
    Directional {
        /// Unit direction of the light.
        direction: DVec3,
        /// Tint, linear, 0 to 1.
        color: DVec3,
        /// On a surface that faces it, in lux.
        illuminance_lux: f64,
    },
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum LampTable {
    Point(PointTable),
    Spot(SpotTable),
    Directional(DirectionalTable),
}

type Color = Option<VectorKeys<Tint>>;

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PointTable {
    position_m: VectorKeys<PositionM>,
    color: Color,
    intensity_cd: Option<NumberKeys<Candela>>,
    range_m: Option<In<RangeM>>,
    radius_m: Option<In<LampM>>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SpotTable {
    position_m: VectorKeys<PositionM>,
    direction: VectorKeys<Part>,
    color: Color,
    intensity_cd: Option<NumberKeys<Candela>>,
    inner_deg: Option<In<ConeDeg>>,
    outer_deg: Option<In<ConeDeg>>,
    range_m: Option<In<RangeM>>,
    radius_m: Option<In<LampM>>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct DirectionalTable {
    direction: VectorKeys<Part>,
    color: Color,
    illuminance_lux: Option<NumberKeys<Lux>>,
}

/// Values of a lamp over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LampKeys {
    position: Keyed<DVec3>,
    /// Unit directions at the keys.
    direction: Keyed<DVec3>,
    color: Keyed<DVec3>,
    /// Candela, or lux of parallel light.
    strength: Keyed<f64>,
}

impl LampKeys {
    /// The same, if any value changes.
    pub(super) fn moving(self) -> Option<Self> {
        let vectors = [&self.position, &self.direction, &self.color];
        let moves = vectors.iter().any(|keyed| keyed.keys().len() > 1) || self.strength.keys().len() > 1;
        moves.then_some(self)
    }
}

/// Position in the file of a lamp.
struct LampPath<'a> {
    path: String,
    positions: &'a Positions<'a>,
}

impl LampPath<'_> {
    fn of(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }

    fn position(&self, given: &VectorKeys<PositionM>) -> Result<Keyed<DVec3>, SceneError> {
        given.keyed(&self.of("position_m"), self.positions)
    }

    fn color(&self, given: &Color) -> Result<Keyed<DVec3>, SceneError> {
        vector_or(given.as_ref(), DVec3::ONE, &self.of("color"), self.positions)
    }

    fn candela(&self, given: Option<&NumberKeys<Candela>>) -> Result<Keyed<f64>, SceneError> {
        number_or(given, LAMP_CD, &self.of("intensity_cd"), self.positions)
    }

    fn direction(&self, given: &VectorKeys<Part>) -> Result<Keyed<DVec3>, SceneError> {
        let key = self.of("direction");
        let none = || self.positions.bad(&key, "no length", "three numbers, not all 0");
        let keyed = given.keyed(&key, self.positions)?;
        if keyed.keys().len() == 1 {
            return keyed.at(0.0).try_normalize().map(Keyed::from).ok_or_else(none);
        }
        keyed.directions("direction of a light").map_err(|error| match error {
            WindError::AxisReverses { time, .. } => {
                let found = format!("turned about up to the key at {time} s");
                let allowed = "a key between that defines the direction of the turn";
                self.positions.bad(&key, found, allowed)
            }
            _ => none(),
        })
    }
}

impl Lamp {
    /// The lamp at a time in seconds.
    pub(super) fn at(self, keys: &LampKeys, time_s: f64) -> Self {
        let color = keys.color.at(time_s);
        let strength = keys.strength.at(time_s);
        let position = keys.position.at(time_s);
        let along = keys.direction.at(time_s);
        // A constant direction keeps its bits.
        let direction = if keys.direction.keys().len() > 1 { along.normalize_or(along) } else { along };
        match self {
            Self::Point { radius, range, .. } => {
                Self::Point { position, radius, color, intensity_cd: strength, range }
            }
            Self::Spot { radius, inner, outer, range, .. } => {
                Self::Spot { position, radius, direction, color, intensity_cd: strength, inner, outer, range }
            }
            Self::Directional { .. } => Self::Directional { direction, color, illuminance_lux: strength },
        }
    }

    /// The lamp at time 0, and its values over time.
    pub(super) fn checked(
        i: usize,
        table: &LampTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, LampKeys), SceneError> {
        let path = |kind: &str| LampPath { path: format!("light[{i}].{kind}"), positions };
        let zero = DVec3::ZERO;
        let (lamp, keys) = match table {
            LampTable::Point(table) => {
                let path = path("point");
                let keys = LampKeys {
                    position: path.position(&table.position_m)?,
                    direction: zero.into(),
                    color: path.color(&table.color)?,
                    strength: path.candela(table.intensity_cd.as_ref())?,
                };
                let radius = table.radius_m.map(|radius| radius.0);
                let range = table.range_m.map(|range| range.0);
                (Self::Point { position: zero, radius, color: zero, intensity_cd: 0.0, range }, keys)
            }
            LampTable::Spot(table) => {
                let outer = table.outer_deg.map_or(CONE_DEG.1, |outer| outer.0);
                // If only the outer cone is given and it is narrow, the inner one is within it.
                let inner =
                    table.inner_deg.map_or(CONE_DEG.0.min(outer * CONE_DEG.0 / CONE_DEG.1), |inner| inner.0);
                if inner >= outer {
                    let name = if table.inner_deg.is_some() { "inner_deg" } else { "outer_deg" };
                    let key = format!("light[{i}].spot.{name}");
                    let found = format!("{inner} degrees within {outer}");
                    return Err(positions.bad(&key, found, "inner_deg below outer_deg"));
                }
                let path = path("spot");
                let keys = LampKeys {
                    position: path.position(&table.position_m)?,
                    direction: path.direction(&table.direction)?,
                    color: path.color(&table.color)?,
                    strength: path.candela(table.intensity_cd.as_ref())?,
                };
                let spot = Self::Spot {
                    position: zero,
                    radius: table.radius_m.map(|radius| radius.0),
                    direction: zero,
                    color: zero,
                    intensity_cd: 0.0,
                    inner: inner.to_radians(),
                    outer: outer.to_radians(),
                    range: table.range_m.map(|range| range.0),
                };
                (spot, keys)
            }
            LampTable::Directional(table) => {
                let path = path("directional");
                let lux = table.illuminance_lux.as_ref();
                let keys = LampKeys {
                    position: zero.into(),
                    direction: path.direction(&table.direction)?,
                    color: path.color(&table.color)?,
                    strength: number_or(lux, PARALLEL_LUX, &path.of("illuminance_lux"), positions)?,
                };
                (Self::Directional { direction: zero, color: zero, illuminance_lux: 0.0 }, keys)
            }
        };
        Ok((lamp.at(&keys, 0.0), keys))
    }
}
