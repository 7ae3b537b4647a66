//! `downpour render`: a picture of a scene in the rain, or a clip.

mod clip;
mod frames;
mod job;
mod journal;
#[cfg(feature = "video")]
mod mp4;
mod outputs;
mod paths;
mod report;
#[cfg(feature = "video")]
mod video;
mod watch;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use downpour::render::rain::RefractionForm;
use downpour::scene::Budget;
use downpour::{ClipLight, Frame, PendingFrame, Renderer, RendererOptions};

use super::input::{Input, InputArguments, say_missing};
use super::streaks::StreaksArgument;
use crate::backend::{BackendArguments, renderer_failure};
use crate::failure::{Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;
use crate::progress::{FrameProgress, doing};
use crate::{quantity, stream};
use frames::Frames;
use outputs::{Bytes, Format, Outputs};

/// Memory per pixel, in bytes, while a picture is made and written: the scene, the sky's light at its pixels
/// (twice while threads merge their parts), the rain, the pane with the scene behind it, and the file.
pub(super) const BYTES_PER_PIXEL: u64 = 300;

/// Memory per pixel, in bytes, of the light of a frame before that is averaged.
const LIGHT_BYTES_PER_PIXEL: u64 = 96;

/// Make a picture of a scene in the rain, or a clip.
#[derive(Debug, Args)]
#[command(
    after_help = "A clip: --frames 0..240 --fps 24 with -o frames/%04d.png, frames/%04d.exr or clip.mp4. Existing \
frames are not rendered again: the same command resumes where it was stopped, and a later end makes the clip longer. \
The journal is .NAME.downpour-job beside the frames; for an .mp4 the frames are in .NAME.frames until it is complete. \
The exposure of a clip is that of its first frame."
)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    input: InputArguments,
    /// Output picture: .png (for viewing) or .exr (linear radiance, unexposed). With --frames: a numbered name such as
    /// frames/%04d.png, or .mp4 (AV1, sRGB; even width and height).
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Make a clip: frames A to B - 1. Frame k is taken at --time + k / fps seconds; puddles and panes are rained on from frame 0 on.
    #[arg(long, value_name = "A..B", value_parser = frames::frames, allow_hyphen_values = true)]
    #[arg(requires = "fps")]
    frames: Option<Frames>,
    /// Frames per second of the clip, 0.001 to 1000.
    #[arg(long, value_name = "N", value_parser = frames::fps, allow_hyphen_values = true)]
    #[arg(requires = "frames")]
    fps: Option<f64>,
    /// Write all layers into one .exr: R, G, B; clean.R, .G, .B; rain.R, .G, .B; transmittance.Y; depth.Z (meters along
    /// the ray, 1e30 for the sky); of the drop that a pixel shows most of its id, diameter, distance and alpha; of the surface
    /// behind it its wetness, depth of water and motion.
    #[arg(long)]
    layers: bool,
    /// Write statistics: counts of drops, rates, times. Of a clip: the means, and each frame's.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Write a row for each drop that is drawn: position and velocity in the world, diameter. Of a clip: a numbered name
    /// such as drops/%04d.csv.
    #[arg(long, value_name = "FILE.csv")]
    dump_drops: Option<PathBuf>,
    /// Samples along an edge of a pixel, 1 to 8.
    #[arg(long, value_name = "N", default_value = "2", value_parser = quantity::samples)]
    #[arg(allow_hyphen_values = true)]
    samples: u32,
    /// Rays that look for the light of sky and surfaces per sample, 0 to 64; at 0 nothing occludes the sky. By default as many as
    /// `--samples`, less one, and one at least.
    #[arg(long, value_name = "N", value_parser = quantity::sky_rays, allow_hyphen_values = true)]
    sky_rays: Option<u32>,
    /// Pixels between those whose rays look for the light of sky and surfaces, and of lamps on unresolved rain, 1 to 4: more are
    /// faster, with more noise.
    #[arg(long, value_name = "N", default_value = "1", value_parser = quantity::ray_spacing)]
    #[arg(allow_hyphen_values = true)]
    ray_spacing: u32,
    /// Frames of a clip over which the light of sky and surfaces is averaged, where they show the same surface, 1 to 8, so that its noise
    /// flickers less: 4 halve it. Those before the first frame that is asked for are found, too.
    #[arg(long, value_name = "N", default_value = "1", value_parser = quantity::light_frames, allow_hyphen_values = true)]
    light_frames: u32,
    #[command(flatten)]
    streaks: StreaksArgument,
    /// Lookup of the color of a drop's pixel [default: the weather's].
    #[arg(long, value_enum)]
    refraction: Option<Refraction>,
    /// Make the picture again when the weather file changes, until the command is stopped. A broken file prints its error and
    /// the last good picture stays.
    #[arg(long, conflicts_with = "frames")]
    watch: bool,
    /// Replace existing files; start a clip from its first frame.
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    backend: BackendArguments,
    /// Print errors only.
    #[arg(short, long)]
    quiet: bool,
}

/// Lookup of the color of a drop's pixel.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Refraction {
    /// By the directions of refracted and reflected light, in an environment map around the eye.
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
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        self.input.check()?;
        self.backend.check()?;
        if self.light_frames > 1 && self.frames.is_none() {
            let found = format!("--light-frames {} without --frames", self.light_frames);
            return Err(Failure::new(INPUT, format!("{found}; allowed: with --frames and --fps, or 1")));
        }
        match (self.frames, self.fps) {
            (Some(frames), Some(fps)) => clip::run(self, frames, fps, interrupt),
            _ if self.watch => watch::run(self, interrupt),
            _ => self.picture(self.overwrite, interrupt),
        }
    }

    /// Makes a single picture.
    fn picture(&self, overwrite: bool, interrupt: &Interrupt) -> Result<(), Failure> {
        let (stats, drops) = (self.stats.as_deref(), self.dump_drops.as_deref());
        let outputs = Outputs::new(&self.output, stats, drops, overwrite)?;
        self.check_layers(outputs.format)?;
        let input = doing("reading", self.quiet, || self.input.read(&mut Budget::default()))?;
        outputs.keep(&input.files)?;
        let time_s = self.input.time;
        let mut renderer = self.renderer(input, time_s, outputs.wants_stats())?;
        let frame = self.frame(&mut renderer, time_s, interrupt)?;
        let drawn = frame.picture.drawn.len();
        let unresolved = (100.0 * frame.medium.unresolved_fraction()).round();
        let weather = renderer.weather();
        let rate = weather.rain_at(time_s).rate_mm_h;
        let rate = (rate * 1.0e3).round() / 1.0e3;
        self.say(&format!(
            "rain: {rate} mm/h, {drawn} drops drawn; {unresolved} % of its cross-section to 50 m is unresolved"
        ));
        let bytes = Bytes {
            stats: report::text(&report::stats(&frame, renderer.computer(), weather)).into(),
            drops: if outputs.wants_drops() { report::drops(&frame).into() } else { Vec::new() },
            picture: self.encode(outputs.format, &frame)?,
        };
        outputs.publish(&bytes, interrupt)?;
        let [width, height] = frame.size();
        self.say(&format!("wrote {}: {width} x {height}", shown(&self.output)));
        Ok(())
    }

    /// Rays that look for the light of sky and surfaces per sample.
    fn sky_rays(&self) -> u32 {
        self.sky_rays.unwrap_or_else(|| RendererOptions::sky_rays_for(self.samples))
    }

    /// Renderer of the frames of a weather, from a time on.
    fn renderer(&self, input: Input, first_s: f64, measure: bool) -> Result<Renderer, Failure> {
        let Input { weather, loaded, .. } = input;
        reserve(weather.size, self.light_frames)?;
        let clip_light = self.fps.map(|frames_per_s| ClipLight { frames: self.light_frames, frames_per_s });
        let options = RendererOptions {
            kept_frames: 0,
            running_frames: 1,
            samples: self.samples,
            sky_rays: self.sky_rays(),
            ray_spacing: self.ray_spacing,
            refraction: self.refraction.map(RefractionForm::from),
            atlas: self.streaks.read(&weather)?.atlas()?,
            measure,
            truth: self.layers,
            first_s,
            clip_light,
        };
        let device = self.backend.device(|text| self.say(text))?;
        let renderer =
            doing("setting the scene", self.quiet, || Renderer::new(weather, loaded, options, device))?;
        self.say_fallback(&renderer);
        say_missing(renderer.weather(), renderer.loaded(), renderer.first_scene(), |text| self.say(text));
        Ok(renderer)
    }

    /// Renders a frame, with progress for long ones. A GPU that hangs ends the process: dropping its device would wait.
    fn frame(&self, renderer: &mut Renderer, time_s: f64, interrupt: &Interrupt) -> Result<Frame, Failure> {
        self.finish_frame(self.begin_frame(renderer, time_s, interrupt)?, interrupt)
    }

    /// Begins a frame.
    fn begin_frame(
        &self,
        renderer: &mut Renderer,
        time_s: f64,
        interrupt: &Interrupt,
    ) -> Result<PendingFrame, Failure> {
        let backend = renderer.computer().backend;
        let mut frame_progress = FrameProgress::new(self.quiet);
        let begun = renderer.begin_frame_with(time_s, &mut |progress| frame_progress.tell(progress));
        drop(frame_progress);
        let frame = begun.map_err(|error| renderer_failure(error, interrupt))?;
        if renderer.computer().backend != backend {
            self.say_fallback(renderer);
        }
        Ok(frame)
    }

    /// Waits for a frame.
    fn finish_frame(&self, frame: PendingFrame, interrupt: &Interrupt) -> Result<Frame, Failure> {
        frame.finish().map_err(|error| renderer_failure(error, interrupt))
    }

    /// Prints the reason why the CPU draws instead of a GPU, if it does.
    fn say_fallback(&self, renderer: &Renderer) {
        if let Some(reason) = &renderer.computer().reason {
            self.say(&format!("backend: cpu ({reason})"));
        }
    }

    /// # Errors
    /// Exit code 2 for layers in a format without layers.
    fn check_layers(&self, format: Format) -> Result<(), Failure> {
        if self.layers && format != Format::Exr {
            let found = format!("--layers for {}", shown(&self.output));
            return Err(Failure::new(INPUT, format!("{found}; allowed: for .exr only")));
        }
        Ok(())
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }

    /// The file of a picture.
    fn encode(&self, format: Format, frame: &Frame) -> Result<Vec<u8>, Failure> {
        Ok(match format {
            Format::Exr if self.layers => frame.exr_layers()?,
            Format::Exr => frame.exr()?,
            Format::Png => frame.png()?,
        })
    }
}

/// Checks that the memory for a picture is available. An allocation that fails later on would abort the process.
fn reserve([width, height]: [u32; 2], light_frames: u32) -> Result<(), Failure> {
    let light = (u64::from(light_frames - 1) * LIGHT_BYTES_PER_PIXEL).div_ceil(BYTES_PER_PIXEL);
    if has_room([width, height], 1 + light) {
        return Ok(());
    }
    let needed = memory([width, height], 1 + light) >> 20;
    let found = format!("{width} x {height} pixels: {needed} MiB of memory are needed");
    Err(Failure::new(
        LIMIT,
        format!("{found}; allowed: the memory of this machine (a smaller --size needs less)"),
    ))
}

/// Memory, bytes, of so many pictures at a time.
fn memory([width, height]: [u32; 2], pictures: u64) -> u64 {
    u64::from(width)
        .saturating_mul(u64::from(height))
        .saturating_mul(BYTES_PER_PIXEL)
        .saturating_mul(pictures)
}

/// True if the memory of so many pictures at a time is available.
fn has_room(size: [u32; 2], pictures: u64) -> bool {
    let mut room: Vec<u8> = Vec::new();
    usize::try_from(memory(size, pictures)).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok())
}
