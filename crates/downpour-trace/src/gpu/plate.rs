//! The plate of a scene on the device, for rain.

use std::ops::Range;

use downpour_gpu::{BufferSource, Dispatch, GpuError, wgpu};
use downpour_render::gpu::{LightingOnGpu, PlateOnGpu, RainPass, RainPipeline};
use downpour_render::rain::Rain;

use super::scene::{RayBuffers, SceneOnGpu, ScenePipeline, SceneRays};
use crate::capture::environment_frame;
use crate::data::RenderFrame;
use crate::trace::TraceAmbient;

/// Environment map, lamps and obstacles of a scene, on the device, for rain.
#[derive(Debug)]
pub struct ScenePlate<'a> {
    /// Rows of the finest level of the environment map that are to be traced; none if it is there already.
    finest: Vec<SceneRays<'a>>,
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
        let all = std::iter::once(0..rain.environment.size).collect();
        self.plate_around(buffers, scene, frame, rain, (rains.environment(buffers, rain)?, all))
    }

    /// The same with an environment map in a buffer, of which these rows are to be traced: whole workgroups.
    pub(super) fn plate_around(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        rain: &Rain,
        (environment, traced): (wgpu::Buffer, Vec<Range<u32>>),
    ) -> Result<ScenePlate<'_>, GpuError> {
        let of_map = environment_frame(frame, &rain.environment);
        // An environment map has no filter: nothing is written there.
        let nothing = buffers.storage("no light of the sky", &[TraceAmbient::default()])?;
        let nothing_else = buffers.storage("no light of other surfaces", &[TraceAmbient::default()])?;
        let width = of_map.camera.width;
        let traced: Vec<_> = traced.into_iter().flat_map(|rows| self.parts(rows, width)).collect();
        let most = traced.iter().map(|rows| rows.len() as u32).max().unwrap_or(0);
        let states = if most > 0 { self.states(buffers, &of_map.camera, most)? } else { None };
        let to = [&environment, &nothing, &nothing_else];
        let of_rays = RayBuffers { reflections: None, to, states: states.as_ref() };
        let mut finest = Vec::new();
        for rows in traced {
            let of_rows = RenderFrame { first_row: rows.start, ..of_map };
            finest.push(self.rays(buffers, scene, &of_rows, of_rays, rows.len() as u32)?);
        }
        let lighting = scene.lighting(buffers, frame)?;
        Ok(ScenePlate { finest, environment, lighting })
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

    /// Dispatches that trace what is to be traced of the environment map, and make its coarser levels; none if it is there already.
    #[must_use]
    pub fn dispatches<'a>(&'a self, pass: &'a RainPass<'_>) -> Vec<Dispatch<'a>> {
        let finest = self.finest();
        if finest.is_empty() { finest } else { [finest, pass.environment()].concat() }
    }

    /// Those of the finest level alone.
    pub(super) fn finest(&self) -> Vec<Dispatch<'_>> {
        self.finest.iter().flat_map(SceneRays::dispatches).collect()
    }
}
