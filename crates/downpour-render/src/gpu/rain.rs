//! Drops before a scene on a GPU.

use std::sync::{Arc, OnceLock};

use downpour_drop::oscillation::Fluids;
use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, made_once, wgpu};
use downpour_math::pyramid::PyramidLevel;
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::render::rain::{
    STREAK_LIGHT_KERNEL, STREAK_RAYS, STREAK_RAYS_KERNEL, STREAK_TABLE_KERNEL,
};

use super::drop_light::{DropLightOnGpu, DropLightPass, DropLightPipeline};
use super::drops::{DropsOf, DropsPass, DropsPipeline};
use super::kept_light::KeptLight;
use super::layers::{LayersPass, LayersPipeline};
use super::medium::{MediumPass, MediumPipeline};
use super::plate::PlateOnGpu;
use super::project::{FallingOnGpu, JobGroups, ListOnGpu, ProjectPass, ProjectPipeline};
use super::spray::{SprayOf, SprayPass, SprayPipeline};
use super::tiles::{TilesPass, TilesPipeline};
use crate::rain::light::{DropLightTable, DropLights};
use crate::rain::profiles::ProfilesFrame;
use crate::rain::project::ProjectFrame;
use crate::rain::tiles::TilesFrame;
use crate::rain::{DropMasks, DropsFrame, Rain, RainOptions, ScreenDrop, StreakPath, StreakRay};

/// The pipelines of drops: made once, used for any number of pictures.
#[derive(Clone, Debug)]
pub struct RainPipeline {
    gpu: Gpu,
    pyramid: ComputeKernel,
    means: ComputeKernel,
    rays: ComputeKernel,
    light: ComputeKernel,
    project: ProjectPipeline,
    tiles: TilesPipeline,
    lamps: DropLightPipeline,
    medium: MediumPipeline,
    drops: DropsPipeline,
    /// Made for the first picture with layers.
    layers: Arc<OnceLock<LayersPipeline>>,
    /// Made for the first picture with spray.
    spray: Arc<OnceLock<SprayPipeline>>,
}

/// Masks on the device.
#[derive(Clone, Debug)]
pub struct RainOnGpu {
    /// Masks that were uploaded.
    of: (Arc<Vec<u32>>, DropLightTable),
    masks: wgpu::Buffer,
    tables: wgpu::Buffer,
    light: DropLightOnGpu,
}

/// The drops of one picture, ready to be drawn.
#[derive(Debug)]
pub struct RainPass<'a> {
    pipeline: &'a RainPipeline,
    levels: Vec<(wgpu::BindGroup, u32)>,
    project: Option<ProjectPass<'a>>,
    means: (wgpu::BindGroup, u32),
    /// True if the means are those of the last picture.
    has_means: bool,
    /// Their rays, and their light.
    profiles: [wgpu::BindGroup; 2],
    groups: JobGroups,
    tiles: TilesPass<'a>,
    lamps: [DropLightPass<'a>; 2],
    medium: MediumPass<'a>,
    drops: DropsPass<'a>,
    spray: Option<SprayPass>,
    layers: Option<LayersPass>,
    texels: wgpu::Buffer,
    table: wgpu::Buffer,
    layer: wgpu::Buffer,
    /// The frame of the drops, and where it is.
    frame: (DropsFrame, wgpu::Buffer),
    /// Classes with a mean, before it is known which are wanted.
    classes: Vec<StreakPath>,
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
            project: ProjectPipeline::new(gpu)?,
            tiles: TilesPipeline::new(gpu)?,
            lamps: DropLightPipeline::new(gpu)?,
            medium: MediumPipeline::new(gpu)?,
            drops: DropsPipeline::new(gpu)?,
            layers: Arc::default(),
            spray: Arc::default(),
        })
    }

    /// The pipeline of layers.
    fn layers(&self) -> Result<&LayersPipeline, GpuError> {
        made_once(&self.layers, || LayersPipeline::new(&self.gpu))
    }

    /// The pipelines of spray.
    fn spray(&self) -> Result<&SprayPipeline, GpuError> {
        made_once(&self.spray, || SprayPipeline::new(&self.gpu))
    }

    /// Drops whose lists the device can bind.
    #[must_use]
    pub fn most_drops(&self) -> u32 {
        // Lamps light 64 drops per workgroup, of which there are 65 535 along one axis.
        (self.gpu.max_storage_bytes() / size_of::<ScreenDrop>() as u64).min(64 * 65_535) as u32
    }

    /// Brings the masks to the device.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if they are larger than the device allows, or what else the GPU says.
    pub fn upload(&self, masks: &DropMasks) -> Result<RainOnGpu, GpuError> {
        Ok(RainOnGpu {
            of: (Arc::clone(&masks.words), masks.light.clone()),
            masks: self.gpu.storage_buffer("masks of drops", &masks.words)?,
            tables: self.gpu.storage_buffer("tables of masks", masks.tables())?,
            light: self.lamps.upload(&masks.light)?,
        })
    }

    /// Brings the frequencies of the oscillation of drops in some fluids to the device.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn frequencies(&self, fluids: &Fluids) -> Result<wgpu::Buffer, GpuError> {
        self.project.frequencies(fluids)
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
        buffers.buffer("environment map", Self::environment_bytes(rain), wgpu::BufferUsages::STORAGE)
    }

    /// Size of that buffer, bytes.
    #[must_use]
    pub fn environment_bytes(rain: &Rain) -> u64 {
        u64::from(rain.environment.texels()) * 16
    }

    /// Makes ready to draw drops over a plate, with buffers from `buffers`. `lights` are the lamps of `rain` on the drops, and those
    /// on the profiles of streaks.
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
        let drops = upload_list(buffers, rain)?;
        let of_lamps = [
            self.lamps.prepare_rows(
                buffers,
                plate.lighting,
                &masks.light,
                &lights[0],
                &drops.rows,
                lights[0].count(&rain.rows) as u32,
            )?,
            self.lamps.prepare(buffers, plate.lighting, &masks.light, &lights[1], &rain.streak_rows())?,
        ];
        self.prepare_list(buffers, plate, masks, rain, lights, (None, drops, of_lamps))
    }

    /// Makes ready to put drops on a picture that are on the device, and to draw them over a plate. `rain` is one without drops, of
    /// these options.
    ///
    /// # Errors
    /// As [`RainPipeline::upload`].
    pub fn prepare_falling<'a>(
        &'a self,
        buffers: &impl BufferSource,
        plate: &PlateOnGpu<'_>,
        masks: (&RainOnGpu, &DropMasks),
        (rain, options): (&Rain, &RainOptions),
        lights: &[DropLights<'_>; 2],
        falling: FallingOnGpu<'_>,
    ) -> Result<RainPass<'a>, GpuError> {
        let (masks, of_masks) = masks;
        let project = ProjectFrame::new(&rain.frame.camera, of_masks, options, falling.count);
        let profiles = ProfilesFrame::new(&options.exposure, project.room, options.medium.class());
        let frames = (&project, &profiles);
        let (pass, drops, streaks) =
            self.project.prepare(buffers, falling, &masks.tables, frames, &rain.profiles)?;
        let lamps = |lights, rows, count| {
            self.lamps.prepare_rows(buffers, plate.lighting, &masks.light, lights, rows, count)
        };
        let of_lamps =
            [lamps(&lights[0], &drops.rows, drops.count)?, lamps(&lights[1], &streaks.rows, streaks.count)?];
        self.prepare_list(buffers, plate, masks, rain, lights, (Some(pass), drops, of_lamps))
    }

    fn prepare_list<'a>(
        &'a self,
        buffers: &impl BufferSource,
        plate: &PlateOnGpu<'_>,
        masks: &RainOnGpu,
        rain: &Rain,
        lights: &[DropLights<'_>; 2],
        (project, drops, lamps): (Option<ProjectPass<'a>>, ListOnGpu, [DropLightPass<'a>; 2]),
    ) -> Result<RainPass<'a>, GpuError> {
        let storage = wgpu::BufferUsages::STORAGE;
        let (clean, texels) = (plate.pixels, plate.environment.clone());
        let level = |level: &PyramidLevel| {
            let uniform = buffers.uniform("level of the environment map", level)?;
            Ok((self.pyramid.bind(buffers, &[&uniform, &texels])?, level.size[0].div_ceil(8)))
        };
        let levels = rain.environment.levels().iter().map(level).collect::<Result<_, GpuError>>()?;
        let picture = rain.frame.camera.size();
        let pixels = u64::from(picture[0]) * u64::from(picture[1]);
        let layer = buffers.buffer("rain", pixels * 16, storage)?;
        let of_drops = DropsFrame { count: drops.count, ..rain.frame };
        let frame = buffers.uniform("drops frame", &of_drops)?;
        let tiles =
            self.tiles.prepare(buffers, &drops.list, clean, &TilesFrame::new(picture, drops.count))?;
        let [rays, entries] = drops.room.map(|count| u64::from(count.max(1)));
        let table = buffers.buffer("streak radiance", entries * 16, storage)?;
        let rays = buffers.buffer("rays of streaks", rays * size_of::<StreakRay>() as u64, storage)?;
        let means =
            (self.means.bind(buffers, &[&frame, &texels, &drops.classes.0, &table])?, drops.classes.1);
        let [ray_jobs, light_jobs] = &drops.jobs;
        let traced = self.rays.bind(buffers, &[&drops.list, &drops.paths, ray_jobs, &table, &rays])?;
        let all = [&frame, &texels, &drops.list, &drops.paths, light_jobs, &rays, lamps[1].light(), &table];
        let lit = self.light.bind(buffers, &all)?;
        let medium = self.medium.prepare(buffers, plate, &rain.medium_light(&lights[0]), &layer)?;
        let of = DropsOf {
            frame: &frame,
            texels: &texels,
            masks: &masks.masks,
            list: &drops.list,
            tiles: tiles.lists(),
            clean,
            layer: &layer,
            table: &table,
            light: lamps[0].light(),
            medium: medium.frame(),
        };
        let shown = self.drops.prepare(buffers, picture, drops.count, &of)?;
        let spray = match &rain.spray {
            Some(spray) if !lights[0].lighting.is_open() => {
                let of = SprayOf {
                    drops: &frame,
                    table: &table,
                    medium: medium.frame(),
                    phase: medium.phase(),
                    layer: &layer,
                };
                let rays = lights[0].lighting.ray_spacing();
                Some(self.spray()?.prepare(buffers, picture, plate, (spray, rays), of)?)
            }
            _ => None,
        };
        let layers = match &rain.layers {
            Some(layers) => {
                let layers = layers.lit(rain.frame.camera.eye, lights[0].lighting);
                let of = [&frame, &texels, clean, &layer];
                Some(self.layers()?.prepare(buffers, picture, &layers, of)?)
            }
            None => None,
        };
        Ok(RainPass {
            pipeline: self,
            levels,
            project,
            means,
            has_means: false,
            profiles: [traced, lit],
            groups: drops.groups,
            tiles,
            lamps,
            medium,
            drops: shown,
            spray,
            layers,
            texels,
            table,
            layer,
            frame: (of_drops, frame),
            classes: rain.profiles.classes.clone(),
        })
    }
}

/// Brings the drops of a picture to the device.
fn upload_list(buffers: &impl BufferSource, rain: &Rain) -> Result<ListOnGpu, GpuError> {
    let made = &rain.profiles;
    // Each list of jobs begins with their number.
    let headed = |jobs: &[[u32; 2]]| [&[[jobs.len() as u32, 0]], jobs].concat();
    Ok(ListOnGpu {
        count: rain.list.len() as u32,
        list: buffers.storage("drops", &rain.list)?,
        rows: buffers.storage("positions of drops", &rain.rows)?,
        classes: (buffers.storage("classes of drops", &made.classes)?, made.classes.len() as u32),
        paths: buffers.storage("paths of streaks", &made.paths)?,
        jobs: [
            buffers.storage("rows of rays", &headed(&made.ray_jobs))?,
            buffers.storage("columns of profiles", &headed(&made.light_jobs))?,
        ],
        groups: JobGroups::Given([made.ray_jobs.len() as u32, made.light_jobs.len() as u32]),
        room: [made.rays, made.entries],
    })
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

    /// Finds which drops the plate does not hide: after [`RainPass::binning`].
    #[must_use]
    pub fn seen(&self) -> Dispatch<'_> {
        self.tiles.seen()
    }

    /// For each drop its distance, m; 0 where the plate hides all of it, below 0 where it is not on the picture; and the number of
    /// drops.
    #[must_use]
    pub fn distances(&self) -> (&wgpu::Buffer, u32) {
        self.tiles.distances()
    }

    /// The light of lamps on the drops and on the streaks, in this order.
    #[must_use]
    pub fn lamps(&self) -> Vec<Dispatch<'_>> {
        self.lamps.iter().flat_map(DropLightPass::dispatches).collect()
    }

    /// The grid of the air that is open to the rain: before [`RainPass::medium`], beside anything else.
    #[must_use]
    pub fn open_air(&self) -> Dispatch<'_> {
        self.medium.open()
    }

    /// Dispatches before anything is lit or drawn, in stages that write different buffers: drops that are on the device
    /// are put on the picture, streaks get their profiles, the tiles their lists, and the drops that are too small for a profile the
    /// light of their classes. After [`RainPass::environment`].
    #[must_use]
    pub fn binning(&self) -> Vec<Vec<Dispatch<'_>>> {
        let (means, classes) = &self.means;
        let means = self.pipeline.means.dispatch(means, [STREAK_RAYS * STREAK_RAYS, *classes, 1]);
        let mut stages: Vec<Vec<Dispatch<'_>>> =
            self.tiles.dispatches().into_iter().map(|of_tiles| vec![of_tiles]).collect();
        let mut after = 0;
        if let Some(project) = &self.project {
            let (first, profiles) = project.dispatches();
            stages[0].push(first);
            after = profiles.len();
            for (stage, of_profiles) in stages.iter_mut().zip(profiles) {
                stage.push(of_profiles);
            }
        }
        if !self.has_means {
            // Which classes there are is known after the profiles.
            stages[after].push(means);
        }
        stages
    }

    /// The profiles of streaks in the streak radiance table, after the lamps.
    #[must_use]
    pub fn streaks(&self) -> Vec<Dispatch<'_>> {
        let pipeline = self.pipeline;
        let [rays, light] = &self.profiles;
        let rays = self.groups.dispatch(0, &pipeline.rays, rays);
        let light = self.groups.dispatch(1, &pipeline.light, light);
        rays.into_iter().chain(light).collect()
    }

    /// Keeps light for the next picture, and takes what is the same of the `last` one. That one has drawn before the same plate with the
    /// same environment map and the same lamps, with buffers from the same source, and no picture has since; `None`: there is none.
    pub fn keep_light(&mut self, buffers: &impl BufferSource, last: Option<&KeptLight>) -> KeptLight {
        let (drops, frame) = &mut self.frame;
        let means = KeptLight::means(last, drops, &self.classes, &self.table);
        drops.known = means.number;
        drops.made_classes = means.classes;
        self.has_means = means.are_all;
        buffers.write(frame, bytemuck::bytes_of(drops));
        if let Some(last) = last {
            self.medium.go_on_from(&last.medium);
        }
        let (table, medium) = (self.table.clone(), self.medium.of().clone());
        KeptLight { drops: *drops, classes: self.classes.clone(), table, medium }
    }

    /// The drops that are not drawn one by one, in this order; before [`RainPass::drops`].
    #[must_use]
    pub fn medium(&self) -> Vec<Dispatch<'_>> {
        self.medium.dispatches()
    }

    /// Reads what was found of the drops that are not drawn, as the twin has it.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn medium_found(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.medium.found()
    }

    /// Drops in the pixels, in this order, after all else.
    #[must_use]
    pub fn drops(&self) -> Vec<Dispatch<'_>> {
        self.drops.dispatches()
    }

    /// Reads what streaks show that were summed up, as [`Rain::sums`] has it; after [`RainPass::drops`].
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn sums(&self) -> Result<Vec<[u32; 4]>, GpuError> {
        self.drops.summed()
    }

    /// Spray behind that, if the rain has some, in this order; after [`RainPass::drops`].
    #[must_use]
    pub fn spray(&self) -> Vec<Dispatch<'_>> {
        self.spray.as_ref().map_or_else(Vec::new, SprayPass::dispatches)
    }

    /// Reads the map of heights under spray, and what was found of it before each pixel, as the twins have it; nothing without spray.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn spray_found(&self) -> Result<(Vec<f32>, Vec<[f32; 4]>), GpuError> {
        let Some(spray) = &self.spray else { return Ok((Vec::new(), Vec::new())) };
        let [map, found] = spray.made();
        Ok((self.pipeline.gpu.read(map)?, self.pipeline.gpu.read(found)?))
    }

    /// Layers of a texture before that, if the rain has some; after [`RainPass::drops`].
    #[must_use]
    pub fn layers(&self) -> Option<Dispatch<'_>> {
        self.layers.as_ref().map(LayersPass::dispatch)
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
