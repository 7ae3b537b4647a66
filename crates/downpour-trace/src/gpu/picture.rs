//! A whole picture on a GPU.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use downpour_drop::oscillation::Fluids;
use downpour_gpu::{
    BufferPool, BufferSource as _, FramePasses, FrameQueries, FrameTimes, Gpu, GpuError, Readback,
    ReadbackPool, TICKS, wgpu,
};
use downpour_shaders::render::puddle_water::PUDDLE_WATER_RAYS;
use downpour_sim::SimError;
use downpour_sim::field::{EyeDrop, FallingDrop, RainField};
use downpour_sim::gpu::{DropListOnGpu, FieldOnGpu, FieldPipeline, GpuSimError};
use rayon::prelude::*;

use downpour_render::RenderError;
use downpour_render::camera::{Camera, Viewpoint};
use downpour_render::gpu::{
    AddedLightPipeline, BehindGlass, EnvironmentMap, FallingOnGpu, GlowPipeline, KeptLight, RainOnGpu,
    RainPipeline, RefinePipeline, TonePipeline, TonedLayers,
};
use downpour_render::picture::{DeviceUse, Picture, PictureOptions};
use downpour_render::rain::{DropMasks, Rain};
use downpour_render::tone::Tone;

use super::falling::{FallingPass, FoundDrops, FoundList, PictureDrops};
use super::running_light::{RUNNING_MEANS, RunningLightPipeline, RunningOnGpu};
use super::scene::{SceneOnGpu, ScenePass, ScenePipeline};
use super::temporal::{LightOnGpu, TemporalPipeline};
use crate::data::{RenderFrame, SceneData};
use crate::kept::{KeptPlate, PlateUse, seedless};
use crate::kept_environment::KeptEnvironment;
use crate::picture::picture_frame;
use crate::running_light::{RunningFrame, RunningLight};
use crate::scene::SceneView;
use crate::temporal::{LightHistory, LightWindow};

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
    /// The view of the rain is invalid.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// There are more drops than were expected.
    #[error(
        "{found} drops are before the picture, and there is room for {room}: set a smaller [rain] max_drops"
    )]
    NoRoom {
        /// Drops that were found.
        found: u32,
        /// Drops that have room.
        room: u32,
    },
}

impl From<GpuSimError> for GpuPictureError {
    fn from(error: GpuSimError) -> Self {
        match error {
            GpuSimError::Sim(error) => Self::Sim(error),
            GpuSimError::Gpu(error) => Self::Gpu(error),
        }
    }
}

/// Labels of the buffers that a picture keeps.
const GIVEN_AWAY: [&str; 10] = [
    "picture",
    "rain",
    "environment map",
    "glow",
    "display picture",
    TICKS,
    FRAME_LIGHT[0],
    FRAME_LIGHT[1],
    RUNNING_MEANS,
    DropListOnGpu::COUNTS_LABEL,
];

/// Those of the lists among them.
const LISTS_GIVEN_AWAY: [&str; 2] = [DISTANCES, DropListOnGpu::DROPS_LABEL];

/// Label of the list of drops' distances.
const DISTANCES: &str = "distances of drops";

/// Labels of the buffers with the light of a frame that later ones ask for.
const FRAME_LIGHT: [&str; 2] = ["light of a frame", "means of light of a frame"];

/// Time of the rays of a scene, ms, up to which a frame is submitted as a whole.
const SHORT_MS: f64 = 100.0;

/// Room for passes that are timed by the device.
const MAX_PASSES: u32 = 32;

/// Pipelines that render pictures.
#[derive(Clone, Debug)]
pub struct PictureRenderer {
    gpu: Gpu,
    scene: ScenePipeline,
    rain: RainPipeline,
    glow: GlowPipeline,
    refine: RefinePipeline,
    temporal: TemporalPipeline,
    running_light: RunningLightPipeline,
    tone: TonePipeline,
    added_light: AddedLightPipeline,
    fields: FieldPipeline,
    pool: Arc<BufferPool>,
    /// Locked for as long as a picture is drawn with the pool's buffers.
    drawing: Arc<Mutex<()>>,
    readbacks: ReadbackPool,
    queries: Arc<FrameQueries>,
    /// Frequencies of the drops of the last picture, and their fluids.
    frequencies: Arc<Mutex<Option<(Fluids, wgpu::Buffer)>>>,
    /// Time of a sample of the last picture that was read, ms.
    pace: Arc<Mutex<Option<f64>>>,
    /// The scene of the last picture.
    uploaded: Arc<Mutex<Option<SceneOnGpu>>>,
    /// Its masks.
    masks: Arc<Mutex<Option<RainOnGpu>>>,
    /// The plate of the last picture, if it was to be kept.
    plate: Arc<Mutex<Option<KeptPlate<KeptBuffer>>>>,
    /// The environment map of the last picture, if it was to be kept.
    environment: Arc<Mutex<Option<KeptEnvironment<KeptBuffer>>>>,
    /// The light of the rain of the last picture, with its frame without a seed, if it was to be kept.
    light: Arc<Mutex<Option<(RenderFrame, KeptLight)>>>,
    /// Light of sky and surfaces in the last frames of a clip.
    history: Arc<Mutex<LightHistory<LightOnGpu>>>,
    /// Running mean of light that the last picture has left.
    running: Arc<Mutex<Option<RunningLight<RunningOnGpu>>>>,
}

/// A buffer that stays from picture to picture.
#[derive(Debug)]
struct KeptBuffer {
    buffer: wgpu::Buffer,
    /// Pictures that show it and that nobody has begun to read have the other handles.
    shown: Arc<()>,
}

impl KeptBuffer {
    /// A buffer of `bytes` bytes: the last one, if it is as large and all pictures that show it are on their way; else a new one.
    fn after(
        last: Option<Self>,
        bytes: u64,
        make: impl FnOnce() -> Result<wgpu::Buffer, GpuError>,
    ) -> Result<Self, GpuError> {
        match last.filter(|last| last.buffer.size() == bytes && Arc::strong_count(&last.shown) == 1) {
            Some(last) => Ok(last),
            None => Ok(Self { buffer: make()?, shown: Arc::default() }),
        }
    }
}

/// Use of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureUse {
    /// Parts of its plate that stay for later pictures.
    pub plate: PlateUse,
    /// Way to the pixels of a picture that is only displayed: [`PictureOnGpu::begin_display`].
    pub tone: Option<Tone>,
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
            glow: GlowPipeline::new(gpu)?,
            refine: RefinePipeline::new(gpu)?,
            temporal: TemporalPipeline::new(gpu)?,
            running_light: RunningLightPipeline::new(gpu)?,
            tone: TonePipeline::new(gpu)?,
            added_light: AddedLightPipeline::new(gpu)?,
            fields: FieldPipeline::new(gpu)?,
            // A picture may be read after the next one is begun.
            pool: Arc::new(
                BufferPool::new(gpu).with_given_away(&GIVEN_AWAY).with_lists_given_away(&LISTS_GIVEN_AWAY),
            ),
            drawing: Arc::default(),
            readbacks: ReadbackPool::default(),
            queries: Arc::default(),
            frequencies: Arc::default(),
            pace: Arc::default(),
            uploaded: Arc::default(),
            masks: Arc::default(),
            plate: Arc::default(),
            environment: Arc::default(),
            light: Arc::default(),
            history: Arc::default(),
            running: Arc::default(),
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
        self.draw(scene, viewpoint, PictureDrops::Listed(drops), masks, options)?.read()
    }

    /// Drops whose lists the device can bind.
    #[must_use]
    pub fn max_drops(&self) -> u32 {
        self.rain.most_drops()
    }

    /// Brings a rain in closed form to the device.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn upload_field(&self, field: &RainField) -> Result<FieldOnGpu, GpuError> {
        self.fields.upload(field)
    }

    /// Renders a picture and leaves it on the device.
    ///
    /// # Errors
    /// As [`PictureRenderer::render`].
    pub fn draw(
        &self,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        drops: PictureDrops<'_>,
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<PictureOnGpu, GpuPictureError> {
        self.draw_for(PictureUse::default(), scene, viewpoint, drops, masks, options)
    }

    /// Renders a picture for a use and leaves it on the device.
    ///
    /// # Errors
    /// As [`PictureRenderer::render`].
    pub fn draw_for(
        &self,
        of: PictureUse,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        drops: PictureDrops<'_>,
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<PictureOnGpu, GpuPictureError> {
        let frame = self.frame_of(scene, viewpoint, options)?;
        let _drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        let pool = &*self.pool;
        pool.begin_frame();
        let pace = *self.pace.lock().unwrap_or_else(PoisonError::into_inner);
        let samples = samples_of(&frame);
        let is_short = pace.is_some_and(|ms_per_sample| ms_per_sample * samples < SHORT_MS);
        let mut passes = FramePasses::after(&self.queries, pool, MAX_PASSES)?.with_short(is_short);
        let made_before = self.gpu.buffers_made();
        let uploaded =
            passes.host("upload", || Ok::<_, GpuError>((self.upload(scene)?, self.upload_masks(masks)?)))?;
        if let Some(ripples) = uploaded.0.ripples(pool)? {
            passes.run("ripples", &ripples.dispatches())?;
        }
        let eye = viewpoint.eye.as_dvec3();
        let camera = frame.camera;
        // The drops are put on the picture by the device.
        let rain = Rain::new(&camera, eye, &[], masks, &options.rain);
        let mut kept = self.plate.lock().unwrap_or_else(PoisonError::into_inner);
        // After an error there is none. Pictures that keep none leave that of others alone.
        let last = if of.plate.kept_frames > 0 { kept.take() } else { None };
        let mut stays = match (of.plate.kept_frames, last) {
            (0, _) => None,
            (_, Some(last)) if last.shows(scene, &frame) => Some(last),
            (_, last) => {
                let mean = self.mean_of_pictures(&camera, last.map(|plate| plate.held))?;
                Some(KeptPlate::new(scene, &frame, mean))
            }
        };
        let mut next = match stays.as_mut() {
            Some(plate) => plate.next(&frame, of.plate.kept_frames),
            None => Some((frame, 1)),
        };
        // What stands still is worth the rays of all pixels.
        let frame = if next.is_none() { frame.with_ray_spacing(1) } else { frame };
        // Buffers that are given back when the picture has been read.
        let mut layers: Vec<(&'static str, wgpu::Buffer)> = Vec::new();
        let mut clean = stays.as_ref().map(|plate| plate.held.buffer.clone());
        let mut around = self.environment.lock().unwrap_or_else(PoisonError::into_inner);
        let environment = self.environment_map(of.plate, scene, &frame, &rain, &mut around)?;
        if of.plate.kept_frames == 0 {
            layers.push(("environment map", environment.0.clone()));
        }
        let around_kept = if of.plate.kept_frames > 0 { around.take() } else { None };
        let kept_buffers =
            [stays.as_ref().map(|plate| &plate.held), around_kept.as_ref().map(|map| &map.held)];
        let shown = kept_buffers.map(|kept| kept.map(|kept| Arc::clone(&kept.shown)));
        let plate = self.scene.plate_around(pool, &uploaded.0, &frame, &rain, environment)?;
        let captured = plate.finest();
        let stands_still = next.is_none() && captured.is_empty();
        let mut is_captured = false;
        let mut kept_running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let running = RunningLight::follow(&mut kept_running, of.plate.running(), scene, next.as_mut());
        if let Some((frame, count)) = next {
            let window = of.plate.window();
            let labels = match (&window, &running) {
                (Some(_), _) => FRAME_LIGHT,
                (None, Some(_)) => [FRAME_LIGHT[0], "means of light"],
                (None, None) => ["light of the sky", "means of light"],
            };
            let traced = self.scene.prepare_paced(pool, &uploaded.0, &frame, pace, labels)?;
            let mut batches: Vec<Vec<_>> = traced.rays().into_iter().map(|band| vec![band]).collect();
            // Few texels with long ways keep a large device idle: it traces the picture meanwhile.
            is_captured = self.scene.takes_samples_together();
            if is_captured {
                batches[0].splice(..0, captured.iter().copied());
            }
            passes.run_batches("scene", &batches)?;
            passes.run_each("skylight", &traced.filters())?;
            if let Some(window) = &window {
                self.average_light(&mut passes, window, &frame, &traced)?;
            } else if let Some(running) = &running {
                self.go_on(&mut passes, running, (scene, &frame), &traced, &mut kept_running)?;
            }
            if let Some(mean) = &clean {
                let more = self.refine.prepare(pool, camera.size(), count, traced.picture(), mean)?;
                passes.run("refine", &[more.dispatch()])?;
            }
            layers.push(("picture", traced.picture().clone()));
            clean.get_or_insert(traced.picture().clone());
            passes.flush()?;
        }
        let clean = clean.expect("a plate that is not kept is traced");
        let (falling, count, search) = passes.host("drops to the device", || match drops {
            PictureDrops::Listed(drops) => {
                let falling: Vec<EyeDrop> = drops.par_iter().map(|drop| EyeDrop::new(drop, eye)).collect();
                Ok((pool.storage(DropListOnGpu::DROPS_LABEL, &falling)?, drops.len() as u32, None))
            }
            PictureDrops::Field(mut drops) => {
                let search = drops.prepare(&self.fields, pool, scene, plate.lighting())?;
                Ok::<_, GpuPictureError>(listed(FallingPass::Field(Box::new(search))))
            }
            PictureDrops::Stepped(simulation, picture) => {
                pool.note_written(simulation.take_written());
                Ok(listed(FallingPass::Stepped(simulation.list(pool, &picture)?)))
            }
        })?;
        let frequencies = self.frequencies(&options.rain.exposure.fluids)?;
        let drops_found = falling.clone();
        let falling = FallingOnGpu { drops: &falling, count, frequencies: &frequencies };
        let view = SceneView { data: scene, frame: &frame };
        let lights = [rain.lights(&view, masks)?, rain.streak_lights(&view, masks)?];
        let of_masks = (&uploaded.1, masks);
        let of_rain = (&rain, &options.rain);
        let mut pass =
            self.rain.prepare_falling(pool, &plate.of(&clean), of_masks, of_rain, &lights, falling)?;
        let mut light = self.light.lock().unwrap_or_else(PoisonError::into_inner);
        // Any picture writes where that of the last one is.
        let before = light.take().filter(|(of, _)| stands_still && *of == seedless(&frame));
        let kept_light =
            stays.is_some().then(|| pass.keep_light(pool, before.as_ref().map(|(_, light)| light)));
        if !captured.is_empty() {
            let finest = if is_captured { Vec::new() } else { captured };
            passes.run("capture", &[finest, pass.environment()].concat())?;
        }
        match &search {
            Some(search) => passes.run_stages("search", &search.stages_beside(pass.open_air()))?,
            None => passes.run("open air", &[pass.open_air()])?,
        }
        passes.run_stages("binning", &pass.binning())?;
        passes.run("lamps", &pass.lamps())?;
        passes.run("streaks", &pass.streaks())?;
        passes.run_each("unresolved", &pass.medium())?;
        passes.run("drops", &[pass.drops(), vec![pass.seen()]].concat())?;
        let spray = pass.spray();
        if !spray.is_empty() {
            passes.run("spray", &spray)?;
        }
        if let Some(layers) = pass.layers() {
            passes.run("layers", &[layers])?;
        }
        let layer = pass.layer_buffer().clone();
        let environment = plate.of(&clean).environment.clone();
        let distances = pass.distances().0.clone();
        drop(pass);
        let glow = self.glow.prepare(pool, &options.glow, &camera, &clean, &layer)?;
        if let Some(glow) = &glow {
            passes.run("glow", &glow.dispatches())?;
        }
        let glow = glow.map(|pass| pass.target().clone());
        let pixels = match &of.tone {
            Some(tone) => {
                let seen =
                    TonedLayers { size: camera.size(), plate: &clean, rain: &layer, glow: glow.as_ref() };
                let toned = self.tone.prepare(pool, seen, tone)?;
                passes.run("tone", &[toned.dispatch()])?;
                Some(toned.target().clone())
            }
            None => None,
        };
        let (times, ticks) = passes.end()?;
        let found = search.map(|search| FoundList::new(search.list(), pixels.is_some()));
        layers.push((DropListOnGpu::DROPS_LABEL, drops_found));
        layers.extend(found.iter().map(|found| (DropListOnGpu::COUNTS_LABEL, found.counts().clone())));
        layers.push(("rain", layer.clone()));
        layers.push((DISTANCES, distances.clone()));
        layers.extend(glow.iter().map(|glow| ("glow", glow.clone())));
        layers.extend(pixels.iter().map(|pixels| ("display picture", pixels.clone())));
        layers.extend(ticks.iter().map(|ticks| (TICKS, ticks.clone())));
        if stays.is_some() {
            *kept = stays;
            *around = around_kept;
            *light = kept_light.map(|light| (seedless(&frame), light));
        }
        drop((kept, around, light));
        let device =
            DeviceUse { bytes_uploaded: pool.written(), buffers_made: self.gpu.buffers_made() - made_before };
        Ok(PictureOnGpu {
            gpu: self.gpu.clone(),
            readbacks: self.readbacks.clone(),
            pool: Arc::clone(&self.pool),
            pace: Arc::clone(&self.pace),
            samples,
            rain,
            count: count as usize,
            found,
            distances,
            clean,
            _shown: shown,
            layer,
            glow,
            environment,
            pixels,
            layers,
            times,
            ticks,
            device,
            added: Vec::new(),
            passes: Vec::new(),
        })
    }

    /// Adds a picture of the same scene in other light to one that is displayed: to all that is seen of it. Its drops are not counted.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn add_light(&self, picture: &mut PictureOnGpu, light: PictureOnGpu) -> Result<(), GpuError> {
        let _drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        let pass = self.added_light.prepare(&*self.pool, light.toned(), &picture.layer)?;
        self.gpu.submit(&[pass.dispatch()])?;
        let PictureOnGpu { times, ticks, device, mut layers, .. } = light;
        // Read with the picture.
        layers.retain(|(label, _)| *label != TICKS);
        give_back(&self.pool, layers);
        picture.layers.extend(ticks.iter().map(|ticks| (TICKS, ticks.clone())));
        picture.added.push(AddedTimes { times, ticks });
        picture.device.bytes_uploaded += device.bytes_uploaded;
        picture.device.buffers_made += device.buffers_made;
        Ok(())
    }

    /// Makes the pixels of a picture for a display.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn show(&self, picture: &mut PictureOnGpu, tone: &Tone) -> Result<(), GpuError> {
        let _drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        let toned = self.tone.prepare(&*self.pool, picture.toned(), tone)?;
        self.gpu.submit(&[toned.dispatch()])?;
        let pixels = toned.target().clone();
        picture.layers.push(("display picture", pixels.clone()));
        picture.pixels = Some(pixels);
        if let Some(found) = &mut picture.found {
            found.count_only();
        }
        Ok(())
    }

    /// The frame of a picture that the device can trace.
    fn frame_of(
        &self,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        options: &PictureOptions,
    ) -> Result<RenderFrame, GpuPictureError> {
        let frame = picture_frame(scene, viewpoint, options)?;
        if self.gpu.adapter().is_software() {
            check_turns(&frame)?;
        }
        Ok(frame)
    }

    /// Finds the light of sky and surfaces in a frame of a clip for the frames after it, without a picture.
    ///
    /// # Errors
    /// As [`PictureRenderer::render`].
    pub fn find_light(
        &self,
        window: &LightWindow,
        scene: &SceneData,
        viewpoint: &Viewpoint,
        options: &PictureOptions,
    ) -> Result<(), GpuPictureError> {
        let frame = self.frame_of(scene, viewpoint, options)?;
        let _drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        let pool = &*self.pool;
        pool.begin_frame();
        let mut passes = FramePasses::new(&self.gpu, 1)?;
        let scene = self.upload(scene)?;
        if let Some(ripples) = scene.ripples(pool)? {
            passes.run("ripples", &ripples.dispatches())?;
        }
        let pace = *self.pace.lock().unwrap_or_else(PoisonError::into_inner);
        let traced = self.scene.prepare_paced(pool, &scene, &frame, pace, FRAME_LIGHT)?;
        passes.run_each("scene", &traced.dispatches())?;
        pool.give_back("picture", traced.picture().clone());
        self.keep_light(window, &frame, traced.light());
        Ok(())
    }

    /// Averages the light of a picture with that of the frames of a clip before it, and keeps its own for those after it.
    fn average_light(
        &self,
        passes: &mut FramePasses,
        window: &LightWindow,
        frame: &RenderFrame,
        traced: &ScenePass<'_>,
    ) -> Result<(), GpuError> {
        let history = self.history.lock().unwrap_or_else(PoisonError::into_inner);
        let before = history.before(window);
        if !before.is_empty() {
            let (light, picture) = (traced.light(), traced.picture());
            let pass = self.temporal.prepare(&*self.pool, frame, light, &before, picture)?;
            passes.run_each("temporal filter", &pass.dispatches())?;
        }
        drop(before);
        drop(history);
        self.keep_light(window, frame, traced.light());
        Ok(())
    }

    /// Makes the light of a picture the running mean of that of the frames before it and its own, and keeps it for those after it.
    fn go_on(
        &self,
        passes: &mut FramePasses,
        of: &RunningFrame,
        (scene, frame): (&SceneData, &RenderFrame),
        traced: &ScenePass<'_>,
        kept: &mut Option<RunningLight<RunningOnGpu>>,
    ) -> Result<(), GpuError> {
        let before = kept.take();
        let (light, picture) = (traced.light(), traced.picture());
        let last = before.as_ref().map(|before| (before.before(of), &before.held));
        let pass = self.running_light.prepare(&*self.pool, frame, light, last, picture)?;
        passes.run("temporal filter", &[pass.dispatch()])?;
        let held = RunningOnGpu { ambient: light.ambient.clone(), means: pass.means().clone() };
        *kept = Some(RunningLight::after(before.as_ref(), of, scene, frame, held));
        if let Some(RunningOnGpu { ambient, means }) = before.map(|before| before.held) {
            self.pool.give_back(FRAME_LIGHT[0], ambient);
            self.pool.give_back(RUNNING_MEANS, means);
        }
        Ok(())
    }

    /// Keeps the light of a frame of a clip for those after it.
    fn keep_light(&self, window: &LightWindow, frame: &RenderFrame, light: &LightOnGpu) {
        let mut history = self.history.lock().unwrap_or_else(PoisonError::into_inner);
        for out in history.add(window, frame.camera, light.clone()) {
            for (label, buffer) in FRAME_LIGHT.into_iter().zip([out.held.ambient, out.held.means]) {
                self.pool.give_back(label, buffer);
            }
        }
    }

    /// True if the light of a frame of a clip is kept.
    #[must_use]
    pub fn has_light(&self, time_s: f64) -> bool {
        self.history.lock().unwrap_or_else(PoisonError::into_inner).has(time_s)
    }

    /// Forgets the light of all frames.
    pub fn forget_light(&self) {
        *self.history.lock().unwrap_or_else(PoisonError::into_inner) = LightHistory::default();
    }

    /// Brings a scene to the device: what it shares with that of the last picture is there. After an error nothing is.
    fn upload(&self, scene: &SceneData) -> Result<SceneOnGpu, GpuError> {
        let pool = &*self.pool;
        let mut last = self.uploaded.lock().unwrap_or_else(PoisonError::into_inner);
        let scene = match last.take() {
            Some(before) => before.renewed(pool, scene)?,
            None => SceneOnGpu::new(pool, scene)?,
        };
        Ok(last.insert(scene).clone())
    }

    /// Brings masks to the device: those of the last picture are there.
    fn upload_masks(&self, masks: &DropMasks) -> Result<RainOnGpu, GpuError> {
        let mut last = self.masks.lock().unwrap_or_else(PoisonError::into_inner);
        let before = last.take();
        Ok(last.insert(self.rain.upload_after(masks, before.as_ref())?).clone())
    }

    /// The environment map of a frame, and the rows of it that are to be traced: in `kept`, if it stays from picture to picture.
    fn environment_map(
        &self,
        of: PlateUse,
        scene: &SceneData,
        frame: &RenderFrame,
        rain: &Rain,
        kept: &mut Option<KeptEnvironment<KeptBuffer>>,
    ) -> Result<(wgpu::Buffer, Vec<Range<u32>>), GpuError> {
        let layout = &rain.environment;
        if of.kept_frames == 0 {
            return Ok((
                self.rain.environment(&*self.pool, rain)?,
                std::iter::once(0..layout.size).collect(),
            ));
        }
        if !kept.as_mut().is_some_and(|map| map.follow(scene, frame, layout)) {
            let last = kept.take().map(|map| map.held);
            let make = || self.rain.environment(&self.gpu, rain);
            let held = KeptBuffer::after(last, RainPipeline::environment_bytes(rain), make)?;
            *kept = Some(KeptEnvironment::new(scene, frame, layout, held));
        }
        let map = kept.as_mut().expect("one was made");
        Ok((map.held.buffer.clone(), map.next(frame.camera.eye)))
    }

    /// A buffer for the plate of a camera.
    fn mean_of_pictures(&self, camera: &Camera, last: Option<KeptBuffer>) -> Result<KeptBuffer, GpuError> {
        let bytes = 16 * u64::from(camera.width) * u64::from(camera.height);
        let make = || self.gpu.empty_buffer("mean of pictures", bytes, wgpu::BufferUsages::STORAGE);
        KeptBuffer::after(last, bytes, make)
    }

    /// Frequencies of drops in some fluids on the device: those of the last picture, if they are the same.
    fn frequencies(&self, fluids: &Fluids) -> Result<wgpu::Buffer, GpuError> {
        let mut last = self.frequencies.lock().unwrap_or_else(PoisonError::into_inner);
        match last.as_ref().filter(|(known, _)| known == fluids) {
            Some((_, buffer)) => Ok(buffer.clone()),
            None => Ok(last.insert((*fluids, self.rain.frequencies(fluids)?)).1.clone()),
        }
    }
}

/// A picture on the device, in layers.
#[derive(Debug)]
pub struct PictureOnGpu {
    gpu: Gpu,
    pool: Arc<BufferPool>,
    readbacks: ReadbackPool,
    pace: Arc<Mutex<Option<f64>>>,
    samples: f64,
    rain: Rain,
    /// Places of the list of drops.
    count: usize,
    /// The list, if the device has made it.
    found: Option<FoundList>,
    distances: wgpu::Buffer,
    clean: wgpu::Buffer,
    /// Of the plate and of the environment map, if they stay.
    _shown: [Option<Arc<()>>; 2],
    layer: wgpu::Buffer,
    glow: Option<wgpu::Buffer>,
    environment: wgpu::Buffer,
    /// The picture for a display, if it was asked for.
    pixels: Option<wgpu::Buffer>,
    /// Buffers that are given back, with their labels.
    layers: Vec<(&'static str, wgpu::Buffer)>,
    times: FrameTimes,
    ticks: Option<wgpu::Buffer>,
    device: DeviceUse,
    /// Times of pictures in other light that were added to it.
    added: Vec<AddedTimes>,
    /// Further passes after those that drew it, with the time of each in ms.
    pub passes: Vec<(&'static str, f64)>,
}

/// Times of the passes of a picture that was added to another.
#[derive(Debug)]
struct AddedTimes {
    times: FrameTimes,
    ticks: Option<wgpu::Buffer>,
}

/// A picture on its way from the device.
#[derive(Debug)]
pub struct PictureReadback {
    pace: Arc<Mutex<Option<f64>>>,
    /// Samples of the scene.
    samples: f64,
    rain: Rain,
    count: usize,
    found: Option<FoundList>,
    read: Readback,
    times: FrameTimes,
    has_ticks: bool,
    has_glow: bool,
    device: DeviceUse,
    passes: Vec<(&'static str, f64)>,
}

impl PictureOnGpu {
    /// Its layers, for a display.
    fn toned(&self) -> TonedLayers<'_> {
        let size = self.rain.frame.camera.size();
        TonedLayers { size, plate: &self.clean, rain: &self.layer, glow: self.glow.as_ref() }
    }

    /// Its layers, for a pane of glass that it is seen through.
    #[must_use]
    pub fn behind_glass(&self) -> BehindGlass<'_> {
        BehindGlass {
            plate: &self.clean,
            rain: &self.layer,
            environment: EnvironmentMap::OnDevice(&self.environment),
        }
    }

    /// Begins to read the picture back, without waiting for the device.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn begin_read(self) -> Result<PictureReadback, GpuError> {
        let Self { pool, pace, samples, rain, count, found, times, passes, device, .. } = self;
        let mut buffers = vec![&self.clean, &self.layer, &self.environment];
        buffers.extend(&self.glow);
        buffers.extend(&self.ticks);
        let read =
            begin_read(&self.readbacks, &self.gpu, (&self.distances, count), &buffers, found.as_ref())?;
        let (has_ticks, has_glow) = (self.ticks.is_some(), self.glow.is_some());
        give_back(&pool, self.layers);
        Ok(PictureReadback {
            pace,
            samples,
            rain,
            count,
            found,
            read,
            times,
            has_ticks,
            has_glow,
            device,
            passes,
        })
    }

    /// Begins to read the picture for a display, without its layers and its drops; without waiting for the device.
    /// `None` if none was asked for.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn begin_display(self) -> Result<Option<DisplayReadback>, GpuError> {
        let Some(pixels) = &self.pixels else { return Ok(None) };
        let mut buffers = vec![pixels];
        buffers.extend(&self.ticks);
        buffers.extend(self.added.iter().filter_map(|added| added.ticks.as_ref()));
        let distances = (&self.distances, self.count);
        let read = begin_read(&self.readbacks, &self.gpu, distances, &buffers, self.found.as_ref())?;
        give_back(&self.pool, self.layers);
        Ok(Some(DisplayReadback {
            size: self.rain.frame.camera.size(),
            pace: self.pace,
            samples: self.samples,
            count: self.count,
            found: self.found,
            read,
            times: self.times,
            has_ticks: self.ticks.is_some(),
            added: self.added.into_iter().map(|added| (added.times, added.ticks.is_some())).collect(),
            device: self.device,
        }))
    }

    /// Reads the picture back.
    ///
    /// # Errors
    /// As [`PictureReadback::finish`].
    pub fn read(self) -> Result<Picture, GpuPictureError> {
        Ok(self.begin_read()?.finish()?.0)
    }
}

impl PictureReadback {
    /// Waits for the picture, and for the drops that the device has found, if it did: [`Picture::drawn`] has their places among
    /// these.
    ///
    /// # Errors
    /// [`GpuPictureError::NoRoom`] if there were more of them than expected, or what the GPU says.
    pub fn finish(self) -> Result<(Picture, Option<FoundDrops>), GpuPictureError> {
        let Self { pace, samples, rain, count, found, mut read, times, .. } = self;
        let (has_ticks, has_glow, device, others) = (self.has_ticks, self.has_glow, self.device, self.passes);
        read.wait()?;
        let begin = Instant::now();
        let mut distances = read.take::<f32>(0)?;
        distances.truncate(count);
        let of_list = 4 + usize::from(has_glow) + usize::from(has_ticks);
        let found = found.map(|found| found.finish(&mut read, of_list, &mut distances)).transpose()?;
        let [clean, layer, environment] = [read.take(1)?, read.take(2)?, read.take(3)?];
        let glow = if has_glow { read.take(4)? } else { Vec::new() };
        let ticks = 4 + usize::from(has_glow);
        let mut passes = times.read(&if has_ticks { read.take(ticks)? } else { Vec::new() });
        note_pace(&pace, &passes, samples, has_ticks);
        passes.extend(others);
        passes.push(("readback", begin.elapsed().as_secs_f64() * 1.0e3));
        let picture = Picture::new(&rain, clean, layer, environment, passes).with_seen(&distances);
        Ok((Picture { device: Some(device), glow, ..picture }, found))
    }
}

/// The buffer and the places of a list that the device makes, with its making.
fn listed(pass: FallingPass<'_>) -> (wgpu::Buffer, u32, Option<FallingPass<'_>>) {
    (pass.list().drops().clone(), pass.list().places(), Some(pass))
}

/// Begins to read the distances of so many drops, the whole of other buffers, and the list of drops.
fn begin_read(
    readbacks: &ReadbackPool,
    gpu: &Gpu,
    (distances, count): (&wgpu::Buffer, usize),
    others: &[&wgpu::Buffer],
    found: Option<&FoundList>,
) -> Result<Readback, GpuError> {
    // Nothing is no part of a buffer.
    let of_drops = (4 * count.max(1) as u64).min(distances.size());
    let mut parts = vec![(distances, 0..of_drops)];
    parts.extend(others.iter().map(|buffer| (*buffer, 0..buffer.size())));
    parts.extend(found.into_iter().flat_map(FoundList::parts));
    readbacks.begin_parts(gpu, &parts)
}

/// Gives buffers back to a pool: what writes them next is submitted after the copies.
fn give_back(pool: &BufferPool, layers: Vec<(&'static str, wgpu::Buffer)>) {
    for (label, buffer) in layers {
        pool.give_back(label, buffer);
    }
}

/// A picture for a display on its way from the device.
#[derive(Debug)]
pub struct DisplayReadback {
    size: [u32; 2],
    pace: Arc<Mutex<Option<f64>>>,
    samples: f64,
    count: usize,
    found: Option<FoundList>,
    read: Readback,
    times: FrameTimes,
    has_ticks: bool,
    /// Times of pictures that were added, and whether these are read with it.
    added: Vec<(FrameTimes, bool)>,
    device: DeviceUse,
}

/// A picture for a display.
#[derive(Clone, Debug)]
pub struct DisplayPicture {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Red, green, blue, alpha of each pixel in sRGB, rows from the top.
    pub pixels: Vec<[u8; 4]>,
    /// Drops that were looked at.
    pub drops_simulated: u64,
    /// Drops whose outline touches the picture.
    pub drops_on_screen: usize,
    /// Those of them that the scene does not hide altogether.
    pub drops_drawn: usize,
    /// The passes in their order, with the milliseconds that each took.
    pub passes: Vec<(&'static str, f64)>,
    /// Use of the device that drew it; `None` on the CPU.
    pub device: Option<DeviceUse>,
}

impl DisplayReadback {
    /// Waits for the picture.
    ///
    /// # Errors
    /// As [`PictureReadback::finish`].
    pub fn finish(self) -> Result<DisplayPicture, GpuPictureError> {
        let Self { size, pace, samples, count, found, mut read, times, has_ticks, added, device } = self;
        read.wait()?;
        let mut distances = read.take::<f32>(0)?;
        distances.truncate(count);
        let pixels = read.take(1)?;
        let mut part = 2;
        let mut ticks = |is_there: bool| {
            let ticks = if is_there { read.take(part)? } else { Vec::new() };
            part += usize::from(is_there);
            Ok::<_, GpuError>(ticks)
        };
        let mut passes = times.read(&ticks(has_ticks)?);
        note_pace(&pace, &passes, samples, has_ticks);
        for (times, has_ticks) in added {
            passes.push(("flash", times.read(&ticks(has_ticks)?).iter().map(|(_, ms)| ms).sum()));
        }
        let drops_simulated = match found {
            Some(found) => found.simulated(&mut read, part)?,
            None => count as u64,
        };
        Ok(DisplayPicture {
            size,
            pixels,
            drops_simulated,
            drops_on_screen: distances.iter().filter(|at| **at >= 0.0).count(),
            drops_drawn: distances.iter().filter(|at| **at > 0.0).count(),
            passes,
            device: Some(device),
        })
    }
}

/// Samples of the pixels of a frame.
fn samples_of(frame: &RenderFrame) -> f64 {
    f64::from(frame.grid * frame.grid) * f64::from(frame.camera.width) * f64::from(frame.camera.height)
}

/// Notes how long a sample of the scene takes, ms.
fn note_pace(pace: &Mutex<Option<f64>>, passes: &[(&'static str, f64)], samples: f64, has_ticks: bool) {
    if has_ticks && let Some((_, ms)) = passes.iter().find(|(name, _)| *name == "scene") {
        *pace.lock().unwrap_or_else(PoisonError::into_inner) = Some(ms / samples);
    }
}

/// Turns of loops after which a software driver of Mesa ends a shader, without a word.
const MAX_LOOP_ITERATIONS: u64 = 65_535;

/// Turns that a ray takes through the hierarchy, and a texture through its levels: a generous mean.
const TURNS_PER_RAY: u64 = 200;

/// # Errors
/// [`GpuError::OverLimit`] if a sample of a pixel may take more turns than a software driver allows: each is a dispatch of its own.
fn check_turns(frame: &RenderFrame) -> Result<(), GpuError> {
    let [sky, lights] = [frame.sky_rays, frame.light_count].map(u64::from);
    // Water adds what it mirrors, lit by a lamp each.
    let mirrored = if frame.puddle_count > 0 { 2 * sky.max(u64::from(PUDDLE_WATER_RAYS)) } else { 0 };
    // On what is wet, each surface asks whether the rain reaches it.
    let exposed = if frame.wetness > 0 { 2 + 2 * sky + mirrored } else { 0 };
    let rays = 1 + lights + 2 * sky + mirrored + exposed;
    let needed = rays * TURNS_PER_RAY + 2 * lights * (1 + sky);
    if needed <= MAX_LOOP_ITERATIONS {
        return Ok(());
    }
    Err(GpuError::OverLimit {
        what: "the work of a sample (rays to the sky, lamps), in turns of loops,".to_owned(),
        found: needed,
        limit_name: "LP_MAX_TGSI_LOOP_ITERATIONS",
        allowed: MAX_LOOP_ITERATIONS,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable as _;

    /// A picture of a software driver that is asked for more was seen to be too dark, without an error.
    #[test]
    fn a_software_driver_is_not_asked_for_more_turns_than_it_takes() {
        let frame = |sky_rays, light_count| RenderFrame { sky_rays, light_count, ..RenderFrame::zeroed() };
        assert!(check_turns(&frame(1, 8)).is_ok());
        assert!(check_turns(&frame(16, 100)).is_ok());
        for too_much in [frame(128, 100), frame(1, 1024)] {
            assert!(matches!(check_turns(&too_much), Err(GpuError::OverLimit { .. })));
        }
    }
}
