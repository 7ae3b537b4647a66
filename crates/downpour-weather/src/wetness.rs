//! `[wetness]`: surfaces that the rain makes wet.

use super::fault::Positions;
use super::quantity::{DryingS, Fraction, In, RainedMm, ReflectionEdge, StorageMm, WetS};
use super::rain::Rain;
use downpour_drop::wetness::{DRYING_S, STORAGE_M, Wetting};
use downpour_scene::error::SceneError;
use downpour_wind::Keyed;
use serde::Deserialize;

/// Default time for which the rain has fallen before time 0, s.
pub const RAINED_S: f64 = 600.0;

/// Time over which the rain is meant whose water runs past a place, s: the shortest time of concentration of the rational method (U.S.
/// Federal Highway Administration, Hydraulic Engineering Circular 22, 2009, section 3.2.2.3).
const CONCENTRATION_S: f64 = 300.0;

/// Default edge coefficient of reflections as billboards.
const REFLECTION_EDGE: f64 = 0.5;

/// Wetness in which a fixed one ends: the storage is full but for this.
const DRY_FRACTION: f64 = 1.0e-5;

/// Form of the reflections on wet ground and puddles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WetReflections {
    /// By rays.
    #[default]
    Rays,
    /// As billboards in a buffer of half the picture's size, blurred vertically: N. Tatarchuk & J. Isidoro 2006, section 6.3.
    Tatarchuk2006 {
        /// The paper's f0, 0 to 10: a reflection is less toward edges by `saturate(1 - ((1 - n.v) f0)^2)`.
        edge: f64,
    },
}

/// Wetness of the surfaces of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wetness {
    /// True if rain wets surfaces.
    pub is_enabled: bool,
    /// Wetness of level surfaces under the open sky at all times, 0 to 1, instead of the law.
    pub fixed: Option<f64>,
    /// Depth of rain that has fallen before time 0, m, 0 to 1; `None`: that of the rain in [`RAINED_S`].
    pub rained_m: Option<f64>,
    /// Time between the end of that rain and time 0, s.
    pub dried_s: f64,
    /// Depth of water that a porous surface stores, m.
    pub storage_m: f64,
    /// Time constant of drying, s.
    pub drying_s: f64,
    /// Form of the reflections on wet ground.
    pub reflections: WetReflections,
}

impl Default for Wetness {
    /// Surfaces in a rain that has fallen for ten minutes.
    fn default() -> Self {
        Self {
            is_enabled: true,
            fixed: None,
            rained_m: None,
            dried_s: 0.0,
            storage_m: STORAGE_M,
            drying_s: DRYING_S,
            reflections: WetReflections::default(),
        }
    }
}

/// Wetness at one time, for surfaces that meet any flux of rain.
///
/// A surface that meets the flux `g` of that of a level one is wet to
/// `1 - (1 - (1 - exp(-g before)) kept) exp(-g since)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WetnessAt {
    /// Rain before the time in which nothing fell, in storages.
    pub before: f64,
    /// Fraction of the wetness that is kept after the time in which nothing fell.
    pub kept: f64,
    /// Rain after it, in storages.
    pub since: f64,
}

/// A rain, and the time after it in which nothing fell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Spell {
    /// Depth of the rain, m.
    rain_m: f64,
    /// Time for which it fell, s; 0 for that before time 0.
    rained_s: f64,
    /// Time after it, s.
    dry_s: f64,
}

impl WetnessAt {
    /// Wetness of a level surface under the open sky.
    #[must_use]
    pub fn level(&self) -> f64 {
        let exp = downpour_math::ops::f64::exp;
        1.0 - (1.0 - (1.0 - exp(-self.before)) * self.kept) * exp(-self.since)
    }
}

impl Wetness {
    /// Wetness at a time in s, of rates in mm/h. `None`: all is dry. Before time 0 it is that of time 0.
    ///
    /// Rains before the last time in which nothing fell count as one that wets a level surface alike.
    pub(super) fn at(&self, rates: &Keyed<f64>, time_s: f64) -> Option<WetnessAt> {
        if !self.is_enabled {
            return None;
        }
        let ln = downpour_math::ops::f64::ln;
        let found = if let Some(fixed) = self.fixed {
            let rest = (1.0 - fixed).max(DRY_FRACTION);
            WetnessAt { before: -ln(rest), kept: 1.0, since: 0.0 }
        } else {
            let wetting = Wetting::new(self.storage_m, self.drying_s).unwrap_or_default();
            let (spells, last) = self.spells(rates, time_s);
            let (mut before, mut kept) = (0.0, 1.0);
            for spell in spells {
                let dried = WetnessAt { before, kept, since: 0.0 };
                before = -ln((1.0 - dried.level()).max(f64::MIN_POSITIVE)) + wetting.dose(spell.rain_m);
                kept = wetting.kept(spell.dry_s);
            }
            WetnessAt { before, kept, since: wetting.dose(last.rain_m) }
        };
        (found.level() > 0.0).then_some(found)
    }

    /// [`Weather::runoff`](super::Weather::runoff) of rates in mm/h.
    pub(super) fn runoff(&self, rates: &Keyed<f64>, seepage_m_s: f64, time_s: f64) -> Option<[f64; 3]> {
        if !self.is_enabled || self.fixed.is_some() {
            return None;
        }
        let wetting = Wetting::new(self.storage_m, self.drying_s).unwrap_or_default();
        let (spells, last) = self.spells(rates, time_s);
        // What the ground stores first does not run off; what has dried it stores anew.
        let left = |spell: &Spell, empty: f64| {
            (spell.rain_m - self.storage_m * empty - seepage_m_s * spell.rained_s).max(0.0)
        };
        let (mut before, mut lost, mut empty) = (0.0f64, 0.0, 1.0);
        for spell in spells {
            before = (before - lost).max(0.0) + left(&spell, empty);
            lost = (self.storage_m / self.drying_s + seepage_m_s) * spell.dry_s;
            let filled = (1.0 - empty + spell.rain_m / self.storage_m).min(1.0);
            empty = 1.0 - filled * wetting.kept(spell.dry_s);
        }
        Some([before, lost, left(&last, empty)])
    }

    /// [`Weather::runoff_rate`](super::Weather::runoff_rate) of rates in mm/h.
    pub(super) fn runoff_rate(&self, rates: &Keyed<f64>, seepage_m_s: f64, time_s: f64) -> f64 {
        // Without a law of what has fallen nothing runs.
        let Some([before, lost, since]) = self.runoff(rates, seepage_m_s, time_s) else { return 0.0 };
        let until = time_s.max(0.0);
        let from = until - CONCENTRATION_S;
        let fell: f64 = spans(rates, from.max(0.0), until).map(|span| span.depth_m).sum();
        // The rain before time 0 fell at the rate of time 0.
        let rate = meters(rates.at(0.0), 1.0);
        let ended = -self.dried_s;
        let began = if rate > 0.0 { ended - self.before_m(rates) / rate } else { ended };
        let fell_before = rate * (ended - began.max(from)).max(0.0);
        // What the ground stores first does not run.
        let ran = (fell + fell_before - seepage_m_s * CONCENTRATION_S).min((before - lost).max(0.0) + since);
        ran.max(0.0) / CONCENTRATION_S
    }

    /// Depth of the rain before time 0, m.
    fn before_m(&self, rates: &Keyed<f64>) -> f64 {
        self.rained_m.unwrap_or_else(|| meters(rates.at(0.0), RAINED_S))
    }

    /// The rains until a time in s, each with the time without rain after it: that before time 0 first. Apart from them the rain that has
    /// not ended.
    fn spells(&self, rates: &Keyed<f64>, time_s: f64) -> (Vec<Spell>, Spell) {
        let mut spells = vec![Spell { rain_m: self.before_m(rates), rained_s: 0.0, dry_s: self.dried_s }];
        let mut last = Spell::default();
        for Span { depth_m, seconds } in spans(rates, 0.0, time_s.max(0.0)) {
            if depth_m > 0.0 {
                last.rain_m += depth_m;
                last.rained_s += seconds;
            } else {
                if last.rained_s > 0.0 {
                    spells.push(std::mem::take(&mut last));
                }
                if let Some(spell) = spells.last_mut() {
                    spell.dry_s += seconds;
                }
            }
        }
        (spells, last)
    }

    pub(super) fn checked(
        table: &WetnessTable,
        rain: &Rain,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let default = Self::default();
        let is_enabled = table.enabled.unwrap_or(true);
        let given = [
            ("wetness.rained_s", table.rained_s.is_some()),
            ("wetness.rained_mm", table.rained_mm.is_some()),
            ("wetness.dried_s", table.dried_s.is_some()),
            ("wetness.storage_mm", table.storage_mm.is_some()),
            ("wetness.drying_s", table.drying_s.is_some()),
        ];
        let reflections = reflections(table, positions)?;
        let beside = |other: &str, allowed: &str| match given.iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(positions.bad(key, format!("beside {other}"), allowed)),
            None => Ok(()),
        };
        if !is_enabled {
            let allowed = "enabled = false alone";
            beside("enabled = false", allowed)?;
            if table.wetness.is_some() {
                return Err(positions.bad("wetness.wetness", "beside enabled = false", allowed));
            }
            if table.reflections.is_some() {
                return Err(positions.bad("wetness.reflections", "beside enabled = false", allowed));
            }
        }
        if table.wetness.is_some() {
            beside("a wetness that is fixed", "wetness alone, or the keys of the law")?;
        }
        if table.rained_s.is_some() {
            let key = "wetness.rained_s";
            if table.rained_mm.is_some() {
                return Err(positions.bad(key, "beside rained_mm", "one or the other"));
            }
            if rain.rate_mm_h <= 0.0 {
                let allowed = "rained_mm, or a rain.rate_mm_h above 0";
                return Err(positions.bad(key, "a time of a rain of 0 mm/h", allowed));
            }
        }
        let of_time = table.rained_s.map(|time| rain.rate_mm_h * 1.0e-3 / 3600.0 * time.0);
        Ok(Self {
            is_enabled,
            fixed: table.wetness.map(|wetness| wetness.0),
            rained_m: table.rained_mm.map(|depth| depth.0 * 1.0e-3).or(of_time),
            dried_s: table.dried_s.map_or(default.dried_s, |time| time.0),
            storage_m: table.storage_mm.map_or(default.storage_m, |depth| depth.0 * 1.0e-3),
            drying_s: table.drying_s.map_or(default.drying_s, |time| time.0),
            reflections,
        })
    }
}

/// Rain between two keys, or between a key and an end.
#[derive(Clone, Copy, Debug)]
struct Span {
    depth_m: f64,
    seconds: f64,
}

/// Depth, m, of a rate in mm/h over some time.
fn meters(mm_h: f64, seconds: f64) -> f64 {
    mm_h * 1.0e-3 / 3600.0 * seconds
}

/// The rain of some rates in mm/h from a time until another, s.
fn spans(rates: &Keyed<f64>, from_s: f64, until_s: f64) -> impl Iterator<Item = Span> {
    let inner =
        rates.keys().iter().map(|&(time, _)| time).filter(move |&time| time > from_s && time < until_s);
    let mut from = from_s;
    inner.chain([until_s]).filter(move |&to| to > from_s).map(move |to| {
        let mean = 0.5 * (rates.at(from) + rates.at(to));
        let seconds = to - from;
        from = to;
        Span { depth_m: meters(mean, seconds), seconds }
    })
}

/// The form that a table asks for.
fn reflections(table: &WetnessTable, positions: &Positions<'_>) -> Result<WetReflections, SceneError> {
    match (table.reflections, table.reflection_edge) {
        (Some(ReflectionsName::Tatarchuk2006), edge) => {
            Ok(WetReflections::Tatarchuk2006 { edge: edge.map_or(REFLECTION_EDGE, |edge| edge.0) })
        }
        (_, None) => Ok(WetReflections::Rays),
        (_, Some(_)) => {
            let allowed = "reflections = \"tatarchuk-2006\" with it";
            Err(positions.bad("wetness.reflection_edge", "beside reflections by rays", allowed))
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
enum ReflectionsName {
    #[serde(rename = "rays")]
    Rays,
    #[serde(rename = "tatarchuk-2006")]
    Tatarchuk2006,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct WetnessTable {
    enabled: Option<bool>,
    wetness: Option<In<Fraction>>,
    rained_s: Option<In<WetS>>,
    rained_mm: Option<In<RainedMm>>,
    dried_s: Option<In<WetS>>,
    storage_mm: Option<In<StorageMm>>,
    drying_s: Option<In<DryingS>>,
    reflections: Option<ReflectionsName>,
    reflection_edge: Option<In<ReflectionEdge>>,
}
