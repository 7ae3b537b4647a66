//! `downpour specimen`: one exact drop, large, in front of a sky map, at rest or as a streak.

use std::path::{Path, PathBuf};

use clap::Args;
use downpour::drop::DropShape;
use downpour::drop::oscillation::Amplitudes;
use downpour::render::file::{write_exr, write_png};
use downpour::render::tone::{Tone, ToneCurve, ToneEdges, ToneLayers, tone_automatic_exposure, tone_picture};
use downpour::scene::Budget;
use downpour::scene::sky::read_sky;
use downpour::specimen::{
    Image, Sky, SpecimenLamp, SpecimenOptions, check_specimen_table, render_specimen, render_specimen_table,
};

use crate::backend::{BackendArguments, compute};
use crate::commands::say_warnings;
use crate::failure::{Failure, INPUT, shown};
use crate::interrupt::Interrupt;
use crate::output::OutputFile;
use crate::quantity::SpecimenSamples;
use crate::{quantity, stream};

/// Draw one drop, exactly, in front of a sky map.
///
/// The drop is at the origin, its axis vertical, bottom down; the camera looks at it from `--distance` along (sin yaw cos
/// pitch, sin pitch, cos yaw cos pitch). With `--exposure` it falls at its terminal speed, is at the origin at mid-exposure, and
/// the picture is the mean over the exposure.
#[derive(Debug, Args)]
pub(crate) struct SpecimenArguments {
    /// Diameter of the drop, 0.001 to 9 mm.
    #[arg(long, value_name = "MM", value_parser = quantity::diameter_mm, allow_hyphen_values = true)]
    diameter: f64,
    /// The sky map: equirectangular, +Y up, .hdr or .exr.
    #[arg(long, value_name = "ENV.hdr")]
    environment: PathBuf,
    /// Distance of the camera in meters.
    #[arg(long, value_name = "M", default_value = "0.1", value_parser = quantity::distance_m)]
    #[arg(allow_hyphen_values = true)]
    distance: f64,
    /// Azimuth of the camera around the drop, degrees.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = quantity::yaw_deg)]
    #[arg(allow_hyphen_values = true)]
    yaw: f64,
    /// Elevation of the camera above the drop, -90 to 90 degrees.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = quantity::elevation_deg)]
    #[arg(allow_hyphen_values = true)]
    pitch: f64,
    /// Vertical field of view, degrees [default: the drop, or all of its path, fills 80 % of the height].
    #[arg(long, value_name = "DEG", value_parser = quantity::fov_deg, allow_hyphen_values = true)]
    fov: Option<f64>,
    /// Exposure in seconds, 0 to 1; 0 is a drop at rest.
    #[arg(long, value_name = "S", default_value = "0", value_parser = quantity::exposure_s)]
    #[arg(allow_hyphen_values = true)]
    exposure: f64,
    /// Of a drop at rest: samples along an edge of a pixel, 1 to 16. Of a streak: instants of the exposure for each of the 16
    /// samples of a pixel, 1 to 4096. Both are exact. `table`: the streak as `render` draws it, by its streak radiance table, for
    /// comparison with the exact one; with `--exposure`, for drops of 0.5 to 9 mm, under lamps of at most 5 degrees.
    #[arg(long, value_name = "N|table", default_value = "4", value_parser = quantity::specimen_samples)]
    #[arg(allow_hyphen_values = true)]
    samples: SpecimenSamples,
    /// Oscillation of the drop: `none`, or the amplitudes of the modes (2,0) and (3,1) over the radius, as 0.2,0.1.
    #[arg(long, value_name = "A20,A31", default_value = "none", value_parser = quantity::oscillation)]
    #[arg(allow_hyphen_values = true)]
    oscillation: Amplitudes,
    /// Phases of the two modes at mid-exposure, in turns.
    #[arg(long, value_name = "T20,T31", default_value = "0,0", value_parser = quantity::phase)]
    #[arg(allow_hyphen_values = true)]
    phase: [f64; 2],
    /// A lamp far away: its direction as `--yaw` and `--pitch` of the camera, angular radius in degrees (0.01 to 90), and
    /// radiance in the units of the map, one number or red, green, blue. Yaw 180 is behind the drop as seen from yaw 0. May be
    /// repeated, up to 8 lamps.
    #[arg(long, value_name = "YAW,PITCH,RADIUS,L|R,G,B", value_parser = quantity::lamp)]
    #[arg(allow_hyphen_values = true)]
    light: Vec<SpecimenLamp>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = quantity::picture_size)]
    size: [u32; 2],
    /// The picture: .exr (linear radiance of the map, unexposed) or .png (exposed by itself).
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Replace the file if it exists.
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    backend: BackendArguments,
    /// Print errors only.
    #[arg(short, long)]
    quiet: bool,
}

/// Format by the extension of the file.
#[derive(Clone, Copy)]
enum Format {
    Exr,
    Png,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("exr") => Ok(Self::Exr),
            Some("png") => Ok(Self::Png),
            _ => Err(Failure::new(INPUT, format!("output {}; allowed: .exr or .png", shown(path)))),
        }
    }
}

impl SpecimenArguments {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let format = Format::of(&self.output)?;
        self.backend.check()?;
        let shape = DropShape::new(self.diameter * 1.0e-3)?;
        let options = SpecimenOptions {
            distance_m: self.distance,
            yaw: self.yaw.to_radians(),
            pitch: self.pitch.to_radians(),
            fov: self.fov.map(f64::to_radians),
            size: self.size,
            exposure_s: self.exposure,
            oscillation: self.oscillation,
            phase: self.phase,
            ..SpecimenOptions::default()
        };
        let options = match self.samples {
            SpecimenSamples::Number(instants) if options.is_streak() => {
                SpecimenOptions { instants, ..options }
            }
            SpecimenSamples::Number(samples) => SpecimenOptions { samples, ..options },
            SpecimenSamples::Table => options,
        };
        options.check(&shape)?;
        SpecimenLamp::check_count(&self.light)?;
        self.check_table(&shape, &options)?;
        let file = OutputFile::new(&self.output, self.overwrite)?;
        let map = read_sky(&self.environment, &mut Budget::default())?;
        say_warnings(&shown(&self.environment), &map.warnings, |text| self.say(text));
        let sky = Sky::new(map.width, map.height, &map.radiance)?.with_lamps(&self.light)?;
        let image = self.render(&shape, &options, sky, interrupt)?;
        let bytes = match format {
            Format::Exr => write_exr(image.width, image.height, &image.pixels)?,
            Format::Png => {
                let pixels: Vec<[f32; 4]> = image.pixels.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
                let exposure = tone_automatic_exposure(&pixels);
                let size = [image.width, image.height];
                let layers = ToneLayers { size, radiance: &image.pixels, glow: &[] };
                let (curve, edges) = (ToneCurve::default(), ToneEdges::default());
                let shown = tone_picture(&layers, &Tone { exposure, curve, edges });
                write_png(image.width, image.height, &shown)?
            }
        };
        file.publish(&bytes, interrupt)?;
        self.say(&format!("wrote {}: {} x {}", shown(&self.output), image.width, image.height));
        Ok(())
    }

    fn by_table(&self) -> bool {
        self.samples == SpecimenSamples::Table
    }

    /// # Errors
    /// Exit code 2 for drops and options without a table.
    fn check_table(&self, shape: &DropShape, options: &SpecimenOptions) -> Result<(), Failure> {
        if !self.by_table() {
            return Ok(());
        }
        if self.exposure == 0.0 {
            let found = "--samples table with --exposure 0: a drop at rest has no streak";
            return Err(Failure::new(INPUT, format!("{found}; allowed: --exposure above 0, up to 1")));
        }
        check_specimen_table(shape, options, &self.light)
            .map_err(|error| Failure::new(INPUT, format!("--samples table: {error}")))
    }

    fn on_cpu(&self, shape: &DropShape, options: &SpecimenOptions, sky: Sky<'_>) -> Result<Image, Failure> {
        let render = if self.by_table() { render_specimen_table } else { render_specimen };
        Ok(render(shape, options, sky)?)
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }

    #[cfg(not(feature = "gpu"))]
    fn render(
        &self,
        shape: &DropShape,
        options: &SpecimenOptions,
        sky: Sky<'_>,
        _: &Interrupt,
    ) -> Result<Image, Failure> {
        compute(&self.backend, |text| self.say(text), || self.on_cpu(shape, options, sky))
    }

    #[cfg(feature = "gpu")]
    fn render(
        &self,
        shape: &DropShape,
        options: &SpecimenOptions,
        sky: Sky<'_>,
        interrupt: &Interrupt,
    ) -> Result<Image, Failure> {
        use downpour::specimen::gpu::{SpecimenRenderer, SpecimenTableRenderer};
        let say = |text: &str| self.say(text);
        let gpu = |gpu: &_| {
            if self.by_table() {
                return SpecimenTableRenderer::new(gpu)?.render(shape, options, sky);
            }
            SpecimenRenderer::new(gpu)?.render(shape, options, sky)
        };
        compute(&self.backend, interrupt, say, gpu, || self.on_cpu(shape, options, sky))
    }
}
