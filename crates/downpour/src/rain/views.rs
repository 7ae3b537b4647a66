//! Views of a host's textures: wgpu tells nothing of a view, so that they are tried before the host's encoder has them.

use std::hash::{DefaultHasher, Hash, Hasher};

use downpour_gpu::wgpu::{self, CommandEncoderDescriptor, RenderPassDescriptor};
use downpour_gpu::{Gpu, GpuError};

use super::{PlateTextures, RainError};

/// Mark of the views that were tried last. It keeps none of them alive: a view of a swapchain must not outlive its frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TriedViews(Option<u64>);

impl TriedViews {
    fn of(textures: &PlateTextures<'_>) -> Self {
        let mut hasher = DefaultHasher::new();
        (textures.color, textures.depth).hash(&mut hasher);
        Self(Some(hasher.finish()))
    }

    /// Tries the views unless they are those of the last frame: in an encoder of their own, which is not submitted, so that a view that does
    /// not fit is an error here and not one of the host's encoder.
    ///
    /// # Errors
    /// [`RainError::View`], or what the GPU says.
    pub(super) fn check(
        &mut self,
        gpu: &Gpu,
        blend: &wgpu::RenderPipeline,
        textures: &PlateTextures<'_>,
        size: [u32; 2],
    ) -> Result<(), RainError> {
        let tried = Self::of(textures);
        if *self == tried {
            return Ok(());
        }
        let color = wgpu::RenderPassColorAttachment {
            view: textures.color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let color_attachments = [Some(color)];
        let of_color =
            RenderPassDescriptor { color_attachments: &color_attachments, ..RenderPassDescriptor::default() };
        try_pass(gpu, "color texture", &of_color, Some(blend), size)?;
        // A depth texture of one level has no view of another size.
        if textures.depth.texture().mip_level_count() > 1 {
            let depth = wgpu::RenderPassDepthStencilAttachment {
                view: textures.depth,
                depth_ops: None,
                stencil_ops: None,
            };
            let of_depth = RenderPassDescriptor {
                depth_stencil_attachment: Some(depth),
                ..RenderPassDescriptor::default()
            };
            try_pass(gpu, "depth texture", &of_depth, None, size)?;
        }
        *self = tried;
        Ok(())
    }
}

/// Records and ends a pass over a whole picture. The pipeline wants the texture's format, and the scissors its size.
fn try_pass(
    gpu: &Gpu,
    what: &'static str,
    descriptor: &RenderPassDescriptor<'_>,
    pipeline: Option<&wgpu::RenderPipeline>,
    [width, height]: [u32; 2],
) -> Result<(), RainError> {
    let tried = gpu.create("a view of a texture", 0, |device| {
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_render_pass(descriptor);
        if let Some(pipeline) = pipeline {
            pass.set_pipeline(pipeline);
        }
        pass.set_scissor_rect(0, 0, width, height);
        drop(pass);
        drop(encoder.finish());
    });
    tried.map_err(|error| match error {
        GpuError::Refused { reason, .. } => RainError::View { what, reason },
        error => error.into(),
    })
}
