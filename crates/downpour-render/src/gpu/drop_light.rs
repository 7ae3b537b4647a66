//! Light of lamps on drops on a GPU: what [`DropLights::light`] makes on the CPU.

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::drop_light::DROP_LIGHT_KERNEL;

use super::plate::LightingOnGpu;
use crate::rain::light::{DropLightTable, DropLights};

/// The pipeline of the light on drops: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct DropLightPipeline {
    gpu: Gpu,
    kernel: ComputeKernel,
}

/// The table on the device.
#[derive(Clone, Debug)]
pub struct DropLightOnGpu {
    table: wgpu::Buffer,
}

/// The light on the drops of a picture, ready to be worked out.
#[derive(Debug)]
pub struct DropLightPass<'a> {
    pipeline: &'a DropLightPipeline,
    parts: Vec<wgpu::BindGroup>,
    groups: u32,
    rows: usize,
    light: wgpu::Buffer,
}

impl DropLightPipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), kernel: ComputeKernel::new(gpu, &DROP_LIGHT_KERNEL, &[])? })
    }

    /// Brings the table to the device.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn upload(&self, table: &DropLightTable) -> Result<DropLightOnGpu, GpuError> {
        Ok(DropLightOnGpu { table: self.gpu.storage_buffer("scattering of drops", table.rows())? })
    }

    /// Makes ready to light drops ([`drop_light_rows`](crate::rain::light::drop_light_rows)). `lighting` is that of
    /// `lights`.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if there are more drops than the device takes, or what else the GPU says.
    pub fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        lighting: &LightingOnGpu,
        table: &DropLightOnGpu,
        lights: &DropLights<'_>,
        drops: &[[f32; 4]],
    ) -> Result<DropLightPass<'a>, GpuError> {
        let list = buffers.storage("positions of drops", drops)?;
        self.prepare_rows(buffers, lighting, table, lights, &list, lights.count(drops) as u32)
    }

    /// Makes ready to light `count` drops whose rows are on the device; rows without a radius are passed over.
    ///
    /// # Errors
    /// As [`DropLightPipeline::prepare`].
    pub fn prepare_rows<'a>(
        &'a self,
        buffers: &impl BufferSource,
        lighting: &LightingOnGpu,
        table: &DropLightOnGpu,
        lights: &DropLights<'_>,
        drops: &wgpu::Buffer,
        count: u32,
    ) -> Result<DropLightPass<'a>, GpuError> {
        let rows = count as usize * lights.stride();
        let light = buffers.buffer("light on drops", rows.max(1) as u64 * 16, wgpu::BufferUsages::STORAGE)?;
        let mut parts = Vec::new();
        for part in lights.frames(count) {
            let part = buffers.uniform("lamps", &part)?;
            let own = [drops, &table.table, &light, &part];
            let bound: Vec<_> = lighting.buffers.iter().chain(own).collect();
            parts.push(self.kernel.bind(buffers, &bound)?);
        }
        let groups = count.div_ceil(64).max(1);
        Ok(DropLightPass { pipeline: self, parts, groups, rows, light })
    }
}

impl DropLightPass<'_> {
    /// The dispatches, a part of the lamps each, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let kernel = &self.pipeline.kernel;
        self.parts.iter().map(|bindings| kernel.dispatch(bindings, [self.groups, 1, 1])).collect()
    }

    /// The light on the device, laid out as by [`DropLights::light`]; one row of nothing if there are no drops.
    #[must_use]
    pub fn light(&self) -> &wgpu::Buffer {
        &self.light
    }

    /// Reads the light.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn read(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let mut light = self.pipeline.gpu.read(&self.light)?;
        light.truncate(self.rows);
        Ok(light)
    }
}
