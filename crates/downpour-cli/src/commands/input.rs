//! Input of `render` and `check`: a weather file, or a bare model in a shower.

use std::path::{Path, PathBuf};

use clap::Args;
use downpour::Source;
use downpour::render::camera::check_size;
use downpour::scene::Budget;
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{Loaded, Observer, Weather};
use glam::DVec3;

use super::say_warnings;
use crate::failure::Failure;
use crate::quantity;

/// A scene, and arguments that override its weather.
#[derive(Debug, Args)]
pub(crate) struct InputArguments {
    /// A weather file (.toml), or a model (.glb, .gltf), shown in a shower of 50 mm/h with the sun behind it.
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    /// Rain rate, 0 to 500 mm/h [default: the weather's].
    #[arg(long, value_name = "MM_H", value_parser = quantity::rate_mm_h, allow_hyphen_values = true)]
    pub(crate) rate: Option<f64>,
    /// Time in seconds, 0 to 1000000: drops have fallen and models have moved for so long.
    #[arg(long, value_name = "S", default_value = "0", value_parser = quantity::time_s)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) time: f64,
    /// Width and height in pixels [default: the weather's].
    #[arg(long, value_name = "WxH", value_parser = quantity::picture_size, allow_hyphen_values = true)]
    pub(crate) size: Option<[u32; 2]>,
    /// Time that the shutter is open, 0 to 1 s: drops become streaks; 0 freezes them; an eye becomes a camera [default: the
    /// weather's].
    #[arg(long, value_name = "S", value_parser = quantity::exposure_s, allow_hyphen_values = true)]
    pub(crate) shutter: Option<f64>,
    /// Same seed, same drops [default: the weather's].
    #[arg(long, value_name = "N", value_parser = quantity::seed, allow_hyphen_values = true)]
    pub(crate) seed: Option<u64>,
    /// Additional folder in which the files of a weather are searched; may be repeated.
    #[arg(long, value_name = "FOLDER")]
    pub(crate) asset_root: Vec<PathBuf>,
}

/// A weather with everything that it names.
pub(crate) type Input = Source;

impl InputArguments {
    /// Checks the arguments that need no file.
    ///
    /// # Errors
    /// Exit code 2 for an invalid name, 3 for a size over the limit.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        Source::check(&self.input, &self.roots())?;
        Ok(self.size.map_or(Ok(()), check_size)?)
    }

    fn roots(&self) -> Vec<&Path> {
        self.asset_root.iter().map(PathBuf::as_path).collect()
    }

    /// Reads everything.
    ///
    /// # Errors
    /// Errors of the readers, with their exit codes.
    pub(crate) fn read(&self, budget: &mut Budget) -> Result<Input, Failure> {
        let mut input = Source::read(&self.input, &self.roots(), budget)?;
        let weather = &mut input.weather;
        if let Some(rate) = self.rate {
            weather.set_rate(rate);
        }
        if let Some(shutter) = self.shutter {
            weather.camera.shutter = shutter;
            weather.camera.observer = Observer::Camera;
        }
        weather.rain.seed = self.seed.unwrap_or(weather.rain.seed);
        weather.size = self.size.unwrap_or(weather.size);
        Ok(input)
    }
}

/// The rain rate of a weather, or the least and the largest of its keys, mm/h.
pub(crate) fn rate_text(weather: &Weather) -> String {
    let Some(rates) = weather.keys.rate() else { return weather.rain.rate_mm_h.to_string() };
    let least = rates.keys().iter().map(|key| key.1).fold(f64::INFINITY, f64::min);
    format!("{least} to {}", weather.heaviest_rain().rate_mm_h)
}

/// Prints the parts of a scene that were dropped, repaired or missing.
pub(crate) fn say_missing(weather: &Weather, loaded: &Loaded, frame_scene: &FrameScene, say: impl Fn(&str)) {
    say_warnings(&weather.name, &loaded.warnings, &say);
    say_cores(weather, &say);
    if frame_scene.left_out > 0 {
        let what = "not drawn: their transforms have no inverse or lead too far";
        say(&format!("warning: {}: {} meshes {what}", weather.name, frame_scene.left_out));
    }
    if frame_scene.triangles == 0 {
        say(&format!("warning: {}: no triangles: a picture of the sky alone", weather.name));
    }
}

/// Prints the primitives of the wind that are finer than the cells of the rain's wind.
pub(crate) fn say_cores(weather: &Weather, say: impl Fn(&str)) {
    let Ok(grid) = weather.wind_box.grid(DVec3::ZERO) else { return };
    let least = f64::from(grid.cell().max_element());
    for (number, part) in weather.wind.parts().iter().enumerate() {
        if let Some(core) = part.min_core_radius().filter(|&core| core < least) {
            let cells = format!("below a cell of [wind_field], {least} m: the rain feels it blurred");
            say(&format!("warning: {}: [[wind]] {number}: a core of {core} m is {cells}", weather.name));
        }
    }
}
