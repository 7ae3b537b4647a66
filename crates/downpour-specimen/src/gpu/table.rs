//! The streak of a specimen by the table of the renderer of rain, on a GPU.

use downpour_drop::DropShape;
use downpour_gpu::{Gpu, GpuError};

use super::GpuSpecimenError;
use crate::options::SpecimenOptions;
use crate::render::empty;
use crate::table::table_streaks;
use crate::{Image, Sky};
use downpour_render::gpu::RainPipeline;
use downpour_trace::gpu::ScenePipeline;

/// The pipelines of a streak by the table: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct SpecimenTableRenderer {
    gpu: Gpu,
    scenes: ScenePipeline,
    rains: RainPipeline,
}

impl SpecimenTableRenderer {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// [`GpuError`] of the device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { gpu: gpu.clone(), scenes: ScenePipeline::new(gpu)?, rains: RainPipeline::new(gpu)? })
    }

    /// Renders a streak, as [`render_specimen_table`](crate::render_specimen_table) does on the CPU. The
    /// background, a few lookups for each pixel, is computed there.
    ///
    /// # Errors
    /// [`GpuSpecimenError::Specimen`] as there, else the error of the device: a sky map needs 16 bytes per texel in one buffer.
    pub fn render(
        &self,
        shape: &DropShape,
        options: &SpecimenOptions,
        sky: Sky<'_>,
    ) -> Result<Image, GpuSpecimenError> {
        let mut image = empty(options);
        for streak in table_streaks(shape, options, sky)? {
            let (scene, masks) = (self.scenes.upload(&streak.scene)?, self.rains.upload(&streak.masks)?);
            let clean = self.gpu.storage_buffer("background of a streak", &streak.clean)?;
            let view = streak.view();
            let lights = [streak.lights(&view)?, streak.streak_lights(&view)?];
            let plate = self.scenes.plate(&self.gpu, &scene, &streak.frame, &self.rains, &streak.rain)?;
            let pass = self.rains.prepare(&self.gpu, &plate.of(&clean), &masks, &streak.rain, &lights)?;
            let environment = plate.dispatches(&pass);
            let binning = pass.binning().concat();
            for dispatches in [environment, binning, pass.lamps(), pass.streaks(), pass.drops()] {
                self.gpu.submit(&dispatches)?;
                // One submission at a time: software drivers queue without end.
                self.gpu.wait()?;
            }
            streak.show(&pass.layer()?, &mut image);
        }
        Ok(image)
    }
}
