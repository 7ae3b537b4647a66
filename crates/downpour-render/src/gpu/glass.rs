//! A picture through a pane of glass, on a GPU.

use std::sync::{Mutex, PoisonError};

use downpour_gpu::{BufferPool, BufferSource as _, ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::render::glass::GLASS_PICTURE_KERNEL;
use downpour_shaders::render::rain::COMPOSE_KERNEL;

use crate::glass::{GlassPicture, GlassPictureFrame};

/// Samples of a dispatch, at most: a submission must stay far below the time after which a driver resets.
const SAMPLES_PER_DISPATCH: u32 = 1 << 22;

/// Label of the picture that is read.
const MADE: &str = "picture through glass";

/// The pipelines of a pane and its buffers: made once, used for any number of pictures.
#[derive(Debug)]
pub struct GlassRenderer {
    gpu: Gpu,
    /// Buffers of the pictures, one picture at a time.
    pool: Mutex<BufferPool>,
    compose: ComputeKernel,
    pyramid: ComputeKernel,
    kernel: ComputeKernel,
}

/// The picture before a pane of glass, on the device.
#[derive(Clone, Copy, Debug)]
pub struct BehindGlass<'a> {
    /// The plate: radiance and distance of each pixel, rows from the top.
    pub plate: &'a wgpu::Buffer,
    /// The rain before it: radiance and transmittance of each pixel.
    pub rain: &'a wgpu::Buffer,
    /// The environment map.
    pub environment: EnvironmentMap<'a>,
}

/// An environment map with all of its levels.
#[derive(Clone, Copy, Debug)]
pub enum EnvironmentMap<'a> {
    /// Of a buffer of the device.
    OnDevice(&'a wgpu::Buffer),
    /// Of these texels, for which the pane has a buffer.
    Texels(&'a [[f32; 4]]),
}

impl GlassRenderer {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            gpu: gpu.clone(),
            // The picture is read whole: it has the size that it needs.
            pool: Mutex::new(BufferPool::new(gpu).with_given_away(&[MADE])),
            compose: kernel(&COMPOSE_KERNEL)?,
            pyramid: kernel(&PYRAMID_KERNEL)?,
            kernel: kernel(&GLASS_PICTURE_KERNEL)?,
        })
    }

    /// The plate through the rain, with its coarser levels.
    fn behind(
        &self,
        pool: &BufferPool,
        glass: &GlassPicture,
        seen: &BehindGlass<'_>,
    ) -> Result<wgpu::Buffer, GpuError> {
        let gpu = &self.gpu;
        let [width, height] = glass.frame.camera.size();
        let levels = glass.coarser_levels();
        let texels = levels.last().map_or(u64::from(width) * u64::from(height), |last| {
            u64::from(last.target_texel) + u64::from(last.size[0]) * u64::from(last.size[1])
        });
        let behind = pool.buffer("picture behind glass", texels * 16, wgpu::BufferUsages::STORAGE)?;
        let size = pool.uniform("size of the picture behind glass", &[width, height, 0, 0])?;
        let composed = self.compose.bind(gpu, &[&size, seen.plate, seen.rain, &behind])?;
        let mut bound = Vec::new();
        for level in &levels {
            let uniform = pool.uniform("level of the picture behind glass", level)?;
            bound.push((self.pyramid.bind(gpu, &[&uniform, &behind])?, level.size));
        }
        let groups = |[columns, rows]: [u32; 2]| [columns.div_ceil(8), rows.div_ceil(8), 1];
        let mut dispatches = vec![self.compose.dispatch(&composed, groups([width, height]))];
        dispatches.extend(bound.iter().map(|(level, size)| self.pyramid.dispatch(level, groups(*size))));
        gpu.submit(&dispatches)?;
        Ok(behind)
    }

    /// Number of buffers that were created so far; a like picture creates none.
    #[must_use]
    pub fn buffers_made(&self) -> u64 {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner).made()
    }

    /// The picture through the pane: what [`GlassPicture::through`] makes on the CPU.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if a buffer is larger than the device allows, or what else the GPU says.
    pub fn through(&self, glass: &GlassPicture, seen: &BehindGlass<'_>) -> Result<Vec<[f32; 3]>, GpuError> {
        let gpu = &self.gpu;
        let frame = &glass.frame;
        let pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        // The picture before has been read: nothing uses its buffers any more.
        pool.begin_frame();
        let drops = pool.storage("drops on glass", &glass.drops)?;
        let bins = pool.storage("bins of drops on glass", &glass.bins)?;
        let wet = pool.storage("wetness of glass", &glass.wet)?;
        let lens = pool.storage("points of the lens", &glass.lens)?;
        let lights = pool.storage("lamps before glass", &glass.lights)?;
        let behind = self.behind(&pool, glass, seen)?;
        let environment = match seen.environment {
            EnvironmentMap::OnDevice(buffer) => buffer.clone(),
            EnvironmentMap::Texels(texels) => pool.storage("environment map of a pane", texels)?,
        };
        let pixels = u64::from(frame.camera.width) * u64::from(frame.camera.height);
        let made = pool.buffer(MADE, pixels * 16, wgpu::BufferUsages::STORAGE)?;
        let row = frame.camera.width.max(1).saturating_mul(frame.samples.max(1));
        let rows = (SAMPLES_PER_DISPATCH / row).max(8).next_multiple_of(8);
        for first_row in (0..frame.camera.height).step_by(rows as usize) {
            let band = GlassPictureFrame { first_row, ..*frame };
            let uniform = pool.uniform("glass picture frame", &band)?;
            let buffers = [&uniform, &drops, &bins, &wet, &lens, &behind, &environment, &made, &lights];
            let bindings = self.kernel.bind(gpu, &buffers)?;
            let groups =
                [frame.camera.width.div_ceil(8), rows.min(frame.camera.height - first_row).div_ceil(8), 1];
            gpu.submit(&[self.kernel.dispatch(&bindings, groups)])?;
            if gpu.adapter().is_software() {
                // One submission at a time: software drivers queue without end.
                gpu.wait()?;
            }
        }
        let seen = gpu.read::<[f32; 4]>(&made)?.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
        pool.give_back(MADE, made);
        Ok(seen)
    }
}
