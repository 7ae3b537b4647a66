//! The plate of a scene on the device, for rain.

use downpour_gpu::{BufferSource, Dispatch, GpuError, wgpu};
use downpour_render::gpu::{LightingOnGpu, PlateOnGpu, RainPass, RainPipeline};
use downpour_render::rain::Rain;

use super::scene::{SceneOnGpu, ScenePipeline, SceneRays};
use crate::capture::environment_frame;
use crate::data::RenderFrame;
use crate::trace::TraceAmbient;

/// Environment map, lamps and obstacles of a scene, on the device, for rain.
#[derive(Debug)]
pub struct ScenePlate<'a> {
    finest: SceneRays<'a>,
    /// True if the environment map is there already.
    is_kept: bool,
    environment: wgpu::Buffer,
    lighting: LightingOnGpu,
}

impl ScenePipeline {
    /// Prepares what `rain` needs of a scene besides its picture, with buffers from `buffers`; `frame` is that of the picture.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn plate(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        rains: &RainPipeline,
        rain: &Rain,
    ) -> Result<ScenePlate<'_>, GpuError> {
        self.plate_around(buffers, scene, frame, rain, (rains.environment(buffers, rain)?, false))
    }

    /// The same with an environment map, which is there already or is to be traced into this buffer.
    pub(super) fn plate_around(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        rain: &Rain,
        (environment, is_kept): (wgpu::Buffer, bool),
    ) -> Result<ScenePlate<'_>, GpuError> {
        let of_map = environment_frame(frame, &rain.environment);
        // An environment map has no filter: nothing is written there.
        let nothing = buffers.storage("no light of the sky", &[TraceAmbient::default()])?;
        let rows = of_map.camera.height;
        let states = self.states(buffers, &of_map.camera, rows)?;
        let finest = self.rays(buffers, scene, &of_map, [&environment, &nothing], states.as_ref(), rows)?;
        let lighting = scene.lighting(buffers, frame)?;
        Ok(ScenePlate { finest, is_kept, environment, lighting })
    }
}

impl ScenePlate<'_> {
    /// The plate with the scene's picture: radiance and distance of each pixel.
    #[must_use]
    pub fn of<'a>(&'a self, pixels: &'a wgpu::Buffer) -> PlateOnGpu<'a> {
        PlateOnGpu { pixels, environment: &self.environment, lighting: &self.lighting }
    }

    /// Lamps and obstacles.
    pub(super) fn lighting(&self) -> &LightingOnGpu {
        &self.lighting
    }

    /// Dispatches that trace the environment map, with its coarser levels; none if it is there already.
    #[must_use]
    pub fn dispatches<'a>(&'a self, pass: &'a RainPass<'_>) -> Vec<Dispatch<'a>> {
        if self.is_kept {
            return Vec::new();
        }
        self.finest.dispatches().chain(pass.environment()).collect()
    }
}
