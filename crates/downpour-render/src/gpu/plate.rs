//! A plate on the device.

use downpour_gpu::wgpu;

/// Buffers of the lamps and obstacles of a plate: bindings 0 to 5 of the kernels that ask for them, in the layout of
/// `shaders/wgsl/render/data.wgsl`. Rain hands them on and does not look into them.
#[derive(Clone, Debug)]
pub struct LightingOnGpu {
    /// The buffers, in the order of their bindings; the first is a uniform, the frame of the picture.
    pub buffers: [wgpu::Buffer; 6],
}

/// A picture without rain on the device: [`Plate`](crate::plate::Plate).
#[derive(Clone, Copy, Debug)]
pub struct PlateOnGpu<'a> {
    /// Radiance and distance of each pixel, rows from the top.
    pub pixels: &'a wgpu::Buffer,
    /// The environment map, with room for all levels ([`RainPipeline::environment`](super::RainPipeline::environment)); the
    /// finest is filled in before [`RainPass::environment`](super::RainPass::environment).
    pub environment: &'a wgpu::Buffer,
    /// Lamps and obstacles.
    pub lighting: &'a LightingOnGpu,
}
