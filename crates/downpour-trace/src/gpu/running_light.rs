//! The light of live frames on a GPU: [`running_light`](crate::running_light).

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::scene::RUNNING_LIGHT_KERNEL;

use super::temporal::LightOnGpu;
use crate::data::RenderFrame;
use crate::running_light::{RunningMean, no_frame_before};
use crate::temporal::TemporalFrame;

/// Label of the buffers of running means, which the next frame reads.
pub(super) const RUNNING_MEANS: &str = "running means of light";

/// Pipeline of running means.
#[derive(Clone, Debug)]
pub struct RunningLightPipeline {
    kernel: ComputeKernel,
}

/// What a frame has left on the device for the one after it.
#[derive(Clone, Debug)]
pub struct RunningOnGpu {
    /// Light that the rays of each pixel have found, with its positions.
    pub ambient: wgpu::Buffer,
    /// Running means.
    pub means: wgpu::Buffer,
}

/// A frame, ready to be taken into the running means.
#[derive(Debug)]
pub struct RunningLightPass<'a> {
    kernel: &'a ComputeKernel,
    bound: wgpu::BindGroup,
    groups: [u32; 3],
    means: wgpu::Buffer,
}

impl RunningLightPipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: ComputeKernel::new(gpu, &RUNNING_LIGHT_KERNEL, &[])? })
    }

    /// Prepares the running means of a frame's light and of that of the frame before; what they change is added to its picture.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        frame: &RenderFrame,
        own: &LightOnGpu,
        before: Option<(TemporalFrame, &RunningOnGpu)>,
        picture: &wgpu::Buffer,
    ) -> Result<RunningLightPass<'_>, GpuError> {
        let [width, height] = frame.camera.size();
        let pixels = u64::from(width) * u64::from(height);
        let uniform = buffers.uniform("frame", frame)?;
        let bytes = pixels * 2 * size_of::<RunningMean>() as u64;
        let means = buffers.buffer(RUNNING_MEANS, bytes, wgpu::BufferUsages::STORAGE)?;
        // The first frame reads nothing of what stands in place of the one before it.
        let (at, ambient, means_before) = match &before {
            Some((at, before)) => (*at, &before.ambient, &before.means),
            None => (no_frame_before(frame), &own.ambient, &own.ambient),
        };
        let at = buffers.uniform("frame before", &at)?;
        let of_frame = [(0, &uniform), (1, &own.ambient), (2, &own.means), (4, picture)];
        let of_before = [(5, &at), (6, ambient), (10, means_before), (11, &means)];
        let bound = self.kernel.bind_at(buffers, of_frame.into_iter().chain(of_before))?;
        Ok(RunningLightPass {
            kernel: &self.kernel,
            bound,
            groups: [width.div_ceil(8), height.div_ceil(8), 1],
            means,
        })
    }
}

impl RunningLightPass<'_> {
    /// The dispatch.
    #[must_use]
    pub fn dispatch(&self) -> Dispatch<'_> {
        self.kernel.dispatch(&self.bound, self.groups)
    }

    /// The running means that it makes.
    #[must_use]
    pub fn means(&self) -> &wgpu::Buffer {
        &self.means
    }
}
