//! The picture of a scene on a GPU: the same rays, the same buffers.

use std::sync::{Arc, OnceLock};

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, FramePasses, Gpu, GpuError, wgpu};
use downpour_shaders::render::scene::{SKYLIGHT_KERNEL, SKYLIGHT_PASSES, TRACE_KERNEL};

use downpour_render::gpu::LightingOnGpu;

use crate::data::{RenderFrame, SceneData};
use crate::trace::TraceAmbient;

/// Pixels of a dispatch on a device whose speed is not known: a submission must stay far below the time after which a driver resets.
const PIXELS_PER_DISPATCH: u32 = 1 << 17;

/// Time of a dispatch on a device whose speed is known, ms. A fast device has all pixels in one: short dispatches leave it idle at the
/// end of each.
const DISPATCH_MS: f64 = 60.0;

/// Pipeline that traces scenes.
#[derive(Clone, Debug)]
pub struct ScenePipeline {
    gpu: Gpu,
    /// By what a scene has: [`SceneParts`]. Made for the first scene that has it.
    tracers: [OnceLock<ComputeKernel>; SceneParts::COUNT],
    skylight: ComputeKernel,
}

/// A scene on the device.
#[derive(Clone, Debug)]
pub struct SceneOnGpu {
    /// Scene that was uploaded: arrays that another scene shares with it are on the device already.
    of: SceneData,
    nodes: wgpu::Buffer,
    triangles: wgpu::Buffer,
    corners: wgpu::Buffer,
    table: wgpu::Buffer,
    texels: wgpu::Buffer,
    sky: wgpu::Buffer,
}

impl ScenePipeline {
    /// Creates the pipeline.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let tracers: [OnceLock<ComputeKernel>; SceneParts::COUNT] = Default::default();
        let plain = SceneParts::default();
        tracers[plain.index()].get_or_init({
            let made = tracer(gpu, plain)?;
            || made
        });
        let skylight = ComputeKernel::new(gpu, &SKYLIGHT_KERNEL, &[])?;
        Ok(Self { gpu: gpu.clone(), tracers, skylight })
    }

    /// The kernel that traces a frame, with what the scene has and without what it has not.
    pub(super) fn tracer(&self, frame: &RenderFrame) -> Result<&ComputeKernel, GpuError> {
        let parts = SceneParts::of(frame);
        let cell = &self.tracers[parts.index()];
        if let Some(kernel) = cell.get() {
            return Ok(kernel);
        }
        let made = tracer(&self.gpu, parts)?;
        Ok(cell.get_or_init(|| made))
    }

    /// Uploads a scene.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if a buffer is larger than the device allows, or what else the GPU says.
    pub fn upload(&self, scene: &SceneData) -> Result<SceneOnGpu, GpuError> {
        self.upload_after(scene, None)
    }

    /// Uploads a scene, reusing the buffers that it shares with `before`.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn upload_after(
        &self,
        scene: &SceneData,
        before: Option<&SceneOnGpu>,
    ) -> Result<SceneOnGpu, GpuError> {
        SceneOnGpu::new(&self.gpu, scene, before)
    }

    /// The picture of a frame: radiance and nearest distance, rows from the top. What
    /// [`SceneView::picture`](crate::scene::SceneView::picture) makes on the CPU.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn picture(&self, scene: &SceneOnGpu, frame: &RenderFrame) -> Result<Vec<[f32; 4]>, GpuError> {
        let pass = self.prepare(&self.gpu, scene, frame)?;
        FramePasses::new(&self.gpu, 1)?.run_each("scene", &pass.dispatches())?;
        self.gpu.read(&pass.picture)
    }

    /// Prepares a frame of a scene, with buffers from `buffers`.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
    ) -> Result<ScenePass<'_>, GpuError> {
        self.prepare_paced(buffers, scene, frame, None)
    }

    /// The same on a device that took so long for a sample of a like frame, ms.
    pub(super) fn prepare_paced(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        sample_ms: Option<f64>,
    ) -> Result<ScenePass<'_>, GpuError> {
        let pixels = u64::from(frame.camera.width) * u64::from(frame.camera.height);
        let storage = wgpu::BufferUsages::STORAGE;
        let picture = buffers.buffer("picture", pixels * 16, storage)?;
        let bytes = pixels * size_of::<TraceAmbient>() as u64;
        let found_light = buffers.buffer("light of the sky", bytes, storage)?;
        let samples = f64::from(frame.grid * frame.grid);
        let paced = sample_ms.map_or(0, |ms| (DISPATCH_MS / (ms * samples).max(1.0e-9)) as u32);
        let rows = paced.max(PIXELS_PER_DISPATCH) / frame.camera.width.max(1);
        let rows = rows.clamp(8, frame.camera.height.max(8)).next_multiple_of(8);
        let tracer = self.tracer(frame)?;
        let means = || buffers.buffer("means of light", pixels * 32, storage);
        let means = [means()?, means()?];
        let (mut bands, mut filters) = (Vec::new(), Vec::new());
        for skylight_pass in 0..=SKYLIGHT_PASSES {
            let [from, to] = [&means[(skylight_pass as usize + 1) % 2], &means[skylight_pass as usize % 2]];
            for first_row in (0..frame.camera.height).step_by(rows as usize) {
                let frame = RenderFrame { first_row, skylight_pass, ..*frame };
                let uniform = buffers.uniform("frame", &frame)?;
                let groups = [
                    frame.camera.width.div_ceil(8),
                    rows.min(frame.camera.height - first_row).div_ceil(8),
                    1,
                ];
                if skylight_pass == 0 {
                    let bound = tracer.bind(&self.gpu, &scene.buffers(&uniform, &picture, &found_light))?;
                    bands.push((bound, groups));
                }
                let bound = self.skylight.bind(&self.gpu, &[&uniform, &found_light, from, to, &picture])?;
                filters.push((bound, groups));
            }
        }
        Ok(ScenePass { pipeline: self, tracer, bands, filters, picture })
    }

    /// The device.
    pub(super) fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

/// Parts of a scene that slow down the kernel for all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct SceneParts {
    has_puddles: bool,
    has_pane: bool,
    is_wet: bool,
    shines: bool,
}

impl SceneParts {
    /// Number of combinations.
    const COUNT: usize = 16;

    fn of(frame: &RenderFrame) -> Self {
        Self {
            has_puddles: frame.puddle_count > 0,
            has_pane: frame.pane > 0,
            is_wet: frame.wetness > 0,
            shines: frame.emitters > 0,
        }
    }

    /// Index of the combination, below [`SceneParts::COUNT`].
    fn index(self) -> usize {
        let flags = [self.has_puddles, self.has_pane, self.is_wet, self.shines];
        flags.iter().rev().fold(0, |index, &flag| index << 1 | usize::from(flag))
    }
}

/// The kernel that traces scenes: with what they have not, it would be slower for all.
fn tracer(gpu: &Gpu, parts: SceneParts) -> Result<ComputeKernel, GpuError> {
    let number = |on: bool| if on { 1.0 } else { 0.0 };
    let overrides = [
        ("SCENE_WET", number(parts.has_puddles)),
        ("SCENE_PANE", number(parts.has_pane)),
        ("WET_SURFACES", number(parts.is_wet)),
        ("SCENE_SHINES", number(parts.shines)),
    ];
    ComputeKernel::new(gpu, &TRACE_KERNEL, &overrides)
}

/// A frame of a scene, ready to be drawn.
#[derive(Debug)]
pub struct ScenePass<'a> {
    pipeline: &'a ScenePipeline,
    tracer: &'a ComputeKernel,
    bands: Vec<(wgpu::BindGroup, [u32; 3])>,
    filters: Vec<(wgpu::BindGroup, [u32; 3])>,
    picture: wgpu::Buffer,
}

impl ScenePass<'_> {
    /// The dispatches, one band of rows each: first those that trace, then those that filter.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        [self.rays(), self.filters()].concat()
    }

    /// Those that trace.
    #[must_use]
    pub fn rays(&self) -> Vec<Dispatch<'_>> {
        self.bands.iter().map(|(bound, groups)| self.tracer.dispatch(bound, *groups)).collect()
    }

    /// Those that filter the light of the sky, after them.
    #[must_use]
    pub fn filters(&self) -> Vec<Dispatch<'_>> {
        let kernel = &self.pipeline.skylight;
        self.filters.iter().map(|(bound, groups)| kernel.dispatch(bound, *groups)).collect()
    }

    /// The picture on the device: radiance and nearest distance, rows from the top.
    #[must_use]
    pub fn picture(&self) -> &wgpu::Buffer {
        &self.picture
    }
}

impl SceneOnGpu {
    /// Brings a scene to the device where `before` is already: only what the two do not share.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn new(gpu: &Gpu, scene: &SceneData, before: Option<&Self>) -> Result<Self, GpuError> {
        macro_rules! buffer {
            ($field:ident, $label:literal) => {
                match before.filter(|before| Arc::ptr_eq(&before.of.$field, &scene.$field)) {
                    Some(before) => before.$field.clone(),
                    None => gpu.storage_buffer($label, &scene.$field)?,
                }
            };
        }
        Ok(Self {
            nodes: buffer!(nodes, "scene nodes"),
            triangles: buffer!(triangles, "scene triangles"),
            corners: buffer!(corners, "scene corners"),
            table: match before.filter(|before| before.of.table == scene.table) {
                Some(before) => before.table.clone(),
                None => gpu.storage_buffer("scene table", &scene.table)?,
            },
            texels: buffer!(texels, "scene texels"),
            sky: buffer!(sky, "scene sky"),
            of: scene.clone(),
        })
    }

    /// Lamps and obstacles of the scene with the table of `scene`, which differs from what was uploaded in its lights only, for
    /// the rain of a frame.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn lighting_of(
        &self,
        buffers: &impl BufferSource,
        frame: &RenderFrame,
        scene: &SceneData,
    ) -> Result<LightingOnGpu, GpuError> {
        let table = buffers.storage("scene table", &scene.table)?;
        Self { table, ..self.clone() }.lighting(buffers, frame)
    }

    /// Lamps and obstacles of the scene, for the rain of a frame.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn lighting(
        &self,
        buffers: &impl BufferSource,
        frame: &RenderFrame,
    ) -> Result<LightingOnGpu, GpuError> {
        let frame = buffers.uniform("frame of the lighting", frame)?;
        let of_scene = [&self.nodes, &self.triangles, &self.corners, &self.table, &self.texels];
        let [nodes, triangles, corners, table, texels] = of_scene.map(Clone::clone);
        Ok(LightingOnGpu { buffers: [frame, nodes, triangles, corners, table, texels] })
    }

    /// Nodes and triangles of the scene's bounding volume hierarchy (`downpour_bvh::Bvh`).
    #[must_use]
    pub fn obstacles(&self) -> [&wgpu::Buffer; 2] {
        [&self.nodes, &self.triangles]
    }

    /// Buffers that the kernel that traces the scene binds, in order.
    pub(super) fn buffers<'a>(
        &'a self,
        frame: &'a wgpu::Buffer,
        picture: &'a wgpu::Buffer,
        found_light: &'a wgpu::Buffer,
    ) -> [&'a wgpu::Buffer; 9] {
        let [nodes, triangles, corners] = [&self.nodes, &self.triangles, &self.corners];
        [frame, nodes, triangles, corners, &self.table, &self.texels, &self.sky, picture, found_light]
    }
}
