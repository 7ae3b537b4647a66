//! `[drips]` and `[[drip]]`: water that drips from edges.

use super::quantity::{DripMm, DripsPerS, Exactly, In, PositionM};
use glam::DVec3;
use serde::Deserialize;

/// Water that drips from the edges of the scene, and from points that are set by hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drips {
    /// True if water that has fallen on the scene drips from its edges.
    pub is_enabled: bool,
    /// Points that are set by hand, in the order of the file.
    pub points: Vec<DripPoint>,
}

/// A point that drips at a rate of its own, whatever the rain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DripPoint {
    /// Position, m.
    pub position: DVec3,
    /// Drops per second.
    pub per_s: f64,
    /// Diameter of the drops, m; `None`: that of a broad edge.
    pub diameter_m: Option<f64>,
}

impl Drips {
    pub(super) fn checked(table: &DripsTable, points: &[DripTable]) -> Self {
        let points = points.iter().map(|point| DripPoint {
            position: point.position_m.numbers().into(),
            per_s: point.per_second.0,
            diameter_m: point.diameter_mm.map(|diameter| diameter.0 * 1.0e-3),
        });
        Self { is_enabled: table.enabled.unwrap_or_default(), points: points.collect() }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct DripsTable {
    pub(super) enabled: Option<bool>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct DripTable {
    position_m: Exactly<In<PositionM>, 3>,
    per_second: In<DripsPerS>,
    diameter_mm: Option<In<DripMm>>,
}
