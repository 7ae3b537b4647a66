//! Raw file: tables of keys with units, before they become a [`Weather`].

use super::fault::Positions;
use super::glass::GlassTable;
use super::glow::GlowTable;
use super::lamps::{Lamp, LampTable};
use super::lightning::{FlashTable, Lightning, LightningTable, MAX_FLASHES};
use super::models::{Model, ModelTable};
use super::puddle::{self, Puddle, PuddleTable};
use super::quantity::{Exactly, Whole};
use super::rain::{Rain, RainTable};
use super::sky::{Sky, SkyTable, SunSource, SunTable};
use super::streaks::StreaksTable;
use super::wetness::{Wetness, WetnessTable};
use super::wind::{self, GustsTable, TurbulenceTable, WindFieldTable, WindTable};
use super::{Camera, MAX_LIGHTS, MAX_MODELS, MAX_PUDDLES, Weather, camera::CameraTable};
use downpour_scene::error::{SceneError, quoted};
use downpour_scene::uri::{Address, RelativePath, check};
use serde::Deserialize;

/// Maximum length of a file path, in bytes.
const MAX_PATH: usize = 4096;

/// All tables of the file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Tables {
    rain: RainTable,
    sky: SkyTable,
    sun: Option<SunTable>,
    camera: CameraTable,
    model: Vec<ModelTable>,
    light: Vec<LampTable>,
    flash: Vec<FlashTable>,
    lightning: LightningTable,
    wind: Vec<WindTable>,
    gusts: Option<GustsTable>,
    turbulence: Option<TurbulenceTable>,
    wind_field: WindFieldTable,
    streaks: StreaksTable,
    glass: Option<GlassTable>,
    glow: GlowTable,
    puddle: Vec<PuddleTable>,
    wetness: WetnessTable,
    output: OutputTable,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct OutputTable {
    size: Option<Exactly<Whole<1, 16_384>, 2>>,
}

/// Parses text to checked values.
pub(super) fn parse(text: &str) -> Result<Weather, SceneError> {
    let positions = Positions::find(text)?;
    let tables: Tables = toml::from_str(text).map_err(|error| positions.refused(&error))?;
    for (key, count, most) in [
        ("model", tables.model.len(), MAX_MODELS),
        ("light", tables.light.len(), MAX_LIGHTS),
        ("flash", tables.flash.len(), MAX_FLASHES),
        ("puddle", tables.puddle.len(), MAX_PUDDLES),
        ("wind", tables.wind.len(), downpour_wind::WIND_PARTS),
    ] {
        if count > most {
            return Err(positions.limit(key, format!("{count} times [[{key}]]"), format!("at most {most}")));
        }
    }
    let sky = Sky::checked(&tables.sky, &positions)?;
    let rain = Rain::checked(&tables.rain, &positions)?;
    let streaks = tables.streaks.checked();
    let drop_model = tables.rain.drop_model(&streaks, &positions)?;
    let default = Weather::default();
    let puddles = numbered(&tables.puddle, |i, table| Puddle::checked(i, table, &positions))?;
    puddle::check_all(&puddles, &positions)?;
    Ok(Weather {
        name: String::new(),
        wetness: Wetness::checked(&tables.wetness, &rain, &positions)?,
        lightning: Lightning::checked(&tables.lightning, &tables.flash, rain.seed, &positions)?,
        glass: tables.glass.map(|glass| glass.checked(&rain, &positions)).transpose()?,
        glow: tables.glow.checked(),
        rain,
        drop_model,
        sun: SunSource::checked(tables.sun.as_ref(), &sky, &positions)?,
        sky,
        camera: Camera::checked(&tables.camera, &positions)?,
        models: numbered(&tables.model, |i, table| Model::checked(i, table, &positions))?,
        lights: numbered(&tables.light, |i, table| Lamp::checked(i, table, &positions))?,
        wind: wind::checked(&tables.wind, tables.gusts.as_ref(), tables.turbulence.as_ref(), &positions)?,
        wind_box: tables.wind_field.checked(&positions)?,
        streaks,
        puddles,
        size: tables.output.size.map_or(default.size, |Exactly(size)| size.map(|Whole(side)| side)),
    })
}

/// All entries of a list, or the first error.
fn numbered<T, U>(
    tables: &[T],
    checked: impl Fn(usize, &T) -> Result<U, SceneError>,
) -> Result<Vec<U>, SceneError> {
    tables.iter().enumerate().map(|(i, table)| checked(i, table)).collect()
}

/// A path in a weather file: relative, and inside its folder.
pub(super) fn path(text: &str, key: &str, positions: &Positions<'_>) -> Result<RelativePath, SceneError> {
    if text.len() > MAX_PATH {
        let found = format!("a path of {} bytes", text.len());
        return Err(positions.bad(key, found, format!("at most {MAX_PATH} bytes")));
    }
    // Unlike an address in glTF, a path here is plain text: a percent sign is literal.
    let allowed = "only relative paths inside the folder of the weather file or an asset root";
    match check(&text.replace('%', "%25")) {
        Ok(Address::File(path)) => Ok(path),
        Ok(Address::Data { .. }) => Err(positions.bad(key, "data instead of a file", allowed)),
        Err(refused) => {
            let why = refused.found.rsplit_once("\" ").map_or("is refused", |(_, why)| why);
            Err(positions.bad(key, format!("{} {why}", quoted(text)), allowed))
        }
    }
}
