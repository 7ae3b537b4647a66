//! `downpour check`: dry run of `render`.

use clap::Args;
use downpour::RendererError;
use downpour::render::glass::WetPane;
use downpour::render::rain::drop_model;
use downpour::scene::{Budget, scene::Texture};
use downpour::shower::Shower;
use downpour::trace::frame_scene::{CameraChoice, FrameScene};
use downpour::trace::puddle::PuddleMap;
use downpour::trace::wet_ground::WetGround;
use downpour::weather::Observer;

use super::input::{Input, InputArguments, say_missing};
use super::render::BYTES_PER_PIXEL;
use super::streaks::{Streaks, StreaksArgument};
use crate::failure::Failure;
use crate::listing::{Datum, Entry};
use crate::progress::doing;
use crate::{listing, stream};

/// Eleven words: mass, motion, claims, wetness, decisions and inflow.
const PANE_BYTES_PER_CELL: u64 = 44;

/// Check a scene or weather file, and list what render would do with it.
///
/// The exit code is that of render: 2, after the list, for a weather that needs the streak atlas without --streaks.
#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    input: InputArguments,
    #[command(flatten)]
    streaks: StreaksArgument,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

impl CheckArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        self.input.check()?;
        let input = doing("reading", false, || self.input.read(&mut Budget::default()))?;
        let streaks = self.streaks.read(&input.weather)?;
        let frame_scene = doing("setting the scene", false, || {
            FrameScene::new(&input.weather, &input.loaded, self.input.time)
        })?;
        say_missing(&input.weather, &input.loaded, &frame_scene, stream::message);
        let mut entries = scene(&input, &frame_scene);
        entries.extend(light(&input));
        entries.extend(rain(&input)?);
        entries.extend(motion(&input)?);
        entries.push(Entry::new("streak_atlas", "streak atlas", Datum::Word(streaks.text()), ""));
        entries.extend(water(&input, &frame_scene)?);
        let (of_pane, pane_bytes) = pane(&input, &frame_scene, self.input.time)?;
        entries.extend(of_pane);
        let [width, height] = input.weather.size.map(u64::from);
        let bytes = frame_scene.bytes() + width * height * BYTES_PER_PIXEL + pane_bytes + streaks.bytes();
        entries.push(Entry::new("memory_mib", "memory, about", Datum::Computed(mebibytes(bytes), 3), "MiB"));
        stream::print(&if self.json { listing::json(&entries) } else { listing::text(&entries) })?;
        match streaks {
            Streaks::Nowhere => Err(RendererError::NoAtlas.into()),
            Streaks::Unwanted | Streaks::Atlas(_) => Ok(()),
        }
    }
}

fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1u32 << 20)
}

fn count(key: &'static str, label: &'static str, number: usize) -> Entry {
    Entry::new(key, label, Datum::Count(number as u64), "")
}

fn scene(input: &Input, frame_scene: &FrameScene) -> Vec<Entry> {
    use Datum::{Computed, Triple, Word};
    let scene = &input.loaded.scene;
    let playing: Vec<&str> = input
        .loaded
        .animations
        .iter()
        .flatten()
        .filter_map(|&index| scene.animations.get(index))
        .map(|animation| if animation.name.is_empty() { "without a name" } else { animation.name.as_str() })
        .collect();
    let camera = match frame_scene.camera {
        CameraChoice::Weather => "of the weather file".to_owned(),
        CameraChoice::Scene(index) => {
            let name = scene.cameras.get(index).map_or("", |camera| camera.name.as_str());
            format!("{index} of the scene{}{name}", if name.is_empty() { "" } else { ", " })
        }
        CameraChoice::Framing => "in front of all that there is".to_owned(),
        _ => "at the height of a person's eyes".to_owned(),
    };
    let eye = (frame_scene.origin + frame_scene.viewpoint.eye.as_dvec3()).to_array();
    let forward = frame_scene.viewpoint.forward.as_dvec3().to_array();
    let fov = f64::from(frame_scene.viewpoint.fov_y).to_degrees();
    let [width, height] = frame_scene.size.map(|edge| edge as usize);
    let lens = &input.weather.camera;
    let observer = match lens.observer {
        Observer::Camera => "camera".to_owned(),
        Observer::Eye => "eye".to_owned(),
    };
    let lightning = &input.weather.lightning;
    let strokes = lightning.flashes().iter().map(|flash| flash.strokes.len()).sum();
    let per_minute = lightning.storm().map_or(0.0, |storm| storm.per_minute);
    vec![
        count("triangles", "triangles", frame_scene.triangles),
        count("instances", "instances of meshes", frame_scene.instances),
        count("materials", "materials", scene.materials.len()),
        count("textures", "textures", scene.textures.len()),
        Entry::new(
            "textures_mib",
            "their pixels",
            Computed(mebibytes(texture_bytes(&scene.textures)), 3),
            "MiB",
        ),
        count("lights", "lamps", frame_scene.lamps),
        count("flash_strokes", "strokes of lightning by hand", strokes),
        count("flash_strokes_left_out", "those that the limit of flashing leaves out", lightning.left_out()),
        Entry::new("flashes_per_minute", "flashes from a seed", Computed(per_minute, 4), "1/min"),
        count("animations", "movements", scene.animations.len()),
        Entry::new("animations_playing", "those that play", Datum::words(&playing), ""),
        count("cameras", "cameras of the scene", scene.cameras.len()),
        Entry::new("camera", "camera that is taken", Word(camera), ""),
        Entry::new("camera_position_m", "its position", Triple(eye, 4), "m"),
        Entry::new("camera_forward", "its view", Triple(forward, 3), ""),
        Entry::new("fov_deg", "its vertical field of view", Computed(fov, 4), "degrees"),
        Entry::new("observer", "observer of moving drops", Word(observer), ""),
        Entry::new("shutter_s", "time in which light is gathered", Computed(lens.shutter, 4), "s"),
        count("width", "columns", width),
        count("height", "rows", height),
    ]
}

/// Bytes of all pictures, each once, even if several textures use it.
fn texture_bytes(textures: &[Texture]) -> u64 {
    let mut seen = std::collections::HashSet::new();
    let pictures = textures.iter().map(|texture| &texture.picture);
    pictures.filter(|picture| seen.insert(std::sync::Arc::as_ptr(picture))).map(|p| p.pixels.bytes()).sum()
}

fn light(input: &Input) -> Vec<Entry> {
    use Datum::{Computed, Triple, Unbounded};
    let (sky, sun) = (&input.loaded.sky, &input.loaded.sun);
    let none = || Unbounded("none");
    let of_sun = |datum: fn(&downpour::scene::sky::Sun) -> Datum| sun.as_ref().map_or_else(none, datum);
    vec![
        count("sky_width", "columns of the sky map", sky.width as usize),
        count("sky_height", "rows of the sky map", sky.height as usize),
        Entry::new("sky_mean_radiance", "mean radiance of the sky", Triple(sky.mean_radiance(), 3), ""),
        Entry::new(
            "sun_direction",
            "direction to the sun",
            of_sun(|sun| Triple(sun.direction.map(f64::from), 4)),
            "",
        ),
        Entry::new(
            "sun_irradiance",
            "irradiance of the sun",
            of_sun(|sun| Triple(sun.irradiance_rgb.map(f64::from), 3)),
            "",
        ),
        Entry::new(
            "sun_diameter_deg",
            "diameter of its disk",
            of_sun(|sun| Computed(2.0 * f64::from(sun.angular_radius).to_degrees(), 3)),
            "degrees",
        ),
    ]
}

/// Simulation of the rain, and its wind.
fn motion(input: &Input) -> Result<Vec<Entry>, Failure> {
    let wind = &input.weather.wind;
    let form = if Shower::new(&input.weather)?.is_closed_form() { "in closed form" } else { "step by step" };
    let or_none = |there: bool, word: &'static str| Datum::Word(if there { word } else { "none" }.to_owned());
    Ok(vec![
        Entry::new("rain_is_worked_out", "rain is worked out", Datum::Word(form.to_owned()), ""),
        count("wind_primitives", "primitives of the wind", wind.parts().len()),
        Entry::new("gusts", "gusts", or_none(wind.gusts().is_some(), "everywhere at once"), ""),
        Entry::new(
            "turbulence",
            "turbulence",
            or_none(wind.turbulence().is_some(), "carried by the wind"),
            "",
        ),
    ])
}

/// Water on the ground.
fn water(input: &Input, frame_scene: &FrameScene) -> Result<Vec<Entry>, Failure> {
    let ground = WetGround::new(&input.weather, &input.loaded, frame_scene, 0.0)?;
    let sum = |of: fn(&PuddleMap) -> f32| {
        ground.iter().flat_map(WetGround::maps).map(|map| f64::from(of(map))).sum::<f64>()
    };
    let deepest = ground.iter().flat_map(WetGround::maps).map(PuddleMap::deepest_m).fold(0.0, f32::max);
    let weather = &input.weather;
    let wetness = weather.wetness_at(0.0).map_or(0.0, |at| at.level());
    Ok(vec![
        Entry::new("wetness", "wetness of level ground in the rain", Datum::Computed(wetness, 3), ""),
        count("panes", "panes of the scene that rain is seen on", weather.panes.len()),
        count("puddles", "rectangles with puddles", weather.puddles.len()),
        Entry::new("puddle_area_m2", "area under water", Datum::Computed(sum(PuddleMap::area_m2), 4), "m^2"),
        Entry::new(
            "puddle_volume_l",
            "volume of the water",
            Datum::Computed(1.0e3 * sum(PuddleMap::volume_m3), 4),
            "l",
        ),
        Entry::new(
            "puddle_deepest_mm",
            "its greatest depth",
            Datum::Computed(1.0e3 * f64::from(deepest), 3),
            "mm",
        ),
    ])
}

/// Pane in front of the camera, and its memory.
fn pane(input: &Input, frame_scene: &FrameScene, first_s: f64) -> Result<(Vec<Entry>, u64), Failure> {
    let Some(wet) = WetPane::new(&input.weather, &frame_scene.viewpoint, first_s)? else {
        return Ok((
            vec![Entry::new("pane", "pane in front of the camera", Datum::Unbounded("none"), "")],
            0,
        ));
    };
    let options = wet.lattice().options();
    let [columns, rows] = options.size;
    let [width, height] = wet.size_m();
    let per_minute = options.landings()? * width * height * 60.0;
    let bytes = u64::from(columns) * u64::from(rows) * PANE_BYTES_PER_CELL;
    let entries = vec![
        Entry::new("pane", "pane before the camera", Datum::Word(format!("{columns} x {rows} cells")), ""),
        Entry::new("pane_width_m", "its width", Datum::Computed(width, 4), "m"),
        Entry::new("pane_height_m", "its height", Datum::Computed(height, 4), "m"),
        Entry::new("pane_drops", "drops that land on it", Datum::Computed(per_minute, 4), "per minute"),
        count("pane_wipers", "its wipers", options.wipers.len()),
        Entry::new("pane_tick_ms", "its tick", Datum::Computed(wet.lattice().tick_s() * 1.0e3, 4), "ms"),
        Entry::new("pane_mib", "its memory", Datum::Computed(mebibytes(bytes), 3), "MiB"),
    ];
    Ok((entries, bytes))
}

fn rain(input: &Input) -> Result<Vec<Entry>, Failure> {
    use Datum::{Computed, Given, Word};
    // Of a rate that changes, the largest.
    let rain = &input.weather.heaviest_rain();
    let law = rain.sizes()?;
    let rate = if input.weather.keys.rate().is_some() { "largest rain rate" } else { "rain rate" };
    let median = 1.0e3 * law.median_volume_diameter();
    let drawn_as = match drop_model(&input.weather, &input.loaded)? {
        Some(model) => {
            let file = input.weather.drop_model.as_ref().map_or("", |file| file.as_str());
            format!("{file}, {} triangles", model.triangles.len())
        }
        None => input.weather.rain.drop_shape.name().to_owned(),
    };
    Ok(vec![
        Entry::new("rate_mm_h", rate, Given(rain.rate_mm_h), "mm/h"),
        Entry::new("distribution", "distribution", Word(rain.law.name().to_owned()), ""),
        Entry::new("drop_shape", "drops are drawn as", Word(drawn_as), ""),
        Entry::new("seed", "seed", Datum::Count(rain.seed), ""),
        Entry::new("number_m3", "drops", Computed(law.number_density(), 4), "per m^3"),
        Entry::new("median_volume_diameter_mm", "median volume diameter", Computed(median, 4), "mm"),
        Entry::new(
            "visibility_km",
            "visibility",
            Datum::bounded(law.visibility() * 1.0e-3, 3, "unlimited"),
            "km",
        ),
    ])
}
