//! Unresolved rain on a GPU: what [`MediumLight::layer`] makes on the CPU.

use std::sync::{Arc, OnceLock};

use bytemuck::Zeroable;
use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, made_once, wgpu, workgroups};
use downpour_shaders::render::medium::{
    MEDIUM_CELLS, MEDIUM_FILTER_KERNEL, MEDIUM_LIGHT_KERNEL, MEDIUM_OPEN_KERNEL, MEDIUM_SMOOTH_KERNEL,
    MEDIUM_SMOOTH_PARTS_KERNEL,
};

use super::plate::PlateOnGpu;
use crate::rain::medium::{MediumFrame, MediumLight};
use crate::spacing::RaySpacing;

/// The pipelines of unresolved rain: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct MediumPipeline {
    gpu: Gpu,
    open: ComputeKernel,
    light: ComputeKernel,
    filter: ComputeKernel,
    /// Of a picture with fog: made for the first one.
    smooth: Arc<OnceLock<[ComputeKernel; 2]>>,
}

/// The unresolved rain of a picture, ready to be worked out.
#[derive(Debug)]
pub struct MediumPass<'a> {
    pipeline: &'a MediumPipeline,
    open: (wgpu::BindGroup, [u32; 3]),
    light: (wgpu::BindGroup, [u32; 3]),
    /// Kernels that take means, in this order.
    filters: Vec<(ComputeKernel, wgpu::BindGroup)>,
    pixels: [u32; 3],
    frame: wgpu::Buffer,
    phase: wgpu::Buffer,
    found: wgpu::Buffer,
    /// Everything that its light is found from, besides plate and lamps.
    of: MediumOf,
    /// True if the light is there already.
    is_known: bool,
}

/// Everything that the light of unresolved rain before a plate is found from, besides the plate and its lamps.
#[derive(Clone, Debug)]
pub(super) struct MediumOf {
    medium: MediumFrame,
    rays: RaySpacing,
    phase: Vec<[f32; 4]>,
    found: wgpu::Buffer,
}

impl MediumOf {
    /// True if another picture of the same plate has the same light, in the same buffer: streaks of unresolved drops, which move, are
    /// none of it.
    fn is_same(&self, other: &Self) -> bool {
        let still = |medium: &MediumFrame| MediumFrame {
            axis: [0.0; 3],
            across: [0.0; 3],
            beside: [0.0; 3],
            seed: 0,
            is_grainy: 0,
            shells: Zeroable::zeroed(),
            ..*medium
        };
        self.found == other.found
            && self.rays == other.rays
            && self.phase == other.phase
            && still(&self.medium) == still(&other.medium)
    }
}

impl MediumPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            gpu: gpu.clone(),
            open: kernel(&MEDIUM_OPEN_KERNEL)?,
            light: kernel(&MEDIUM_LIGHT_KERNEL)?,
            filter: kernel(&MEDIUM_FILTER_KERNEL)?,
            smooth: Arc::default(),
        })
    }

    /// Makes ready to work out the rain before a picture. `plate` is that of `medium`, `layer` what the result goes to, a row per pixel.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the picture is larger than the device takes, or what else the GPU says.
    pub fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        plate: &PlateOnGpu<'_>,
        medium: &MediumLight<'_>,
        layer: &wgpu::Buffer,
    ) -> Result<MediumPass<'a>, GpuError> {
        let [width, height] = medium.camera.size();
        let pixels = u64::from(width) * u64::from(height);
        let rows = medium.grid_rows() as u64 + 2 * pixels;
        let found = buffers.buffer("unresolved rain", rows * 16, wgpu::BufferUsages::STORAGE)?;
        let phase = buffers.constants("phase function", &medium.phase)?;
        let frame = buffers.uniform("medium frame", &medium.medium)?;
        let clean = plate.pixels;
        let numbered = || (0u32..).zip(&plate.lighting.buffers);
        let open = self.open.bind_at(buffers, numbered().chain([(6, clean), (8, &found), (9, &frame)]))?;
        let of_light = [(6, clean), (7, &phase), (8, &found), (9, &frame)];
        let light = self.light.bind_at(buffers, numbered().chain(of_light))?;
        let of_filter = [(0, &plate.lighting.buffers[0]), (1, &found), (2, clean), (9, &frame)];
        let bound = |kernel: &ComputeKernel, more: &[(u32, &wgpu::Buffer)]| {
            let bindings = kernel.bind_at(buffers, of_filter.into_iter().chain(more.iter().copied()))?;
            Ok::<_, GpuError>((kernel.clone(), bindings))
        };
        let filters = if medium.medium.fog[0] > 0.0 {
            let parts = buffers.buffer("seen light in fog", pixels * 16, wgpu::BufferUsages::STORAGE)?;
            let [first, then] = made_once(&self.smooth, || {
                let kernel = |kernel| ComputeKernel::new(&self.gpu, kernel, &[]);
                Ok([kernel(&MEDIUM_SMOOTH_PARTS_KERNEL)?, kernel(&MEDIUM_SMOOTH_KERNEL)?])
            })?;
            vec![bound(first, &[(4, &parts)])?, bound(then, &[(3, layer), (4, &parts)])?]
        } else {
            vec![bound(&self.filter, &[(3, layer)])?]
        };
        let cells = medium.medium.columns * medium.medium.rows;
        let rays = medium.lighting.ray_spacing();
        Ok(MediumPass {
            pipeline: self,
            open: (open, workgroups(cells.div_ceil(MEDIUM_CELLS))),
            light: (light, rays.workgroups([width, height])),
            filters,
            pixels: [width.div_ceil(8), height.div_ceil(8), 1],
            frame,
            phase,
            of: MediumOf { medium: medium.medium, rays, phase: medium.phase.clone(), found: found.clone() },
            found,
            is_known: false,
        })
    }
}

impl MediumPass<'_> {
    /// The grid of the air that is open to the rain.
    #[must_use]
    pub fn open(&self) -> Dispatch<'_> {
        self.pipeline.open.dispatch(&self.open.0, self.open.1)
    }

    /// The dispatches after that, in this order: the light, unless it is there already, and its means.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let light = self.pipeline.light.dispatch(&self.light.0, self.light.1);
        let means = self.filters.iter().map(|(kernel, bindings)| kernel.dispatch(bindings, self.pixels));
        (!self.is_known).then_some(light).into_iter().chain(means).collect()
    }

    /// Takes the light that the last picture has found, if it is the same; its plate and lamps are.
    pub(super) fn go_on_from(&mut self, last: &MediumOf) {
        self.is_known = self.of.is_same(last);
    }

    /// Everything that its light is found from.
    pub(super) fn of(&self) -> &MediumOf {
        &self.of
    }

    /// The frame of the medium on the device.
    pub(super) fn frame(&self) -> &wgpu::Buffer {
        &self.frame
    }

    /// The phase functions on the device.
    pub(super) fn phase(&self) -> &wgpu::Buffer {
        &self.phase
    }

    /// Reads the grid and what was found before each pixel, as [`MediumLight::found`].
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn found(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.found)
    }
}
