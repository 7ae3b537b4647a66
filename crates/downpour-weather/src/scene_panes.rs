//! `[[pane]]`: glass of the scene on which rain is seen.

use super::fault::Positions;
use super::material_names::{MaterialNames, check_length};
use super::quantity::{ElevationDeg, Exactly, In, PositionM, SheetDropMm, SheetHeightM, SheetM, TurnDeg};
use downpour_scene::error::SceneError;
use glam::DVec3;
use serde::Deserialize;

/// Default way of the water down glass, m: a storey.
const HEIGHT_M: f64 = 3.0;

/// Default diameter of the largest drop that stays on glass, m.
const MAX_DROP_M: f64 = 5.0e-3;

/// Glass of the scene on which rain is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenePane {
    /// Name of the material that it is of; `None`: any that lets light through.
    pub material: Option<String>,
    /// Part of it; `None`: wherever the material is.
    pub rectangle: Option<SceneRectangle>,
    /// Way of the water down it, m, without a rectangle.
    pub height_m: f64,
    /// Diameter of the largest drop that stays, m.
    pub largest_m: f64,
    /// Seed of the drops.
    pub seed: u32,
}

/// A rectangle in the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneRectangle {
    /// Its center, m.
    pub center: DVec3,
    /// Width and height, m.
    pub size_m: [f64; 2],
    /// Direction that it faces: turn about the vertical axis, rad, from +X toward +Z.
    pub turn: f64,
    /// Angle of that direction above the horizon, rad.
    pub tilt: f64,
}

impl SceneRectangle {
    /// Unit vector that it faces.
    #[must_use]
    pub fn outward(&self) -> DVec3 {
        let (sin, cos) = (downpour_math::ops::f64::sin, downpour_math::ops::f64::cos);
        DVec3::new(cos(self.tilt) * cos(self.turn), sin(self.tilt), cos(self.tilt) * sin(self.turn))
    }
}

impl ScenePane {
    pub(super) fn checked(
        index: usize,
        table: &ScenePaneTable,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let at = |name: &str| format!("pane[{index}].{name}");
        if let Some(name) = &table.material {
            check_length(name, &at("material"), positions)?;
        }
        let rectangle = match (table.position_m, table.size_m) {
            (Some(center), Some(size)) => Some(SceneRectangle {
                center: center.numbers().into(),
                size_m: size.numbers(),
                turn: table.turn_deg.map_or(0.0, |turn| turn.0.to_radians()),
                tilt: table.tilt_deg.map_or(0.0, |tilt| tilt.0.to_radians()),
            }),
            (None, None) => None,
            (Some(_), None) => {
                return Err(positions.bad(&at("position_m"), "without size_m", "both, or none"));
            }
            (None, Some(_)) => {
                return Err(positions.bad(&at("size_m"), "without position_m", "both, or none"));
            }
        };
        if rectangle.is_none() {
            let given = [("turn_deg", table.turn_deg.is_some()), ("tilt_deg", table.tilt_deg.is_some())];
            if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
                return Err(positions.bad(&at(key), "without a rectangle", "with position_m and size_m"));
            }
        } else if table.height_m.is_some() {
            let allowed = "without position_m and size_m, which give the height";
            return Err(positions.bad(&at("height_m"), "beside a rectangle", allowed));
        }
        Ok(Self {
            material: table.material.clone(),
            rectangle,
            height_m: table.height_m.map_or(HEIGHT_M, |height| height.0),
            largest_m: table.largest_mm.map_or(MAX_DROP_M, |largest| largest.0 * 1.0e-3),
            seed: table.seed.unwrap_or_default(),
        })
    }

    /// Checks that its material is one of `names`.
    pub(super) fn check_material(&self, index: usize, names: &MaterialNames<'_>) -> Result<(), SceneError> {
        let name = self.material.as_ref();
        name.map_or(Ok(()), |name| names.check(name, &format!("pane[{index}].material")))
    }
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ScenePaneTable {
    material: Option<String>,
    position_m: Option<Exactly<In<PositionM>, 3>>,
    size_m: Option<Exactly<In<SheetM>, 2>>,
    turn_deg: Option<In<TurnDeg>>,
    tilt_deg: Option<In<ElevationDeg>>,
    height_m: Option<In<SheetHeightM>>,
    largest_mm: Option<In<SheetDropMm>>,
    seed: Option<u32>,
}
