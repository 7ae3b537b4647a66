//! `[[wind]]`, `[gusts]`, `[turbulence]` and `[wind_field]`.

pub(super) mod keys;

use super::fault::Positions;
use super::quantity::{
    CoreM, EddyM, EddyMS, Exactly, GustM, HeightM, In, Intensity, Outflow, Part, PositionM, Range, TurnDeg,
    Turning, Whole, WindBoxM, WindMS, WindPositionM,
};
use downpour_math::OutOfRange;
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_wind::grid::WIND_GRID_CELLS;
use downpour_wind::{
    Gusts, Keyed, KeyedSingularity, KeyedTornado, Turbulence, Wind, WindCore, WindError, WindForm, WindGrid,
    WindPart,
};
use glam::DVec3;
use keys::{NumberKeys, VectorKeys, keyed, vector_or};
use serde::Deserialize;

/// Default core radius, in meters: three cells of the default grid.
const CORE_M: f64 = 5.0;

/// Spacing of the keys of a turning wind, in degrees: between two of them it is 0.1 % slower.
const TURN_STEP_DEG: f64 = 5.0;

/// Box of cells in which a non-uniform wind is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindBox {
    /// Number of cells along x, y and z, 1 to 4096 each, 2^23 together.
    pub size: [u32; 3],
    /// Edges of the box, 0.01 to 1e6 m.
    pub edges: DVec3,
    /// Center, in meters; `None` for the eye.
    pub center: Option<DVec3>,
}

impl Default for WindBox {
    /// The grid of Rousseau 2008: 64 cells along edges of 100 m, around the eye.
    fn default() -> Self {
        Self { size: [64; 3], edges: DVec3::splat(100.0), center: None }
    }
}

impl WindBox {
    /// Grid for an eye at a position, in meters.
    ///
    /// # Errors
    /// As [`WindGrid::new`]: the box is farther than 1e6 m from the origin.
    #[expect(clippy::arithmetic_side_effects, reason = "of floats: what is too far is refused by the grid")]
    pub fn grid(&self, eye: DVec3) -> Result<WindGrid, WindError> {
        let (middle, half) = (self.center.unwrap_or(eye), self.edges * 0.5);
        WindGrid::new((middle - half).as_vec3(), (middle + half).as_vec3(), self.size)
    }
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum WindTable {
    Uniform(UniformTable),
    Source(SingularityTable<Outflow>),
    Sink(SingularityTable<Outflow>),
    Vortex(SingularityTable<Turning>),
    Tornado(TornadoTable),
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct UniformTable {
    speed_m_s: NumberKeys<WindMS>,
    towards_deg: Option<NumberKeys<TurnDeg>>,
    direction: Option<VectorKeys<Part>>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(bound = "R: super::quantity::Range", rename = "Singularity")
)]
#[serde(deny_unknown_fields, bound = "R: Range")]
pub(super) struct SingularityTable<R> {
    strength_m2_s: Option<NumberKeys<R>>,
    strength_m3_s: Option<NumberKeys<R>>,
    center_m: Option<VectorKeys<WindPositionM>>,
    axis: Option<VectorKeys<Part>>,
    core_m: Option<NumberKeys<CoreM>>,
    core: Option<CoreWord>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct TornadoTable {
    circulation_m2_s: NumberKeys<Turning>,
    discharge_m3_s: Option<NumberKeys<Outflow>>,
    base_m: Option<VectorKeys<WindPositionM>>,
    height_m: NumberKeys<HeightM>,
    axis: Option<VectorKeys<Part>>,
    core_m: Option<NumberKeys<CoreM>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum CoreWord {
    Rosenhead,
    Rankine,
    LambOseen,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct GustsTable {
    intensity: Option<In<Intensity>>,
    length_m: Option<In<GustM>>,
    seed: Option<u64>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct TurbulenceTable {
    speed_m_s: Option<In<EddyMS>>,
    length_m: Option<In<EddyM>>,
    seed: Option<u64>,
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct WindFieldTable {
    size: Option<Exactly<Whole<1, 4096>, 3>>,
    box_m: Option<Exactly<In<WindBoxM>, 3>>,
    center_m: Option<Exactly<In<PositionM>, 3>>,
}

impl WindFieldTable {
    /// Rejects a grid of a wind that needs none.
    pub(super) fn checked(&self, wind: &Wind, positions: &Positions<'_>) -> Result<WindBox, SceneError> {
        let default = WindBox::default();
        let size = self.size.map_or(default.size, |Exactly(size)| size.map(|Whole(cells)| cells));
        let cells: u64 = size.iter().map(|&n| u64::from(n)).product();
        if cells > WIND_GRID_CELLS {
            let found = format!("{cells} cells");
            return Err(positions.limit("wind_field.size", found, format!("at most {WIND_GRID_CELLS}")));
        }
        let given = [
            ("wind_field.size", self.size.is_some()),
            ("wind_field.box_m", self.box_m.is_some()),
            ("wind_field.center_m", self.center_m.is_some()),
        ];
        if let (Some(_), Some((key, _))) = (wind.uniform(), given.into_iter().find(|(_, given)| *given)) {
            let found = "a grid for a wind that is the same everywhere";
            let allowed = "with [turbulence], or a source, sink, vortex or tornado in [[wind]]";
            return Err(positions.bad(key, found, allowed));
        }
        Ok(WindBox {
            size,
            edges: self.box_m.map_or(default.edges, |edges| edges.numbers().into()),
            center: self.center_m.map(|center| center.numbers().into()),
        })
    }
}

/// The whole wind of a file.
pub(super) fn checked(
    parts: &[WindTable],
    gusts: Option<&GustsTable>,
    turbulence: Option<&TurbulenceTable>,
    positions: &Positions<'_>,
) -> Result<Wind, SceneError> {
    let gusts = gusts.map(|table| {
        let default = Gusts::default();
        Gusts {
            intensity: table.intensity.map_or(default.intensity, |fraction| fraction.0),
            length: table.length_m.map_or(default.length, |length| length.0),
            seed: table.seed.unwrap_or(default.seed),
        }
    });
    let turbulence = turbulence.map(|table| {
        let default = Turbulence::default();
        Turbulence {
            speed: table.speed_m_s.map_or(default.speed, |speed| speed.0),
            length: table.length_m.map_or(default.length, |length| length.0),
            seed: table.seed.unwrap_or(default.seed),
        }
    });
    if gusts.is_some() && !parts.iter().any(|part| matches!(part, WindTable::Uniform(_))) {
        let allowed = "with [[wind]] uniform = { ... }, which gusts";
        return Err(positions.bad("gusts", "without a uniform wind", allowed));
    }
    let parts = parts.iter().enumerate().map(|(i, table)| table.checked(i, positions));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    // Each part has been checked; only the total number of keys remains.
    Wind::new(parts, gusts, turbulence).map_err(|error| match error {
        WindError::KeyCount { found, allowed } => {
            let found = format!("{found} different times of keys in all uniform winds");
            positions.limit("wind", found, format!("at most {allowed}"))
        }
        error => positions.bad("wind", error.to_string(), "a wind in its ranges"),
    })
}

impl WindTable {
    fn checked(&self, i: usize, positions: &Positions<'_>) -> Result<WindPart, SceneError> {
        let (name, part) = match self {
            Self::Uniform(table) => ("uniform", table.part(&format!("wind[{i}].uniform"), positions)?),
            Self::Source(table) => {
                ("source", WindPart::Source(table.part(&format!("wind[{i}].source"), positions)?))
            }
            Self::Sink(table) => ("sink", WindPart::Sink(table.part(&format!("wind[{i}].sink"), positions)?)),
            Self::Vortex(table) => {
                ("vortex", WindPart::Vortex(table.part(&format!("wind[{i}].vortex"), positions)?))
            }
            Self::Tornado(table) => ("tornado", table.part(&format!("wind[{i}].tornado"), positions)?),
        };
        // Alone, so that an error names its key.
        match Wind::new(vec![part.clone()], None, None) {
            Ok(_) => Ok(part),
            Err(error) => Err(refused(&format!("wind[{i}].{name}"), &error, positions)),
        }
    }
}

/// Error of a part over time, although each number is in its range.
fn refused(path: &str, error: &WindError, positions: &Positions<'_>) -> SceneError {
    match error {
        WindError::OutOfRange(OutOfRange { quantity, found, unit, allowed }) => {
            let key = if *quantity == "height" { format!("{path}.height_m") } else { path.to_owned() };
            positions.bad(&key, format!("{quantity} {found} {unit}"), allowed.as_ref())
        }
        WindError::ZeroAxis { .. } => {
            positions.bad(&format!("{path}.axis"), "no length", "three numbers, not all 0")
        }
        WindError::AxisReverses { time, .. } => {
            let found = format!("turned about up to the key at {time} s");
            positions.bad(
                &format!("{path}.axis"),
                found,
                "a key between that defines the direction of the turn",
            )
        }
        WindError::CoreOfPoint { found } => {
            let found = format!("{found} with strength_m3_s");
            positions.bad(&format!("{path}.core"), found, "rosenhead, or strength_m2_s")
        }
        error => positions.bad(path, error.to_string(), "a wind in its ranges"),
    }
}

impl UniformTable {
    fn part(&self, path: &str, positions: &Positions<'_>) -> Result<WindPart, SceneError> {
        let key = |name: &str| format!("{path}.{name}");
        let speed = self.speed_m_s.keyed(&key("speed_m_s"), positions)?;
        let direction = match (&self.towards_deg, &self.direction) {
            (Some(degrees), None) => turning(degrees, &key("towards_deg"), positions)?,
            (None, Some(direction)) => direction.keyed(&key("direction"), positions)?,
            (Some(_), Some(_)) => {
                return Err(positions.bad(&key("direction"), "beside towards_deg", "one of the two"));
            }
            (None, None) => {
                let allowed = "towards_deg or direction is needed";
                return Err(positions.bad(path, "no towards_deg", allowed));
            }
        };
        WindPart::uniform(&speed, &direction)
            .map_err(|_| positions.bad(&key("direction"), "no length", "three numbers, not all 0"))
    }
}

/// Level directions, with additional keys if the wind turns far.
fn turning(
    degrees: &NumberKeys<TurnDeg>,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Keyed<DVec3>, SceneError> {
    // The times of the file are checked first.
    let angles = degrees.keyed(path, positions)?;
    let towards = |angle: f64| {
        let radians = angle.to_radians();
        DVec3::new(ops::cos(radians), 0.0, ops::sin(radians))
    };
    let raw = degrees.raw();
    if raw.len() < 2 {
        return Ok(angles.map(towards));
    }
    let mut keys = Vec::new();
    for pair in angles.keys().windows(2) {
        let [(start, from), (end, to)] = *pair else { continue };
        let steps = ((to - from).abs() / TURN_STEP_DEG).min((end - start) * 1e5).ceil().max(1.0);
        let mut step = 0.0;
        while step < steps {
            let fraction = step / steps;
            keys.push((start + (end - start) * fraction, towards(from + (to - from) * fraction)));
            step += 1.0;
        }
    }
    if let Some(&(time, last)) = angles.keys().last() {
        keys.push((time, towards(last)));
    }
    if keys.len() > downpour_wind::WIND_KEYS {
        let found = format!("{} keys, one for each {TURN_STEP_DEG} degrees of a turn", keys.len());
        return Err(positions.limit(path, found, format!("at most {}", downpour_wind::WIND_KEYS)));
    }
    keyed(keys, path, positions)
}

impl<R> SingularityTable<R> {
    fn part(&self, path: &str, positions: &Positions<'_>) -> Result<KeyedSingularity, SceneError> {
        let key = |name: &str| format!("{path}.{name}");
        let (form, strength) = match (&self.strength_m2_s, &self.strength_m3_s) {
            (Some(line), None) => (WindForm::Line, line.keyed(&key("strength_m2_s"), positions)?),
            (None, Some(point)) => (WindForm::Point, point.keyed(&key("strength_m3_s"), positions)?),
            (Some(_), Some(_)) => {
                let allowed = "one of the two: strength_m2_s of a line, strength_m3_s of a point";
                return Err(positions.bad(&key("strength_m3_s"), "beside strength_m2_s", allowed));
            }
            (None, None) => {
                let allowed = "strength_m2_s of a line or strength_m3_s of a point is needed";
                return Err(positions.bad(path, "no strength", allowed));
            }
        };
        Ok(KeyedSingularity {
            form,
            core: match self.core {
                None | Some(CoreWord::Rosenhead) => WindCore::Rosenhead,
                Some(CoreWord::Rankine) => WindCore::Rankine,
                Some(CoreWord::LambOseen) => WindCore::LambOseen,
            },
            strength,
            center: vector_or(self.center_m.as_ref(), DVec3::ZERO, &key("center_m"), positions)?,
            axis: vector_or(self.axis.as_ref(), DVec3::Y, &key("axis"), positions)?,
            core_radius: core(self.core_m.as_ref(), &key("core_m"), positions)?,
        })
    }
}

fn core(
    given: Option<&NumberKeys<CoreM>>,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Keyed<f64>, SceneError> {
    given.map_or_else(|| Ok(CORE_M.into()), |given| given.keyed(path, positions))
}

impl TornadoTable {
    fn part(&self, path: &str, positions: &Positions<'_>) -> Result<WindPart, SceneError> {
        let key = |name: &str| format!("{path}.{name}");
        let discharge = match &self.discharge_m3_s {
            Some(discharge) => discharge.keyed(&key("discharge_m3_s"), positions)?,
            None => 0.0.into(),
        };
        Ok(WindPart::Tornado(KeyedTornado {
            circulation: self.circulation_m2_s.keyed(&key("circulation_m2_s"), positions)?,
            discharge,
            base: vector_or(self.base_m.as_ref(), DVec3::ZERO, &key("base_m"), positions)?,
            axis: vector_or(self.axis.as_ref(), DVec3::Y, &key("axis"), positions)?,
            height: self.height_m.keyed(&key("height_m"), positions)?,
            core_radius: core(self.core_m.as_ref(), &key("core_m"), positions)?,
        }))
    }
}
