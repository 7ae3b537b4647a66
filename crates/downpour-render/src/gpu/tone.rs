//! A picture to look at, on a GPU: what [`tone_picture`](crate::tone::tone_picture) makes on the CPU.

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::tone::TONE_KERNEL;

use crate::tone::{Tone, ToneEdges, ToneFrame, tone_number};

/// Pipeline of pictures to look at.
#[derive(Clone, Debug)]
pub struct TonePipeline {
    kernel: ComputeKernel,
}

/// Layers of a picture on a device.
#[derive(Clone, Copy, Debug)]
pub struct TonedLayers<'a> {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Radiance and distance of each pixel.
    pub plate: &'a wgpu::Buffer,
    /// Radiance of the rain, and the transmittance of what is behind it.
    pub rain: &'a wgpu::Buffer,
    /// Radiance that glow adds.
    pub glow: Option<&'a wgpu::Buffer>,
}

/// A picture to look at, ready to be made.
#[derive(Debug)]
pub struct TonePass<'a> {
    kernel: &'a ComputeKernel,
    bindings: wgpu::BindGroup,
    groups: [u32; 3],
    target: wgpu::Buffer,
}

impl TonePipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: ComputeKernel::new(gpu, &TONE_KERNEL, &[])? })
    }

    /// Makes ready to make the picture of some layers.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the picture is larger than the device takes, or what else the GPU says.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        layers: TonedLayers<'_>,
        tone: &Tone,
    ) -> Result<TonePass<'_>, GpuError> {
        let [width, height] = layers.size;
        let has_glow = u32::from(layers.glow.is_some());
        let has_edges = u32::from(tone.edges == ToneEdges::ToneAware);
        let (curve, exposure) = (tone_number(tone.curve), tone.exposure);
        let frame = ToneFrame { width, height, curve, exposure, has_glow, has_edges, ..Default::default() };
        let frame = buffers.uniform("tone", &frame)?;
        let bytes = u64::from(width) * u64::from(height) * 4;
        let target = buffers.buffer("display picture", bytes, wgpu::BufferUsages::STORAGE)?;
        // Without glow nothing is read there.
        let glow = layers.glow.unwrap_or(layers.rain);
        let bindings = self.kernel.bind(buffers, &[&frame, layers.plate, layers.rain, glow, &target])?;
        let groups = [width.div_ceil(8), height.div_ceil(8), 1];
        Ok(TonePass { kernel: &self.kernel, bindings, groups, target })
    }
}

impl TonePass<'_> {
    /// The dispatch.
    #[must_use]
    pub fn dispatch(&self) -> Dispatch<'_> {
        self.kernel.dispatch(&self.bindings, self.groups)
    }

    /// Pixels, rows from the top: red, green, blue, alpha of 8 bits each, red lowest.
    #[must_use]
    pub fn target(&self) -> &wgpu::Buffer {
        &self.target
    }
}
