//! What `render` and `check` read: a weather file, or a bare model in a shower.

use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use downpour::render::stage::{Stage, check_size};
use downpour::scene::beneath::{Files, NoFiles, OpenFile, RelativePath};
use downpour::scene::gltf::read_scene;
use downpour::scene::weather::{Loaded, Observer, Roots, Weather, load};
use downpour::scene::{Budget, SceneError};
use glam::DVec3;

use super::{bare, say_warnings};
use crate::failure::{Failure, INPUT, shown};
use crate::quantity;

/// A scene, and what of its weather is asked for otherwise.
#[derive(Debug, Args)]
pub(crate) struct InputArguments {
    /// A weather file (.toml), or a model (.glb, .gltf) that stands in a shower of 50 mm/h with the sun behind it.
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
    /// Another folder in which the files of a weather may lie; may be given several times.
    #[arg(long, value_name = "FOLDER")]
    pub(crate) asset_root: Vec<PathBuf>,
}

/// A weather with everything that it names.
#[derive(Debug)]
pub(crate) struct Input {
    pub(crate) weather: Weather,
    pub(crate) loaded: Loaded,
    /// Every file that was opened, as far as the command knows it.
    pub(crate) files: Vec<PathBuf>,
}

/// What a file is by the end of its name.
enum Kind {
    Weather,
    Model,
}

impl InputArguments {
    /// What can be told from the arguments alone.
    ///
    /// # Errors
    /// Exit code 2 for a name that is none, 3 for a size over the limit.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.kind()?;
        if !self.asset_root.is_empty() && matches!(self.kind()?, Kind::Model) {
            return Err(Failure::new(INPUT, "--asset-root is for weather files; allowed: with a .toml"));
        }
        Ok(self.size.map_or(Ok(()), check_size)?)
    }

    fn kind(&self) -> Result<Kind, Failure> {
        let extension = self.input.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("toml") => Ok(Kind::Weather),
            Some("glb" | "gltf") => Ok(Kind::Model),
            _ => {
                let allowed = "a weather file (.toml) or a model (.glb, .gltf)";
                Err(Failure::new(INPUT, format!("input {}; allowed: {allowed}", shown(&self.input))))
            }
        }
    }

    /// Reads everything.
    ///
    /// # Errors
    /// What the readers say, with their exit codes.
    pub(crate) fn read(&self, budget: &mut Budget) -> Result<Input, Failure> {
        let mut input = match self.kind()? {
            Kind::Weather => self.read_weather(budget)?,
            Kind::Model => self.read_model(budget)?,
        };
        input.files.push(self.input.clone());
        let weather = &mut input.weather;
        weather.rain.rate_mm_h = self.rate.unwrap_or(weather.rain.rate_mm_h);
        if let Some(shutter) = self.shutter {
            weather.camera.shutter = shutter;
            weather.camera.observer = Observer::Camera;
        }
        weather.rain.seed = self.seed.unwrap_or(weather.rain.seed);
        weather.size = self.size.unwrap_or(weather.size);
        Ok(input)
    }

    fn read_weather(&self, budget: &mut Budget) -> Result<Input, Failure> {
        let weather = Weather::read(&self.input, budget)?;
        let others: Vec<&Path> = self.asset_root.iter().map(PathBuf::as_path).collect();
        let own = self.input.parent().unwrap_or(Path::new(""));
        let folders: Vec<&Path> = [own].into_iter().chain(others.iter().copied()).collect();
        let files = Noted {
            files: &Roots::open(&self.input, &others)?,
            folders: &folders,
            opened: RefCell::new(Vec::new()),
        };
        let loaded = load(&weather, &files, budget)?;
        Ok(Input { weather, loaded, files: files.opened.into_inner() })
    }

    /// A model in a shower, its first movement playing.
    fn read_model(&self, budget: &mut Budget) -> Result<Input, Failure> {
        let mut weather = bare::shower(shown(&self.input));
        let mut loaded = load(&weather, &NoFiles, budget)?;
        loaded.scene = read_scene(&self.input, budget)?;
        weather.sun = bare::sun(&weather, &loaded)?;
        loaded.sun = load(&weather, &NoFiles, budget)?.sun;
        loaded.animations = vec![(!loaded.scene.animations.is_empty()).then_some(0)];
        loaded.warnings.extend(loaded.scene.warnings.iter().cloned());
        Ok(Input { weather, loaded, files: Vec::new() })
    }
}

impl Input {
    /// Says what was left out or made good, and what is not there at all.
    pub(crate) fn say_warnings(&self, stage: &Stage, say: impl Fn(&str)) {
        say_warnings(&self.weather.name, &self.loaded.warnings, &say);
        say_cores(&self.weather, &say);
        if stage.left_out > 0 {
            let what = "not drawn: their transforms have no inverse or lead too far";
            say(&format!("warning: {}: {} meshes {what}", self.weather.name, stage.left_out));
        }
        if stage.triangles == 0 {
            say(&format!("warning: {}: no triangles: a picture of the sky alone", self.weather.name));
        }
    }
}

/// Says which primitives of the wind are finer than the cells that the rain feels it in.
pub(crate) fn say_cores(weather: &Weather, say: impl Fn(&str)) {
    let Ok(grid) = weather.wind_box.grid(DVec3::ZERO) else { return };
    let least = f64::from(grid.cell().max_element());
    for (number, part) in weather.wind.parts().iter().enumerate() {
        if let Some(core) = part.least_core().filter(|&core| core < least) {
            let cells = format!("below a cell of [wind_field], {least} m: the rain feels it blurred");
            say(&format!("warning: {}: [[wind]] {number}: a core of {core} m is {cells}", weather.name));
        }
    }
}

/// Files, with a note of each that was opened.
struct Noted<'a> {
    files: &'a dyn Files,
    folders: &'a [&'a Path],
    opened: RefCell<Vec<PathBuf>>,
}

impl Files for Noted<'_> {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let opened = self.files.open(path)?;
        // Which of the folders had it does not matter to who must not be overwritten.
        let places = self.folders.iter().map(|folder| folder.join(path.as_str()));
        self.opened.borrow_mut().extend(places.filter(|place| fs::symlink_metadata(place).is_ok()));
        Ok(opened)
    }
}
