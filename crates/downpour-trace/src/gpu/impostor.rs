//! The reflection buffer on a GPU: [`impostor`](crate::impostor).

use std::sync::OnceLock;

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, made_once, wgpu};
use downpour_shaders::render::impostor::{IMPOSTOR_BLUR_KERNEL, IMPOSTOR_DRAW_KERNEL};

use crate::data::{RenderFrame, SceneData};
use crate::impostor::blur::pass_count;

/// Pipelines that draw the buffer, made for the first scene that has one.
#[derive(Clone, Debug, Default)]
pub struct ImpostorPipeline {
    kernels: OnceLock<[ComputeKernel; 2]>,
}

/// The buffer of a frame, ready to be drawn.
#[derive(Debug)]
pub struct ImpostorPass<'a> {
    turns: Vec<(&'a ComputeKernel, wgpu::BindGroup)>,
    groups: [u32; 3],
    drawn: wgpu::Buffer,
}

impl ImpostorPipeline {
    /// Prepares the buffer of a frame; `None` if reflections are found by rays.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        buffers: &impl BufferSource,
        scene: &SceneData,
        frame: &RenderFrame,
    ) -> Result<Option<ImpostorPass<'_>>, GpuError> {
        let Some(impostors) = scene.impostors.as_ref().filter(|_| frame.impostors > 0) else {
            return Ok(None);
        };
        let [draw, blur] = made_once(&self.kernels, || {
            Ok::<_, GpuError>([
                ComputeKernel::new(gpu, &IMPOSTOR_DRAW_KERNEL, &[])?,
                ComputeKernel::new(gpu, &IMPOSTOR_BLUR_KERNEL, &[])?,
            ])
        })?;
        let [width, height] = frame.camera.size().map(|edge| edge.div_ceil(2));
        let bytes = u64::from(width) * u64::from(height) * 8;
        let mut drawn = buffers.buffer("reflection buffer", bytes, wgpu::BufferUsages::STORAGE)?;
        let mut blurred = buffers.buffer("reflection buffer, blurred", bytes, wgpu::BufferUsages::STORAGE)?;
        let list = buffers.storage("billboards", &impostors.rows())?;
        let uniform = buffers.uniform("frame", frame)?;
        let mut turns = vec![(draw, draw.bind_at(buffers, [(0, &uniform), (1, &list), (2, &drawn)])?)];
        for turn in 0..pass_count(&frame.camera) {
            let uniform = buffers.uniform("frame", &RenderFrame { turn, ..*frame })?;
            turns.push((blur, blur.bind_at(buffers, [(0, &uniform), (1, &drawn), (2, &blurred)])?));
            std::mem::swap(&mut drawn, &mut blurred);
        }
        Ok(Some(ImpostorPass { turns, groups: [width.div_ceil(8), height.div_ceil(8), 1], drawn }))
    }
}

impl ImpostorPass<'_> {
    /// The dispatches, in their order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        self.turns.iter().map(|(kernel, bound)| kernel.dispatch(bound, self.groups)).collect()
    }

    /// The buffer: [`SceneView::mirrored_picture`](crate::scene::SceneView::mirrored_picture).
    #[must_use]
    pub fn drawn(&self) -> &wgpu::Buffer {
        &self.drawn
    }
}
