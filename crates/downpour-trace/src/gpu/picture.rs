//! A whole picture on a GPU.

use std::sync::{Arc, Mutex, PoisonError};

use downpour_gpu::{BufferPool, BufferSource as _, Gpu, GpuError, wgpu};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_RAYS;
use downpour_sim::field::{EyeDrop, FallingDrop};
use rayon::prelude::*;

use downpour_render::RenderError;
use downpour_render::camera::Viewpoint;
use downpour_render::gpu::{BehindGlass, FallingOnGpu, RainOnGpu, RainPipeline};
use downpour_render::picture::{Picture, PictureOptions, timed};
use downpour_render::rain::{DropMasks, Rain};

use super::scene::{SceneOnGpu, ScenePipeline};
use crate::data::{RenderFrame, SceneData};
use crate::picture::picture_frame;
use crate::scene::SceneView;

/// Error of a picture on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuPictureError {
    /// The picture is invalid.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Labels of the buffers that a picture keeps.
const GIVEN_AWAY: [&str; 2] = ["rain", "distances of drops"];

/// Pipelines that render pictures.
#[derive(Clone, Debug)]
pub struct PictureRenderer {
    gpu: Gpu,
    scene: ScenePipeline,
    rain: RainPipeline,
    /// Locked for as long as a picture is drawn.
    pool: Arc<Mutex<BufferPool>>,
    /// The scene and the masks of the last picture.
    uploaded: Arc<Mutex<Option<(SceneOnGpu, RainOnGpu)>>>,
}

impl PictureRenderer {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuPictureError> {
        Ok(Self {
            gpu: gpu.clone(),
            scene: ScenePipeline::new(gpu)?,
            rain: RainPipeline::new(gpu)?,
            // A picture may be read after the next one is begun.
            pool: Arc::new(Mutex::new(BufferPool::new(gpu).with_given_away(&GIVEN_AWAY))),
            uploaded: Arc::default(),
        })
    }

    /// Renders a picture, as [`render_picture`](crate::picture::render_picture) does on the CPU.
    ///
    /// # Errors
    /// [`GpuPictureError`] if the options cannot be met, or what the GPU says.
    pub fn render(
        &self,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<Picture, GpuPictureError> {
        Ok(self.draw(scene, viewpoint, drops, masks, options)?.read()?)
    }

    /// Renders a picture and leaves it on the device.
    ///
    /// # Errors
    /// As [`PictureRenderer::render`].
    pub fn draw(
        &self,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        drops: &[FallingDrop],
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<PictureOnGpu, GpuPictureError> {
        let frame = picture_frame(scene, viewpoint, options)?;
        if self.gpu.adapter().is_software() {
            check_turns(&frame)?;
        }
        let mut passes = Vec::new();
        let uploaded = timed(&mut passes, "upload", || {
            let mut last = self.uploaded.lock().unwrap_or_else(PoisonError::into_inner);
            // What the scene shares with that of the last picture is on the device, and so are its masks.
            let scene = self.scene.upload_after(scene, last.as_ref().map(|(scene, _)| scene))?;
            let masks = self.rain.upload_after(masks, last.as_ref().map(|(_, masks)| masks))?;
            *last = Some((scene.clone(), masks.clone()));
            drop(last);
            Ok::<_, GpuError>((scene, masks))
        })?;
        let clean = timed(&mut passes, "scene", || self.scene.draw(&uploaded.0, &frame))?;
        let eye = viewpoint.eye.as_dvec3();
        let camera = frame.camera;
        // The drops are put on the picture by the device.
        let rain = Rain::new(&camera, eye, &[], masks, &options.rain);
        let pool = &*self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        pool.begin_frame();
        let (falling, frequencies) = timed(&mut passes, "drops to the device", || {
            let falling: Vec<EyeDrop> = drops.par_iter().map(|drop| EyeDrop::new(drop, eye)).collect();
            let frequencies = self.rain.frequencies(&options.rain.exposure.fluids)?;
            Ok::<_, GpuError>((pool.storage("falling drops", &falling)?, frequencies))
        })?;
        let count = drops.len() as u32;
        let falling = FallingOnGpu { drops: &falling, count, frequencies: &frequencies };
        let view = SceneView { data: scene, frame: &frame };
        let lights = [rain.lights(&view, masks)?, rain.streak_lights(&view, masks)?];
        let plate = self.scene.plate(&uploaded.0, &frame, &self.rain, &rain)?;
        let of_masks = (&uploaded.1, masks);
        let of_rain = (&rain, &options.rain);
        let pass = self.rain.prepare_falling(pool, &plate.of(&clean), of_masks, of_rain, &lights, falling)?;
        timed(&mut passes, "capture", || {
            self.gpu.submit(&plate.dispatches(&pass))?;
            self.gpu.wait()
        })?;
        timed(&mut passes, "projection", || {
            self.gpu.submit(&pass.project())?;
            self.gpu.wait()
        })?;
        timed(&mut passes, "lamps", || {
            self.gpu.submit(&pass.lamps())?;
            self.gpu.wait()
        })?;
        timed(&mut passes, "streaks", || {
            self.gpu.submit(&pass.streaks())?;
            self.gpu.wait()
        })?;
        timed(&mut passes, "unresolved", || {
            for dispatch in pass.medium() {
                self.gpu.submit(&[dispatch])?;
                self.gpu.wait()?;
            }
            Ok::<_, GpuError>(())
        })?;
        timed(&mut passes, "drops", || {
            self.gpu.submit(&pass.drops())?;
            self.gpu.submit(&[pass.seen()])?;
            self.gpu.wait()
        })?;
        let layer = pass.layer_buffer().clone();
        let environment = plate.of(&clean).environment.clone();
        let distances = pass.distances().0.clone();
        drop(pass);
        let seen = Seen { distances, count: drops.len() };
        Ok(PictureOnGpu { gpu: self.gpu.clone(), rain, seen, clean, layer, environment, passes })
    }
}

/// Distances of drops on the device.
#[derive(Debug)]
struct Seen {
    distances: wgpu::Buffer,
    count: usize,
}

/// A picture on the device, in layers.
#[derive(Debug)]
pub struct PictureOnGpu {
    gpu: Gpu,
    rain: Rain,
    seen: Seen,
    clean: wgpu::Buffer,
    layer: wgpu::Buffer,
    environment: wgpu::Buffer,
    /// Passes in order, with the time of each in ms.
    pub passes: Vec<(&'static str, f64)>,
}

impl PictureOnGpu {
    /// Its layers, for a pane of glass that it is seen through.
    #[must_use]
    pub fn behind_glass(&self) -> BehindGlass<'_> {
        BehindGlass { plate: &self.clean, rain: &self.layer, environment: &self.environment }
    }

    /// Reads the picture back.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn read(self) -> Result<Picture, GpuError> {
        let Self { gpu, rain, seen, clean, layer, environment, mut passes } = self;
        let (mut distances, clean, layer, environment) = timed(&mut passes, "readback", || {
            let distances = gpu.read::<f32>(&seen.distances)?;
            Ok::<_, GpuError>((
                distances,
                gpu.read::<[f32; 4]>(&clean)?,
                gpu.read(&layer)?,
                gpu.read(&environment)?,
            ))
        })?;
        distances.truncate(seen.count);
        Ok(Picture::new(&rain, clean, layer, environment, passes).with_seen(&distances))
    }
}

/// Turns of loops after which a software driver of Mesa ends a shader, without a word.
const MAX_LOOP_ITERATIONS: u64 = 65_535;

/// Turns that a ray takes through the hierarchy, and a texture through its levels: a generous mean.
const TURNS_PER_RAY: u64 = 200;

/// # Errors
/// [`GpuError::OverLimit`] if a pixel may take more turns than a software driver allows.
fn check_turns(frame: &RenderFrame) -> Result<(), GpuError> {
    let [grid, sky, lights] = [frame.grid, frame.sky_rays, frame.light_count].map(u64::from);
    // Water adds what it mirrors, lit by a lamp each.
    let mirrored = if frame.puddle_count > 0 { 2 * sky.max(u64::from(PUDDLE_WATER_RAYS)) } else { 0 };
    let rays = 1 + lights + 2 * sky + mirrored;
    let needed = grid * grid * (rays * TURNS_PER_RAY + 2 * lights * (1 + sky));
    if needed <= MAX_LOOP_ITERATIONS {
        return Ok(());
    }
    Err(GpuError::OverLimit {
        what: "the work of a pixel (samples, rays to the sky, lamps), in turns of loops,".to_owned(),
        found: needed,
        limit_name: "LP_MAX_TGSI_LOOP_ITERATIONS",
        allowed: MAX_LOOP_ITERATIONS,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable as _;

    /// With 4 x 4 samples of 16 rays to the sky a picture of a software driver was seen to be too dark by half, without
    /// an error.
    #[test]
    fn a_software_driver_is_not_asked_for_more_turns_than_it_takes() {
        let frame = |grid, sky_rays, light_count| RenderFrame {
            grid,
            sky_rays,
            light_count,
            ..RenderFrame::zeroed()
        };
        assert!(check_turns(&frame(2, 1, 8)).is_ok());
        assert!(check_turns(&frame(2, 4, 30)).is_ok());
        for too_much in [frame(4, 16, 0), frame(8, 16, 1), frame(2, 64, 100), frame(1, 1, 1024)] {
            assert!(matches!(check_turns(&too_much), Err(GpuError::OverLimit { .. })));
        }
    }
}
