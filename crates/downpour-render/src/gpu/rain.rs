//! Drops before a scene on a GPU.

use downpour_gpu::{ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::rain::{DROPS_KERNEL, REDUCE_KERNEL};

use super::scene::{SceneOnGpu, ScenePipeline};
use crate::rain::{DropMasks, DropsDrop, Rain, ReduceLevel, reduce_levels};
use crate::trace::TraceGather;

/// The pipelines of drops: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct RainPipeline {
    gpu: Gpu,
    reduce: ComputeKernel,
    drops: ComputeKernel,
}

/// Masks on the device.
#[derive(Clone, Debug)]
pub struct RainOnGpu {
    masks: wgpu::Buffer,
}

/// The drops of one picture, ready to be drawn.
#[derive(Debug)]
pub struct RainPass<'a> {
    pipeline: &'a RainPipeline,
    tracer: &'a ScenePipeline,
    size: [u32; 2],
    capture: (wgpu::BindGroup, u32),
    levels: Vec<(wgpu::BindGroup, u32)>,
    drops: wgpu::BindGroup,
    texels: wgpu::Buffer,
    layer: wgpu::Buffer,
}

impl RainPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self { gpu: gpu.clone(), reduce: kernel(&REDUCE_KERNEL)?, drops: kernel(&DROPS_KERNEL)? })
    }

    /// Brings the masks to the device.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if they are larger than the device allows, or what else the GPU says.
    pub fn upload(&self, masks: &DropMasks) -> Result<RainOnGpu, GpuError> {
        Ok(RainOnGpu { masks: self.gpu.storage_buffer("masks of drops", &masks.words)? })
    }

    /// Makes ready to draw drops over a scene. `clean` is the scene's picture with its distances.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn prepare<'a>(
        &'a self,
        tracer: &'a ScenePipeline,
        scene: &SceneOnGpu,
        masks: &RainOnGpu,
        clean: &wgpu::Buffer,
        rain: &Rain,
    ) -> Result<RainPass<'a>, GpuError> {
        let gpu = &self.gpu;
        let size = rain.capture.frame.width;
        let levels = reduce_levels(size);
        let all = levels.last().map_or(size * size, |last| last.target_texel + last.size * last.size);
        let storage = wgpu::BufferUsages::STORAGE;
        let texels = gpu.empty_buffer("capture", u64::from(all) * 16, storage)?;
        let frame = gpu.uniform_buffer("capture frame", &rain.capture.frame)?;
        // A capture has no filter: nothing is written there.
        let nothing = gpu.storage_buffer("no light of the sky", &[TraceGather::default()])?;
        let capture = tracer.kernel.bind(gpu, &scene.buffers(&frame, &texels, &nothing))?;
        let level = |level: &ReduceLevel| {
            let uniform = gpu.uniform_buffer("capture level", level)?;
            Ok((self.reduce.bind(gpu, &[&uniform, &texels])?, level.size.div_ceil(8)))
        };
        let levels = levels.iter().map(level).collect::<Result<_, GpuError>>()?;
        let picture = [rain.frame.width, rain.frame.height];
        let pixels = u64::from(picture[0]) * u64::from(picture[1]);
        let layer = gpu.empty_buffer("rain", pixels * 16, storage)?;
        let frame = gpu.uniform_buffer("drops frame", &rain.frame)?;
        // A buffer has at least one element.
        let list: &[_] = if rain.list.is_empty() { &[DropsDrop::default()] } else { &rain.list };
        let list = gpu.storage_buffer("drops", list)?;
        let tiles = gpu.storage_buffer("tiles of drops", &rain.tiles)?;
        let drops = self.drops.bind(gpu, &[&frame, &list, &tiles, &masks.masks, &texels, clean, &layer])?;
        let capture = (capture, size.div_ceil(8));
        Ok(RainPass { pipeline: self, tracer, size: picture, capture, levels, drops, texels, layer })
    }
}

impl RainPass<'_> {
    /// The capture of the surroundings, with its coarser levels.
    #[must_use]
    pub fn capture(&self) -> Vec<Dispatch<'_>> {
        let (bindings, groups) = &self.capture;
        let finest = self.tracer.kernel.dispatch(bindings, [*groups, *groups, 1]);
        let levels = self.levels.iter();
        let coarser = levels.map(|(bindings, n)| self.pipeline.reduce.dispatch(bindings, [*n, *n, 1]));
        std::iter::once(finest).chain(coarser).collect()
    }

    /// The drops.
    #[must_use]
    pub fn drops(&self) -> Dispatch<'_> {
        let groups = [self.size[0].div_ceil(8), self.size[1].div_ceil(8), 1];
        self.pipeline.drops.dispatch(&self.drops, groups)
    }

    /// Reads the rain: radiance, and the transmittance of the scene behind it; rows from the top.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn layer(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.layer)
    }

    /// Reads the capture, all levels.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn surroundings(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.texels)
    }
}
