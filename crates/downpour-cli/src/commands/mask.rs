//! `downpour mask`: the refraction mask of a drop or of a drop model, as a file.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use downpour::drop::DropShape;
use downpour::drop::air::Air;
use downpour::drop::optics::water_index_in_air;
use downpour::mask::file::{exr, ktx2, png};
use downpour::mask::{ClosedMesh, MAX_TRIANGLES, Mask, MaskOptions, SIZES, View, trace_drop, trace_model};
use downpour::scene::{Budget, gltf::read_triangles};

use crate::backend::{BackendArguments, compute};
use crate::commands::say_warnings;
use crate::exit_code::ExitCode as _;
use crate::failure::{Failure, INPUT, LIMIT, shown};
use crate::interrupt::Interrupt;
use crate::output::OutputFile;
use crate::{quantity, stream};

/// The most masks of a KTX2 array.
const MAX_MASKS: usize = 128;

/// The most texels of all masks of a file: 128 masks of 512 x 512, or 2 of 4096 x 4096.
const MAX_TEXELS: u64 = 1 << 25;

/// Memory per texel, in bytes, while masks are traced and written: a quarter more than the measured peak of .exr, the
/// largest of the formats.
const BYTES_PER_TEXEL: u64 = 130;

/// Memory budget of a drop model.
const MODEL_BUDGET_BYTES: u64 = 1 << 30;

/// Trace the refraction mask of a drop, or of a drop model, and write it to a file.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("drop").required(true))]
pub(crate) struct MaskArguments {
    /// Diameter of the drop, 0.001 to 9 mm; several, separated by commas, for an array in .ktx2.
    #[arg(long, value_name = "MM", group = "drop", value_delimiter = ',', allow_hyphen_values = true)]
    #[arg(value_parser = quantity::diameter_mm)]
    diameter: Vec<f64>,
    /// A drop model: a closed mesh in a .glb or .gltf file, in meters, its +Y up.
    #[arg(long, value_name = "DROP.glb", group = "drop")]
    model: Option<PathBuf>,
    /// Edge of the mask in pixels, 4 to 4096.
    #[arg(long, value_name = "PIXELS", default_value = "512", value_parser = quantity::size)]
    #[arg(allow_hyphen_values = true)]
    size: u64,
    /// Elevation of the view above the drop's horizon, -90 to 90 degrees.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = quantity::elevation_deg)]
    #[arg(allow_hyphen_values = true)]
    elevation: f64,
    /// Refractive index relative to air, above 1, up to 4 [default: 1.333].
    #[arg(long, value_name = "N", value_parser = quantity::refractive_index, allow_hyphen_values = true)]
    refractive_index: Option<f64>,
    /// Wavelength, 200 to 1100 nm, at which the refractive index of water is taken.
    #[arg(long, value_name = "NM", value_parser = quantity::wavelength_nm, allow_hyphen_values = true)]
    #[arg(conflicts_with = "refractive_index")]
    wavelength: Option<f64>,
    /// Temperature, -12 to 40 C, at which the refractive index of water is taken [default: 20].
    #[arg(long, value_name = "C", value_parser = quantity::temperature_of_index_c)]
    #[arg(allow_hyphen_values = true, requires = "wavelength")]
    temperature: Option<f64>,
    /// Output file: .exr (all data, 32 bits), .ktx2 (texture array, 16 bits) or .png (preview).
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Write .exr with 16 bits.
    #[arg(long)]
    half: bool,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Ktx2,
    Png,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Failure> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("exr") => Ok(Self::Exr),
            Some("ktx2") => Ok(Self::Ktx2),
            Some("png") => Ok(Self::Png),
            _ => Err(Failure::new(INPUT, format!("output {}; allowed: .exr, .png or .ktx2", shown(path)))),
        }
    }
}

/// Refracting shape.
enum Subject {
    Drops(Vec<DropShape>),
    Model(ClosedMesh),
}

impl MaskArguments {
    pub(crate) fn run(&self, interrupt: &Interrupt) -> Result<(), Failure> {
        let format = Format::of(&self.output)?;
        self.check(format)?;
        self.backend.check()?;
        let options = self.options()?;
        let file = OutputFile::new(&self.output, self.overwrite)?;
        let subject = self.subject()?;
        reserve(self.texels())?;
        let masks = self.trace(&subject, &options, interrupt)?;
        let bytes = encode(format, self.half, &masks)?;
        drop(masks);
        file.publish(&bytes, interrupt)?;
        let (count, size) = (self.diameter.len().max(1), self.size);
        let masks = if count == 1 { "a mask".to_owned() } else { format!("{count} masks") };
        self.say(&format!("wrote {}: {masks} of {size} x {size}", shown(&self.output)));
        Ok(())
    }

    fn say(&self, text: &str) {
        if !self.quiet {
            stream::message(text);
        }
    }

    fn texels(&self) -> u64 {
        self.size.saturating_mul(self.size).saturating_mul(self.diameter.len().max(1) as u64)
    }

    /// Checks the arguments that need no file.
    fn check(&self, format: Format) -> Result<(), Failure> {
        let refuse = |code, message: String| Err(Failure::new(code, message));
        let most = *SIZES.end();
        if self.size > u64::from(most) {
            return refuse(LIMIT, format!("--size is {}; allowed: {} to {most}", self.size, SIZES.start()));
        }
        let count = self.diameter.len();
        if count > 1 && format != Format::Ktx2 {
            let allowed = "one diameter, or a .ktx2 file, which holds an array";
            return refuse(
                INPUT,
                format!("{count} diameters for {}; allowed: {allowed}", shown(&self.output)),
            );
        }
        if count > MAX_MASKS {
            return refuse(INPUT, format!("{count} diameters; allowed: 1 to {MAX_MASKS}"));
        }
        if self.texels() > MAX_TEXELS {
            let found = format!("{count} masks of {0} x {0} texels", self.size);
            let most = MAX_TEXELS / (self.size * self.size);
            return refuse(LIMIT, format!("{found}; allowed: {most} masks of this size"));
        }
        if self.half && format != Format::Exr {
            return refuse(INPUT, format!("--half for {}; allowed: for .exr only", shown(&self.output)));
        }
        Ok(())
    }

    fn options(&self) -> Result<MaskOptions, Failure> {
        let usual = MaskOptions::default();
        let refractive_index = match (self.refractive_index, self.wavelength) {
            (Some(index), _) => index,
            (None, Some(nm)) => {
                let standard = Air::standard();
                let temperature = self.temperature.unwrap_or(standard.temperature_c());
                water_index_in_air(nm * 1.0e-9, &Air::new(temperature, standard.pressure_pa())?)?
            }
            (None, None) => usual.refractive_index,
        };
        let size = u32::try_from(self.size).unwrap_or(u32::MAX);
        Ok(MaskOptions { size, view: View::from_elevation(self.elevation.to_radians())?, refractive_index })
    }

    fn subject(&self) -> Result<Subject, Failure> {
        let Some(path) = &self.model else {
            let shapes: Result<_, _> = self.diameter.iter().map(|mm| DropShape::new(mm * 1.0e-3)).collect();
            return Ok(Subject::Drops(shapes?));
        };
        let most = MAX_TRIANGLES;
        let mut budget = Budget { bytes: MODEL_BUDGET_BYTES, vertices: 3 * most as u64, ..Budget::default() };
        let model = read_triangles(path, &mut budget)?.strict()?;
        if model.indices.len() > most {
            let found = format!("{}: {} triangles", model.name, model.indices.len());
            return Err(Failure::new(LIMIT, format!("{found}; allowed: at most {most}")));
        }
        let mesh = ClosedMesh::new(&model.positions, model.normals.as_deref(), &model.indices)
            .map_err(|error| Failure::new(error.exit_code(), format!("{}: {error}", model.name)))?;
        say_warnings(&model.name, &model.warnings, |text| self.say(text));
        Ok(Subject::Model(mesh))
    }

    #[cfg(not(feature = "gpu"))]
    fn trace(&self, subject: &Subject, options: &MaskOptions, _: &Interrupt) -> Result<Vec<Mask>, Failure> {
        compute(&self.backend, |text| self.say(text), || on_cpu(subject, options))
    }

    #[cfg(feature = "gpu")]
    fn trace(
        &self,
        subject: &Subject,
        options: &MaskOptions,
        interrupt: &Interrupt,
    ) -> Result<Vec<Mask>, Failure> {
        let say = |text: &str| self.say(text);
        let gpu = |gpu: &_| on_gpu(gpu, subject, options);
        compute(&self.backend, interrupt, say, gpu, || on_cpu(subject, options))
    }
}

fn on_cpu(subject: &Subject, options: &MaskOptions) -> Result<Vec<Mask>, Failure> {
    Ok(match subject {
        Subject::Drops(shapes) => {
            shapes.iter().map(|shape| trace_drop(shape, options)).collect::<Result<_, _>>()?
        }
        Subject::Model(mesh) => vec![trace_model(mesh, options, None)?],
    })
}

#[cfg(feature = "gpu")]
fn on_gpu(
    gpu: &downpour::gpu::Gpu,
    subject: &Subject,
    options: &MaskOptions,
) -> Result<Vec<Mask>, downpour::mask::gpu::GpuMaskError> {
    let tracer = downpour::mask::gpu::GpuTracer::new(gpu)?;
    match subject {
        Subject::Drops(shapes) => shapes.iter().map(|shape| tracer.trace_drop(shape, options)).collect(),
        Subject::Model(mesh) => Ok(vec![tracer.trace_model(mesh, options, None)?]),
    }
}

fn encode(format: Format, half: bool, masks: &[Mask]) -> Result<Vec<u8>, Failure> {
    let precision = if half { exr::Precision::Half } else { exr::Precision::Float };
    Ok(match (format, masks) {
        (Format::Exr, [mask]) => exr::write_exr(mask, precision)?,
        (Format::Png, [mask]) => png::write_png(mask)?,
        // The arguments were checked: only an array may have another number of masks than one.
        _ => ktx2::write_ktx2(masks)?,
    })
}

/// Checks that the memory for the masks is available. An allocation that fails later on would abort the process.
fn reserve(texels: u64) -> Result<(), Failure> {
    let bytes = texels.saturating_mul(BYTES_PER_TEXEL);
    let mut room: Vec<u8> = Vec::new();
    let had = usize::try_from(bytes).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok());
    if had {
        return Ok(());
    }
    let found = format!("{} MiB of memory are needed", bytes >> 20);
    Err(Failure::new(
        LIMIT,
        format!("{found}; allowed: the memory of this machine (a smaller --size needs less)"),
    ))
}
