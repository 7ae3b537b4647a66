//! `[wetness]`: surfaces that the rain makes wet.

use super::fault::Positions;
use super::quantity::{DryingS, Fraction, In, RainedMm, StorageMm, WetS};
use super::rain::Rain;
use downpour_drop::wetness::{DRYING_S, STORAGE_M, Wetting};
use downpour_scene::error::SceneError;
use serde::Deserialize;

/// Default time for which the rain has fallen before time 0, s.
pub const RAINED_S: f64 = 600.0;

/// Wetness in which a fixed one ends: the storage is full but for this.
const DRY_FRACTION: f64 = 1.0e-5;

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

/// What has fallen until a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainedAt {
    /// Depth of the rain before the time in which nothing fell, m.
    pub before_m: f64,
    /// Time in which nothing fell, s.
    pub dried_s: f64,
    /// Depth of the rain after it, m.
    pub since_m: f64,
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
    /// Wetness at a time in s, of a rain. `None`: all is dry. Before time 0 it is that of time 0.
    #[must_use]
    pub fn at(&self, rain: &Rain, time_s: f64) -> Option<WetnessAt> {
        if !self.is_enabled {
            return None;
        }
        let found = if let Some(fixed) = self.fixed {
            let rest = (1.0 - fixed).max(DRY_FRACTION);
            WetnessAt { before: -downpour_math::ops::f64::ln(rest), kept: 1.0, since: 0.0 }
        } else {
            let wetting = Wetting::new(self.storage_m, self.drying_s).unwrap_or_default();
            let RainedAt { before_m, dried_s, since_m } = self.rained_at(rain, time_s);
            WetnessAt {
                before: wetting.dose(before_m),
                kept: wetting.kept(dried_s),
                since: wetting.dose(since_m),
            }
        };
        (found.level() > 0.0).then_some(found)
    }

    /// Water that has run off level ground at a time in s, m: before the time in which nothing fell, lost by drying in that time, and
    /// after it. `None` where no law says: hollows have been filled since long.
    #[must_use]
    pub fn runoff(&self, rain: &Rain, time_s: f64) -> Option<[f64; 3]> {
        if !self.is_enabled || self.fixed.is_some() {
            return None;
        }
        let RainedAt { before_m, dried_s, since_m } = self.rained_at(rain, time_s);
        // What the ground stores first does not run off; dry ground stores it anew.
        let dry = 1.0 - Wetting::new(self.storage_m, self.drying_s).unwrap_or_default().kept(dried_s);
        let left = |fallen: f64, stored: f64| (fallen - stored).max(0.0);
        Some([
            left(before_m, self.storage_m),
            self.storage_m / self.drying_s * dried_s,
            left(since_m, self.storage_m * dry),
        ])
    }

    /// What has fallen until a time in s, and for how long nothing has.
    #[must_use]
    pub fn rained_at(&self, rain: &Rain, time_s: f64) -> RainedAt {
        let rate_m_s = rain.rate_mm_h * 1.0e-3 / 3600.0;
        let before_m = self.rained_m.unwrap_or(rate_m_s * RAINED_S);
        let time_s = time_s.max(0.0);
        // It rains from time 0 on, or it dries on.
        let dried_s = if rate_m_s > 0.0 { self.dried_s } else { self.dried_s + time_s };
        RainedAt { before_m, dried_s, since_m: rate_m_s * time_s }
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
        })
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WetnessTable {
    enabled: Option<bool>,
    wetness: Option<In<Fraction>>,
    rained_s: Option<In<WetS>>,
    rained_mm: Option<In<RainedMm>>,
    dried_s: Option<In<WetS>>,
    storage_mm: Option<In<StorageMm>>,
    drying_s: Option<In<DryingS>>,
}
