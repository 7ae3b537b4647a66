//! `downpour wind`: a picture of the wind in a slice, and statistics of it.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use downpour::render::file::write_png;
use downpour::render::wind_picture::{WindPicture, WindPlane, WindSlice, draw_wind};
use downpour::scene::Budget;
use downpour::shower::{Shower, Still};
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::Weather;
use downpour::wind::primitive::velocity;
use downpour::wind::turbulence::wind_turbulence_velocity;
use downpour::wind::{WindField, WindGrid, WindMatrix};
use glam::{DVec3, Vec3};

use super::input::{Input, InputArguments, say_cores};
use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::listing::{Datum, Entry};
use crate::output::OutputFile;
use crate::{listing, quantity, stream};

/// Draw the wind of a weather file in a slice: speed as color, direction as streaks and arrows.
///
/// The picture shows the wind that the rain feels: a non-uniform wind in the cells of `[wind_field]`, and none in
/// objects; a uniform one without the lee of objects.
#[derive(Debug, Args)]
pub(crate) struct WindArguments {
    /// A weather file (.toml) with a wind.
    #[arg(value_name = "INPUT")]
    input: PathBuf,
    /// Time in seconds, 0 to 1000000.
    #[arg(long, value_name = "S", default_value = "0", value_parser = quantity::time_s)]
    #[arg(allow_hyphen_values = true)]
    time: f64,
    /// Slice: xy=Z, xz=Y (from above) or yz=X, in meters.
    #[arg(long, value_name = "PLANE=M", value_parser = slice, allow_hyphen_values = true)]
    slice: (WindPlane, f32),
    /// Minimum region of the picture: the lower corner and the upper, meters [default: the weather's box of cells].
    #[arg(long = "box", value_name = "X,Y,Z,X,Y,Z", value_parser = corners, allow_hyphen_values = true)]
    region: Option<[f32; 6]>,
    /// Width and height in pixels, 64 to 4096.
    #[arg(long, value_name = "WxH", default_value = "960x720", value_parser = quantity::picture_size)]
    size: [u32; 2],
    /// The wind that is drawn.
    #[arg(long, value_enum, default_value_t = Form::Cells)]
    form: Form,
    /// Additional folder in which the files of a weather are searched; may be repeated.
    #[arg(long, value_name = "FOLDER")]
    asset_root: Vec<PathBuf>,
    /// The picture, .png.
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Replace the file if it exists.
    #[arg(long)]
    overwrite: bool,
    /// Write the statistics as JSON.
    #[arg(long)]
    json: bool,
    /// Print errors only.
    #[arg(short, long)]
    quiet: bool,
}

/// Form of the wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// As the rain feels it, in cells and around objects.
    Cells,
    /// The sum of the primitives and of the turbulence, without cells and objects.
    Primitives,
}

/// A plane and its coordinate.
fn slice(text: &str) -> Result<(WindPlane, f32), String> {
    let allowed = "xy=Z, xz=Y or yz=X with a number of meters, -1e6 to 1e6";
    let wrong = || format!("allowed: {allowed}");
    let (plane, offset) = text.split_once('=').ok_or_else(wrong)?;
    let plane = match plane {
        "xy" => WindPlane::Xy,
        "xz" => WindPlane::Xz,
        "yz" => WindPlane::Yz,
        _ => return Err(wrong()),
    };
    let offset: f32 = offset.parse().map_err(|_| wrong())?;
    if (-1.0e6..=1.0e6).contains(&offset) { Ok((plane, offset + 0.0)) } else { Err(wrong()) }
}

/// Two corners of a box.
fn corners(text: &str) -> Result<[f32; 6], String> {
    let wrong = |_| "allowed: six numbers of meters, as -10,0,-10,10,20,10".to_owned();
    let numbers: Vec<f32> = text
        .split(',')
        .map(|part| part.trim().parse().map_err(|_| ()))
        .collect::<Result<_, ()>>()
        .map_err(wrong)?;
    numbers.try_into().map_err(|_| ()).map_err(wrong)
}

impl WindArguments {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        check_name(&self.input, "toml", "input", "a weather file (.toml): a model has no wind")?;
        check_name(&self.output, "png", "output", ".png")?;
        let file = OutputFile::new(&self.output, self.overwrite)?;
        let weather = &Weather::read(&self.input, &mut Budget::default())?;
        if !self.quiet {
            say_cores(weather, stream::message);
        }
        if weather.wind.is_still() {
            let allowed = "a weather file with [[wind]] or [turbulence]";
            return Err(Failure::new(
                INPUT,
                format!("{}: still air; allowed: {allowed}", shown(&self.input)),
            ));
        }
        let eye = weather.camera.path.as_ref().map_or(DVec3::ZERO, |path| path.at(self.time).position);
        let grid = weather.wind_box.grid(eye)?;
        let (low, high) = match self.region {
            Some([a, b, c, d, e, f]) => (Vec3::new(a, b, c), Vec3::new(d, e, f)),
            None => (grid.low(), grid.high()),
        };
        let (plane, offset) = self.slice;
        let slice = WindSlice::new(plane, offset, low, high, self.size)?;
        let field = self.field(weather)?;
        let (picture, entries) = self.draw(weather, &grid, &slice, field.as_ref())?;
        let [width, height] = picture.size;
        file.publish(&write_png(width, height, &picture.pixels)?, interrupt)?;
        if self.json {
            stream::print(&listing::json(&entries))?;
        }
        if !self.quiet {
            let speeds = format!("{:.2} to {:.2} m/s", picture.slowest, picture.fastest);
            stream::message(&format!("wrote {}: {width} x {height}, {speeds}", shown(&self.output)));
        }
        Ok(())
    }

    /// Wind that the rain feels, and its reference velocity, if that is requested and the wind is non-uniform.
    fn field(&self, weather: &Weather) -> Result<Option<(WindField, Vec3)>, Failure> {
        if self.form == Form::Primitives || weather.wind.uniform().is_some() {
            return Ok(None);
        }
        let input = self.input()?;
        let frame_scene = FrameScene::new(&input.weather, &input.loaded, self.time)?;
        let field = Shower::new(&input.weather)?.wind_field(&Still(&frame_scene), self.time)?;
        Ok(field.map(|field| (field, frame_scene.origin.as_vec3())))
    }

    /// The weather with its scene.
    fn input(&self) -> Result<Input, Failure> {
        let arguments = InputArguments {
            input: self.input.clone(),
            rate: None,
            time: self.time,
            size: None,
            shutter: None,
            seed: None,
            asset_root: self.asset_root.clone(),
        };
        arguments.read(&mut Budget::default())
    }

    fn draw(
        &self,
        weather: &Weather,
        grid: &WindGrid,
        slice: &WindSlice,
        field: Option<&(WindField, Vec3)>,
    ) -> Result<(WindPicture, Vec<Entry>), Failure> {
        let primitives = weather.wind.at(self.time);
        let matrices = WindMatrix::encode(&primitives)?;
        let modes = weather.wind.modes(self.time, grid);
        let low = grid.low();
        let picture = draw_wind(slice, &|at| {
            if let Some((field, origin)) = field {
                return field.sample(at - *origin);
            }
            let start = velocity(&matrices, at);
            modes.iter().fold(start, |sum, mode| sum + wind_turbulence_velocity(mode, at - low))
        });
        let entry = Entry::new;
        let entries = vec![
            entry("time_s", "time", Datum::Given(self.time), "s"),
            entry("primitives", "primitives", Datum::Count(primitives.len() as u64), ""),
            entry("waves", "waves of turbulence", Datum::Count(modes.len() as u64), ""),
            entry("speed_min_m_s", "least speed", Datum::Computed(picture.slowest, 4), "m/s"),
            entry("speed_mean_m_s", "mean speed", Datum::Computed(picture.mean, 4), "m/s"),
            entry("speed_max_m_s", "greatest speed", Datum::Computed(picture.fastest, 4), "m/s"),
            entry("divergence_rms_s", "divergence, rms", Datum::Computed(picture.divergence_rms, 3), "1/s"),
        ];
        Ok((picture, entries))
    }
}

/// Checks the extension of a name.
fn check_name(path: &Path, end: &str, what: &str, allowed: &str) -> Result<(), Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if extension.as_deref() == Some(end) {
        return Ok(());
    }
    Err(Failure::new(INPUT, format!("{what} {}; allowed: {allowed}", shown(path))))
}
