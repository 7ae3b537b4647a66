//! Puddle on a GPU: the same numbers as [`Puddle`](crate::puddle::Puddle), with several time steps per dispatch, in
//! tiles; for the membrane one step per dispatch, without tiles.

use downpour_gpu::{
    BufferPool, BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, timing::PassTime, wgpu,
};
use downpour_math::ops::ops_is_finite;
use downpour_math::packing::packing_unpack_snorm;
use downpour_math::pyramid::PyramidLevel;
use downpour_shaders::common::PYRAMID_KERNEL;
use downpour_shaders::lattice::puddle::{
    DIRECT_KERNEL, NORMAL_KERNEL, PUDDLE_STEP_TILE, SEED_KERNEL, SLOPES_KERNEL, STEP_KERNEL,
};

use crate::error::LatticeError;
use crate::puddle::lattice::{PuddleGrid, puddle_state_pack, puddle_state_unpack};
use crate::puddle::{
    CraterMaker, Craters, Impact, Model, PuddleOptions, PuddleSeed, PuddleStorage, SeedSquares, Wake,
    craters, footprints, slope_levels, whole_normal,
};

/// Maximum number of seeds per dispatch: a driver may end an invocation that loops too long.
const SEEDS: usize = 4096;

/// Error of a puddle on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuPuddleError {
    /// The puddle is not valid.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Kernels of puddles of a device: they serve any number of puddles, one after another.
#[derive(Clone, Debug)]
pub struct PuddleKernels {
    gpu: Gpu,
    step: ComputeKernel,
    seed: ComputeKernel,
    normal: ComputeKernel,
    slopes: ComputeKernel,
    pyramid: ComputeKernel,
}

impl PuddleKernels {
    /// Creates the kernels.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            gpu: gpu.clone(),
            step: kernel(&STEP_KERNEL)?,
            seed: kernel(&SEED_KERNEL)?,
            normal: kernel(&NORMAL_KERNEL)?,
            slopes: kernel(&SLOPES_KERNEL)?,
            pyramid: kernel(&PYRAMID_KERNEL)?,
        })
    }
}

/// Kernels of one submission.
#[derive(Debug, Default)]
struct Work {
    kernels: Vec<(ComputeKernel, wgpu::BindGroup, [u32; 3])>,
    /// Which of the states is the newer one after them.
    newer: usize,
    /// Time steps.
    steps: u64,
}

/// A puddle on a GPU.
#[derive(Debug)]
pub struct GpuPuddle {
    gpu: Gpu,
    model: Model,
    /// Grid of the whole lattice, for kernels that do not step.
    whole: PuddleGrid,
    kernels: PuddleKernels,
    /// Kernel of a single step: faster than tiles for degree 1.
    direct: Option<ComputeKernel>,
    /// Uniforms and seeds. A frame of the pool is one submission.
    pool: BufferPool,
    bytes_uploaded: u64,
    links: wgpu::Buffer,
    /// Two copies of the state.
    states: [wgpu::Buffer; 2],
    newer: usize,
    reset: wgpu::Buffer,
    reset_before: u64,
    steps: u64,
}

impl GpuPuddle {
    /// Creates level water over the whole lattice.
    ///
    /// # Errors
    /// [`GpuPuddleError::Lattice`] names the option out of range; else errors of the GPU.
    pub fn new(gpu: &Gpu, options: &PuddleOptions) -> Result<Self, GpuPuddleError> {
        Self::with_kernels(&PuddleKernels::new(gpu)?, options)
    }

    /// The same with kernels that are there already.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_kernels(kernels: &PuddleKernels, options: &PuddleOptions) -> Result<Self, GpuPuddleError> {
        Self::assemble(kernels, Model::new(options, None)?)
    }

    /// Creates level water where `land` is false.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_land(gpu: &Gpu, options: &PuddleOptions, land: &[bool]) -> Result<Self, GpuPuddleError> {
        Self::assemble(&PuddleKernels::new(gpu)?, Model::new(options, Some(land))?)
    }

    fn assemble(kernels: &PuddleKernels, mut model: Model) -> Result<Self, GpuPuddleError> {
        let gpu = &kernels.gpu;
        let whole = model.grid(model.limit(), 1);
        let state = || level_state(gpu, &model);
        // 16-bit numbers are rounded once per sweep, so the steps per sweep affect the result.
        let plain = model.degree == 1 && model.options.storage == PuddleStorage::Full;
        let direct = plain.then(|| ComputeKernel::new(gpu, &DIRECT_KERNEL, &[]));
        Ok(Self {
            direct: direct.transpose()?,
            whole,
            kernels: kernels.clone(),
            pool: BufferPool::new(gpu),
            bytes_uploaded: model.links.bytes.len() as u64,
            links: gpu.storage_buffer("puddle links", &model.links.bytes)?,
            states: [state()?, state()?],
            newer: 0,
            reset: gpu.storage_buffer("puddle resets", &[0u32])?,
            reset_before: 0,
            steps: 0,
            gpu: gpu.clone(),
            model,
        })
    }

    /// Options of the puddle.
    #[must_use]
    pub fn options(&self) -> &PuddleOptions {
        &self.model.options
    }

    /// Maximum number of time steps per dispatch, from the options and the degree of the operator.
    #[must_use]
    pub fn steps_per_sweep(&self) -> u32 {
        self.model.steps_per_sweep()
    }

    /// Advances the puddle by `dt_s` seconds. Returns the number of sub-steps. Does not wait.
    ///
    /// # Errors
    /// [`GpuPuddleError::Lattice`] if the time is not valid; else errors of the GPU.
    pub fn step(&mut self, dt_s: f32) -> Result<u32, GpuPuddleError> {
        let substeps = self.model.substeps(f64::from(dt_s))?;
        self.pool.begin_frame();
        let mut work = Work { newer: self.newer, ..Work::default() };
        self.add_steps(&mut work, f64::from(dt_s), substeps)?;
        self.submit(&work)?;
        Ok(substeps)
    }

    /// Maker of craters for this puddle.
    #[must_use]
    pub fn crater_maker(&self) -> CraterMaker {
        CraterMaker::new(&self.model)
    }

    /// Adds craters, which are of this puddle's [`crater_maker`](Self::crater_maker), and then advances the puddle by `dt_s` seconds,
    /// once for each of `steps`: in one submission. Does not wait.
    ///
    /// # Errors
    /// As [`step`](Self::step); the puddle is then unchanged.
    pub fn rain(&mut self, steps: &[Craters], dt_s: f32) -> Result<(), GpuPuddleError> {
        let substeps = self.model.substeps(f64::from(dt_s))?;
        self.pool.begin_frame();
        let mut work = Work { newer: self.newer, ..Work::default() };
        for Craters(seeds) in steps {
            self.add_seeds(&mut work, seeds)?;
            self.add_steps(&mut work, f64::from(dt_s), substeps)?;
        }
        self.submit(&work)
    }

    /// Adds `substeps` sub-steps, `dt_s` seconds together, to some work.
    fn add_steps(&mut self, work: &mut Work, dt_s: f64, substeps: u32) -> Result<(), GpuPuddleError> {
        let dt = dt_s / f64::from(substeps);
        let full = if self.direct.is_some() { 1 } else { self.model.steps_per_sweep() };
        let kernel = self.direct.as_ref().unwrap_or(&self.kernels.step);
        let (whole, rest) = (substeps / full, substeps % full);
        let mut sweeps = vec![full; whole as usize];
        sweeps.extend((rest > 0).then_some(rest));
        let uniforms =
            [full, rest.max(1)].map(|steps| self.pool.uniform("puddle grid", &self.model.grid(dt, steps)));
        let [full_uniform, rest_uniform] = uniforms;
        let (full_uniform, rest_uniform) = (full_uniform?, rest_uniform?);
        for steps in sweeps {
            let (from, to) = (&self.states[work.newer], &self.states[1 - work.newer]);
            let uniform = if steps == full { &full_uniform } else { &rest_uniform };
            let bindings = kernel.bind(&self.pool, &[uniform, &self.links, from, to, &self.reset])?;
            work.kernels.push((kernel.clone(), bindings, self.groups(steps, self.direct.is_some())));
            work.newer = 1 - work.newer;
        }
        work.steps += u64::from(substeps);
        Ok(())
    }

    /// Adds seeds to some work.
    fn add_seeds(&self, work: &mut Work, seeds: &[PuddleSeed]) -> Result<(), GpuPuddleError> {
        for seeds in seeds.chunks(SEEDS) {
            let squares = SeedSquares::new(&self.model.links, seeds);
            if squares.entries.is_empty() {
                continue;
            }
            let uniform = self.pool.uniform("puddle grid", &self.whole)?;
            let list = self.pool.storage("puddle seeds", seeds)?;
            let first = self.pool.storage("puddle seeds of squares", &squares.first)?;
            let entries = self.pool.storage("puddle seed entries", &squares.entries)?;
            let [from, to] = [work.newer, 1 - work.newer].map(|k| &self.states[k]);
            let buffers = [&uniform, &self.links, from, &list, &first, &entries, to];
            let bindings = self.kernels.seed.bind(&self.pool, &buffers)?;
            work.kernels.push((self.kernels.seed.clone(), bindings, groups_of(&self.whole)));
            work.newer = 1 - work.newer;
        }
        Ok(())
    }

    /// Submits some work, if there is any.
    fn submit(&mut self, work: &Work) -> Result<(), GpuPuddleError> {
        if work.kernels.is_empty() {
            return Ok(());
        }
        let dispatches: Vec<Dispatch<'_>> = work
            .kernels
            .iter()
            .map(|(kernel, bindings, groups)| kernel.dispatch(bindings, *groups))
            .collect();
        self.gpu.submit(&dispatches)?;
        self.bytes_uploaded += self.pool.written();
        self.newer = work.newer;
        self.steps += work.steps;
        Ok(())
    }

    /// Number of workgroups of a sweep: a tile writes its cells without the halo.
    fn groups(&self, steps: u32, direct: bool) -> [u32; 3] {
        if direct {
            let [_, ny] = self.model.options.size;
            return [(self.model.links.stride() as u32 / 4).div_ceil(32), ny.div_ceil(8), 1];
        }
        let halo = (self.model.degree * steps).next_multiple_of(4);
        let inner = PUDDLE_STEP_TILE - 2 * halo;
        let [nx, ny] = self.model.options.size;
        [nx.div_ceil(inner), ny.div_ceil(inner), 1]
    }

    /// Time of the device for `repeats` sweeps of `steps` time steps each (at most what the options allow), as the
    /// mean of one. The puddle advances.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn time_sweep(&mut self, dt_s: f32, steps: u32, repeats: u32) -> Result<PassTime, GpuPuddleError> {
        self.model.substeps(f64::from(dt_s))?;
        let steps = steps.clamp(1, self.model.steps_per_sweep());
        let dt = f64::from(dt_s).min(self.model.limit());
        let uniform = self.gpu.uniform_buffer("puddle grid", &self.model.grid(dt, steps))?;
        let direct = self.direct.as_ref().filter(|_| steps == 1);
        let kernel = direct.unwrap_or(&self.kernels.step);
        let bind = |from: usize| {
            let buffers = [&uniform, &self.links, &self.states[from], &self.states[1 - from], &self.reset];
            kernel.bind(&self.gpu, &buffers)
        };
        let (there, back) = (bind(self.newer)?, bind(1 - self.newer)?);
        let groups = self.groups(steps, direct.is_some());
        let pair = [kernel.dispatch(&there, groups), kernel.dispatch(&back, groups)];
        let pairs = repeats.div_ceil(2);
        let time = self.gpu.time(&pair, pairs)?;
        self.steps += u64::from(2 * pairs) * u64::from(steps);
        Ok(PassTime { device: time.device.map(|t| t / 2), wall: time.wall / 2 })
    }

    /// Adds the crater of each impact.
    ///
    /// # Errors
    /// As [`Puddle::seed`](crate::puddle::Puddle::seed); else errors of the GPU.
    pub fn seed(&mut self, impacts: &[Impact]) -> Result<(), GpuPuddleError> {
        let seeds = craters(&self.model, impacts)?;
        self.add(&seeds)
    }

    /// Displaces water by an object that moves through it.
    ///
    /// # Errors
    /// As [`Puddle::displace`](crate::puddle::Puddle::displace); else errors of the GPU.
    pub fn displace(&mut self, wake: &Wake) -> Result<(), GpuPuddleError> {
        let seeds = footprints(&self.model, wake)?;
        self.add(&seeds)
    }

    fn add(&mut self, seeds: &[PuddleSeed]) -> Result<(), GpuPuddleError> {
        self.pool.begin_frame();
        let mut work = Work { newer: self.newer, ..Work::default() };
        self.add_seeds(&mut work, seeds)?;
        self.submit(&work)
    }

    /// Makes the water level again. Does not wait.
    ///
    /// # Errors
    /// Errors of the GPU; the puddle is then unchanged.
    pub fn set_level(&mut self) -> Result<(), GpuPuddleError> {
        self.states[self.newer] = level_state(&self.gpu, &self.model)?;
        Ok(())
    }

    /// Slopes of the present state, for kernels that other work submits before the puddle is stepped or seeded again.
    #[must_use]
    pub fn slopes(&self) -> PuddleSlopes {
        PuddleSlopes {
            slopes: self.kernels.slopes.clone(),
            pyramid: self.kernels.pyramid.clone(),
            grid: self.whole,
            links: self.links.clone(),
            state: self.states[self.newer].clone(),
        }
    }

    /// Number of bytes that were written to the device for steps and seeds so far, and for the links.
    #[must_use]
    pub fn bytes_uploaded(&self) -> u64 {
        self.bytes_uploaded
    }

    /// Heights over the level, m, and velocities, m/s, row by row. Waits.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn state(&self) -> Result<[Vec<f32>; 2], GpuPuddleError> {
        let buffer = &self.states[self.newer];
        let quads: Vec<[[f32; 4]; 2]> = match self.model.options.storage {
            PuddleStorage::Full => self.gpu.read(buffer)?,
            PuddleStorage::Half => {
                let words: Vec<[u32; 4]> = self.gpu.read(buffer)?;
                let unpack = |quad: &[u32; 4]| [0, 1].map(|k| quad.map(|word| puddle_state_unpack(word)[k]));
                words.iter().map(unpack).collect()
            }
        };
        Ok([0, 1].map(|k| {
            let [nx, _] = self.model.links.size;
            let rows = quads.chunks_exact(self.model.links.stride() / 4);
            rows.flat_map(|row| row.iter().flat_map(move |quad| quad[k]).take(nx)).collect()
        }))
    }

    /// Heights over the level, m, row by row. Waits.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn heights(&self) -> Result<Vec<f32>, GpuPuddleError> {
        let [heights, _] = self.state()?;
        Ok(heights)
    }

    /// Sets heights and velocities, as [`Puddle::set_state`](crate::puddle::Puddle::set_state).
    ///
    /// # Errors
    /// As there; else errors of the GPU.
    pub fn set_state(&mut self, heights: &[f32], velocities: &[f32]) -> Result<u64, GpuPuddleError> {
        let cells = self.model.cells();
        for (quantity, values) in [("the field of heights", heights), ("the field of velocities", velocities)]
        {
            if values.len() != cells {
                return Err(LatticeError::Cells { quantity, found: values.len(), allowed: cells }.into());
            }
        }
        let ([nx, ny], stride) = (self.model.links.size, self.model.links.stride());
        let mut quads = vec![[[0.0f32; 4]; 2]; stride / 4 * ny];
        let mut bad = 0;
        for (i, (&height, &velocity)) in heights.iter().zip(velocities).enumerate() {
            let (x, y) = (i % nx, i / nx);
            if !self.model.links.is_water(x, y) {
                continue;
            }
            if ops_is_finite(height) && ops_is_finite(velocity) {
                let quad = &mut quads[(y * stride + x) / 4];
                quad[0][x % 4] = height;
                quad[1][x % 4] = velocity;
            } else {
                bad += 1;
            }
        }
        self.reset_before += bad;
        self.states[self.newer] = match self.model.options.storage {
            PuddleStorage::Full => self.gpu.storage_buffer("puddle state", &quads)?,
            PuddleStorage::Half => {
                let words: Vec<[u32; 4]> = quads
                    .iter()
                    .map(|[h, v]| std::array::from_fn(|i| puddle_state_pack(h[i], v[i])))
                    .collect();
                self.gpu.storage_buffer("puddle state", &words)?
            }
        };
        Ok(bad)
    }

    /// Normals of the surface, as [`Puddle::normals`](crate::puddle::Puddle::normals), accurate to 3e-5. Waits.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn normals(&self) -> Result<Vec<[f32; 3]>, GpuPuddleError> {
        let uniform = self.gpu.uniform_buffer("puddle grid", &self.whole)?;
        let stride = self.model.links.stride();
        let bytes = (stride * self.model.links.size[1] * 4) as u64;
        let words = self.gpu.empty_buffer("puddle normals", bytes, wgpu::BufferUsages::STORAGE)?;
        let buffers = [&uniform, &self.links, &self.states[self.newer], &words];
        let bindings = self.kernels.normal.bind(&self.gpu, &buffers)?;
        self.gpu.submit(&[self.kernels.normal.dispatch(&bindings, groups_of(&self.whole))])?;
        let words: Vec<u32> = self.gpu.read(&words)?;
        let rows = words.chunks_exact(stride);
        let [nx, _] = self.model.links.size;
        Ok(rows.flat_map(|row| row.iter().take(nx).map(|&w| whole_normal(packing_unpack_snorm(w)))).collect())
    }

    /// Number of cells that were reset because they were not finite. Waits.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn reset_cells(&self) -> Result<u64, GpuPuddleError> {
        let count: Vec<u32> = self.gpu.read(&self.reset)?;
        Ok(self.reset_before + count.first().copied().map_or(0, u64::from))
    }

    /// Number of time steps so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Buffer of the newest state, for other shaders: a quad of heights and one of velocities for each four cells of a
    /// row, as f32, or four words of two 16-bit numbers in units of 1/1024. Each call makes the other copy the newest.
    #[must_use]
    pub fn state_buffer(&self) -> &wgpu::Buffer {
        &self.states[self.newer]
    }
}

/// State of level water: new buffers are zero.
fn level_state(gpu: &Gpu, model: &Model) -> Result<wgpu::Buffer, GpuError> {
    let cells = (model.links.stride() * model.links.size[1]) as u64;
    let bytes = cells * if model.options.storage == PuddleStorage::Half { 4 } else { 8 };
    gpu.empty_buffer("puddle state", bytes, wgpu::BufferUsages::STORAGE)
}

/// Workgroups of kernels with an invocation for each quad.
fn groups_of(grid: &PuddleGrid) -> [u32; 3] {
    [grid.quads.div_ceil(16), grid.size[1].div_ceil(16), 1]
}

/// Slopes of a puddle on a GPU at a time, in levels.
#[derive(Clone, Debug)]
pub struct PuddleSlopes {
    slopes: ComputeKernel,
    pyramid: ComputeKernel,
    grid: PuddleGrid,
    links: wgpu::Buffer,
    state: wgpu::Buffer,
}

impl PuddleSlopes {
    /// Columns and rows of the finest level.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.grid.size
    }

    /// Buffer of the state that has these slopes.
    #[must_use]
    pub fn state(&self) -> &wgpu::Buffer {
        &self.state
    }

    /// Number of texels of all levels.
    #[must_use]
    pub fn texel_count(&self) -> u32 {
        let [columns, rows] = self.grid.size;
        let below: u32 = slope_levels(self.grid.size).iter().map(|level| level.size[0] * level.size[1]).sum();
        columns * rows + below
    }

    /// Prepares the kernels that write all levels, as [`Puddle::slopes`](crate::puddle::Puddle::slopes) and the means of four below
    /// it, into the texels of a storage buffer from number `first` on: four numbers each, the finest level first.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn prepare(
        &self,
        buffers: &impl BufferSource,
        texels: &wgpu::Buffer,
        first: u32,
    ) -> Result<PuddleSlopesPass<'_>, GpuError> {
        let uniform = buffers.uniform("puddle grid", &PuddleGrid { first_texel: first, ..self.grid })?;
        let bound = [(0, &uniform), (1, &self.links), (2, &self.state), (4, texels)];
        let finest = self.slopes.bind_at(buffers, bound)?;
        let mut coarser = Vec::new();
        for level in slope_levels(self.grid.size) {
            let (source, target_texel) = (first + level.source, first + level.target_texel);
            let uniform = buffers.uniform("puddle level", &PyramidLevel { source, target_texel, ..level })?;
            let groups = [level.size[0].div_ceil(8), level.size[1].div_ceil(8), 1];
            coarser.push((self.pyramid.bind(buffers, &[&uniform, texels])?, groups));
        }
        Ok(PuddleSlopesPass { of: self, finest, coarser })
    }
}

/// Slopes of a puddle, ready to be written.
#[derive(Debug)]
pub struct PuddleSlopesPass<'a> {
    of: &'a PuddleSlopes,
    finest: wgpu::BindGroup,
    coarser: Vec<(wgpu::BindGroup, [u32; 3])>,
}

impl PuddleSlopesPass<'_> {
    /// The dispatches in their order, the finest level first.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        let finest = self.of.slopes.dispatch(&self.finest, groups_of(&self.of.grid));
        let coarser = self.coarser.iter().map(|(bound, groups)| self.of.pyramid.dispatch(bound, *groups));
        std::iter::once(finest).chain(coarser).collect()
    }
}
