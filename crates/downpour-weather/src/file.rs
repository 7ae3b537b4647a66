//! Raw file: tables of keys with units, before they become a [`Weather`].

use super::drips::{DripTable, Drips, DripsTable};
use super::effect_keys::EffectKeys;
use super::fault::Positions;
use super::fog::FogTable;
use super::glass::GlassTable;
use super::glow::GlowTable;
use super::keys::WeatherKeys;
use super::lamps::{Lamp, LampTable};
use super::layers::LayersTable;
use super::lightning::{FlashTable, Lightning, LightningTable, MAX_FLASHES};
use super::look::LookTable;
use super::materials::{self, MaterialTable};
use super::models::{Model, ModelTable};
use super::presets;
use super::puddle::{self, Puddle, PuddleTable};
use super::quantity::{Exactly, Whole};
use super::rain::{self, Rain, RainTable};
use super::ripples::RipplesTable;
use super::scene_panes::{ScenePane, ScenePaneTable};
use super::sky::{Sky, SkyTable, SunSource, SunTable};
use super::splashes::{Splashes, SplashesTable};
use super::spray::{Spray, SprayTable};
use super::streaks::StreaksTable;
use super::wetness::{Wetness, WetnessTable};
use super::wind::{self, GustsTable, TurbulenceTable, WindFieldTable, WindTable};
use super::{
    Camera, CameraPath, MAX_DRIPS, MAX_LIGHTS, MAX_MATERIALS, MAX_MODELS, MAX_PANES, MAX_PUDDLES, Weather,
    camera::CameraTable,
};
use downpour_scene::error::{SceneError, quoted};
use downpour_scene::uri::{Address, RelativePath, check};
use serde::Deserialize;

/// Maximum length of a file path, in bytes.
const MAX_PATH: usize = 4096;

/// All tables of the file.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct Tables {
    preset: Option<String>,
    rain: RainTable,
    layers: LayersTable,
    sky: SkyTable,
    sun: Option<SunTable>,
    camera: CameraTable,
    model: Vec<ModelTable>,
    material: Vec<MaterialTable>,
    light: Vec<LampTable>,
    flash: Vec<FlashTable>,
    lightning: LightningTable,
    wind: Vec<WindTable>,
    gusts: Option<GustsTable>,
    turbulence: Option<TurbulenceTable>,
    wind_field: WindFieldTable,
    streaks: StreaksTable,
    glass: Option<GlassTable>,
    fog: Option<FogTable>,
    glow: GlowTable,
    look: LookTable,
    puddle: Vec<PuddleTable>,
    ripples: RipplesTable,
    wetness: WetnessTable,
    pane: Vec<ScenePaneTable>,
    splashes: SplashesTable,
    spray: SprayTable,
    drips: DripsTable,
    drip: Vec<DripTable>,
    output: OutputTable,
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct OutputTable {
    size: Option<Exactly<Whole<1, 16_384>, 2>>,
}

/// Parses text to checked values.
pub(super) fn parse(text: &str) -> Result<Weather, SceneError> {
    let positions = Positions::find(text)?;
    let own: Tables = toml::from_str(text).map_err(|error| positions.refused(&error))?;
    let tables = with_preset(own, text.len(), &positions)?;
    for (key, count, most) in [
        ("model", tables.model.len(), MAX_MODELS),
        ("material", tables.material.len(), MAX_MATERIALS),
        ("light", tables.light.len(), MAX_LIGHTS),
        ("flash", tables.flash.len(), MAX_FLASHES),
        ("puddle", tables.puddle.len(), MAX_PUDDLES),
        ("drip", tables.drip.len(), MAX_DRIPS),
        ("pane", tables.pane.len(), MAX_PANES),
        ("wind", tables.wind.len(), downpour_wind::WIND_PARTS),
    ] {
        if count > most {
            return Err(positions.limit(key, format!("{count} times [[{key}]]"), format!("at most {most}")));
        }
    }
    let (sky, sky_keys) = Sky::checked(&tables.sky, &positions)?;
    let (sun, sun_keys) = SunSource::checked(tables.sun.as_ref(), &sky, &positions)?;
    let camera_keys = tables.camera.keys(&positions)?;
    let camera = Camera::checked(&tables.camera, &camera_keys, &positions)?;
    let models = numbered(&tables.model, |i, table| Model::checked(i, table, &positions))?;
    let (models, model_keys): (Vec<_>, Vec<_>) = models.into_iter().unzip();
    let lamps = numbered(&tables.light, |i, table| Lamp::checked(i, table, &positions))?;
    let (lights, lamp_keys): (Vec<_>, Vec<_>) = lamps.into_iter().unzip();
    let (rain, rates) = Rain::checked(&tables.rain, &tables.layers, &positions)?;
    let heaviest = Rain { rate_mm_h: rates.as_ref().map_or(rain.rate_mm_h, rain::most), ..rain };
    if rates.is_some() && tables.drips.enabled == Some(true) {
        let allowed = "false, or a rate without keys";
        return Err(positions.bad("drips.enabled", "drips of a rain whose rate changes", allowed));
    }
    let spray = Spray::checked(&tables.spray, &positions)?;
    let (look, look_keys) = tables.look.checked(&spray, &positions)?;
    let streaks = tables.streaks.checked(rain.drop_light, &positions)?;
    let drop_model = tables.rain.drop_model(&streaks, &positions)?;
    let default = Weather::default();
    let puddles = numbered(&tables.puddle, |i, table| Puddle::checked(i, table, &positions))?;
    let (puddles, of_puddles): (Vec<_>, Vec<_>) = puddles.into_iter().unzip();
    let (fills, influences): (Vec<_>, Vec<_>) =
        of_puddles.into_iter().map(|[fill, influence]| (fill, influence)).unzip();
    puddle::check_all(&puddles, &positions)?;
    let wetness = Wetness::checked(&tables.wetness, &rain, &positions)?;
    if !wetness.is_enabled && !tables.pane.is_empty() {
        let allowed = "no [[pane]], or a rain that wets surfaces";
        return Err(positions.bad("pane", "beside wetness.enabled = false", allowed));
    }
    let wind = wind::checked(&tables.wind, tables.gusts.as_ref(), tables.turbulence.as_ref(), &positions)?;
    let (splashes, splash_size) = Splashes::checked(&tables.splashes, &positions)?;
    let (glow, [glare, glow_width]) = tables.glow.checked(&positions)?;
    let (fog, fog_keys) = tables.fog.map(|fog| fog.checked(&positions)).transpose()?.unzip();
    let effects = EffectKeys {
        splash_size,
        glare,
        glow_width,
        fog: fog_keys,
        brightness: tables.lightning.brightness(&positions)?,
        influences: influences.into_iter().enumerate().filter_map(|(i, one)| Some((i, one?))).collect(),
    };
    let is_still = wind.is_still() && camera.path.as_ref().is_none_or(CameraPath::is_still);
    Ok(Weather {
        name: String::new(),
        wetness,
        panes: numbered(&tables.pane, |i, table| ScenePane::checked(i, table, &positions))?,
        splashes,
        spray,
        drips: Drips::checked(&tables.drips, &tables.drip),
        lightning: Lightning::checked(&tables.lightning, &tables.flash, rain.seed, &positions)?,
        glass: tables.glass.map(|glass| glass.checked(&heaviest, is_still, &positions)).transpose()?,
        fog,
        glow,
        look,
        rain,
        drop_model,
        sun,
        sky,
        camera,
        models,
        materials: materials::checked(&tables.material, &positions)?,
        lights,
        wind_box: tables.wind_field.checked(&wind, &positions)?,
        wind,
        streaks,
        puddles,
        waves: tables.ripples.checked(&positions)?,
        keys: WeatherKeys::new(
            rates,
            camera_keys,
            (sky_keys, sun_keys),
            (model_keys, lamp_keys),
            fills,
            look_keys,
            effects,
        ),
        size: tables.output.size.map_or(default.size, |Exactly(size)| size.map(|Whole(side)| side)),
    })
}

/// The tables of a file with those of its preset, if it names one.
fn with_preset(own: Tables, end: usize, positions: &Positions<'_>) -> Result<Tables, SceneError> {
    let Some(name) = &own.preset else { return Ok(own) };
    let merged = positions.with_preset(presets::text(name, positions)?)?;
    let merged = toml::de::Deserializer::from(toml::Spanned::new(0..end, merged));
    Tables::deserialize(merged).map_err(|error| positions.refused(&error))
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
