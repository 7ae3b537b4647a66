//! Spray on a GPU: [`spray`](crate::rain::spray).

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::spray::{
    SPRAY_BLEND_KERNEL, SPRAY_CELLS, SPRAY_KERNEL, SPRAY_LEVELS, SPRAY_LIGHT_KERNEL, SPRAY_MAP_KERNEL,
};

use super::plate::PlateOnGpu;
use crate::rain::spray::{SprayFrame, SprayMap};
use crate::spacing::RaySpacing;

/// Pipelines of spray.
#[derive(Clone, Debug)]
pub(super) struct SprayPipeline {
    map: ComputeKernel,
    found: ComputeKernel,
    light: ComputeKernel,
    blend: ComputeKernel,
}

/// Parts of a picture's rain that its spray is seen with.
#[derive(Clone, Copy, Debug)]
pub(super) struct SprayOf<'a> {
    /// The frame of the drops.
    pub(super) drops: &'a wgpu::Buffer,
    /// The streak radiance table.
    pub(super) table: &'a wgpu::Buffer,
    /// The frame of the medium.
    pub(super) medium: &'a wgpu::Buffer,
    /// Its phase functions.
    pub(super) phase: &'a wgpu::Buffer,
    /// The rain of each pixel.
    pub(super) layer: &'a wgpu::Buffer,
}

/// The spray of a picture, ready to be drawn.
#[derive(Debug)]
pub(super) struct SprayPass {
    kernels: [ComputeKernel; 4],
    bindings: [wgpu::BindGroup; 4],
    groups: [u32; 3],
    groups_of_light: [u32; 3],
    map: wgpu::Buffer,
    found: wgpu::Buffer,
}

impl SprayPipeline {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            map: kernel(&SPRAY_MAP_KERNEL)?,
            found: kernel(&SPRAY_KERNEL)?,
            light: kernel(&SPRAY_LIGHT_KERNEL)?,
            blend: kernel(&SPRAY_BLEND_KERNEL)?,
        })
    }

    /// Makes ready to put spray behind the rain of a picture of columns and rows.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        [width, height]: [u32; 2],
        plate: &PlateOnGpu<'_>,
        (frame, rays): (&SprayFrame, RaySpacing),
        of: SprayOf<'_>,
    ) -> Result<SprayPass, GpuError> {
        let storage = wgpu::BufferUsages::STORAGE;
        let map = buffers.buffer("heights under spray", u64::from(SprayMap::len()) * 4, storage)?;
        let pixels = u64::from(width) * u64::from(height);
        let found = buffers.buffer("spray", pixels * 32, storage)?;
        let frame = buffers.uniform("spray frame", &frame.with_rays(rays))?;
        let numbered = || (0u32..).zip(&plate.lighting.buffers);
        let picture = &plate.lighting.buffers[0];
        let bindings = [
            self.map.bind_at(buffers, numbered().chain([(8, &map), (10, &frame)]))?,
            self.found.bind_at(
                buffers,
                [(0, picture), (6, plate.pixels), (7, &map), (8, &found), (9, of.medium), (10, &frame)],
            )?,
            self.light.bind_at(buffers, numbered().chain([(7, of.phase), (8, &found), (9, of.medium)]))?,
            self.blend.bind_at(
                buffers,
                [
                    (0, of.drops),
                    (1, plate.environment),
                    (2, &found),
                    (3, of.layer),
                    (7, of.table),
                    (9, of.medium),
                    (10, &frame),
                ],
            )?,
        ];
        Ok(SprayPass {
            kernels: [self.map.clone(), self.found.clone(), self.light.clone(), self.blend.clone()],
            bindings,
            groups: [width.div_ceil(8), height.div_ceil(8), 1],
            groups_of_light: rays.workgroups([width, height]),
            map,
            found,
        })
    }
}

impl SprayPass {
    /// The map of heights, what is found in it, its light, and its place behind the rain, in this order.
    pub(super) fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let groups =
            [[SPRAY_CELLS, SPRAY_CELLS, SPRAY_LEVELS], self.groups, self.groups_of_light, self.groups];
        let all = self.kernels.iter().zip(&self.bindings).zip(groups);
        all.map(|((kernel, bindings), groups)| kernel.dispatch(bindings, groups)).collect()
    }

    /// The map of heights, and what was found before each pixel.
    pub(super) fn made(&self) -> [&wgpu::Buffer; 2] {
        [&self.map, &self.found]
    }
}
