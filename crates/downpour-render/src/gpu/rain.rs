//! Drops before a scene on a GPU.

use std::sync::Arc;

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_math::pyramid::PyramidLevel;
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::render::rain::{
    DROPS_KERNEL, STREAK_LIGHT_KERNEL, STREAK_RAYS, STREAK_RAYS_KERNEL, STREAK_TABLE_KERNEL,
};

use super::drop_light::{DropLightOnGpu, DropLightPass, DropLightPipeline};
use super::medium::{MediumPass, MediumPipeline};
use super::plate::PlateOnGpu;
use super::tiles::{TilesPass, TilesPipeline};
use crate::rain::light::{DropLightTable, DropLights};
use crate::rain::tiles::TilesFrame;
use crate::rain::{DropMasks, DropsDrop, Rain, StreakPath, StreakRay};

/// The pipelines of drops: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct RainPipeline {
    gpu: Gpu,
    pyramid: ComputeKernel,
    means: ComputeKernel,
    rays: ComputeKernel,
    light: ComputeKernel,
    tiles: TilesPipeline,
    lamps: DropLightPipeline,
    medium: MediumPipeline,
    drops: ComputeKernel,
}

/// Masks on the device.
#[derive(Clone, Debug)]
pub struct RainOnGpu {
    /// Masks that were uploaded.
    of: (Arc<Vec<u32>>, DropLightTable),
    masks: wgpu::Buffer,
    light: DropLightOnGpu,
}

/// The drops of one picture, ready to be drawn.
#[derive(Debug)]
pub struct RainPass<'a> {
    pipeline: &'a RainPipeline,
    size: [u32; 2],
    levels: Vec<(wgpu::BindGroup, u32)>,
    means: Option<(wgpu::BindGroup, u32)>,
    profiles: Option<Profiles>,
    tiles: TilesPass<'a>,
    lamps: [DropLightPass<'a>; 2],
    medium: MediumPass<'a>,
    drops: wgpu::BindGroup,
    texels: wgpu::Buffer,
    table: wgpu::Buffer,
    layer: wgpu::Buffer,
}

/// The profiles of streaks, ready to be traced and lit.
#[derive(Debug)]
struct Profiles {
    rays: (wgpu::BindGroup, [u32; 3]),
    light: (wgpu::BindGroup, [u32; 3]),
}

/// Least sizes, bytes, for a [`BufferPool`](downpour_gpu::BufferPool): a drop before the lens has a thousand times the rays of
/// one farther off.
pub const RAIN_BUFFERS: [(&str, u64); 2] = [("rays of streaks", 32 << 20), ("streak radiance", 32 << 20)];

/// Jobs along a row of workgroups: fewer than every device allows.
const ALONG: u32 = 32_768;

/// Jobs for all workgroups of [`groups`]: the last one is done again by those that are left over. Buffers may be longer than
/// their contents, so that no workgroup may look beyond these.
fn padded(jobs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let [x, y, _] = groups(jobs.len() as u32);
    let mut all = jobs.to_vec();
    all.resize((x * y) as usize, jobs.last().copied().unwrap_or_default());
    all
}

/// Workgroups for so many jobs: no dimension has more than every device allows.
pub(super) fn groups(jobs: u32) -> [u32; 3] {
    [jobs.min(ALONG), jobs.div_ceil(ALONG), 1]
}

impl RainPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            gpu: gpu.clone(),
            pyramid: kernel(&PYRAMID_KERNEL)?,
            means: kernel(&STREAK_TABLE_KERNEL)?,
            rays: kernel(&STREAK_RAYS_KERNEL)?,
            light: kernel(&STREAK_LIGHT_KERNEL)?,
            tiles: TilesPipeline::new(gpu)?,
            lamps: DropLightPipeline::new(gpu)?,
            medium: MediumPipeline::new(gpu)?,
            drops: kernel(&DROPS_KERNEL)?,
        })
    }

    /// Brings the masks to the device.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if they are larger than the device allows, or what else the GPU says.
    pub fn upload(&self, masks: &DropMasks) -> Result<RainOnGpu, GpuError> {
        Ok(RainOnGpu {
            of: (Arc::clone(&masks.words), masks.light.clone()),
            masks: self.gpu.storage_buffer("masks of drops", &masks.words)?,
            light: self.lamps.upload(&masks.light)?,
        })
    }

    /// Brings the masks to the device, if they are not those that `before` has there.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn upload_after(&self, masks: &DropMasks, before: Option<&RainOnGpu>) -> Result<RainOnGpu, GpuError> {
        let is_same = |on: &&RainOnGpu| Arc::ptr_eq(&on.of.0, &masks.words) && on.of.1.is_same(&masks.light);
        before.filter(is_same).map_or_else(|| self.upload(masks), |on| Ok(on.clone()))
    }

    /// A buffer for the environment map of a rain, with room for all levels.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn environment(&self, buffers: &impl BufferSource, rain: &Rain) -> Result<wgpu::Buffer, GpuError> {
        let bytes = u64::from(rain.environment.texels()) * 16;
        buffers.buffer("environment map", bytes, wgpu::BufferUsages::STORAGE)
    }

    /// Makes ready to draw drops over a plate, with buffers from `buffers`. `lights` are the lamps of `rain` on the drops, and those on the profiles of
    /// streaks.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        plate: &PlateOnGpu<'_>,
        masks: &RainOnGpu,
        rain: &Rain,
        lights: &[DropLights<'_>; 2],
    ) -> Result<RainPass<'a>, GpuError> {
        let gpu = &self.gpu;
        let storage = wgpu::BufferUsages::STORAGE;
        let (clean, texels) = (plate.pixels, plate.environment.clone());
        let level = |level: &PyramidLevel| {
            let uniform = buffers.uniform("level of the environment map", level)?;
            Ok((self.pyramid.bind(gpu, &[&uniform, &texels])?, level.size[0].div_ceil(8)))
        };
        let levels = rain.environment.levels().iter().map(level).collect::<Result<_, GpuError>>()?;
        let picture = rain.frame.camera.size();
        let pixels = u64::from(picture[0]) * u64::from(picture[1]);
        let layer = buffers.buffer("rain", pixels * 16, storage)?;
        let frame = buffers.uniform("drops frame", &rain.frame)?;
        // A buffer has at least one element.
        let list: &[_] = if rain.list.is_empty() { &[DropsDrop::default()] } else { &rain.list };
        let list = buffers.storage("drops", list)?;
        let tiles = self.tiles.prepare(buffers, &list, &TilesFrame::new(picture, rain.list.len() as u32))?;
        let made = &rain.profiles;
        let table = buffers.buffer("streak radiance", u64::from(made.entries.max(1)) * 16, storage)?;
        let lamps = [
            self.lamps.prepare(buffers, plate.lighting, &masks.light, &lights[0], &rain.rows)?,
            self.lamps.prepare(buffers, plate.lighting, &masks.light, &lights[1], &rain.streak_rows())?,
        ];
        let mut means = None;
        if !made.classes.is_empty() {
            let classes = buffers.storage("classes of drops", &made.classes)?;
            let bindings = self.means.bind(gpu, &[&frame, &texels, &classes, &table])?;
            means = Some((bindings, made.classes.len() as u32));
        }
        let mut profiles = None;
        if !made.paths.is_empty() {
            let paths = buffers.storage::<StreakPath>("paths of streaks", &made.paths)?;
            let bytes = u64::from(made.rays) * size_of::<StreakRay>() as u64;
            let rays = buffers.buffer("rays of streaks", bytes, storage)?;
            let jobs = buffers.storage("rows of rays", &padded(&made.ray_jobs))?;
            let traced = self.rays.bind(gpu, &[&list, &paths, &jobs, &table, &rays])?;
            let jobs = buffers.storage("columns of profiles", &padded(&made.light_jobs))?;
            let all = [&frame, &texels, &list, &paths, &jobs, &rays, lamps[1].light(), &table];
            let lit = self.light.bind(gpu, &all)?;
            profiles = Some(Profiles {
                rays: (traced, groups(made.ray_jobs.len() as u32)),
                light: (lit, groups(made.light_jobs.len() as u32)),
            });
        }
        let medium = self.medium.prepare(buffers, plate, &rain.medium_light(&lights[0]), &layer)?;
        let bindings = [
            &frame,
            &texels,
            &masks.masks,
            &list,
            tiles.lists(),
            clean,
            &layer,
            &table,
            lamps[0].light(),
            medium.frame(),
        ];
        let drops = self.drops.bind(gpu, &bindings)?;
        Ok(RainPass {
            pipeline: self,
            size: picture,
            levels,
            means,
            profiles,
            tiles,
            lamps,
            medium,
            drops,
            texels,
            table,
            layer,
        })
    }
}

impl RainPass<'_> {
    /// The coarser levels of the environment map, after its finest one.
    #[must_use]
    pub fn environment(&self) -> Vec<Dispatch<'_>> {
        self.levels
            .iter()
            .map(|(bindings, n)| self.pipeline.pyramid.dispatch(bindings, [*n, *n, 1]))
            .collect()
    }

    /// Reads the lists of drops for the tiles of the picture, as the twin has them ([`TileLists::words`](crate::rain::tiles::TileLists::words)).
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn tile_lists(&self) -> Result<Vec<u32>, GpuError> {
        self.tiles.read()
    }

    /// The light of lamps on the drops and on the streaks, in this order.
    #[must_use]
    pub fn lamps(&self) -> Vec<Dispatch<'_>> {
        self.lamps.iter().flat_map(DropLightPass::dispatches).collect()
    }

    /// The streak radiance table, after the environment map and the lamps; nothing where no drop moves.
    #[must_use]
    pub fn streaks(&self) -> Vec<Dispatch<'_>> {
        let pipeline = self.pipeline;
        let mut all = Vec::new();
        if let Some((bindings, classes)) = &self.means {
            all.push(pipeline.means.dispatch(bindings, [STREAK_RAYS * STREAK_RAYS, *classes, 1]));
        }
        if let Some(Profiles { rays, light }) = &self.profiles {
            all.push(pipeline.rays.dispatch(&rays.0, rays.1));
            all.push(pipeline.light.dispatch(&light.0, light.1));
        }
        all
    }

    /// The drops that are not drawn one by one, in this order; before [`RainPass::drops`].
    #[must_use]
    pub fn medium(&self) -> [Dispatch<'_>; 3] {
        self.medium.dispatches()
    }

    /// Reads what was found of the drops that are not drawn, as the twin has it.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn medium_found(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.medium.found()
    }

    /// The drops: the lists of the tiles, and then what their pixels show, in this order.
    #[must_use]
    pub fn drops(&self) -> Vec<Dispatch<'_>> {
        let mut all = self.tiles.dispatches();
        let groups = [self.size[0].div_ceil(8), self.size[1].div_ceil(8), 1];
        all.push(self.pipeline.drops.dispatch(&self.drops, groups));
        all
    }

    /// The rain on the device, as [`RainPass::layer`] reads it.
    #[must_use]
    pub fn layer_buffer(&self) -> &wgpu::Buffer {
        &self.layer
    }

    /// Reads the rain: radiance, and the transmittance of the scene behind it; rows from the top.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn layer(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.layer)
    }

    /// Reads the streak radiance table.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn streak_table(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.table)
    }

    /// Reads the environment map, all levels.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn environment_texels(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.pipeline.gpu.read(&self.texels)
    }
}
