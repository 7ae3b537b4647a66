//! The light of the frames of a clip on a GPU: [`temporal`](crate::temporal).

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::scene::TEMPORAL_KERNEL;

use crate::data::RenderFrame;
use crate::temporal::TemporalFrame;

/// Pipeline that averages light over frames.
#[derive(Clone, Debug)]
pub struct TemporalPipeline {
    kernel: ComputeKernel,
}

/// Light of sky and surfaces that a frame has found, on the device.
#[derive(Clone, Debug)]
pub struct LightOnGpu {
    /// Light that the rays of each pixel have found.
    pub ambient: wgpu::Buffer,
    /// Means of it over neighbors.
    pub means: wgpu::Buffer,
}

/// The frames before a frame, ready to be added.
#[derive(Debug)]
pub struct TemporalPass<'a> {
    kernel: &'a ComputeKernel,
    bound: Vec<wgpu::BindGroup>,
    groups: [u32; 3],
}

impl TemporalPipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: ComputeKernel::new(gpu, &TEMPORAL_KERNEL, &[])? })
    }

    /// Prepares the average of a frame's light with that of frames before it; what that changes is added to its picture.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        frame: &RenderFrame,
        own: &LightOnGpu,
        before: &[(TemporalFrame, &LightOnGpu)],
        picture: &wgpu::Buffer,
    ) -> Result<TemporalPass<'_>, GpuError> {
        let [width, height] = frame.camera.size();
        let pixels = u64::from(width) * u64::from(height);
        let uniform = buffers.uniform("frame", frame)?;
        let sums = buffers.buffer("sums of light", pixels * 32, wgpu::BufferUsages::STORAGE)?;
        let bound = before.iter().map(|(at, light)| {
            let at = buffers.uniform("frame before", at)?;
            let of_frame = [(0, &uniform), (1, &own.ambient), (2, &own.means), (4, picture)];
            let of_before = [(5, &at), (6, &light.ambient), (7, &light.means), (8, &sums)];
            self.kernel.bind_at(buffers, of_frame.into_iter().chain(of_before))
        });
        Ok(TemporalPass {
            kernel: &self.kernel,
            bound: bound.collect::<Result<_, _>>()?,
            groups: [width.div_ceil(8), height.div_ceil(8), 1],
        })
    }
}

impl TemporalPass<'_> {
    /// The dispatches, one for each frame.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        self.bound.iter().map(|bound| self.kernel.dispatch(bound, self.groups)).collect()
    }
}
