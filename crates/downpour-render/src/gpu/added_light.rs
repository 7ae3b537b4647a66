//! A picture of a scene in other light, added to one on a GPU: what [`Picture::add_light`](crate::picture::Picture::add_light) does on the CPU.

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::rain::COMPOSE_LIT_KERNEL;

use super::TonedLayers;

/// Pipeline that adds pictures.
#[derive(Clone, Debug)]
pub struct AddedLightPipeline {
    kernel: ComputeKernel,
}

/// A picture that is added, ready to be.
#[derive(Debug)]
pub struct AddedLightPass<'a> {
    kernel: &'a ComputeKernel,
    bindings: wgpu::BindGroup,
    groups: [u32; 3],
}

impl AddedLightPipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: ComputeKernel::new(gpu, &COMPOSE_LIT_KERNEL, &[])? })
    }

    /// Makes ready to add all that is seen of `light` to the radiance of the rain of a picture of its size.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        light: TonedLayers<'_>,
        rain: &wgpu::Buffer,
    ) -> Result<AddedLightPass<'_>, GpuError> {
        let [width, height] = light.size;
        let size = buffers.uniform("size", &[width, height, u32::from(light.glow.is_some()), 0])?;
        // Without glow nothing is read there.
        let glow = light.glow.unwrap_or(light.rain);
        let bindings = self.kernel.bind(buffers, &[&size, light.plate, light.rain, rain, glow])?;
        let groups = [width.div_ceil(8), height.div_ceil(8), 1];
        Ok(AddedLightPass { kernel: &self.kernel, bindings, groups })
    }
}

impl AddedLightPass<'_> {
    /// The dispatch.
    #[must_use]
    pub fn dispatch(&self) -> Dispatch<'_> {
        self.kernel.dispatch(&self.bindings, self.groups)
    }
}
