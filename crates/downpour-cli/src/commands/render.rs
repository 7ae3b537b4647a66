//! `downpour render`: a picture of a scene in the rain, or a clip.

mod clip;
mod frames;
mod ground;
mod job;
mod journal;
#[cfg(feature = "video")]
mod mp4;
mod outputs;
mod painter;
mod pane;
mod places;
mod report;
mod shower;
#[cfg(feature = "video")]
mod video;

use std::borrow::Cow;
use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, ValueEnum};
use downpour::render::file::{write_exr, write_exr_layers, write_png};
use downpour::render::picture::{Picture, PictureOptions, noise_seed};
use downpour::render::rain::light::DropLightOptions;
use downpour::render::rain::{Exposure, RainMedium, RainOptions, RefractionForm};
use downpour::render::shower::{MovingScenery, Scenery, Still};
use downpour::render::stage::Stage;
use downpour::render::tone::tone_picture;
use downpour::scene::Budget;
use downpour::scene::weather::Weather;

use super::input::{Input, InputArguments};
use super::streaks::StreaksArgument;
use crate::backend::BackendArguments;
use crate::failure::{Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;
use crate::progress::doing;
use crate::{quantity, stream};
use frames::Frames;
use ground::Puddles;
use job::moves;
use outputs::{Bytes, Format, Outputs};
use painter::with_painter;
use pane::Pane;
use report::Told;
use shower::{Ask, Showers};

/// Memory per pixel, in bytes, while a picture is made and written: the scene, what its pixels found of the sky's light
/// (twice while threads hand in their parts), the rain, the pane with what is behind it, and the file.
pub(super) const BYTES_PER_PIXEL: u64 = 300;

/// Make a picture of a scene in the rain, or a clip.
#[derive(Debug, Args)]
#[command(
    after_help = "A clip: --frames 0..240 --fps 24 with -o frames/%04d.png, frames/%04d.exr or clip.mp4. Frames \
that are there are not made again: the same command goes on where it was stopped, and a later end makes the clip longer. \
What was done stands in .NAME.downpour-job beside the frames; for an .mp4 the frames are in .NAME.frames until it is there. \
The exposure of a clip is that of its first frame."
)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    input: InputArguments,
    /// The picture: .png (to look at) or .exr (linear radiance, unexposed). With --frames: a numbered name such as
    /// frames/%04d.png, or .mp4 (AV1, sRGB; even width and height).
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Make a clip: frames A to B - 1. Frame k is taken at --time + k / fps seconds.
    #[arg(long, value_name = "A..B", value_parser = frames::frames, allow_hyphen_values = true)]
    #[arg(requires = "fps")]
    frames: Option<Frames>,
    /// Frames per second of the clip, 0.001 to 1000.
    #[arg(long, value_name = "N", value_parser = frames::fps, allow_hyphen_values = true)]
    #[arg(requires = "frames")]
    fps: Option<f64>,
    /// Write all layers into one .exr: R, G, B; clean.R, .G, .B; rain.R, .G, .B; transmittance.Y; depth.Z (metres along
    /// the ray, 1e30 for the sky).
    #[arg(long)]
    layers: bool,
    /// Write what was done: counts of drops, rates, times. Of a clip: the means, and each frame's.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Write a row for each drop that is drawn: place and velocity in the world, diameter. Of a clip: a numbered name
    /// such as drops/%04d.csv.
    #[arg(long, value_name = "FILE.csv")]
    dump_drops: Option<PathBuf>,
    /// Samples along an edge of a pixel, 1 to 8.
    #[arg(long, value_name = "N", default_value = "2", value_parser = quantity::samples)]
    #[arg(allow_hyphen_values = true)]
    samples: u32,
    /// Rays to the sky per sample, 0 to 64; with 0 nothing hides the sky.
    #[arg(long, value_name = "N", default_value = "1", value_parser = quantity::sky_rays)]
    #[arg(allow_hyphen_values = true)]
    sky_rays: u32,
    #[command(flatten)]
    streaks: StreaksArgument,
    /// How a drop's pixel finds its colour [default: the weather's].
    #[arg(long, value_enum)]
    refraction: Option<Refraction>,
    /// Replace files that exist; begin a clip anew.
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    backend: BackendArguments,
    /// Say nothing but errors.
    #[arg(short, long)]
    quiet: bool,
}

/// How a drop's pixel finds its colour.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Refraction {
    /// The directions of refracted and reflected light, in all that is round the eye.
    Direction,
    /// The shift in a picture 165 degrees wide, 512 x 512; no reflection.
    #[value(name = "rousseau-2006")]
    Rousseau2006,
}

impl From<Refraction> for RefractionForm {
    fn from(refraction: Refraction) -> Self {
        match refraction {
            Refraction::Direction => Self::Direction,
            Refraction::Rousseau2006 => Self::Rousseau2006,
        }
    }
}

impl RenderArguments {
    /// How drops refract: as the command line has it, else the weather.
    fn refraction(&self, weather: &Weather) -> RefractionForm {
        self.refraction.map_or(weather.rain.refraction.into(), RefractionForm::from)
    }

    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        self.input.check()?;
        self.backend.check()?;
        match (self.frames, self.fps) {
            (Some(frames), Some(fps)) => clip::run(self, frames, fps, interrupt),
            _ => self.picture(interrupt),
        }
    }

    /// Makes a single picture.
    fn picture(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let (stats, drops) = (self.stats.as_deref(), self.dump_drops.as_deref());
        let outputs = Outputs::new(&self.output, stats, drops, self.overwrite)?;
        self.check_layers(outputs.format)?;
        let input = doing("reading", self.quiet, || self.input.read(&mut Budget::default()))?;
        outputs.keep(&input.files)?;
        reserve(input.weather.size)?;
        let atlas = self.streaks.read(&input.weather)?.atlas()?;
        let stage = self.stage(&input, self.input.time)?;
        input.say_warnings(&stage, |text| self.say(text));
        let begin = Instant::now();
        let rain = &input.weather.rain;
        let showers = &mut Showers::new(&input.weather, &input.loaded, atlas.as_ref(), self.quiet)?;
        let ask = Ask { measure: outputs.wants_stats(), quiet: self.quiet };
        let moving = MovingScenery { weather: &input.weather, loaded: &input.loaded };
        let still = Still(&stage);
        let scenery: &dyn Scenery = if moves(&input.loaded) { &moving } else { &still };
        let shower = showers.at(scenery, &stage, self.input.time, &ask)?;
        let mut pane = Pane::new(&input.weather, &stage, self.input.time, self.quiet)?;
        let (stage, time_s) = (Cow::Owned(stage), self.input.time);
        let stage = doing("rain on puddles", self.quiet, || {
            Puddles::new(&input.weather, &input.loaded, &stage, time_s)?.lay(stage, time_s)
        })?;
        let stage = &*pane.hang(stage, self.input.time)?;
        // The files have become buffers.
        drop(input.loaded);
        let options = self.options(stage, &input.weather, self.input.time, shower.medium);
        let say = |text: &str| self.say(text);
        let (picture, computer) = with_painter(&self.backend, interrupt, say, |painter| {
            doing("drawing", self.quiet, || {
                let mut picture = painter.paint(stage, &shower.visible.drops, &showers.masks, &options)?;
                let through = pane.before(stage, &picture, &options)?;
                painter.look(&mut picture, through)?;
                Ok((picture, painter.computer().clone()))
            })
        })?;
        let frame_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        let drawn = picture.drawn.len();
        let unresolved = (100.0 * shower.medium.unresolved_fraction()).round();
        self.say(&format!(
            "rain: {} mm/h, {drawn} drops drawn; {unresolved} % of its cross-section to 50 m is unresolved",
            rain.rate_mm_h
        ));
        let told = Told {
            computer: &computer,
            rain: &shower.visible,
            asked_rate_mm_h: rain.rate_mm_h,
            measured_rate_mm_h: shower.measured_rate_mm_h,
            medium: &shower.medium,
            time_s: self.input.time,
            seed: rain.seed,
            triangles: stage.triangles,
            frame_ms,
        };
        let exposure = stage.exposure(&picture.clean);
        let bytes = Bytes {
            stats: report::text(&report::stats(&picture, &told)).into(),
            drops: if outputs.wants_drops() {
                report::drops(&picture.drawn, &shower.visible.drops).into()
            } else {
                Vec::new()
            },
            picture: self.encode(outputs.format, picture, exposure)?,
        };
        outputs.publish(&bytes, interrupt)?;
        let [width, height] = stage.size;
        self.say(&format!("wrote {}: {width} x {height}", shown(&self.output)));
        Ok(())
    }

    /// # Errors
    /// Exit code 2 for layers in a file that has none.
    fn check_layers(&self, format: Format) -> Result<(), Failure> {
        if self.layers && format != Format::Exr {
            let found = format!("--layers for {}", shown(&self.output));
            return Err(Failure::new(INPUT, format!("{found}; allowed: for .exr only")));
        }
        Ok(())
    }

    /// The scene of a weather at the first time that is asked for.
    fn stage(&self, input: &Input, time_s: f64) -> Result<Stage, Failure> {
        Ok(doing("setting the scene", self.quiet, || Stage::new(&input.weather, &input.loaded, time_s))?)
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }

    fn options(&self, stage: &Stage, weather: &Weather, time_s: f64, medium: RainMedium) -> PictureOptions {
        let usual = RainOptions::default();
        let exposure = Exposure::of_weather(weather, stage.motion, time_s);
        let form = self.refraction(weather);
        PictureOptions {
            size: stage.size,
            grid: self.samples,
            sky_rays: self.sky_rays,
            seed: noise_seed(weather.rain.seed, time_s),
            rain: RainOptions {
                form,
                capture_size: form.capture_size(),
                medium,
                exposure,
                light: DropLightOptions::of_weather(weather),
                ..usual
            },
        }
    }

    /// The file of a picture.
    fn encode(&self, format: Format, picture: Picture, exposure: f32) -> Result<Vec<u8>, Failure> {
        let [width, height] = picture.size;
        if self.layers {
            let glass = picture.through_glass.as_deref();
            return Ok(write_exr_layers(width, height, &picture.clean, &picture.rain, glass)?);
        }
        let radiance = picture.radiance();
        Ok(match format {
            Format::Exr => write_exr(width, height, &radiance)?,
            Format::Png => {
                drop(picture);
                let pixels: Vec<[f32; 4]> = radiance.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
                drop(radiance);
                write_png(width, height, &tone_picture(&pixels, exposure))?
            }
        })
    }
}

/// Whether the memory that a picture will take can be had. An allocation that fails later on would end the process.
fn reserve([width, height]: [u32; 2]) -> Result<(), Failure> {
    let bytes = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(BYTES_PER_PIXEL);
    let mut room: Vec<u8> = Vec::new();
    if usize::try_from(bytes).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok()) {
        return Ok(());
    }
    let found = format!("{width} x {height} pixels: {} MiB of memory are needed", bytes >> 20);
    Err(Failure::new(LIMIT, format!("{found}; allowed: what this machine has (a smaller --size needs less)")))
}
