//! Specimen on a GPU. Pixels come from the same formulas as on the CPU; parity tests compare the two.

use downpour_drop::DropShape;
use downpour_drop::oscillation::DropOscillation;
use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_mask::gpu::DropUniform;
use downpour_shaders::render::specimen::{
    SPECIMEN_KERNEL, SPECIMEN_LAMPS, SPECIMEN_STREAK_KERNEL, SPECIMEN_STREAK_TRACES,
};

use super::lamp::SpecimenLamp;
use super::motion::SpecimenMotion;
use super::options::SpecimenOptions;
use super::render::{View, views};
use super::sky::Sky;
use super::{Image, SpecimenError};

mod table;

pub use table::SpecimenTableRenderer;

/// Error of rendering a specimen on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuSpecimenError {
    /// The specimen itself is not possible.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// The GPU did not do it.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// The camera in a uniform. The same layout as `SpecimenCamera` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CameraUniform {
    /// Unit vector to the right.
    pub right: [f32; 3],
    /// Slope of a ray per sample.
    pub step: f32,
    /// Unit vector upwards in the picture.
    pub up: [f32; 3],
    /// Distance from the drop's origin, in equivalent radii.
    pub distance: f32,
    /// Unit vector from the drop to the camera.
    pub back: [f32; 3],
    /// Samples along an edge of a pixel.
    pub samples: u32,
}

/// The uniform of the kernel. The same layout as `SpecimenView` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SpecimenUniform {
    /// The drop.
    pub traced: DropUniform,
    /// The camera.
    pub camera: CameraUniform,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Width and height of the sky map.
    pub sky: [u32; 2],
    /// First row of the band.
    pub first_row: u32,
    /// Rows of the band.
    pub rows: u32,
    /// Bit c: the color c is written.
    pub channels: u32,
    /// Padding of the WGSL layout.
    pub padding: u32,
}

/// A lamp. The same layout as `SpecimenLamp` in WGSL; all zeros mean no lamp.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LampUniform {
    /// Toward the middle, of length 1.
    pub direction: [f32; 3],
    /// The squared chord from the middle to the edge.
    pub reach: f32,
    /// Linear radiance.
    pub radiance: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding: u32,
}

impl From<&SpecimenLamp> for LampUniform {
    fn from(lamp: &SpecimenLamp) -> Self {
        Self {
            direction: lamp.direction.map(|c| c as f32),
            reach: lamp.reach as f32,
            radiance: lamp.radiance,
            padding: 0,
        }
    }
}

/// Motion of the drop in the exposure. The same layout as `SpecimenStreak` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct StreakUniform {
    /// The oscillation.
    pub oscillation: DropOscillation,
    /// The first four coefficients of the volume.
    pub volume: [f32; 4],
    /// The fifth.
    pub volume_last: f32,
    /// 1 / A^2 and 1 / B^2 of the spheroid that holds the drop at any time.
    pub inverse_wide: f32,
    /// As `inverse_wide`.
    pub inverse_tall: f32,
    /// Radii per second.
    pub speed: f32,
    /// Radii of fall in half of the exposure.
    pub farthest: f32,
    /// Instants per sample of the picture.
    pub instants: u32,
    /// The first trace of the dispatch.
    pub first: u32,
    /// The number of its traces.
    pub count: u32,
}

impl StreakUniform {
    /// The traces of one dispatch.
    #[must_use]
    pub fn new(motion: &SpecimenMotion, first: u32, count: u32) -> Self {
        let [v1, v2, v3, w0, volume_last] = motion.drop.volume_polynomial().map(|v| v as f32);
        Self {
            oscillation: motion.drop.oscillation().gpu(),
            volume: [v1, v2, v3, w0],
            volume_last,
            inverse_wide: motion.inverse_wide as f32,
            inverse_tall: motion.inverse_tall as f32,
            speed: motion.speed as f32,
            farthest: motion.farthest as f32,
            instants: motion.instants,
            first,
            count,
        }
    }
}

/// Samples per dispatch: a submission must stay far below the time after which a driver resets.
const SAMPLES_PER_BAND: u64 = 1 << 21;

/// Rows of a workgroup.
const GROUP_ROWS: u32 = 8;

/// The pipeline of the specimen: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct SpecimenRenderer {
    gpu: Gpu,
    kernel: ComputeKernel,
}

impl SpecimenRenderer {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// [`GpuError`] of the device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), kernel: ComputeKernel::new(gpu, &SPECIMEN_KERNEL, &[])? })
    }

    /// Renders a drop in front of a sky, as [`render_specimen`](super::render_specimen) does on the CPU.
    ///
    /// ```no_run
    /// use downpour_drop::DropShape;
    /// use downpour_gpu::{AdapterChoice, Gpu};
    /// use downpour_specimen::{Sky, SpecimenOptions, gpu::SpecimenRenderer};
    /// let renderer = SpecimenRenderer::new(&Gpu::open(&AdapterChoice::Auto)?)?;
    /// let radiance = vec![[1.0; 3]; 32];
    /// let sky = Sky::new(8, 4, &radiance)?;
    /// let image = renderer.render(&DropShape::new(2.0e-3)?, &SpecimenOptions::default(), sky)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`GpuSpecimenError::Specimen`] if an option is out of range, else the error of the device: a sky map needs 12 bytes
    /// per texel in one buffer.
    pub fn render(
        &self,
        shape: &DropShape,
        options: &SpecimenOptions,
        sky: Sky<'_>,
    ) -> Result<Image, GpuSpecimenError> {
        let views = views(shape, options)?;
        let streak = match options.motion(shape)? {
            // Created on demand: a picture of a drop at rest does not wait for its compiler.
            Some(motion) => Some((motion, ComputeKernel::new(&self.gpu, &SPECIMEN_STREAK_KERNEL, &[])?)),
            None => None,
        };
        let [width, height] = options.size;
        let map = self.gpu.storage_buffer("sky map", sky.radiance())?;
        let mut lamps = [LampUniform::default(); SPECIMEN_LAMPS as usize];
        for (slot, lamp) in lamps.iter_mut().zip(sky.lamps()) {
            *slot = lamp.into();
        }
        let lamps = self.gpu.uniform_buffer("specimen lamps", &lamps)?;
        let band = band_rows(options);
        let bytes = u64::from(width) * u64::from(band.min(height)) * size_of::<[f32; 3]>() as u64;
        let target = self.gpu.empty_buffer("specimen", bytes, wgpu::BufferUsages::STORAGE)?;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for first_row in (0..height).step_by(band as usize) {
            let rows = band.min(height - first_row);
            for view in &views {
                let uniform = uniform(shape, view, sky, first_row, rows);
                let uniform = self.gpu.uniform_buffer("specimen view", &uniform)?;
                let groups = [width.div_ceil(8), rows.div_ceil(GROUP_ROWS), 1];
                let Some((motion, kernel)) = &streak else {
                    let bindings = self.kernel.bind(&self.gpu, &[&uniform, &map, &target, &lamps])?;
                    self.gpu.submit(&[self.kernel.dispatch(&bindings, groups)])?;
                    continue;
                };
                let traces = options.samples * options.samples * options.instants;
                for first in (0..traces).step_by(SPECIMEN_STREAK_TRACES as usize) {
                    let count = SPECIMEN_STREAK_TRACES.min(traces - first);
                    let of_streak = StreakUniform::new(motion, first, count);
                    let of_streak = self.gpu.uniform_buffer("specimen streak", &of_streak)?;
                    let bindings = kernel.bind(&self.gpu, &[&uniform, &map, &target, &lamps, &of_streak])?;
                    self.gpu.submit(&[kernel.dispatch(&bindings, groups)])?;
                }
            }
            let read = self.gpu.read::<[f32; 3]>(&target)?;
            pixels.extend_from_slice(&read[..width as usize * rows as usize]);
        }
        Ok(Image { width, height, pixels })
    }
}

/// Rows per dispatch.
fn band_rows(options: &SpecimenOptions) -> u32 {
    let per_row = u64::from(options.size[0]) * u64::from(options.samples * options.samples);
    let rows = u32::try_from(SAMPLES_PER_BAND / per_row.max(1)).unwrap_or(u32::MAX);
    (rows / GROUP_ROWS * GROUP_ROWS).clamp(GROUP_ROWS, 1 << 16)
}

fn uniform(shape: &DropShape, view: &View, sky: Sky<'_>, first_row: u32, rows: u32) -> SpecimenUniform {
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    SpecimenUniform {
        traced: DropUniform {
            shape: shape.gpu_coefficients(),
            up: single(view.drop.up),
            index: view.drop.index as f32,
            inverse_wide: view.drop.inverse_wide as f32,
            inverse_tall: view.drop.inverse_tall as f32,
            pixel: 0.0,
            size: 0,
        },
        camera: CameraUniform {
            right: single(view.camera.right),
            step: view.camera.step as f32,
            up: single(view.camera.up),
            distance: view.camera.distance as f32,
            back: single(view.camera.back),
            samples: view.samples,
        },
        size: view.size,
        sky: [sky.width(), sky.height()],
        first_row,
        rows,
        channels: (0..3).map(|c| u32::from(view.channels[c]) << c).sum(),
        padding: 0,
    }
}
