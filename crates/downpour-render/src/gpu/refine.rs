//! Means of pictures on a GPU: [`refine`](crate::refine).

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::refine::REFINE_KERNEL;

/// Pipeline of means of pictures.
#[derive(Clone, Debug)]
pub struct RefinePipeline {
    kernel: ComputeKernel,
}

/// A picture more in a mean, ready to be taken.
#[derive(Debug)]
pub struct RefinePass<'a> {
    kernel: &'a ComputeKernel,
    bindings: wgpu::BindGroup,
    groups: [u32; 3],
}

impl RefinePipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: ComputeKernel::new(gpu, &REFINE_KERNEL, &[])? })
    }

    /// Makes ready to take a picture of `size` columns and rows into a mean, as its `count`-th from 1 on.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        size: [u32; 2],
        count: u32,
        next: &wgpu::Buffer,
        mean: &wgpu::Buffer,
    ) -> Result<RefinePass<'_>, GpuError> {
        let [width, height] = size;
        let frame = buffers.uniform("mean of pictures", &[width, height, count, 0])?;
        let bindings = self.kernel.bind(buffers, &[&frame, next, mean])?;
        Ok(RefinePass { kernel: &self.kernel, bindings, groups: [width.div_ceil(8), height.div_ceil(8), 1] })
    }
}

impl RefinePass<'_> {
    /// The dispatch.
    #[must_use]
    pub fn dispatch(&self) -> Dispatch<'_> {
        self.kernel.dispatch(&self.bindings, self.groups)
    }
}
