//! Pane on a GPU, with the same bits as [`Glass`](crate::glass::Glass) on the CPU.

use downpour_gpu::{ComputeKernel, Gpu, GpuError, ReadbackPool, wgpu};
use downpour_shaders::lattice::glass as shaders;
use glam::{Vec2, Vec3};

use crate::glass::blade::GlassBlade;
use crate::glass::frame::GlassFrame;
use crate::glass::host::{Plan, Ticks, free_cell, poured_units, surface, wetness};
use crate::glass::{GlassAir, GlassError, GlassOptions, GlassRain, GlassState, GlassTotals};

/// Ticks per submission: a submission must stay far below the time after which a driver resets.
const TICKS: u32 = 64;

/// Number of words of the totals.
const TOTALS: usize = 16;

/// Error of a pane on a GPU.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuGlassError {
    /// The pane is not valid.
    #[error(transparent)]
    Glass(#[from] GlassError),
    /// The GPU failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

#[derive(Debug)]
struct Kernels {
    claim: ComputeKernel,
    decide: ComputeKernel,
    transfer: ComputeKernel,
    settle: ComputeKernel,
    next: ComputeKernel,
    height: ComputeKernel,
    smooth: ComputeKernel,
    normal: ComputeKernel,
}

#[derive(Debug)]
struct Buffers {
    frame: wgpu::Buffer,
    table: wgpu::Buffer,
    surface: wgpu::Buffer,
    mass: wgpu::Buffer,
    motion: wgpu::Buffer,
    keys: wgpu::Buffer,
    wet: wgpu::Buffer,
    target: wgpu::Buffer,
    decided: wgpu::Buffer,
    next: wgpu::Buffer,
    arrival: wgpu::Buffer,
    blades: wgpu::Buffer,
    totals: wgpu::Buffer,
}

#[derive(Debug)]
struct Bindings {
    claim: wgpu::BindGroup,
    decide: wgpu::BindGroup,
    transfer: wgpu::BindGroup,
    settle: wgpu::BindGroup,
    next: wgpu::BindGroup,
}

/// A pane of glass with drops, on a GPU.
#[derive(Debug)]
pub struct GpuGlass {
    gpu: Gpu,
    plan: Plan,
    kernels: Kernels,
    buffers: Buffers,
    bindings: Bindings,
    surface: Vec<u32>,
    poured: u64,
    readbacks: ReadbackPool,
}

impl GpuGlass {
    /// Creates a dry pane.
    ///
    /// # Errors
    /// [`GpuGlassError::Glass`] if the options are not valid, else errors of the GPU: a pane of 4096 x 4096 cells needs buffers
    /// of 128 MiB.
    pub fn new(gpu: &Gpu, options: &GlassOptions) -> Result<Self, GpuGlassError> {
        let plan = Plan::new(options)?;
        let surface = surface(options)?;
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        let kernels = Kernels {
            claim: kernel(&shaders::CLAIM_KERNEL)?,
            decide: kernel(&shaders::DECIDE_KERNEL)?,
            transfer: kernel(&shaders::TRANSFER_KERNEL)?,
            settle: kernel(&shaders::SETTLE_KERNEL)?,
            next: kernel(&shaders::NEXT_KERNEL)?,
            height: kernel(&shaders::HEIGHT_KERNEL)?,
            smooth: kernel(&shaders::SMOOTH_KERNEL)?,
            normal: kernel(&shaders::NORMAL_KERNEL)?,
        };
        let buffers = Buffers::new(gpu, &plan, &surface)?;
        let bindings = Bindings::new(gpu, &kernels, &buffers)?;
        Ok(Self {
            gpu: gpu.clone(),
            plan,
            kernels,
            buffers,
            bindings,
            surface,
            poured: 0,
            readbacks: ReadbackPool::default(),
        })
    }

    /// Advances the pane by `dt_s` seconds, as [`Glass::step`](crate::glass::Glass::step); submits the work without
    /// waiting.
    ///
    /// # Errors
    /// [`GpuGlassError::Glass`] if the step is not in its range, else errors of the GPU.
    pub fn step(&mut self, dt_s: f64) -> Result<(), GpuGlassError> {
        let ticks = self.plan.ticks(dt_s)?;
        let mut first = 0;
        while first < ticks.count {
            let count = TICKS.min(ticks.count - first);
            self.submit(&ticks, first, count)?;
            first += count;
        }
        Ok(())
    }

    /// Waits until all that was submitted is done.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.gpu.wait()
    }

    /// The water on the pane now. It waits for the device.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn state(&self) -> Result<GlassState, GpuError> {
        let Buffers { mass, motion, wet, .. } = &self.buffers;
        let mut read = self.readbacks.begin(&self.gpu, &[mass, motion, wet])?;
        let clocks = read.take::<u32>(2)?;
        let traversal = clocks.iter().map(|&last| wetness(self.plan.frame(), last)).collect();
        let tails = self.plan.tails(&clocks);
        Ok(GlassState { traversal, tails, mass: read.take(0)?, motion: read.take(1)? })
    }

    fn submit(&self, ticks: &Ticks, first: u32, count: u32) -> Result<(), GpuError> {
        let frame = GlassFrame {
            first_step: ticks.frame.first_step + first,
            first_clock: ticks.frame.first_clock + first * ticks.frame.clock_step,
            ..ticks.frame
        };
        let queue = self.gpu.queue();
        queue.write_buffer(&self.buffers.frame, 0, bytemuck::bytes_of(&frame));
        queue.write_buffer(&self.buffers.totals, 0, bytemuck::bytes_of(&0u32));
        let per_tick = frame.blades as usize;
        let (from, to) = (first as usize * per_tick, (first + count) as usize * per_tick);
        let blades = ticks.blades.get(from..to).unwrap_or_default();
        queue.write_buffer(&self.buffers.blades, 0, bytemuck::cast_slice(blades));
        let [x, y] = frame.size.map(|n| n.div_ceil(16));
        let all = [x, y, 1];
        let (kernels, bindings) = (&self.kernels, &self.bindings);
        let tick = [
            kernels.claim.dispatch(&bindings.claim, all),
            kernels.decide.dispatch(&bindings.decide, all),
            kernels.transfer.dispatch(&bindings.transfer, all),
            kernels.settle.dispatch(&bindings.settle, all),
            kernels.next.dispatch(&bindings.next, [1, 1, 1]),
        ];
        let many: Vec<_> = (0..count).flat_map(|_| tick).collect();
        self.gpu.submit(&many)
    }

    /// Sets rain and air from now on, as [`Glass::set_weather`](crate::glass::Glass::set_weather).
    ///
    /// # Errors
    /// [`GpuGlassError::Glass`] as there.
    pub fn set_weather(&mut self, rain: &GlassRain, air: &GlassAir) -> Result<(), GpuGlassError> {
        self.plan.set_weather(rain, air)?;
        self.gpu.queue().write_buffer(&self.buffers.table, 0, bytemuck::bytes_of(&*self.plan.table));
        Ok(())
    }

    /// Adds water to a cell, as [`Glass::pour`](crate::glass::Glass::pour). It waits for the device.
    ///
    /// # Errors
    /// As there, and errors of the GPU.
    pub fn pour(&mut self, x: u32, y: u32, volume_m3: f64) -> Result<(), GpuGlassError> {
        let index = free_cell(self.plan.options(), &self.surface, x, y)?;
        let before = self.mass()?.get(index).copied().unwrap_or_default();
        let units = poured_units(volume_m3, before)?;
        let mass = before + units;
        self.gpu.queue().write_buffer(&self.buffers.mass, 4 * index as u64, bytemuck::bytes_of(&mass));
        self.poured += u64::from(units);
        Ok(())
    }

    /// Options of the pane.
    #[must_use]
    pub fn options(&self) -> &GlassOptions {
        self.plan.options()
    }

    /// Length of a tick, s.
    #[must_use]
    pub fn tick_s(&self) -> f64 {
        self.plan.tick_s()
    }

    /// Number of ticks that have been submitted.
    #[must_use]
    pub fn ticks(&self) -> u64 {
        self.plan.done()
    }

    /// Mass of each cell in units of [`Glass::UNIT_M3`](crate::glass::Glass::UNIT_M3), row by row from the top.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn mass(&self) -> Result<Vec<u32>, GpuError> {
        self.gpu.read(&self.buffers.mass)
    }

    /// Velocity and progress of the drop in each cell in the format of the kernels.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn motion(&self) -> Result<Vec<[u32; 2]>, GpuError> {
        self.gpu.read(&self.buffers.motion)
    }

    /// Water balance, to the unit.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn totals(&self) -> Result<GlassTotals, GpuError> {
        let words = self.gpu.read::<u32>(&self.buffers.totals)?;
        let word = |k: u32| words.get(k as usize).copied().map_or(0, u64::from);
        let total = |k: u32| word(k) | (word(k + 1) << 32);
        Ok(GlassTotals {
            landed: total(shaders::GLASS_TOTAL_LANDED),
            poured: self.poured,
            stored: self.mass()?.into_iter().map(u64::from).sum(),
            over_edge: total(shaders::GLASS_TOTAL_EDGE),
            evaporated: total(shaders::GLASS_TOTAL_EVAPORATED),
            wiped: total(shaders::GLASS_TOTAL_WIPED),
            spilled: total(shaders::GLASS_TOTAL_SPILLED),
            saturated: total(shaders::GLASS_TOTAL_SATURATED),
        })
    }

    /// Buffer of heights, in cells / 256, as [`Glass::height_units`](crate::glass::Glass::height_units).
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn height_buffer(&self) -> Result<wgpu::Buffer, GpuError> {
        let gpu = &self.gpu;
        let bytes = 4 * self.surface.len() as u64;
        let caps = gpu.empty_buffer("glass caps", bytes, wgpu::BufferUsages::STORAGE)?;
        let heights = gpu.empty_buffer("glass heights", bytes, wgpu::BufferUsages::STORAGE)?;
        // The frame on the device is that of the last submission; only its size matters here.
        let b = &self.buffers;
        let cap =
            self.kernels.height.bind(gpu, &[&b.frame, &b.table, &b.mass, &b.motion, &b.surface, &caps])?;
        let smooth = self.kernels.smooth.bind(gpu, &[&b.frame, &caps, &heights])?;
        gpu.submit(&[
            self.kernels.height.dispatch(&cap, self.groups()),
            self.kernels.smooth.dispatch(&smooth, self.groups()),
        ])?;
        Ok(heights)
    }

    /// Height of the water in each cell, m.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn heights(&self) -> Result<Vec<f32>, GpuError> {
        let unit = (self.options().cell_m / 256.0) as f32;
        let heights = self.gpu.read::<u32>(&self.height_buffer()?)?;
        Ok(heights.into_iter().map(|h| h as f32 * unit).collect())
    }

    /// Buffer of normals: x and y of each, two f32.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn normal_buffer(&self) -> Result<wgpu::Buffer, GpuError> {
        let heights = self.height_buffer()?;
        let bytes = 8 * self.surface.len() as u64;
        let normals = self.gpu.empty_buffer("glass normals", bytes, wgpu::BufferUsages::STORAGE)?;
        let bindings = self.kernels.normal.bind(&self.gpu, &[&self.buffers.frame, &heights, &normals])?;
        self.gpu.submit(&[self.kernels.normal.dispatch(&bindings, self.groups())])?;
        Ok(normals)
    }

    /// Unit normals of the water surface: x right, y down the pane, z out of it.
    ///
    /// # Errors
    /// Errors of the GPU.
    pub fn normals(&self) -> Result<Vec<Vec3>, GpuError> {
        let normals = self.gpu.read::<Vec2>(&self.normal_buffer()?)?;
        Ok(normals.into_iter().map(|n| n.extend((1.0 - n.length_squared()).max(0.0).sqrt())).collect())
    }

    fn groups(&self) -> [u32; 3] {
        let [x, y] = self.plan.frame().size.map(|n| n.div_ceil(16));
        [x, y, 1]
    }
}

impl Buffers {
    fn new(gpu: &Gpu, plan: &Plan, surface: &[u32]) -> Result<Self, GpuError> {
        // New buffers of WebGPU are zero.
        let words =
            |label, words: usize| gpu.empty_buffer(label, 4 * words as u64, wgpu::BufferUsages::STORAGE);
        let cells = surface.len();
        let blades = (plan.frame().blades * TICKS) as usize * size_of::<GlassBlade>() / 4;
        Ok(Self {
            frame: gpu.uniform_buffer("glass frame", plan.frame())?,
            table: gpu.uniform_buffer("glass table", &*plan.table)?,
            surface: gpu.storage_buffer("glass surface", surface)?,
            mass: words("glass mass", cells)?,
            motion: words("glass motion", 2 * cells)?,
            keys: words("glass keys", cells)?,
            wet: words("glass wet", cells)?,
            target: words("glass target", cells)?,
            decided: words("glass decided", 2 * cells)?,
            next: words("glass next", cells)?,
            arrival: words("glass arrival", cells)?,
            blades: words("glass blades", blades.max(size_of::<GlassBlade>() / 4))?,
            totals: words("glass totals", TOTALS)?,
        })
    }
}

impl Bindings {
    fn new(gpu: &Gpu, kernels: &Kernels, b: &Buffers) -> Result<Self, GpuError> {
        let claim = [&b.frame, &b.table, &b.mass, &b.motion, &b.keys, &b.wet, &b.totals];
        let decide = [
            &b.frame, &b.table, &b.mass, &b.motion, &b.keys, &b.wet, &b.surface, &b.target, &b.decided,
            &b.totals,
        ];
        let transfer =
            [&b.frame, &b.table, &b.mass, &b.target, &b.surface, &b.blades, &b.next, &b.arrival, &b.totals];
        let settle = [&b.frame, &b.mass, &b.motion, &b.keys, &b.arrival, &b.next, &b.decided, &b.totals];
        Ok(Self {
            claim: kernels.claim.bind(gpu, &claim)?,
            decide: kernels.decide.bind(gpu, &decide)?,
            transfer: kernels.transfer.bind(gpu, &transfer)?,
            settle: kernels.settle.bind(gpu, &settle)?,
            next: kernels.next.bind(gpu, &[&b.totals])?,
        })
    }
}
