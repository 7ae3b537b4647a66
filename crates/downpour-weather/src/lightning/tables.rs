//! `[[flash]]` and `[lightning]`.

use super::{Flash, Lightning, MAX_STROKES, MAX_STROKES_PER_SECOND, Storm, Stroke};
use crate::fault::Positions;
use crate::quantity::{
    Clouds, ElevationDeg, Exactly, FlashM, FlashMs, FlashesPerMinute, In, KeyTimeS, Lux, RiseMs, Scale,
    StrokeKey, Tint, TurnDeg,
};
use crate::sky::towards;
use crate::wind::keys::{Given, NumberKeys, number_given};
use downpour_scene::error::SceneError;
use serde::Deserialize;

/// Default elevation of a flash, degrees.
const ELEVATION_DEG: f64 = 30.0;

/// Default illuminance of a flash at its peak, lux: a first stroke at a distance of 1 km (2.9e6 cd s with a decay of 10 ms).
const FLASH_LUX: f64 = 290.0;

/// Default time constants of a stroke, ms.
const RISE_MS: f64 = 0.1;
const DECAY_MS: f64 = 10.0;

/// Default illuminance by the lit clouds over that by the flash.
const CLOUDS: f64 = 0.5;

/// Default tint: nitrogen lines and a hot continuum, bluish white.
const COLOR: [f64; 3] = [0.8, 0.87, 1.0];

/// Default distances of flashes from a seed, m.
const DISTANCE_M: [f64; 2] = [1000.0, 4000.0];

/// A whole circle, degrees.
const CIRCLE_DEG: f64 = 360.0;

#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct FlashTable {
    time_s: In<KeyTimeS>,
    azimuth_deg: In<TurnDeg>,
    elevation_deg: Option<In<ElevationDeg>>,
    illuminance_lux: Option<In<Lux>>,
    color: Option<Exactly<In<Tint>, 3>>,
    rise_ms: Option<In<RiseMs>>,
    decay_ms: Option<In<FlashMs>>,
    clouds: Option<In<Clouds>>,
    strokes: Option<Vec<Exactly<In<StrokeKey>, 2>>>,
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LightningTable {
    enabled: Option<bool>,
    limit: Option<bool>,
    per_minute: Option<In<FlashesPerMinute>>,
    seed: Option<u64>,
    distance_m: Option<Exactly<In<FlashM>, 2>>,
    azimuth_deg: Option<Exactly<In<TurnDeg>, 2>>,
    brightness: Option<NumberKeys<Scale>>,
    clouds: Option<In<Clouds>>,
    color: Option<Exactly<In<Tint>, 3>>,
}

impl Flash {
    /// Entry `i` of `[[flash]]`.
    fn checked(i: usize, table: &FlashTable, positions: &Positions<'_>) -> Result<Self, SceneError> {
        let rise_ms = table.rise_ms.map_or(RISE_MS, |ms| ms.0);
        let decay_ms = table.decay_ms.map_or(DECAY_MS, |ms| ms.0);
        if rise_ms >= decay_ms {
            let name = if table.rise_ms.is_some() { "rise_ms" } else { "decay_ms" };
            let found = format!("a rise of {rise_ms} ms and a decay of {decay_ms} ms");
            return Err(positions.bad(&format!("flash[{i}].{name}"), found, "rise_ms below decay_ms"));
        }
        let lux = table.illuminance_lux.map_or(FLASH_LUX, |lux| lux.0);
        let stroke = |[after_ms, factor]: [f64; 2]| Stroke {
            after_s: after_ms * 1.0e-3,
            illuminance_lux: lux * factor,
            decay_s: decay_ms * 1.0e-3,
        };
        let elevation = table.elevation_deg.map_or(ELEVATION_DEG, |elevation| elevation.0);
        Ok(Self {
            time_s: table.time_s.0,
            towards: towards(table.azimuth_deg.0.to_radians(), elevation.to_radians()),
            color: table.color.map_or(COLOR, Exactly::numbers),
            rise_s: rise_ms * 1.0e-3,
            clouds: table.clouds.map_or(CLOUDS, |clouds| clouds.0),
            strokes: strokes(i, table, positions)?.into_iter().map(stroke).collect(),
        })
    }
}

/// Strokes of entry `i`: times after its first one, ms, and factors.
fn strokes(i: usize, table: &FlashTable, positions: &Positions<'_>) -> Result<Vec<[f64; 2]>, SceneError> {
    let Some(keys) = &table.strokes else { return Ok(vec![[0.0, 1.0]]) };
    let key = format!("flash[{i}].strokes");
    if keys.is_empty() {
        return Err(positions.bad(&key, "no strokes", "[[milliseconds after time_s, factor], ...]"));
    }
    if keys.len() > MAX_STROKES {
        let found = format!("{} strokes", keys.len());
        return Err(positions.limit(&key, found, format!("at most {MAX_STROKES}")));
    }
    let mut found: Vec<[f64; 2]> = Vec::with_capacity(keys.len());
    for (k, stroke) in keys.iter().map(|stroke| stroke.numbers()).enumerate() {
        let [after, factor] = stroke;
        let at = format!("{key}[{k}]");
        if factor > 1.0 {
            return Err(positions.bad(&format!("{at}[1]"), format!("a factor of {factor}"), "0 to 1"));
        }
        if let Some([before, _]) = found.last()
            && after < before + 1.0
        {
            let found = format!("a stroke at {after} ms, after one at {before} ms");
            return Err(positions.bad(&at, found, "times that rise by a millisecond at least"));
        }
        found.push(stroke);
    }
    Ok(found)
}

impl Lightning {
    pub(crate) fn checked(
        table: &LightningTable,
        flashes: &[FlashTable],
        rain_seed: u64,
        positions: &Positions<'_>,
    ) -> Result<Self, SceneError> {
        let mut found: Vec<Flash> = Vec::with_capacity(flashes.len());
        for (i, flash) in flashes.iter().enumerate() {
            let flash = Flash::checked(i, flash, positions)?;
            if let Some(before) = found.last()
                && flash.time_s < before.time_s
            {
                let what = format!("a flash at {} s, after one at {} s", flash.time_s, before.time_s);
                return Err(positions.bad(&format!("flash[{i}].time_s"), what, "flashes in order of time"));
            }
            found.push(flash);
        }
        check_rate(&found, positions)?;
        let storm = table.storm(rain_seed, positions)?;
        if table.enabled == Some(false) {
            return Ok(Self::default());
        }
        Ok(Self::new(found, storm, table.limit.unwrap_or(true)))
    }
}

/// Refuses more strokes in a second than a picture can be lit by.
fn check_rate(flashes: &[Flash], positions: &Positions<'_>) -> Result<(), SceneError> {
    let mut times: Vec<(f64, usize)> = Vec::new();
    for (i, flash) in flashes.iter().enumerate() {
        times.extend(flash.strokes.iter().map(|stroke| (flash.time_s + stroke.after_s, i)));
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    for run in times.windows(MAX_STROKES_PER_SECOND.saturating_add(1)) {
        if let (Some((first, _)), Some((last, i))) = (run.first(), run.last())
            && last - first < 1.0
        {
            let key = format!("flash[{i}].time_s");
            let found = format!("more than {MAX_STROKES_PER_SECOND} strokes in the second from {first} s on");
            return Err(positions.limit(
                &key,
                found,
                format!("at most {MAX_STROKES_PER_SECOND} in any second"),
            ));
        }
    }
    Ok(())
}

impl LightningTable {
    /// Factor of the light of flashes from a seed over time, if it is given.
    pub(crate) fn brightness(&self, positions: &Positions<'_>) -> Result<Given, SceneError> {
        number_given(self.brightness.as_ref(), "lightning.brightness", positions)
    }

    /// Flashes from a seed, if there are any.
    fn storm(&self, rain_seed: u64, positions: &Positions<'_>) -> Result<Option<Storm>, SceneError> {
        let Some(per_minute) = self.per_minute.map(|rate| rate.0).filter(|rate| *rate > 0.0) else {
            let given = [
                ("seed", self.seed.is_some()),
                ("distance_m", self.distance_m.is_some()),
                ("azimuth_deg", self.azimuth_deg.is_some()),
                ("brightness", self.brightness.is_some()),
                ("clouds", self.clouds.is_some()),
                ("color", self.color.is_some()),
            ];
            return match given.into_iter().find(|(_, given)| *given) {
                Some((key, _)) if self.per_minute.is_none() => {
                    let key = format!("lightning.{key}");
                    Err(positions.bad(&key, "without per_minute", "with a per_minute of flashes from a seed"))
                }
                _ => Ok(None),
            };
        };
        let distance_m = self.distance_m.map_or(DISTANCE_M, Exactly::numbers);
        let azimuth_deg = self.azimuth_deg.map_or([0.0, CIRCLE_DEG], Exactly::numbers);
        for (key, [low, high]) in [("distance_m", distance_m), ("azimuth_deg", azimuth_deg)] {
            if low > high {
                let key = format!("lightning.{key}");
                return Err(positions.bad(&key, format!("{low} to {high}"), "the lower number first"));
            }
        }
        Ok(Some(Storm {
            per_minute,
            seed: self.seed.unwrap_or(rain_seed),
            distance_m,
            azimuth: azimuth_deg.map(f64::to_radians),
            brightness: self.brightness(positions)?.map_or(1.0, |factor| factor.at(0.0)),
            clouds: self.clouds.map_or(CLOUDS, |clouds| clouds.0),
            color: self.color.map_or(COLOR, Exactly::numbers),
        }))
    }
}
