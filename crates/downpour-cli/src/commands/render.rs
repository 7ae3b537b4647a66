//! `downpour render`: a picture of a scene in the rain.

mod outputs;
mod report;
mod shower;

use std::path::PathBuf;
use std::time::Instant;

use clap::{Args, ValueEnum};
use downpour::render::file::{write_exr, write_exr_layers, write_png};
use downpour::render::picture::{Picture, PictureOptions, render_picture};
use downpour::render::rain::{DropMasks, RainOptions, RefractionForm};
use downpour::render::stage::Stage;
use downpour::render::tone::tone_picture;
use downpour::scene::Budget;
use downpour::sim::field::FallingDrop;

use super::input::InputArguments;
use crate::backend::{BackendArguments, compute};
use crate::failure::{Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;
use crate::{quantity, stream};
use outputs::{Bytes, Format, Outputs};
use report::{Computer, Told};
use shower::{Shower, Showers};

/// Memory per pixel, in bytes, while a picture is made and written: the scene, what its pixels found of the sky's light
/// (twice while threads hand in their parts), the rain, and the file.
pub(super) const BYTES_PER_PIXEL: u64 = 220;

/// Make a picture of a scene in the rain.
#[derive(Debug, Args)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    input: InputArguments,
    /// The picture: .png (to look at) or .exr (linear radiance, unexposed).
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Write all layers into one .exr: R, G, B; clean.R, .G, .B; rain.R, .G, .B; transmittance.Y; depth.Z (metres along
    /// the ray, 1e30 for the sky).
    #[arg(long)]
    layers: bool,
    /// Write what was done: counts of drops, rates, times.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Write a row for each drop that is drawn: place and velocity in the world, diameter.
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
    /// How a drop's pixel finds its colour.
    #[arg(long, value_enum, default_value = "direction")]
    refraction: Refraction,
    /// Replace files that exist.
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
    /// The shift in a picture 165 degrees wide; no reflection.
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
        let (stats, drops) = (self.stats.as_deref(), self.dump_drops.as_deref());
        let outputs = Outputs::new(&self.output, stats, drops, self.overwrite)?;
        if self.layers && outputs.format != Format::Exr {
            let found = format!("--layers for {}", shown(&self.output));
            return Err(Failure::new(INPUT, format!("{found}; allowed: for .exr only")));
        }
        let input = self.input.read(&mut Budget::default())?;
        outputs.keep(&input.files)?;
        reserve(input.weather.size)?;
        let stage = Stage::new(&input.weather, &input.loaded, self.input.time)?;
        input.say_warnings(&stage, |text| self.say(text));
        let begin = Instant::now();
        let rain = &input.weather.rain;
        let showers = Showers::new(rain)?;
        let shower = showers.at(&stage, self.input.time, outputs.wants_stats())?;
        // The files have become buffers.
        drop(input.loaded);
        let (picture, computer) = self.render(&stage, &shower, &showers.masks, rain.seed, interrupt)?;
        let frame_ms = begin.elapsed().as_secs_f64() * 1.0e3;
        let drawn = picture.drawn.len();
        self.say(&format!("rain: {} mm/h, {drawn} drops drawn", rain.rate_mm_h));
        let told = |measured_rate_mm_h| Told {
            computer: &computer,
            rain: &shower.visible,
            asked_rate_mm_h: rain.rate_mm_h,
            measured_rate_mm_h,
            time_s: self.input.time,
            seed: rain.seed,
            triangles: stage.triangles,
            frame_ms,
        };
        let stats = shower.measured_rate_mm_h.map(|rate| report::stats(&picture, &told(rate)));
        let bytes = Bytes {
            stats: stats.unwrap_or_default().into(),
            drops: if outputs.wants_drops() {
                report::drops(&picture.drawn, &shower.visible.drops).into()
            } else {
                Vec::new()
            },
            picture: self.encode(outputs.format, &stage, picture)?,
        };
        outputs.publish(&bytes, interrupt)?;
        let [width, height] = stage.size;
        self.say(&format!("wrote {}: {width} x {height}", shown(&self.output)));
        Ok(())
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }

    fn options(&self, stage: &Stage, seed: u64) -> PictureOptions {
        PictureOptions {
            size: stage.size,
            grid: self.samples,
            sky_rays: self.sky_rays,
            seed,
            rain: RainOptions { form: self.refraction.into(), ..RainOptions::default() },
        }
    }

    #[cfg(not(feature = "gpu"))]
    fn render(
        &self,
        stage: &Stage,
        shower: &Shower,
        masks: &DropMasks,
        seed: u64,
        _: &Interrupt,
    ) -> Result<(Picture, Computer), Failure> {
        let options = self.options(stage, seed);
        let drops = stage.place(&shower.visible.drops);
        compute(&self.backend, |text| self.say(text), || on_cpu(stage, &drops, masks, &options))
    }

    #[cfg(feature = "gpu")]
    fn render(
        &self,
        stage: &Stage,
        shower: &Shower,
        masks: &DropMasks,
        seed: u64,
        interrupt: &Interrupt,
    ) -> Result<(Picture, Computer), Failure> {
        use downpour::render::gpu::{GpuPictureError, PictureRenderer};
        let options = self.options(stage, seed);
        let drops = stage.place(&shower.visible.drops);
        let say = |text: &str| self.say(text);
        let gpu = |gpu: &downpour::gpu::Gpu| {
            let renderer = PictureRenderer::new(gpu)?;
            let picture = renderer.render(&stage.data, &stage.viewpoint, &drops, masks, &options)?;
            let computer = Computer { adapter: gpu.adapter().name.clone(), backend: "gpu" };
            Ok::<_, GpuPictureError>((picture, computer))
        };
        compute(&self.backend, interrupt, say, gpu, || on_cpu(stage, &drops, masks, &options))
    }

    fn encode(&self, format: Format, stage: &Stage, picture: Picture) -> Result<Vec<u8>, Failure> {
        let [width, height] = picture.size;
        if self.layers {
            return Ok(write_exr_layers(width, height, &picture.clean, &picture.rain)?);
        }
        let radiance = picture.radiance();
        Ok(match format {
            Format::Exr => write_exr(width, height, &radiance)?,
            Format::Png => {
                let exposure = stage.exposure(&picture.clean);
                drop(picture);
                let pixels: Vec<[f32; 4]> = radiance.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
                drop(radiance);
                write_png(width, height, &tone_picture(&pixels, exposure))?
            }
        })
    }
}

fn on_cpu(
    stage: &Stage,
    drops: &[FallingDrop],
    masks: &DropMasks,
    options: &PictureOptions,
) -> Result<(Picture, Computer), Failure> {
    let picture = render_picture(&stage.data, &stage.viewpoint, drops, masks, options)?;
    Ok((picture, Computer { adapter: "CPU".to_owned(), backend: "cpu" }))
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
