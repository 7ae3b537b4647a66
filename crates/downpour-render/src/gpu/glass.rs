//! A picture through a pane of glass, on a GPU.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, wgpu};
use downpour_shaders::render::glass::GLASS_PICTURE_KERNEL;

use crate::glass::{GlassPicture, GlassPictureFrame};

/// Samples of a dispatch, at most: a submission must stay far below the time after which a driver resets.
const SAMPLES_PER_DISPATCH: u32 = 1 << 22;

/// The pipeline of a pane: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct GlassRenderer {
    gpu: Gpu,
    kernel: ComputeKernel,
}

impl GlassRenderer {
    /// Makes the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), kernel: ComputeKernel::new(gpu, &GLASS_PICTURE_KERNEL, &[])? })
    }

    /// The picture through the pane: what [`GlassPicture::through`] makes on the CPU.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if a buffer is larger than the device allows, or what else the GPU says.
    pub fn through(
        &self,
        glass: &GlassPicture,
        behind: &[[f32; 4]],
        capture: &[[f32; 4]],
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let gpu = &self.gpu;
        let frame = &glass.frame;
        let drops = gpu.storage_buffer("drops on glass", &glass.drops)?;
        let bins = gpu.storage_buffer("bins of drops on glass", &glass.bins)?;
        let wet = gpu.storage_buffer("wetness of glass", &glass.wet)?;
        let lens = gpu.storage_buffer("places of the lens", &glass.lens)?;
        let lights = gpu.storage_buffer("lamps before glass", &glass.lights)?;
        let behind = gpu.storage_buffer("picture behind glass", &glass.levelled(behind))?;
        let capture = gpu.storage_buffer("capture round the eye", capture)?;
        let pixels = u64::from(frame.camera.width) * u64::from(frame.camera.height);
        let made = gpu.empty_buffer("picture through glass", pixels * 16, wgpu::BufferUsages::STORAGE)?;
        let row = frame.camera.width.max(1).saturating_mul(frame.samples.max(1));
        let rows = (SAMPLES_PER_DISPATCH / row).max(8).next_multiple_of(8);
        for first_row in (0..frame.camera.height).step_by(rows as usize) {
            let band = GlassPictureFrame { first_row, ..*frame };
            let uniform = gpu.uniform_buffer("glass picture frame", &band)?;
            let buffers = [&uniform, &drops, &bins, &wet, &lens, &behind, &capture, &made, &lights];
            let bindings = self.kernel.bind(gpu, &buffers)?;
            let groups =
                [frame.camera.width.div_ceil(8), rows.min(frame.camera.height - first_row).div_ceil(8), 1];
            gpu.submit(&[self.kernel.dispatch(&bindings, groups)])?;
            // One submission at a time: software drivers queue without end.
            gpu.wait()?;
        }
        Ok(gpu.read::<[f32; 4]>(&made)?.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    }
}
