//! `[[light]]`.

use super::fault::Positions;
use super::quantity::{Candela, ConeDeg, Exactly, In, LampM, Lux, Part, PositionM, RangeM, Tint};
use downpour_scene::error::SceneError;
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
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum LampTable {
    Point(PointTable),
    Spot(SpotTable),
    Directional(DirectionalTable),
}

type Color = Option<Exactly<In<Tint>, 3>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointTable {
    position_m: Exactly<In<PositionM>, 3>,
    color: Color,
    intensity_cd: Option<In<Candela>>,
    range_m: Option<In<RangeM>>,
    radius_m: Option<In<LampM>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpotTable {
    position_m: Exactly<In<PositionM>, 3>,
    direction: Exactly<In<Part>, 3>,
    color: Color,
    intensity_cd: Option<In<Candela>>,
    inner_deg: Option<In<ConeDeg>>,
    outer_deg: Option<In<ConeDeg>>,
    range_m: Option<In<RangeM>>,
    radius_m: Option<In<LampM>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DirectionalTable {
    direction: Exactly<In<Part>, 3>,
    color: Color,
    illuminance_lux: Option<In<Lux>>,
}

impl Lamp {
    pub(super) fn checked(
        i: usize,
        table: &LampTable,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let color = |given: Color| given.map_or(DVec3::ONE, |color| color.numbers().into());
        let candela = |given: Option<In<Candela>>| given.map_or(LAMP_CD, |candela| candela.0);
        let unit = |direction: Exactly<In<Part>, 3>, key: &str| {
            DVec3::from_array(direction.numbers()).try_normalize().ok_or_else(|| {
                positions.bad(&format!("light[{i}].{key}.direction"), "no length", "three numbers, not all 0")
            })
        };
        match table {
            LampTable::Point(table) => Ok(Self::Point {
                position: table.position_m.numbers().into(),
                radius: table.radius_m.map(|radius| radius.0),
                color: color(table.color),
                intensity_cd: candela(table.intensity_cd),
                range: table.range_m.map(|range| range.0),
            }),
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
                Ok(Self::Spot {
                    position: table.position_m.numbers().into(),
                    radius: table.radius_m.map(|radius| radius.0),
                    direction: unit(table.direction, "spot")?,
                    color: color(table.color),
                    intensity_cd: candela(table.intensity_cd),
                    inner: inner.to_radians(),
                    outer: outer.to_radians(),
                    range: table.range_m.map(|range| range.0),
                })
            }
            LampTable::Directional(table) => Ok(Self::Directional {
                direction: unit(table.direction, "directional")?,
                color: color(table.color),
                illuminance_lux: table.illuminance_lux.map_or(PARALLEL_LUX, |lux| lux.0),
            }),
        }
    }
}
