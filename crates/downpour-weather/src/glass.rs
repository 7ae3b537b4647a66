//! `[glass]` and `[[glass.wiper]]`: a pane before the camera, and the rain on it.

use super::fault::Positions;
use super::file::path;
use super::pane_map::PaneMap;
use super::quantity::{
    AboveM, AdvancingDeg, BeadMm, BeforeS, BladeFilmUm, BladeM, CellMm, DryingMmH, Exactly, FilmUm, Fraction,
    GlassWetS, HighlightMm, In, PaneApertureMm, PaneM, PaneMS, PaneTiltDeg, PeriodS, PivotM, Pull, ReachM,
    RecedingDeg, TrailMm, TurnDeg,
};
use super::wind::keys::NumberKeys;
use super::{Rain, Weather};
use downpour_lattice::glass::{
    GlassAir, GlassContact, GlassError, GlassOptions, GlassRain, GlassTrail, GlassWetting, GlassWiper,
    GlassWiperKey, GlassWiperMotion, GlassWornBand,
};
use downpour_math::OutOfRange;
use downpour_math::ops::f64 as ops;
use downpour_scene::error::SceneError;
use downpour_wind::Keyed;
use glam::DVec3;
use serde::Deserialize;

/// Maximum speed of drops on a pane of a weather, m/s.
const SPEED_LIMIT_M_S: f64 = 0.4;

/// Maximum number of rows of cells of the lattice.
const MAX_ROWS: u32 = 4096;

/// Maximum angle of a wiper's keys in the lattice.
const MAX_RAD: f64 = 7.0;

/// Maximum speed of the air toward a pane, m/s.
const MAX_SPEED_M_S: f64 = 100.0;

/// Speed of the air toward a pane where there is neither wind nor motion, m/s: a light breeze.
const STILL_M_S: f64 = 3.0;

/// Time over which the speed of an eye is taken, s.
const EYE_S: f64 = 0.1;

/// Maximum number of wipers that are drawn.
const MAX_DRAWN: usize = 8;

/// Object in focus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PaneFocus {
    /// The scene behind the pane, each point at its distance: the drops are blurred.
    #[default]
    Scene,
    /// The pane: the scene behind it is blurred.
    Glass,
}

/// Reflectance of the surfaces of pane and water.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PaneFresnel {
    /// Fresnel's equations.
    #[default]
    Exact,
    /// 0.05 + 0.95 (1 - cos)^4 for the water's surface.
    #[serde(rename = "tatarchuk-2006")]
    Tatarchuk2006,
}

/// Effect of the drops on light that falls through the pane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PaneShadow {
    /// Drops are lenses, whose light converges behind them and spreads beyond.
    #[default]
    Lens,
    /// Their shadows have highlights in the middle, at any distance.
    #[serde(rename = "tatarchuk-2006")]
    Tatarchuk2006,
    /// No effect.
    None,
}

/// A pane fixed to the camera: a window or a windshield, the eye inside, rain outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Pane {
    /// Distance from the eye to the pane along the center of the picture, m.
    pub distance: f64,
    /// Tilt from the horizontal, rad: pi/2 is a window; a windshield leans toward the eye.
    pub tilt: f64,
    /// Width and height along the pane, m; it is centered in the picture. `None`: the visible size.
    pub size: Option<[f64; 2]>,
    /// Edge of a cell, m.
    pub cell: f64,
    /// Height of the pane above the picture, m: water runs down from there.
    pub above: f64,
    /// Speed of the air with the rain toward the pane, m/s, over time; `None`: that of wind and eye, [`Weather::pane_speed`].
    pub speed: Option<Keyed<f64>>,
    /// Time of rain on the pane before the first picture, s.
    pub before: f64,
    /// Object in focus.
    pub focus: PaneFocus,
    /// Diameter of the lens, m; 0: all is in focus.
    pub aperture: f64,
    /// Brightness on the eye's side (interior ambient), as a fraction of the scene's brightness around the eye.
    pub interior_ambient: f64,
    /// Model of reflectance.
    pub fresnel: PaneFresnel,
    /// Diameter, m, of the sphere of water from which on a drop shows lamps and the sun as bright spots: the mass above
    /// which Tatarchuk & Isidoro 2006 draw highlights. 0: all drops, as in optics; small ones have small spots.
    pub highlight: f64,
    /// Shadows of the drops in light of lamps and the sun through the pane.
    pub shadows: PaneShadow,
    /// Contact angles of water on the glass.
    pub contact: GlassContact,
    /// Thickness of the water film behind running drops, m.
    pub film: f64,
    /// Drying, mm/h.
    pub drying_mm_h: f64,
    /// Affinity of the glass for water: black repels, white attracts. `None`: noise.
    pub affinity: Option<PaneMap>,
    /// Attraction of drops by affinity, 0 to 4.
    pub affinity_pull: f64,
    /// Friction of the glass, from none to nearly twice the usual. `None`: noise.
    pub friction_map: Option<PaneMap>,
    /// Parts of the pane that hold no water. `None`: none.
    pub obstacles: Option<PaneMap>,
    /// Time that glass stays wet, s; friction and attraction there.
    pub wetting: GlassWetting,
    /// Beads that running drops leave behind.
    pub trail: GlassTrail,
    /// Seed of all random values on the pane.
    pub seed: u64,
    /// Wipers. The times of their keys are those of the weather; a sweep starts with the rain on the pane.
    pub wipers: Vec<GlassWiper>,
    /// True for each of the wipers whose blade and arm are drawn; at most 8 are.
    pub wipers_drawn: Vec<bool>,
}

impl Pane {
    /// Number of cells along a pane of a size in meters.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "whole, and within the range of u32")]
    pub fn cells(&self, size: [f64; 2]) -> [u32; 2] {
        size.map(|edge| (edge / self.cell).round().clamp(1.0, 1.0e9) as u32)
    }

    /// Number of rows of cells above the visible pane, a size in meters; fewer if the lattice would have too many.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "whole, and within the range of u32")]
    pub fn rows_above(&self, size: [f64; 2]) -> u32 {
        let [_, rows] = self.cells(size);
        ((self.above / self.cell).round().clamp(0.0, 4096.0) as u32).min(MAX_ROWS.saturating_sub(rows))
    }

    /// Options of the lattice for a pane of a visible size in meters, in a rain, from a time in seconds on: its uppermost
    /// [`Pane::rows_above`] rows are above the visible part. The tick is that of the fastest air.
    #[must_use]
    pub fn options(&self, size: [f64; 2], rain: &Rain, begin_s: f64) -> GlassOptions {
        let fastest = self.speed.as_ref().map_or(MAX_SPEED_M_S, |speed| {
            speed.keys().iter().fold(0.0, |most: f64, &(_, speed)| most.max(speed))
        });
        let (rain, air) = self.weather(rain, fastest);
        let [columns, rows] = self.cells(size);
        let above = self.rows_above(size);
        let cells = [columns, rows.saturating_add(above)];
        let usual = GlassOptions::default();
        GlassOptions {
            size: cells,
            cell_m: self.cell,
            tilt_rad: self.tilt,
            contact: self.contact,
            rain,
            air,
            evaporation_mm_h: self.drying_mm_h,
            affinity: self.affinity_texture(cells, above, usual.affinity),
            affinity_pull: self.affinity_pull,
            friction: self.friction_texture(cells, above, usual.friction),
            obstacles: self.obstacle_cells(cells, above),
            wetting: self.wetting,
            trail: self.trail,
            temperature_c: rain.air.temperature_c(),
            wipers: self
                .wipers
                .iter()
                .map(|wiper| shifted(wiper, begin_s, f64::from(above) * self.cell))
                .collect(),
            speed_limit_m_s: SPEED_LIMIT_M_S,
            seed: self.seed,
        }
    }

    /// Rain and air on the pane for an air speed: along the pane flows the component parallel to it.
    #[must_use]
    pub fn weather(&self, rain: &Rain, speed_m_s: f64) -> (GlassRain, GlassAir) {
        let along = speed_m_s * ops::cos(self.tilt).max(0.0);
        let drops = rain.options();
        (
            GlassRain {
                rate_mm_h: rain.rate_mm_h,
                law: rain.law,
                diameters_m: [drops.min_diameter_m, drops.max_diameter_m],
                fall_speed: drops.fall_speed,
                air: rain.air,
                towards_m_s: speed_m_s,
            },
            GlassAir { speed_m_s: along, ..GlassAir::default() },
        )
    }
}

impl Weather {
    /// Speed of the air with the rain toward the pane in front of the camera at a time in seconds, m/s, 0 to 100: that of the pane's key, else
    /// the horizontal velocity of the eye less that of the wind, along the direction in which the eye looks. The wind is that of uniform
    /// parts and gusts. Before `first_s`, the time of the first picture, the eye has the velocity of that time. `forward` is the view
    /// direction of a camera that this weather does not place: its motion is not known here. 0 without a pane.
    #[must_use]
    #[expect(clippy::arithmetic_side_effects, reason = "of floats")]
    pub fn pane_speed(&self, time_s: f64, first_s: f64, forward: DVec3) -> f64 {
        let Some(pane) = &self.glass else { return 0.0 };
        if let Some(speed) = &pane.speed {
            return speed.at(time_s);
        }
        let moves_s = time_s.max(first_s);
        let (forward, eye) = match &self.camera.path {
            Some(path) => {
                let (now, later) = (path.at(moves_s), path.at(moves_s + EYE_S));
                (now.forward, (later.position - now.position) / EYE_S)
            }
            None => (forward, DVec3::ZERO),
        };
        let ahead = DVec3::new(forward.x, 0.0, forward.z).normalize_or_zero();
        (eye - self.wind.air().velocity(time_s)).dot(ahead).clamp(0.0, MAX_SPEED_M_S)
    }
}

/// The wiper with its keys in the lattice's time, and its pivot lowered by `lower` meters.
fn shifted(wiper: &GlassWiper, begin_s: f64, lower: f64) -> GlassWiper {
    let motion = match &wiper.motion {
        GlassWiperMotion::Keys(keys) => GlassWiperMotion::Keys(
            keys.iter().map(|key| GlassWiperKey { time_s: key.time_s - begin_s, ..*key }).collect(),
        ),
        sweep @ GlassWiperMotion::Sweep { .. } => sweep.clone(),
    };
    let [x, y] = wiper.pivot_m;
    GlassWiper { motion, pivot_m: [x, y + lower], ..wiper.clone() }
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct GlassTable {
    distance_m: Option<In<ReachM>>,
    tilt_deg: Option<In<PaneTiltDeg>>,
    size_m: Option<Exactly<In<PaneM>, 2>>,
    cell_mm: Option<In<CellMm>>,
    above_m: Option<In<AboveM>>,
    speed_m_s: Option<NumberKeys<PaneMS>>,
    before_s: Option<In<BeforeS>>,
    focus: Option<PaneFocus>,
    aperture_mm: Option<In<PaneApertureMm>>,
    interior_ambient: Option<In<Fraction>>,
    fresnel: Option<PaneFresnel>,
    highlight_mm: Option<In<HighlightMm>>,
    shadows: Option<PaneShadow>,
    advancing_deg: Option<In<AdvancingDeg>>,
    receding_deg: Option<In<RecedingDeg>>,
    film_um: Option<In<FilmUm>>,
    drying_mm_h: Option<In<DryingMmH>>,
    affinity: Option<String>,
    affinity_pull: Option<In<Pull>>,
    friction_map: Option<String>,
    obstacles: Option<String>,
    wet_s: Option<In<GlassWetS>>,
    wet_ease: Option<In<Fraction>>,
    wet_pull: Option<In<Pull>>,
    trail_mm: Option<In<TrailMm>>,
    bead_mm: Option<In<BeadMm>>,
    seed: Option<u64>,
    #[serde(default)]
    wiper: Vec<WiperTable>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct WiperTable {
    pivot_m: Exactly<In<PivotM>, 2>,
    inner_m: Option<In<BladeM>>,
    length_m: In<BladeM>,
    from_deg: Option<In<TurnDeg>>,
    to_deg: Option<In<TurnDeg>>,
    period_s: Option<In<PeriodS>>,
    angle_deg: Option<NumberKeys<TurnDeg>>,
    is_drawn: Option<bool>,
    film_um: Option<In<BladeFilmUm>>,
    #[serde(default)]
    worn: Vec<WornTable>,
}

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct WornTable {
    from_m: In<BladeM>,
    to_m: In<BladeM>,
    leaves: Option<In<Fraction>>,
}

impl GlassTable {
    /// The pane in a rain; `is_still`: there is neither wind nor a camera that moves.
    pub(super) fn checked(
        &self,
        rain: &Rain,
        is_still: bool,
        positions: &Positions<'_>,
    ) -> Result<Pane, SceneError> {
        let number = |given: Option<f64>, default: f64| given.unwrap_or(default);
        let contact = GlassContact::default();
        let map = |file: &Option<String>, key: &str| {
            file.as_ref().map(|file| path(file, key, positions).map(PaneMap::new)).transpose()
        };
        let usual = GlassOptions::default();
        let pane = Pane {
            distance: number(self.distance_m.map(|m| m.0), 0.5),
            tilt: number(self.tilt_deg.map(|deg| deg.0), 90.0).to_radians(),
            size: self.size_m.map(Exactly::numbers),
            cell: number(self.cell_mm.map(|mm| mm.0), 0.6) * 1.0e-3,
            above: number(self.above_m.map(|m| m.0), 0.15),
            speed: match &self.speed_m_s {
                Some(keys) => Some(keys.keyed("glass.speed_m_s", positions)?),
                None if is_still => Some(STILL_M_S.into()),
                None => None,
            },
            before: number(self.before_s.map(|s| s.0), 60.0),
            focus: self.focus.unwrap_or_default(),
            aperture: number(self.aperture_mm.map(|mm| mm.0), 4.0) * 1.0e-3,
            interior_ambient: number(self.interior_ambient.map(|fraction| fraction.0), 0.1),
            fresnel: self.fresnel.unwrap_or_default(),
            shadows: self.shadows.unwrap_or_default(),
            highlight: number(self.highlight_mm.map(|mm| mm.0), 0.0) * 1.0e-3,
            contact: GlassContact {
                advancing_rad: self.advancing_deg.map_or(contact.advancing_rad, |deg| deg.0.to_radians()),
                receding_rad: self.receding_deg.map_or(contact.receding_rad, |deg| deg.0.to_radians()),
                ..contact
            },
            film: number(self.film_um.map(|um| um.0), 8.0) * 1.0e-6,
            drying_mm_h: number(self.drying_mm_h.map(|rate| rate.0), 0.0),
            affinity: map(&self.affinity, "glass.affinity")?,
            affinity_pull: number(self.affinity_pull.map(|pull| pull.0), usual.affinity_pull),
            friction_map: map(&self.friction_map, "glass.friction_map")?,
            obstacles: map(&self.obstacles, "glass.obstacles")?,
            wetting: GlassWetting {
                life_s: number(self.wet_s.map(|s| s.0), usual.wetting.life_s),
                ease: number(self.wet_ease.map(|fraction| fraction.0), usual.wetting.ease),
                pull: number(self.wet_pull.map(|pull| pull.0), usual.wetting.pull),
                ..usual.wetting
            },
            trail: GlassTrail {
                spacing_m: self.trail_mm.map_or(usual.trail.spacing_m, |mm| mm.0 * 1.0e-3),
                bead_m: self.bead_mm.map_or(usual.trail.bead_m, |mm| mm.0 * 1.0e-3),
            },
            seed: self.seed.unwrap_or(rain.seed),
            wipers: Vec::new(),
            wipers_drawn: Vec::new(),
        };
        if pane.contact.receding_rad > pane.contact.advancing_rad {
            let (low, high) =
                (pane.contact.receding_rad.to_degrees(), pane.contact.advancing_rad.to_degrees());
            let found = format!("{low:.4} with an advancing angle of {high:.4}");
            return Err(positions.bad("glass.receding_deg", found, "0 to the advancing angle"));
        }
        let Some(size) = pane.size else {
            if self.wiper.is_empty() {
                return Ok(pane);
            }
            let allowed = "with size_m = [width, height], in which wipers are positioned";
            return Err(positions.bad("glass.wiper", "without glass.size_m", allowed));
        };
        let [columns, rows] = pane.cells(size);
        if !(8..=4096).contains(&columns) || !(8..=4096).contains(&rows) {
            let found = format!("{columns} x {rows} cells of {} mm", pane.cell * 1.0e3);
            let allowed = "8 to 4096 along each edge: another size_m or cell_mm";
            return Err(if columns.max(rows) > 4096 {
                positions.limit("glass.size_m", found, allowed)
            } else {
                positions.bad("glass.size_m", found, allowed)
            });
        }
        let mut wipers = Vec::new();
        for (i, table) in self.wiper.iter().enumerate() {
            let wiper = table.wiper(&format!("glass.wiper[{i}]"), positions)?;
            // Alone, so that an error names its key.
            let alone = Pane { wipers: vec![wiper.clone()], above: 0.0, ..pane.clone() };
            let checked = alone.options(size, rain, 0.0).check();
            checked.map_err(|error| refused(&format!("glass.wiper[{i}]"), size, &error, positions))?;
            wipers.push(wiper);
        }
        let wipers_drawn: Vec<bool> = self.wiper.iter().map(|table| table.is_drawn.unwrap_or(true)).collect();
        let drawn = wipers_drawn.iter().filter(|is_drawn| **is_drawn).count();
        if drawn > MAX_DRAWN {
            let found = format!("{drawn} that are drawn");
            let allowed = format!("at most {MAX_DRAWN} that are drawn: is_drawn = false for others");
            return Err(positions.limit("glass.wiper", found, &allowed));
        }
        Ok(Pane { wipers, wipers_drawn, ..pane })
    }
}

impl WiperTable {
    fn wiper(&self, path: &str, positions: &Positions<'_>) -> Result<GlassWiper, SceneError> {
        let length = self.length_m.0;
        let motion = match (&self.angle_deg, self.from_deg, self.to_deg, self.period_s) {
            (Some(keys), None, None, None) => {
                let keys = keys.keyed(&format!("{path}.angle_deg"), positions)?;
                let key =
                    |&(time_s, angle): &(f64, f64)| GlassWiperKey { time_s, angle_rad: angle.to_radians() };
                GlassWiperMotion::Keys(keys.keys().iter().map(key).collect())
            }
            (None, Some(from), Some(to), Some(period)) => GlassWiperMotion::Sweep {
                from_rad: from.0.to_radians().clamp(-MAX_RAD, MAX_RAD),
                to_rad: to.0.to_radians().clamp(-MAX_RAD, MAX_RAD),
                period_s: period.0,
            },
            (Some(_), ..) => {
                let allowed = "either angle_deg, or from_deg, to_deg and period_s";
                return Err(positions.bad(
                    &format!("{path}.angle_deg"),
                    "beside from_deg, to_deg or period_s",
                    allowed,
                ));
            }
            _ => {
                let allowed = "from_deg, to_deg and period_s, or angle_deg with keys";
                return Err(positions.bad(path, "no movement", allowed));
            }
        };
        let worn = |band: &WornTable| GlassWornBand {
            from_m: band.from_m.0,
            to_m: band.to_m.0,
            leaves: band.leaves.map_or(0.5, |fraction| fraction.0),
        };
        Ok(GlassWiper {
            pivot_m: self.pivot_m.numbers(),
            inner_m: self.inner_m.map_or(0.15 * length, |m| m.0),
            outer_m: length,
            motion,
            film_m: self.film_um.map_or(0.2, |um| um.0) * 1.0e-6,
            worn: self.worn.iter().map(worn).collect(),
        })
    }
}

/// Error of a wiper although each number is in its range.
fn refused(path: &str, size: [f64; 2], error: &GlassError, positions: &Positions<'_>) -> SceneError {
    let [width, height] = size;
    match error {
        GlassError::WiperOutside { x, y, .. } => {
            let found = format!("({x}, {y}): the blade never touches the pane of {width} x {height} m");
            positions.bad(
                &format!("{path}.pivot_m"),
                found,
                "a position from which the blade reaches the pane",
            )
        }
        GlassError::OutOfRange(OutOfRange { quantity, found, unit, allowed }) => {
            positions.bad(path, format!("{quantity} {found:.4} {unit}"), allowed.as_ref())
        }
        error => positions.bad(path, error.to_string(), "a wiper in its ranges"),
    }
}
