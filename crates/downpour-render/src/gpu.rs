//! The picture of a scene on a GPU: the same rays, the same buffers.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::render::scene::SCENE_KERNEL;

use crate::data::{RenderFrame, SceneData};

/// Most pixels of a dispatch: a submission must stay far below the time after which a driver resets.
const PIXELS_PER_DISPATCH: u32 = 1 << 17;

/// The pipeline of the scene: made once, used for any number of scenes.
#[derive(Clone, Debug)]
pub struct ScenePipeline {
    gpu: Gpu,
    kernel: ComputeKernel,
}

/// A scene on the device.
#[derive(Clone, Debug)]
pub struct SceneOnGpu {
    nodes: wgpu::Buffer,
    triangles: wgpu::Buffer,
    corners: wgpu::Buffer,
    table: wgpu::Buffer,
    texels: wgpu::Buffer,
    sky: wgpu::Buffer,
}

impl ScenePipeline {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), kernel: ComputeKernel::new(gpu, &SCENE_KERNEL, &[])? })
    }

    /// Brings a scene to the device.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if a buffer is larger than the device allows, or what else the GPU says.
    pub fn upload(&self, scene: &SceneData) -> Result<SceneOnGpu, GpuError> {
        Ok(SceneOnGpu {
            nodes: self.gpu.storage_buffer("scene nodes", &scene.nodes)?,
            triangles: self.gpu.storage_buffer("scene triangles", &scene.triangles)?,
            corners: self.gpu.storage_buffer("scene corners", &scene.corners)?,
            table: self.gpu.storage_buffer("scene table", &scene.table)?,
            texels: self.gpu.storage_buffer("scene texels", &scene.texels)?,
            sky: self.gpu.storage_buffer("scene sky", &scene.sky)?,
        })
    }

    /// The picture of a frame: radiance and nearest distance, rows from the top. What
    /// [`SceneView::picture`](crate::scene::SceneView::picture) makes on the CPU.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn picture(&self, scene: &SceneOnGpu, frame: &RenderFrame) -> Result<Vec<[f32; 4]>, GpuError> {
        let pixels = u64::from(frame.width) * u64::from(frame.height);
        let picture = self.gpu.empty_buffer("picture", pixels * 16, wgpu::BufferUsages::STORAGE)?;
        let rows = (PIXELS_PER_DISPATCH / frame.width.max(1)).max(8).next_multiple_of(8);
        for first_row in (0..frame.height).step_by(rows as usize) {
            let uniform = self.gpu.uniform_buffer("frame", &RenderFrame { first_row, ..*frame })?;
            let buffers = [
                &uniform,
                &scene.nodes,
                &scene.triangles,
                &scene.corners,
                &scene.table,
                &scene.texels,
                &scene.sky,
                &picture,
            ];
            let bindings = self.kernel.bind(&self.gpu, &buffers)?;
            let groups = [frame.width.div_ceil(8), rows.min(frame.height - first_row).div_ceil(8), 1];
            self.gpu.submit(&[self.kernel.dispatch(&bindings, groups)])?;
            // One submission at a time: software drivers queue without end.
            self.gpu.wait()?;
        }
        self.gpu.read(&picture)
    }
}
