//! Rainfall as layers of a texture on a GPU: [`layers`](crate::rain::layers).

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::render::layers::LAYERS_KERNEL;

use crate::rain::layers::{LayersFrame, texture_words};

/// Pipeline of layers, and their texture.
#[derive(Clone, Debug)]
pub(super) struct LayersPipeline {
    kernel: ComputeKernel,
    texture: wgpu::Buffer,
}

/// The layers of a picture, ready to be drawn.
#[derive(Debug)]
pub(super) struct LayersPass {
    kernel: ComputeKernel,
    bindings: wgpu::BindGroup,
    groups: [u32; 3],
}

impl LayersPipeline {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let texture = gpu.storage_buffer("texture of layers", texture_words())?;
        Ok(Self { kernel: ComputeKernel::new(gpu, &LAYERS_KERNEL, &[])?, texture })
    }

    /// Makes ready to draw layers before rain. `drops`: the frame of the drops; `capture`: the environment map; `clean`, `rain`: of each
    /// pixel.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        size: [u32; 2],
        frame: &LayersFrame,
        [drops, capture, clean, rain]: [&wgpu::Buffer; 4],
    ) -> Result<LayersPass, GpuError> {
        let frame = buffers.uniform("layers frame", frame)?;
        let bindings = self.kernel.bind(buffers, &[drops, capture, &frame, &self.texture, clean, rain])?;
        let [width, height] = size.map(|pixels| pixels.div_ceil(8));
        Ok(LayersPass { kernel: self.kernel.clone(), bindings, groups: [width, height, 1] })
    }
}

impl LayersPass {
    pub(super) fn dispatch(&self) -> Dispatch<'_> {
        self.kernel.dispatch(&self.bindings, self.groups)
    }
}
