//! Drops put on a picture by a GPU: what [`Rain`](crate::rain::Rain) makes of its drops on the CPU.

use downpour_drop::oscillation::Fluids;
use downpour_gpu::{
    BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, KernelSequence, SequencePass, wgpu, workgroups,
    workgroups_for,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::rain::{
    PROFILES_CLEAR_KERNEL, PROFILES_FINISH_KERNEL, PROFILES_MEASURE_KERNEL, PROFILES_PLACE_KERNEL,
    PROFILES_STATE, PROJECT_KERNEL,
};

#[cfg(feature = "parity")]
use crate::rain::RainOptions;
use crate::rain::profiles::{ProfilesFrame, StreakProfiles};
use crate::rain::project::{ProjectFrame, project_frequencies};
use crate::rain::{ScreenDrop, StreakPath};

/// Kernels of the profiles in the order in which they run, with their bindings.
const PROFILES: [(&Kernel, &[u32]); 4] = [
    (&PROFILES_CLEAR_KERNEL, &[4, 8]),
    (&PROFILES_MEASURE_KERNEL, &[0, 1, 4]),
    (&PROFILES_PLACE_KERNEL, &[0, 1, 2, 3, 4, 5, 6, 7, 8]),
    (&PROFILES_FINISH_KERNEL, &[0, 4, 6, 7, 9, 10]),
];

/// Byte of the workgroups of the light among those of all jobs.
const LIGHT_GROUPS: u64 = 16;

/// Falling drops on the device: [`EyeDrop`](downpour_sim::field::EyeDrop).
#[derive(Clone, Copy, Debug)]
pub struct FallingOnGpu<'a> {
    /// The drops.
    pub drops: &'a wgpu::Buffer,
    /// Number of drops.
    pub count: u32,
    /// Frequencies of their oscillation ([`RainPipeline::frequencies`](super::RainPipeline::frequencies)).
    pub frequencies: &'a wgpu::Buffer,
}

/// The pipelines that put drops on a picture.
#[derive(Clone, Debug)]
pub struct ProjectPipeline {
    gpu: Gpu,
    project: ComputeKernel,
    profiles: KernelSequence,
}

/// Drops of a picture on the device, and the streaks among them that have a profile.
#[derive(Debug)]
pub(super) struct ListOnGpu {
    /// Places in the list; those that are empty are marked.
    pub(super) count: u32,
    pub(super) list: wgpu::Buffer,
    /// Positions and radii, for the light of lamps.
    pub(super) rows: wgpu::Buffer,
    pub(super) classes: (wgpu::Buffer, u32),
    pub(super) paths: wgpu::Buffer,
    /// Rows of rays, and parts of profiles, each behind their number.
    pub(super) jobs: [wgpu::Buffer; 2],
    pub(super) groups: JobGroups,
    /// Rays, and entries of the table.
    pub(super) room: [u32; 2],
}

/// Positions and radii of the streaks that have a profile, for the light of lamps; empty places have no radius.
#[derive(Debug)]
pub(super) struct StreaksOnGpu {
    pub(super) rows: wgpu::Buffer,
    pub(super) count: u32,
}

/// Workgroups of the jobs.
#[derive(Debug)]
pub(super) enum JobGroups {
    /// For so many jobs.
    Given([u32; 2]),
    /// As a buffer says.
    Found(wgpu::Buffer),
}

impl JobGroups {
    /// A dispatch of the rows of rays (0), or of the parts of profiles (1); `None` where there is none.
    pub(super) fn dispatch<'a>(
        &'a self,
        kind: usize,
        kernel: &'a ComputeKernel,
        bindings: &'a wgpu::BindGroup,
    ) -> Option<Dispatch<'a>> {
        match self {
            Self::Given(jobs) => (jobs[kind] > 0).then(|| kernel.dispatch(bindings, workgroups(jobs[kind]))),
            Self::Found(groups) => {
                Some(kernel.dispatch_indirect(bindings, groups, LIGHT_GROUPS * kind as u64))
            }
        }
    }
}

/// The drops of a picture, ready to be put on it.
#[derive(Debug)]
pub struct ProjectPass<'a> {
    pipeline: &'a ProjectPipeline,
    project: (wgpu::BindGroup, [u32; 3]),
    profiles: SequencePass<'a>,
}

impl ProjectPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            gpu: gpu.clone(),
            project: ComputeKernel::new(gpu, &PROJECT_KERNEL, &[])?,
            profiles: KernelSequence::new(gpu, &PROFILES)?,
        })
    }

    /// Brings the frequencies of drops in some fluids to the device.
    pub(super) fn frequencies(&self, fluids: &Fluids) -> Result<wgpu::Buffer, GpuError> {
        self.gpu.storage_buffer("frequencies of drops", &project_frequencies(fluids))
    }

    /// Makes ready to put drops on a picture; `masks` are the tables of the masks ([`DropMasks::tables`](crate::rain::DropMasks::tables)), and `classes` those of a
    /// rain without drops.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] if the lists are larger than the device allows, or what else the GPU says.
    pub(super) fn prepare(
        &self,
        buffers: &impl BufferSource,
        falling: FallingOnGpu<'_>,
        masks: &wgpu::Buffer,
        frames: (&ProjectFrame, &ProfilesFrame),
        classes: &StreakProfiles,
    ) -> Result<(ProjectPass<'_>, ListOnGpu, StreaksOnGpu), GpuError> {
        let (project, profiles) = frames;
        let storage = wgpu::BufferUsages::STORAGE;
        // A list without drops has an empty place.
        let room = project.room.max(1);
        let project = &ProjectFrame { room, ..*project };
        let words = |label, count: u32, size: usize| {
            buffers.buffer(label, u64::from(count.max(1)) * size as u64, storage)
        };
        let list = words("drops", room, size_of::<ScreenDrop>())?;
        let rows = words("positions of drops", room * (1 + project.has_axes), 16)?;
        let uniform = buffers.uniform("project frame", project)?;
        let bound = [&uniform, falling.drops, masks, falling.frequencies, &list, &rows];
        let by_drop = workgroups_for(room);
        let of_project = (self.project.bind(buffers, &bound)?, by_drop);

        let uniform = buffers.uniform("profiles frame", profiles)?;
        let (max_paths, [ray_jobs, light_jobs]) = (profiles.max_paths(), profiles.max_jobs());
        let state = words("sums of profiles", PROFILES_STATE, 4)?;
        let paths = words("paths of streaks", max_paths, size_of::<StreakPath>())?;
        let jobs =
            [words("rows of rays", 1 + ray_jobs, 8)?, words("columns of profiles", 1 + light_jobs, 8)?];
        let streaks = words("positions of streaks", max_paths, 16)?;
        let class_count = classes.classes.len() as u32;
        let classes = buffers.storage("classes of drops", &classes.classes)?;
        let found =
            buffers.buffer("groups of jobs", 2 * LIGHT_GROUPS, storage | wgpu::BufferUsages::INDIRECT)?;
        let all =
            [&uniform, &list, &rows, masks, &state, &paths, &jobs[0], &jobs[1], &streaks, &classes, &found];
        let clear = workgroups_for((streaks.size() / 16) as u32);
        let of_profiles = self.profiles.bind(buffers, &all, &[clear, by_drop, by_drop, [1; 3]])?;
        let made = ListOnGpu {
            count: room,
            list,
            rows,
            classes: (classes, class_count),
            paths,
            jobs,
            groups: JobGroups::Found(found),
            room: [profiles.max_rays, profiles.max_entries],
        };
        let pass = ProjectPass { pipeline: self, project: of_project, profiles: of_profiles };
        Ok((pass, made, StreaksOnGpu { rows: streaks, count: max_paths }))
    }
}

impl ProjectPass<'_> {
    /// The kernel that puts drops on the picture, and those of the profiles in their order. The first of these clears, and needs not
    /// wait for it.
    pub(super) fn dispatches(&self) -> (Dispatch<'_>, Vec<Dispatch<'_>>) {
        let first = self.pipeline.project.dispatch(&self.project.0, self.project.1);
        (first, self.profiles.dispatches())
    }
}

/// Results of the kernels, read back.
#[cfg(feature = "parity")]
#[doc(hidden)]
#[derive(Debug)]
pub struct ProjectFound {
    pub list: Vec<ScreenDrop>,
    pub rows: Vec<[f32; 4]>,
    pub streaks: Vec<[f32; 4]>,
    pub classes: Vec<StreakPath>,
    pub paths: Vec<StreakPath>,
    pub jobs: [Vec<[u32; 2]>; 2],
    pub groups: Vec<u32>,
}

#[cfg(feature = "parity")]
impl ProjectPipeline {
    /// Runs all kernels twice on the same buffers and reads what the second run made.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    #[doc(hidden)]
    pub fn run(
        &self,
        drops: &[downpour_sim::field::EyeDrop],
        masks: &crate::rain::DropMasks,
        frames: (&ProjectFrame, &ProfilesFrame),
        options: &RainOptions,
    ) -> Result<ProjectFound, GpuError> {
        let gpu = &self.gpu;
        let falling = gpu.storage_buffer("falling drops", drops)?;
        let frequencies = self.frequencies(&options.exposure.fluids)?;
        let falling = FallingOnGpu { drops: &falling, count: drops.len() as u32, frequencies: &frequencies };
        let tables = gpu.storage_buffer("tables of masks", masks.tables())?;
        let classes = StreakProfiles::new(
            &mut [],
            &[],
            masks,
            &options.exposure,
            downpour_shaders::render::rain::PROJECT_NO_CLASS,
        );
        let (pass, made, streaks) = self.prepare(gpu, falling, &tables, frames, &classes)?;
        let (first, profiles) = pass.dispatches();
        for _ in 0..2 {
            gpu.submit(&[first])?;
            gpu.submit(&profiles)?;
        }
        Ok(ProjectFound {
            list: gpu.read(&made.list)?,
            rows: gpu.read(&made.rows)?,
            streaks: gpu.read(&streaks.rows)?,
            classes: gpu.read(&made.classes.0)?,
            paths: gpu.read(&made.paths)?,
            jobs: [gpu.read(&made.jobs[0])?, gpu.read(&made.jobs[1])?],
            groups: match &made.groups {
                JobGroups::Given(_) => Vec::new(),
                JobGroups::Found(groups) => gpu.read(groups)?,
            },
        })
    }
}
