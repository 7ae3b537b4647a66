//! The picture of a scene on a GPU: the same rays, the same buffers.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use downpour_gpu::{
    BufferSource, ComputeKernel, Dispatch, FramePasses, Gpu, GpuError, changed_ranges, made_once, wgpu,
};
use downpour_shaders::render::scene::{
    SKYLIGHT_KERNEL, SKYLIGHT_PASSES, TRACE_KERNEL, TRACE_SAMPLE_KERNEL, TRACE_SEEN_KERNEL,
    TRACE_STATE_BYTES, TRACE_STORAGE_BUFFERS,
};

use downpour_lattice::gpu::puddle::PuddleSlopesPass;
use downpour_render::camera::Camera;
use downpour_render::gpu::LightingOnGpu;

use super::impostor::{ImpostorPass, ImpostorPipeline};
use super::ripples::RipplesOnGpu;
use super::temporal::LightOnGpu;
use crate::data::{RenderFrame, SceneData};
use crate::shared_rows::SharedRows;
use crate::trace::TraceAmbient;

/// Pixels of a dispatch on a device whose speed is not known: a submission must stay far below the time after which a driver resets.
const PIXELS_PER_DISPATCH: u32 = 1 << 17;

/// Time of a dispatch on a device whose speed is known, ms. A fast device has all pixels in one: short dispatches leave it idle at the
/// end of each.
const DISPATCH_MS: f64 = 60.0;

/// Bindings of what rays leave: the picture, and light of first surfaces and of others.
const TO: [u32; 3] = [7, 8, 10];

/// Rows of the table that are compared and written together.
const ROWS_PER_BLOCK: usize = 16;

/// Number of dispatches for the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleDispatches {
    /// All of them in one dispatch.
    Together,
    /// Each in a dispatch of its own, with what the pixel has so far in a buffer: software drivers of Mesa end the loops of an
    /// invocation after 65 535 turns in all, without an error; and devices with no more than WebGPU's default limits have too few
    /// bindings for all of them.
    Apart,
}

impl SampleDispatches {
    /// The number that a device needs.
    fn of(gpu: &Gpu) -> Self {
        let buffers = gpu.device().limits().max_storage_buffers_per_shader_stage;
        let apart = gpu.adapter().is_software() || buffers < TRACE_STORAGE_BUFFERS;
        if apart { Self::Apart } else { Self::Together }
    }
}

/// Pipeline that traces scenes.
#[derive(Clone, Debug)]
pub struct ScenePipeline {
    gpu: Gpu,
    samples: SampleDispatches,
    /// Pixels of samples that have dispatches of their own.
    seen: Option<ComputeKernel>,
    /// By what a scene has: [`SceneParts`]. Made for the first scene that has it.
    tracers: [OnceLock<ComputeKernel>; SceneParts::COUNT],
    skylight: ComputeKernel,
    impostors: ImpostorPipeline,
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
        Self::made(gpu, SampleDispatches::of(gpu))
    }

    /// Creates the pipeline, whatever the device needs.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    #[cfg(feature = "parity")]
    #[doc(hidden)]
    pub fn with_samples(gpu: &Gpu, samples: SampleDispatches) -> Result<Self, GpuError> {
        Self::made(gpu, samples)
    }

    fn made(gpu: &Gpu, samples: SampleDispatches) -> Result<Self, GpuError> {
        let tracers: [OnceLock<ComputeKernel>; SceneParts::COUNT] = std::array::from_fn(|_| OnceLock::new());
        let plain = SceneParts::default();
        made_once(&tracers[plain.index()], || tracer(gpu, samples, plain))?;
        let skylight = ComputeKernel::new(gpu, &SKYLIGHT_KERNEL, &[])?;
        let seen = match samples {
            SampleDispatches::Together => None,
            SampleDispatches::Apart => Some(ComputeKernel::new(gpu, &TRACE_SEEN_KERNEL, &[])?),
        };
        Ok(Self {
            gpu: gpu.clone(),
            samples,
            seen,
            tracers,
            skylight,
            impostors: ImpostorPipeline::default(),
        })
    }

    /// The kernel that traces a frame, with what the scene has and without what it has not.
    fn tracer(&self, frame: &RenderFrame) -> Result<&ComputeKernel, GpuError> {
        let parts = SceneParts::of(frame);
        made_once(&self.tracers[parts.index()], || tracer(&self.gpu, self.samples, parts))
    }

    /// True if all samples of a pixel are one dispatch.
    pub(super) fn takes_samples_together(&self) -> bool {
        self.samples == SampleDispatches::Together
    }

    /// Uploads a scene.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if a buffer is larger than the device allows, or what else the GPU says.
    pub fn upload(&self, scene: &SceneData) -> Result<SceneOnGpu, GpuError> {
        SceneOnGpu::new(&self.gpu, scene)
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
        self.prepare_paced(buffers, scene, frame, None, ["light of the sky", "means of light"])
    }

    /// The same on a device that took so long for a sample of a like frame, ms, with the light in buffers of these labels.
    pub(super) fn prepare_paced(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        sample_ms: Option<f64>,
        [of_light, of_means]: [&'static str; 2],
    ) -> Result<ScenePass<'_>, GpuError> {
        let pixels = u64::from(frame.camera.width) * u64::from(frame.camera.height);
        let storage = wgpu::BufferUsages::STORAGE;
        let picture = buffers.buffer("picture", pixels * 16, storage)?;
        let bytes = pixels * size_of::<TraceAmbient>() as u64;
        let found_light = buffers.buffer(of_light, bytes, storage)?;
        let of_others = buffers.buffer("light of other surfaces", bytes, storage)?;
        let samples = f64::from(frame.grid * frame.grid);
        // What pixels have so far takes room on a device that keeps it.
        let pace = sample_ms.filter(|_| self.takes_samples_together());
        let paced = pace.map_or(0, |ms| (DISPATCH_MS / (ms * samples).max(1.0e-9)) as u32);
        let rows = paced.max(PIXELS_PER_DISPATCH) / frame.camera.width.max(1);
        let rows = rows.clamp(8, frame.camera.height.max(8)).next_multiple_of(8 * frame.ray_spacing);
        let (mut bands, mut filters) = (Vec::new(), Vec::new());
        let states = self.states(buffers, &frame.camera, rows.min(frame.camera.height))?;
        let impostors = self.impostors.prepare(&self.gpu, buffers, &scene.of, frame)?;
        let of_rays = RayBuffers {
            reflections: impostors.as_ref().map(ImpostorPass::drawn),
            to: [&picture, &found_light, &of_others],
            states: states.as_ref(),
        };
        for first_row in (0..frame.camera.height).step_by(rows as usize) {
            let frame = RenderFrame { first_row, ..*frame };
            let rows = rows.min(frame.camera.height - first_row);
            bands.push(self.rays(buffers, scene, &frame, of_rays, rows)?);
        }
        let means = |label| buffers.buffer(label, pixels * 32, storage);
        // The last mean is in the second; after it come the other surfaces.
        let means = [means("means of light")?, means(of_means)?];
        const { assert!(SKYLIGHT_PASSES % 2 == 1) };
        for turn in 0..=SKYLIGHT_PASSES + 1 {
            let [from, to] = [&means[(turn as usize + 1) % 2], &means[turn as usize % 2]];
            for first_row in (0..frame.camera.height).step_by(rows as usize) {
                let groups = groups(&frame.camera, rows.min(frame.camera.height - first_row));
                let frame = RenderFrame { first_row, turn, ..*frame };
                let uniform = buffers.uniform("frame", &frame)?;
                let of_means = [(0, &uniform), (1, &found_light), (2, from), (3, to), (4, &picture)];
                let bound = of_means.into_iter().chain([(9, &of_others)]);
                let bound = self.skylight.bind_at(buffers, bound)?;
                filters.push((bound, groups));
            }
        }
        let [_, means] = means;
        let light = LightOnGpu { ambient: found_light, means };
        Ok(ScenePass { pipeline: self, impostors, bands, filters, picture, light })
    }

    /// Ranges of rows of a picture, none larger than what a device takes at once that keeps what pixels have so far.
    pub(super) fn parts(&self, rows: Range<u32>, width: u32) -> Vec<Range<u32>> {
        let most = if self.takes_samples_together() { u32::MAX } else { PIXELS_PER_DISPATCH };
        let step = (most / width.max(1) / 8 * 8).max(8);
        rows.clone()
            .step_by(step as usize)
            .map(|first| first..(first.saturating_add(step)).min(rows.end))
            .collect()
    }

    /// Room for what `rows` rows of pixels have so far, if their samples have dispatches of their own.
    pub(super) fn states(
        &self,
        buffers: &impl BufferSource,
        camera: &Camera,
        rows: u32,
    ) -> Result<Option<wgpu::Buffer>, GpuError> {
        let bytes = u64::from(camera.width) * u64::from(rows) * TRACE_STATE_BYTES;
        let storage = wgpu::BufferUsages::STORAGE;
        self.seen.as_ref().map(|_| buffers.buffer("samples of pixels", bytes, storage)).transpose()
    }

    /// Prepares the rays of `rows` rows of pixels.
    pub(super) fn rays(
        &self,
        buffers: &impl BufferSource,
        scene: &SceneOnGpu,
        frame: &RenderFrame,
        RayBuffers { reflections, to, states }: RayBuffers<'_>,
        rows: u32,
    ) -> Result<SceneRays<'_>, GpuError> {
        let tracer = self.tracer(frame)?;
        let groups = frame.pixels_that_look().workgroups([frame.camera.width, rows]);
        // The kernel has the binding also where it does not read it.
        let reflections = (11, reflections.unwrap_or(&scene.sky));
        let Some((seen, states)) = self.seen.as_ref().zip(states) else {
            let uniform = buffers.uniform("frame", frame)?;
            let bound = tracer.bind_at(
                buffers,
                scene.buffers(&uniform).into_iter().chain([reflections]).chain(TO.into_iter().zip(to)),
            )?;
            return Ok(SceneRays { turns: vec![(tracer, bound)], groups });
        };
        let mut turns = Vec::new();
        for turn in 0..frame.grid * frame.grid {
            let uniform = buffers.uniform("frame", &RenderFrame { turn, ..*frame })?;
            let bound = scene.buffers(&uniform).into_iter().chain([reflections, (9, states)]);
            turns.push((tracer, tracer.bind_at(buffers, bound)?));
        }
        let uniform = buffers.uniform("frame", frame)?;
        let bound = [(0, &uniform), (9, states)].into_iter().chain(TO.into_iter().zip(to));
        turns.push((seen, seen.bind_at(buffers, bound)?));
        Ok(SceneRays { turns, groups })
    }
}

/// Workgroups for some rows of a picture.
fn groups(camera: &Camera, rows: u32) -> [u32; 3] {
    [camera.width.div_ceil(8), rows.div_ceil(8), 1]
}

/// Buffers of the rays of a frame, besides its scene's.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayBuffers<'a> {
    /// The reflection buffer, if the frame has one.
    pub(super) reflections: Option<&'a wgpu::Buffer>,
    /// Output of the rays: the picture, and the light that goes to the filter, of the first surfaces and of others.
    pub(super) to: [&'a wgpu::Buffer; 3],
    /// [`ScenePipeline::states`].
    pub(super) states: Option<&'a wgpu::Buffer>,
}

/// Rays of some rows of pixels, ready to be traced.
#[derive(Debug)]
pub(super) struct SceneRays<'a> {
    /// One after another.
    turns: Vec<(&'a ComputeKernel, wgpu::BindGroup)>,
    groups: [u32; 3],
}

impl SceneRays<'_> {
    /// The dispatches, in their order.
    pub(super) fn dispatches(&self) -> impl Iterator<Item = Dispatch<'_>> {
        self.turns.iter().map(|(kernel, bound)| kernel.dispatch(bound, self.groups))
    }
}

/// Parts of a scene that slow down the kernel for all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct SceneParts {
    has_puddles: bool,
    has_pane: bool,
    is_wet: bool,
    shines: bool,
    is_glazed: bool,
    has_impostors: bool,
    is_translucent: bool,
}

impl SceneParts {
    /// Number of combinations.
    const COUNT: usize = 128;

    fn of(frame: &RenderFrame) -> Self {
        Self {
            has_puddles: frame.puddle_count > 0,
            has_pane: frame.pane > 0,
            is_wet: frame.wetness > 0,
            shines: frame.emitters > 0,
            is_glazed: frame.glazing > 0,
            has_impostors: frame.impostors > 0,
            is_translucent: frame.translucent > 0,
        }
    }

    /// Index of the combination, below [`SceneParts::COUNT`].
    fn index(self) -> usize {
        let flags = [
            self.has_puddles,
            self.has_pane,
            self.is_wet,
            self.shines,
            self.is_glazed,
            self.has_impostors,
            self.is_translucent,
        ];
        flags.iter().rev().fold(0, |index, &flag| index << 1 | usize::from(flag))
    }
}

/// The kernel that traces scenes: with what they have not, it would be slower for all.
fn tracer(gpu: &Gpu, samples: SampleDispatches, parts: SceneParts) -> Result<ComputeKernel, GpuError> {
    let number = |on: bool| if on { 1.0 } else { 0.0 };
    let overrides = [
        ("SCENE_WET", number(parts.has_puddles)),
        ("SCENE_PANE", number(parts.has_pane)),
        ("WET_SURFACES", number(parts.is_wet)),
        ("SCENE_SHINES", number(parts.shines)),
        ("GLAZING_PANES", number(parts.is_glazed)),
        ("IMPOSTOR_REFLECTIONS", number(parts.has_impostors)),
        ("SURFACE_TRANSLUCENT", number(parts.is_translucent)),
    ];
    let kernel = match samples {
        SampleDispatches::Together => &TRACE_KERNEL,
        SampleDispatches::Apart => &TRACE_SAMPLE_KERNEL,
    };
    ComputeKernel::new(gpu, kernel, &overrides)
}

/// A frame of a scene, ready to be drawn.
#[derive(Debug)]
pub struct ScenePass<'a> {
    pipeline: &'a ScenePipeline,
    impostors: Option<ImpostorPass<'a>>,
    bands: Vec<SceneRays<'a>>,
    filters: Vec<(wgpu::BindGroup, [u32; 3])>,
    picture: wgpu::Buffer,
    light: LightOnGpu,
}

impl ScenePass<'_> {
    /// The dispatches, one band of rows each: first those that trace, then those that filter.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        [self.rays(), self.filters()].concat()
    }

    /// Those that trace, after those that draw what they look up.
    #[must_use]
    pub fn rays(&self) -> Vec<Dispatch<'_>> {
        let drawn = self.impostors.iter().flat_map(ImpostorPass::dispatches);
        drawn.chain(self.bands.iter().flat_map(SceneRays::dispatches)).collect()
    }

    /// Those that filter the light of the sky, after them.
    #[must_use]
    pub fn filters(&self) -> Vec<Dispatch<'_>> {
        let kernel = &self.pipeline.skylight;
        self.filters.iter().map(|(bound, groups)| kernel.dispatch(bound, *groups)).collect()
    }

    /// The light of sky and surfaces that it has found.
    #[must_use]
    pub fn light(&self) -> &LightOnGpu {
        &self.light
    }

    /// The picture on the device: radiance and nearest distance, rows from the top.
    #[must_use]
    pub fn picture(&self) -> &wgpu::Buffer {
        &self.picture
    }
}

impl SceneOnGpu {
    /// Brings a scene to a device.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn new(buffers: &impl BufferSource, scene: &SceneData) -> Result<Self, GpuError> {
        Self::with_table(buffers, scene, None, table_of(buffers, scene)?)
    }

    /// The same scene a moment later in place of this one: of its table only the rows that differ are written.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub(super) fn renewed(self, buffers: &impl BufferSource, scene: &SceneData) -> Result<Self, GpuError> {
        let table = if self.table.size() >= table_bytes(scene) {
            write_changes(buffers, &self.table, Some(&self.of), scene);
            self.table.clone()
        } else {
            table_of(buffers, scene)?
        };
        Self::with_table(buffers, scene, Some(&self), table)
    }

    /// A scene whose table is on the device.
    fn with_table(
        buffers: &impl BufferSource,
        scene: &SceneData,
        before: Option<&Self>,
        table: wgpu::Buffer,
    ) -> Result<Self, GpuError> {
        let still = before.and_then(|before| scene.still_ranges(&before.of)).unwrap_or_default();
        let own = scene.still_ranges(scene).unwrap_or_default();
        macro_rules! buffer {
            ($field:ident, $label:literal) => {
                match before {
                    Some(before) if Arc::ptr_eq(&before.of.$field, &scene.$field) => before.$field.clone(),
                    // What moves is written over what it was.
                    Some(before)
                        if !still.$field.is_empty() && has_room_for(&before.$field, &scene.$field) =>
                    {
                        write_around(buffers, &before.$field, &scene.$field, still.$field.clone());
                        before.$field.clone()
                    }
                    // There is room for twice as much that moves.
                    _ => on_device(buffers, $label, &scene.$field, own.$field.clone())?,
                }
            };
        }
        let sky = match before {
            Some(before) if before.of.sky == scene.sky => before.sky.clone(),
            _ => on_device(buffers, "scene sky", &scene.sky, 0..0)?,
        };
        Ok(Self {
            nodes: buffer!(nodes, "scene nodes"),
            triangles: buffer!(triangles, "scene triangles"),
            corners: buffer!(corners, "scene corners"),
            table,
            texels: buffer!(texels, "scene texels"),
            sky,
            of: scene.clone(),
        })
    }

    /// Prepares the kernels that write the ripples of a lattice on the device into the table, which have to be submitted before the scene is
    /// traced. `None` if there is no such lattice.
    ///
    /// # Errors
    /// As [`ScenePipeline::upload`].
    pub fn ripples(&self, buffers: &impl BufferSource) -> Result<Option<PuddleSlopesPass<'_>>, GpuError> {
        let first = self.of.row_count() as u32;
        self.of.ripples.as_ref().map(|ripples| ripples.prepare(buffers, &self.table, first)).transpose()
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
        let mut rows = scene.table.clone();
        rows.extend(scene.shared_places().into_iter().flat_map(|(_, shared)| shared.rows()));
        let table = buffers.storage("scene table", &rows)?;
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

    /// Buffers that a kernel that traces the scene reads, by their bindings.
    fn buffers<'a>(&'a self, frame: &'a wgpu::Buffer) -> [(u32, &'a wgpu::Buffer); 7] {
        let [nodes, triangles, corners] = [&self.nodes, &self.triangles, &self.corners];
        let all = [frame, nodes, triangles, corners, &self.table, &self.texels, &self.sky];
        std::array::from_fn(|binding| (binding as u32, all[binding]))
    }
}

/// A storage buffer with some data, with room for as much again as what is not in `still`, if anything stands still.
fn on_device<T: bytemuck::Pod>(
    buffers: &impl BufferSource,
    label: &'static str,
    data: &[T],
    still: Range<usize>,
) -> Result<wgpu::Buffer, GpuError> {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let moving = if still.is_empty() { 0 } else { data.len() - still.len() };
    let wanted = (bytes.len() + moving * size_of::<T>()) as u64;
    let size = if wanted <= buffers.gpu().max_storage_bytes() { wanted } else { bytes.len() as u64 };
    let buffer = buffers.gpu().empty_buffer(label, size, wgpu::BufferUsages::STORAGE)?;
    buffers.write(&buffer, bytes);
    Ok(buffer)
}

/// True if some data are no larger than a buffer.
fn has_room_for<T>(buffer: &wgpu::Buffer, data: &[T]) -> bool {
    size_of_val(data) as u64 <= buffer.size()
}

/// Writes the elements of a buffer but those in `still`, which are there.
fn write_around<T: bytemuck::Pod>(
    buffers: &impl BufferSource,
    buffer: &wgpu::Buffer,
    data: &[T],
    still: Range<usize>,
) {
    for range in [0..still.start, still.end..data.len()] {
        let offset = (range.start * size_of::<T>()) as u64;
        buffers.write_at(buffer, offset, bytemuck::cast_slice(&data[range]));
    }
}

/// Bytes of the table of a scene with room for the ripples of a lattice on the device.
fn table_bytes(scene: &SceneData) -> u64 {
    let ripples = scene.ripples.as_ref().map_or(0, RipplesOnGpu::row_count);
    (scene.row_count() as u64 + u64::from(ripples)) * 16
}

/// The table of a scene on the device, with room for the ripples of a lattice there.
fn table_of(buffers: &impl BufferSource, scene: &SceneData) -> Result<wgpu::Buffer, GpuError> {
    let table = buffers.gpu().empty_buffer("scene table", table_bytes(scene), wgpu::BufferUsages::STORAGE)?;
    write_changes(buffers, &table, None, scene);
    Ok(table)
}

/// Writes the rows of a table that differ from those of the scene that is there, and the row that says where ripples on the device are.
fn write_changes(
    buffers: &impl BufferSource,
    table: &wgpu::Buffer,
    before: Option<&SceneData>,
    scene: &SceneData,
) {
    let there = before.map_or(&[][..], |before| &before.table);
    // That row is not the host's there.
    let own = before.filter(|before| before.ripples.is_some()).map(|before| before.ripples_row() as usize);
    let own = own.and_then(|row| scene.table.get(row).map(|_| row..row + 1));
    for rows in changed_rows(there, &scene.table).into_iter().chain(own) {
        buffers.write_at(table, 16 * rows.start as u64, bytemuck::cast_slice(&scene.table[rows]));
    }
    let known = before.map(SceneData::shared_places).unwrap_or_default();
    for (first, shared) in scene.shared_places() {
        let there = known.iter().find(|(at, _)| *at == first).map(|(_, shared)| *shared);
        if there.is_some_and(|there| there.is(shared)) {
            continue;
        }
        let rows = shared.rows();
        for changed in changed_rows(there.map_or(&[], SharedRows::rows), rows) {
            let at = 16 * (u64::from(first) + changed.start as u64);
            buffers.write_at(table, at, bytemuck::cast_slice(&rows[changed]));
        }
    }
    if let Some(ripples) = &scene.ripples {
        let head = ripples.head(scene.row_count() as u32);
        buffers.write_at(table, 16 * u64::from(scene.ripples_row()), bytemuck::bytes_of(&head));
        buffers.note_written(ripples.bytes_uploaded);
    }
}

/// Ranges of rows that differ, in whole blocks.
fn changed_rows(before: &[[u32; 4]], table: &[[u32; 4]]) -> Vec<Range<usize>> {
    changed_ranges(before, table, ROWS_PER_BLOCK, 1)
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;
    use std::sync::Mutex;

    use glam::{Vec2, Vec3};

    use super::*;
    use crate::builder::SceneBuilder;
    use crate::puddle::{Ground, PuddleLook, PuddleMap, PuddleRows, WakeRows};
    use crate::sky_light::SkyLight;

    /// A device without kernels that knows what was written to it.
    struct Written {
        gpu: Gpu,
        bytes: Mutex<HashMap<wgpu::Buffer, Vec<u8>>>,
        count: Mutex<usize>,
    }

    impl Written {
        fn new() -> Self {
            let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
            Self { gpu: Gpu::on_device(device, queue), bytes: Mutex::default(), count: Mutex::default() }
        }
    }

    impl BufferSource for Written {
        fn buffer(
            &self,
            label: &'static str,
            bytes: u64,
            usage: wgpu::BufferUsages,
        ) -> Result<wgpu::Buffer, GpuError> {
            self.gpu.empty_buffer(label, bytes, usage)
        }

        fn write_at(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
            let mut all = self.bytes.lock().unwrap();
            let there = all.entry(buffer.clone()).or_insert_with(|| vec![0xff; buffer.size() as usize]);
            there[offset as usize..offset as usize + bytes.len()].copy_from_slice(bytes);
            *self.count.lock().unwrap() += bytes.len();
        }

        fn gpu(&self) -> &Gpu {
            &self.gpu
        }
    }

    /// Puddles and wakes of a frame, and the bytes that it writes at least.
    type Step<'a> = (&'a [(PuddleMap, PuddleLook)], &'a [WakeRows], usize);

    /// The table on the device is that of the scene, whatever of it has changed, and of maps that have not changed nothing is written.
    #[test]
    fn a_table_follows_its_scene() {
        let map = |size: [usize; 2], depth: f32| {
            let ground = Ground { middle: Vec3::ZERO, size: Vec2::ONE, turn: 0.0, reach: 0.3 };
            let cells = (0..size[0] * size[1]).map(|i| [0.0, i as f32, depth, 1.0]).collect();
            (PuddleMap { ground, size, cells, flow: None }, PuddleLook::default())
        };
        let (large, small) = (map([100, 100], 0.01), map([20, 20], 0.02));
        let wake = WakeRows { puddle: 1, size: [8, 8], cell_m: 0.1, slopes: vec![[0.1; 4]; 64] };
        let one = std::slice::from_ref(&large);
        let two = [large.clone(), small.clone()];
        let higher = [large.clone(), map([20, 20], 0.03)];
        let steps: [Step<'_>; 7] = [
            (&two, &[], 166_400),
            // A head or two.
            (&two, &[], 0),
            (&higher, &[], 6_400),
            (&higher, &[], 0),
            // What comes later in the table moves.
            (&higher, std::slice::from_ref(&wake), 167_500),
            (&two, std::slice::from_ref(&wake), 6_400),
            (one, &[], 160_000),
        ];
        let device = Written::new();
        let scene = SceneBuilder::new().build(&SkyLight::new(1, 1, &[[1.0; 3]]));
        let mut on_device: Option<SceneOnGpu> = None;
        for (k, (puddles, wakes, wanted)) in steps.into_iter().enumerate() {
            let mut scene = scene.clone();
            let (shape, shift) = ((128, 7, 0.01), Vec3::ZERO);
            scene.set_puddles(&PuddleRows {
                puddles,
                shape,
                slopes: &[],
                shift,
                rings: None,
                wakes,
                time_s: 0.0,
            });
            *device.count.lock().unwrap() = 0;
            let now = match on_device.take() {
                Some(before) => before.renewed(&device, &scene),
                None => SceneOnGpu::new(&device, &scene),
            };
            let now = now.unwrap();
            let written = *device.count.lock().unwrap();
            assert!(k == 0 || (wanted..wanted + 2000).contains(&written), "{k}: {written} bytes");
            let rows: Vec<[u32; 4]> = (0..scene.row_count() as u32).map(|row| scene.row(row)).collect();
            let bytes = device.bytes.lock().unwrap();
            assert_eq!(bytes[&now.table][..16 * rows.len()], *bytemuck::cast_slice::<_, u8>(&rows), "{k}");
            for (k, (map, _)) in (0..).zip(puddles) {
                assert_eq!(scene.puddle_texel(scene.puddle_load(k).map[2] + 7).to_array(), map.cells[7]);
            }
            on_device = Some(now);
        }
    }

    #[test]
    fn rows_that_differ_are_written_in_blocks() {
        let changed = |before: &[[u32; 4]], table: &[[u32; 4]]| -> Vec<[usize; 2]> {
            changed_rows(before, table).into_iter().map(|rows| [rows.start, rows.end]).collect()
        };
        let table: Vec<[u32; 4]> = (0..100).map(|k| [k; 4]).collect();
        assert_eq!(changed(&[], &table), [[0, 100]]);
        assert!(changed(&table, &table).is_empty());
        let mut before = table.clone();
        (before[15], before[17], before[99]) = ([0; 4], [0; 4], [0; 4]);
        assert_eq!(changed(&before, &table), [[0, 32], [96, 100]]);
        // A table that has grown, and one that is shorter.
        assert_eq!(changed(&table[..40], &table), [[32, 100]]);
        assert!(changed(&table, &table[..32]).is_empty());
    }
}
