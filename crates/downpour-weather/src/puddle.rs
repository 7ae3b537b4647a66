//! `[[puddle]]`: water on the ground of the scene.

use super::fault::Positions;
use super::file::path;
use super::quantity::{
    AttenuationM, Exactly, FieldCellMm, Fill, In, Influence, PositionM, PuddleDepthMm, PuddleM, PuddleReachM,
    ReliefMm, RippleScale, SeepageMmH, Tint, TurnDeg,
};
use super::wind::keys::{Given, NumberKeys, number_given};
use downpour_scene::error::SceneError;
use downpour_scene::uri::RelativePath;
use downpour_wind::Keyed;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, IntoDeserializer, SeqAccess, Visitor};
use std::fmt;

/// Maximum number of cells along an edge of a puddle's map.
pub const MAX_PUDDLE_CELLS: u32 = 2048;

/// Maximum number of cells of all puddles' maps.
pub const MAX_ALL_PUDDLE_CELLS: u64 = 1 << 22;

/// Default edge of a cell, m.
const CELL_M: f64 = 0.025;

/// Water in the hollows of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PuddleFill {
    /// Filled fraction of their depth: 0 empty, 1 until they spill.
    Part(f64),
    /// What the rain of [`Wetness`](crate::Wetness) brings from their catchments.
    Rain {
        /// Depth of water that seeps away, m/s.
        seepage: f64,
        /// True if the water that runs off and spills is shown on its way.
        running: bool,
    },
}

/// Shape of the water.
#[derive(Clone, Debug, PartialEq)]
pub enum PuddleShape {
    /// In the hollows of the ground.
    Found {
        /// Water in the hollows.
        fill: PuddleFill,
        /// Minimum depth of hollows that hold water, m.
        min_depth: f64,
        /// Unevenness of the ground in addition to its model: root mean square of the height, m.
        relief: f64,
        /// Seed of that unevenness.
        seed: u64,
        /// Number of cells along the edges.
        cells: [u32; 2],
    },
    /// Depth from a picture: red, linear, 1 is the full depth. Its center is the puddle's, its columns run
    /// along the first edge.
    Painted(RelativePath),
}

/// What ripples near the eye come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PuddleRings {
    /// The larger drops of the rain in closed form, in the uniform part of the wind, make rings where they fall.
    #[default]
    Drops,
    /// All ripples are those of a lattice, as in Tatarchuk & Isidoro 2006.
    Lattice,
}

/// Water within a rectangle of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Puddle {
    /// Center of the rectangle, m.
    pub middle: [f64; 3],
    /// Its edges, m, along X and Z before it is turned.
    pub size: [f64; 2],
    /// Turn about the vertical axis, rad, from +X toward +Z.
    pub turn: f64,
    /// Distance above and below the center in which the ground is searched, m.
    pub reach: f64,
    /// Shape of the water.
    pub shape: PuddleShape,
    /// Maximum depth, m.
    pub depth: f64,
    /// Size of the ripples, as a multiple of the true one.
    pub ripple_scale: f64,
    /// Turn of the ripples, rad.
    pub ripple_turn: f64,
    /// Slopes of the ripples, as a multiple of the true ones.
    pub ripple_influence: f64,
    /// Where the ripples come from.
    pub rings: PuddleRings,
    /// Attenuation length of the water, m: 1/e of the light is transmitted.
    pub attenuation_length: f64,
    /// Albedo of water so deep that the ground is invisible.
    pub color: [f64; 3],
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PuddleTable {
    position_m: Exactly<In<PositionM>, 3>,
    size_m: Exactly<In<PuddleM>, 2>,
    turn_deg: Option<In<TurnDeg>>,
    reach_m: Option<In<PuddleReachM>>,
    mask: Option<String>,
    depth_mm: Option<In<PuddleDepthMm>>,
    fill: Option<FillKey>,
    seepage_mm_h: Option<In<SeepageMmH>>,
    running: Option<bool>,
    min_depth_mm: Option<In<PuddleDepthMm>>,
    relief_mm: Option<In<ReliefMm>>,
    seed: Option<u64>,
    cell_mm: Option<In<FieldCellMm>>,
    ripple_scale: Option<In<RippleScale>>,
    ripple_deg: Option<In<TurnDeg>>,
    ripple_influence: Option<NumberKeys<Influence>>,
    rings: Option<PuddleRings>,
    attenuation_length_m: Option<In<AttenuationM>>,
    color: Option<Exactly<In<Tint>, 3>>,
}

impl Puddle {
    /// The puddle at time 0, and its fill and the influence of its ripples over time if they are given.
    pub(super) fn checked(
        index: usize,
        table: &PuddleTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, [Given; 2]), SceneError> {
        let at = |name: &str| format!("puddle[{index}].{name}");
        let size = table.size_m.numbers();
        let meters = |given: Option<f64>, default_mm: f64| given.unwrap_or(default_mm) * 1.0e-3;
        let given = table.fill.as_ref().and_then(|fill| fill.0.as_ref());
        let keys = given.map(|fill| fill.keyed(&at("fill"), positions)).transpose()?;
        let shape = if let Some(mask) = &table.mask {
            for (name, given) in [
                ("fill", table.fill.is_some()),
                ("seepage_mm_h", table.seepage_mm_h.is_some()),
                ("running", table.running.is_some()),
                ("min_depth_mm", table.min_depth_mm.is_some()),
                ("relief_mm", table.relief_mm.is_some()),
                ("seed", table.seed.is_some()),
                ("cell_mm", table.cell_mm.is_some()),
            ] {
                if given {
                    let allowed = "either a mask, or a puddle that is found";
                    return Err(positions.bad(&at(name), "beside mask", allowed));
                }
            }
            PuddleShape::Painted(path(mask, &at("mask"), positions)?)
        } else {
            let cell = table.cell_mm.map_or(CELL_M, |mm| mm.0 * 1.0e-3);
            let cells = size.map(|edge| cells(edge, cell));
            if cells.iter().any(|&n| n > MAX_PUDDLE_CELLS) {
                let [width, depth] = cells;
                let allowed =
                    format!("at most {MAX_PUDDLE_CELLS} along each edge: a larger cell_mm, or more puddles");
                return Err(positions.bad(&at("cell_mm"), format!("{width} x {depth} cells"), allowed));
            }
            PuddleShape::Found {
                fill: fill(table, keys.as_ref(), &at, positions)?,
                min_depth: meters(table.min_depth_mm.map(|mm| mm.0), 1.5),
                relief: meters(table.relief_mm.map(|mm| mm.0), 2.2),
                seed: table.seed.unwrap_or(0),
                cells,
            }
        };
        let influence = number_given(table.ripple_influence.as_ref(), &at("ripple_influence"), positions)?;
        let usual_depth_mm = if table.mask.is_some() { 12.0 } else { 100.0 };
        let puddle = Self {
            middle: table.position_m.numbers(),
            size,
            turn: table.turn_deg.map_or(0.0, |deg| deg.0.to_radians()),
            reach: table.reach_m.map_or(0.3, |m| m.0),
            shape,
            depth: meters(table.depth_mm.map(|mm| mm.0), usual_depth_mm),
            ripple_scale: table.ripple_scale.map_or(1.0, |scale| scale.0),
            ripple_turn: table.ripple_deg.map_or(0.0, |deg| deg.0.to_radians()),
            ripple_influence: influence.as_ref().map_or(1.0, |influence| influence.at(0.0)),
            rings: table.rings.unwrap_or_default(),
            attenuation_length: table.attenuation_length_m.map_or(0.25, |m| m.0),
            color: table.color.map_or([0.12, 0.105, 0.08], Exactly::numbers),
        };
        Ok((puddle, [keys, influence]))
    }
}

/// The water in the hollows of a puddle that is found.
fn fill(
    table: &PuddleTable,
    keys: Option<&Keyed<f64>>,
    at: &impl Fn(&str) -> String,
    positions: &Positions<'_>,
) -> Result<PuddleFill, SceneError> {
    let Some(part) = keys else {
        let seepage = table.seepage_mm_h.map_or(0.0, |rate| rate.0 * 1.0e-3 / 3600.0);
        return Ok(PuddleFill::Rain { seepage, running: table.running.unwrap_or(true) });
    };
    for (name, given) in
        [("seepage_mm_h", table.seepage_mm_h.is_some()), ("running", table.running.is_some())]
    {
        if given {
            return Err(positions.bad(&at(name), "beside a fill that is given", "fill = \"rain\""));
        }
    }
    Ok(PuddleFill::Part(part.at(0.0)))
}

/// A fraction, or keys of it, or `None` for the rain.
#[derive(Debug)]
pub(super) struct FillKey(Option<NumberKeys<Fill>>);

impl<'de> Deserialize<'de> for FillKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Written;
        impl<'de> Visitor<'de> for Written {
            type Value = FillKey;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"rain\", a number from 0 to 1, or keys [[time in s, value], ...]")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<FillKey, E> {
                if text == "rain" {
                    return Ok(FillKey(None));
                }
                Err(E::custom(format_args!("{text:?}; allowed: \"rain\", or 0 to 1")))
            }

            fn visit_f64<E: Error>(self, part: f64) -> Result<FillKey, E> {
                NumberKeys::deserialize(part.into_deserializer()).map(|fill| FillKey(Some(fill)))
            }

            fn visit_i64<E: Error>(self, part: i64) -> Result<FillKey, E> {
                self.visit_f64(part as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<FillKey, A::Error> {
                NumberKeys::deserialize(SeqAccessDeserializer::new(seq)).map(|fill| FillKey(Some(fill)))
            }
        }
        deserializer.deserialize_any(Written)
    }
}

/// Number of cells along an edge.
#[expect(clippy::cast_possible_truncation, reason = "whole, and within the range of u32")]
fn cells(edge: f64, cell: f64) -> u32 {
    (edge / cell).round().clamp(2.0, 1.0e9) as u32
}

/// Checks that the maps of all puddles together are not too large.
pub(super) fn check_all(puddles: &[Puddle], positions: &Positions<'_>) -> Result<(), SceneError> {
    let of = |puddle: &Puddle| match puddle.shape {
        PuddleShape::Found { cells: [width, depth], .. } => u64::from(width).saturating_mul(u64::from(depth)),
        PuddleShape::Painted(_) => 0,
    };
    let all: u64 = puddles.iter().map(of).sum();
    if all > MAX_ALL_PUDDLE_CELLS {
        let allowed = format!("at most {MAX_ALL_PUDDLE_CELLS}: larger cell_mm");
        return Err(positions.limit("puddle", format!("{all} cells in all maps"), allowed));
    }
    Ok(())
}
