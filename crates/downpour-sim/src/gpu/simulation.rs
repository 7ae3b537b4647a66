//! Rain on a GPU: the same steps as [`Simulation`](crate::simulation::Simulation), on drops that stay on the device.
//!
//! The drops of a view are in slots, of which there are more than drops: drops that are gone leave their slots to
//! those that enter. The slot of a drop depends on the device; the set of drops does not.

use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::Zeroable as _;
use downpour_drop::distribution::DropSizeDistribution;
use downpour_gpu::timing::PassTime;
use downpour_gpu::{BufferPool, BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::sim::enter::ENTER_KERNEL;
use downpour_shaders::sim::step::{STEP_COUNTERS, STEP_COUNTS, STEP_GONE, STEP_KERNEL, STEP_KIND};
use downpour_wind::UniformWindAt;
use downpour_wind::field::WindFieldGrid;
use glam::{DVec3, Vec3};

use super::step_list::{StepListKernels, StepListPass, StepPicture, StepPiece};
use super::{CollisionMapOnGpu, GpuSimError};
use crate::collision::CollisionMap;
use crate::enter::EnterRegion;
use crate::field::VisibleDrops;
use crate::fill::fill;
use crate::impacts::SplashOptions;
use crate::plan::{AirAtEye, Plan, Turn, lags};
use crate::recent::SPANS;
use crate::resolved::Resolved;
use crate::simulation::{Simulation, SimulationOptions, StepEvents, StepInput};
use crate::step::{StepCaught, StepDrop, StepEvent, StepFrame, StepWorld};
use crate::step_list::{Listing, listed};
use crate::view::View;

/// Maximum number of drops of a piece: two buffers of 64 MiB, which every device can bind.
const PIECE: usize = 1 << 22;

/// Number of drops of a workgroup.
const GROUP: u32 = 256;

/// Number of workgroups along the first axis.
const GROUPS: u32 = 1 << 12;

/// Maximum number of impacts in the buffer: 64 MiB.
const MAX_EVENTS: u32 = 1 << 21;

/// Number of slots per expected drop of a view.
const SLOTS_PER_DROP: f64 = 1.5;
const SPARE_SLOTS: f64 = 1024.0;

/// Number of slots per expected drop below which the slots are reallocated.
const MIN_SLOTS_PER_DROP: f64 = 1.2;

/// Maximum number of regions per bin of sizes.
const REGIONS_PER_BIN: usize = 6;

/// State at the end of a step. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct GpuStepInput<'a> {
    /// Camera; for a view the one in the middle of the time that pictures of this state cover.
    pub view: &'a View,
    /// Origin of single-precision positions, m.
    pub origin: DVec3,
    /// Wind without a field, m/s; with a field, the wind at the eye.
    pub wind: Vec3,
    /// Wind field: its grid, and the cells in its order.
    pub field: Option<(&'a WindFieldGrid, &'a wgpu::Buffer)>,
    /// Bounds on the difference of the field from the wind at the eye: per m of distance, 1/s, and in total, m/s
    /// ([`WindField::spread`](downpour_wind::WindField::spread)). Needed for views only.
    pub spread: [f32; 2],
    /// Collision map.
    pub map: Option<&'a CollisionMapOnGpu>,
    /// Uniform part of the wind, as it changes (see `StepInput`).
    pub air: Option<&'a UniformWindAt<'a>>,
}

impl<'a> GpuStepInput<'a> {
    /// Creates the input of a camera in a constant uniform wind without a collision map.
    #[must_use]
    pub fn new(view: &'a View, origin: DVec3, wind: Vec3) -> Self {
        Self { view, origin, wind, field: None, spread: [0.0; 2], map: None, air: None }
    }

    fn air_at_eye(&self) -> AirAtEye {
        AirAtEye { wind: self.wind, spread: self.spread, lags: lags(self.air) }
    }
}

/// A part of the drops.
struct Piece {
    first: u32,
    /// Number of drops, or of slots.
    count: u32,
    frame: wgpu::Buffer,
    positions: wgpu::Buffer,
    motions: wgpu::Buffer,
    /// Step in which each slot was last taken.
    claims: wgpu::Buffer,
}

impl Piece {
    fn slots(&self) -> StepPiece<'_> {
        let Self { positions, motions, count, first, .. } = self;
        StepPiece { positions, motions, count: *count, first: *first }
    }
}

/// Kernels of a configuration: the step, and the entry of drops.
#[derive(Clone)]
struct Kernels {
    step: ComputeKernel,
    enter: Option<ComputeKernel>,
}

/// A rain on a GPU.
pub struct GpuSimulation {
    gpu: Gpu,
    plan: Plan,
    pieces: Vec<Piece>,
    speeds: Vec<f32>,
    /// Terminal speeds, sizes of the bins, regions of entering drops.
    tables: wgpu::Buffer,
    events: wgpu::Buffer,
    counts: wgpu::Buffer,
    /// Placeholder of unused bindings.
    nothing: wgpu::Buffer,
    nowhere: wgpu::Buffer,
    /// Kernels by the presence of a wind field and of a map.
    kernels: [Option<Kernels>; 4],
    lists: StepListKernels,
    /// Uniforms and bindings of each step.
    pool: BufferPool,
    /// Bytes that were written.
    written: AtomicU64,
}

/// Buffers that the list of a picture's drops reads.
#[derive(Debug)]
pub(super) struct StepBuffers<'a> {
    pub(super) pieces: Vec<StepPiece<'a>>,
    pub(super) tables: &'a wgpu::Buffer,
    pub(super) counts: &'a wgpu::Buffer,
    pub(super) events: &'a wgpu::Buffer,
    /// Placeholders of unused bindings.
    pub(super) nothing: &'a wgpu::Buffer,
    pub(super) nowhere: &'a wgpu::Buffer,
}

impl std::fmt::Debug for GpuSimulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GpuSimulation").field("count", &self.count()).finish_non_exhaustive()
    }
}

impl GpuSimulation {
    /// Creates the rain of a distribution. The wind field and map of the input are those of the CPU: they determine
    /// the initial drops.
    ///
    /// # Errors
    /// As [`Simulation::new`]; [`GpuError`] if the device's memory or limits are too small.
    pub fn new(
        gpu: &Gpu,
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        input: &StepInput<'_>,
    ) -> Result<Self, GpuSimError> {
        Ok(Self::from_cpu(gpu, &Simulation::new(rain, options, input)?)?)
    }

    /// Continues a simulation of the CPU.
    ///
    /// # Errors
    /// [`GpuError`] if the device's memory or limits are too small.
    pub fn from_cpu(gpu: &Gpu, simulation: &Simulation) -> Result<Self, GpuError> {
        let Simulation { mut plan, speeds, drops, kept, .. } = simulation.clone();
        let max_events = plan.options.max_events.min(MAX_EVENTS);
        plan.options.max_events = max_events;
        let mut tables: Vec<u32> = speeds.iter().map(|speed| speed.to_bits()).collect();
        tables.extend(plan.sizes().as_flattened().iter().map(|size| size.to_bits()));
        let regions = plan.bins.len() * REGIONS_PER_BIN + 1;
        tables.resize(tables.len() + regions * size_of::<EnterRegion>() / size_of::<u32>(), 0);
        let max_kept = plan.options.max_kept;
        let places = u64::from(max_events) + SPANS as u64 * u64::from(max_kept);
        let event_bytes = places.max(1) * size_of::<StepEvent>() as u64;
        let events = gpu.empty_buffer("impacts", event_bytes, wgpu::BufferUsages::STORAGE)?;
        let mut counts = [0; COUNTERS];
        for (number, impacts) in (0..).zip(&kept) {
            counts[COUNTS + number] = impacts.len() as u32;
            let held = &impacts[..impacts.len().min(max_kept as usize)];
            let first = max_events as usize + number * max_kept as usize;
            let offset = (first * size_of::<StepEvent>()) as u64;
            gpu.queue().write_buffer(&events, offset, bytemuck::cast_slice(held));
        }
        Ok(Self {
            pieces: pieces(gpu, &plan, &drops)?,
            tables: gpu.storage_buffer("tables of the rain", &tables)?,
            speeds,
            events,
            counts: gpu.storage_buffer("counts of a step", &counts)?,
            nothing: gpu.storage_buffer("nothing", &[0u32; 64])?,
            nowhere: gpu.uniform_buffer("nowhere", &[0u32; 64])?,
            kernels: [const { None }; 4],
            lists: StepListKernels::default(),
            pool: BufferPool::new(gpu),
            written: AtomicU64::new(0),
            gpu: gpu.clone(),
            plan,
        })
    }

    /// Advances by a time of up to 1 s; the camera moves to that of the input. Returns after submission.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and [`GpuError`].
    pub fn advance(&mut self, time_s: f64, input: &GpuStepInput<'_>) -> Result<(), GpuSimError> {
        let turns = self.plan.turns(time_s, input.view, input.origin, input.air_at_eye())?;
        for turn in &turns {
            self.make_room(turn)?;
            let (kernels, bound) = self.bound(input)?;
            let dispatches = self.dispatches(turn, &kernels, &bound);
            self.gpu.submit(&dispatches)?;
            self.count_written(self.pool.written());
        }
        Ok(())
    }

    /// Repeats one step, up to 1/30 s, and returns its mean time.
    ///
    /// # Errors
    /// As [`GpuSimulation::advance`].
    pub fn time(
        &mut self,
        time_s: f64,
        input: &GpuStepInput<'_>,
        repeats: u32,
    ) -> Result<PassTime, GpuSimError> {
        let turns = self.plan.turns(time_s, input.view, input.origin, input.air_at_eye())?;
        let (kernels, bound) = self.bound(input)?;
        let dispatches = turns.first().map(|turn| self.dispatches(turn, &kernels, &bound));
        Ok(self.gpu.time(&dispatches.unwrap_or_default(), repeats)?)
    }

    /// Refills the drops of a view after a jump of the eye, and adds slots if the view has grown.
    fn make_room(&mut self, turn: &Turn) -> Result<(), GpuSimError> {
        if !self.plan.is_open() {
            return Ok(());
        }
        if turn.frame.elsewhere == 1 {
            let sizes = self.plan.sizes();
            let world = StepWorld {
                frame: &turn.frame,
                speeds: &self.speeds,
                sizes: &sizes,
                regions: &[],
                field: None,
                map: None,
            };
            let drops = fill(&self.plan, &world)?;
            self.pieces = pieces(&self.gpu, &self.plan, &drops)?;
        } else if self.count() as f64 - SPARE_SLOTS < MIN_SLOTS_PER_DROP * self.plan.expected() {
            let drops = self.drops()?;
            self.pieces = pieces(&self.gpu, &self.plan, &drops)?;
        }
        Ok(())
    }

    /// Kernels of a configuration, and the bindings of each piece.
    #[expect(clippy::type_complexity, reason = "the bindings of the two kernels")]
    fn bound(
        &mut self,
        input: &GpuStepInput<'_>,
    ) -> Result<(Kernels, Vec<(wgpu::BindGroup, Option<wgpu::BindGroup>)>), GpuError> {
        self.pool.begin_frame();
        let variant = usize::from(input.field.is_some()) + 2 * usize::from(input.map.is_some());
        let kernels = match &self.kernels[variant] {
            Some(kernels) => kernels.clone(),
            None => {
                let on = |there: bool| f64::from(u8::from(there));
                let constants =
                    [("STEP_FIELD", on(input.field.is_some())), ("STEP_COLLIDES", on(input.map.is_some()))];
                let step = ComputeKernel::new(&self.gpu, &STEP_KERNEL, &constants)?;
                let enter = self
                    .plan
                    .is_open()
                    .then(|| ComputeKernel::new(&self.gpu, &ENTER_KERNEL, &constants))
                    .transpose()?;
                self.kernels[variant].insert(Kernels { step, enter }).clone()
            }
        };
        let grid = match input.field {
            Some((grid, _)) => &self.pool.uniform("wind grid", grid)?,
            None => &self.nowhere,
        };
        let cells = input.field.map_or(&self.nothing, |(_, cells)| cells);
        let (frame, texels) =
            input.map.map_or((&self.nowhere, &self.nothing), |map| (map.frame(), map.texels()));
        let bind = |piece: &Piece| {
            let Piece { frame: of_piece, positions, motions, claims, .. } = piece;
            let counts = [&self.events, &self.counts];
            let state = [of_piece, positions, motions, &self.tables, cells];
            let shared = [&state[..], &counts[..], &[grid, frame, texels]].concat();
            let step = kernels.step.bind(&self.pool, &shared)?;
            let all = [&shared[..], &[claims]].concat();
            let enter = kernels.enter.as_ref().map(|enter| enter.bind(&self.pool, &all)).transpose()?;
            Ok::<_, GpuError>((step, enter))
        };
        let bound = self.pieces.iter().map(bind).collect::<Result<_, _>>()?;
        Ok((kernels, bound))
    }

    /// Dispatches of a step; its frame is written before the next submission.
    fn dispatches<'a>(
        &self,
        turn: &Turn,
        kernels: &'a Kernels,
        bound: &'a [(wgpu::BindGroup, Option<wgpu::BindGroup>)],
    ) -> Vec<Dispatch<'a>> {
        let mut work = Vec::new();
        let pieces = self.pieces.len() as u32;
        let open = self.plan.is_open();
        if !turn.regions.is_empty() {
            let first = u64::from(turn.frame.regions_first) * size_of::<u32>() as u64;
            self.pool.write_at(&self.tables, first, bytemuck::cast_slice(&turn.regions));
        }
        if turn.begins_span {
            let counter = (COUNTS + turn.frame.kept_span as usize) * size_of::<u32>();
            self.pool.write_at(&self.counts, counter as u64, bytemuck::bytes_of(&0u32));
        }
        let groups = |count: u32| {
            let groups = count.div_ceil(GROUP);
            [groups.min(GROUPS), groups.div_ceil(GROUPS), 1]
        };
        for (number, (piece, (step, enter))) in (0..).zip(self.pieces.iter().zip(bound)) {
            let first = if open { 0 } else { piece.first };
            let frame = StepFrame { first, count: piece.count, pieces, piece: number, ..turn.frame };
            self.pool.write(&piece.frame, bytemuck::bytes_of(&frame));
            work.push(kernels.step.dispatch(step, groups(piece.count)));
            if let (Some(kernel), Some(bindings), 1..) = (&kernels.enter, enter, turn.frame.candidates) {
                work.push(kernel.dispatch(bindings, groups(turn.frame.candidates.div_ceil(pieces))));
            }
        }
        work
    }

    /// Counts bytes that were written for the rain to the device elsewhere, such as those of its collision map.
    pub fn count_written(&self, bytes: u64) {
        self.written.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Number of bytes that were written since the last call.
    #[must_use]
    pub fn take_written(&self) -> u64 {
        self.written.swap(0, Ordering::Relaxed)
    }

    /// Events since the last call. Impacts are sorted by the drops' numbers; if there are more than the buffer holds,
    /// the recorded ones vary.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn events(&self) -> Result<StepEvents, GpuSimError> {
        let counts = self.gpu.read::<u32>(&self.counts)?;
        let &[events, drops, low, high, lost, ..] = &counts[..] else { return Ok(StepEvents::default()) };
        let recorded = events.min(self.plan.options.max_events);
        let mut list = match recorded {
            0 => Vec::new(),
            _ => self.gpu.read_part::<StepEvent>(&self.events, 0..recorded.into())?,
        };
        list.sort_by_key(|event| {
            (event.drop & 0x3fff_ffff, event.drop >> 30, event.position.map(f32::to_bits))
        });
        self.gpu.queue().write_buffer(&self.counts, 0, bytemuck::bytes_of(&[0u32; COUNTS]));
        let caught = StepCaught { drops: drops.into(), volume: u64::from(high) << 32 | u64::from(low) };
        Ok(StepEvents { events: list, overflow: (events - recorded).into(), caught, lost: lost.into() })
    }

    /// State: for a view sorted by the steps in which drops entered, and by their words; else by their
    /// numbers.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn drops(&self) -> Result<Vec<StepDrop>, GpuSimError> {
        let mut drops = Vec::new();
        for piece in &self.pieces {
            let positions = self.gpu.read::<[u32; 4]>(&piece.positions)?;
            let motions = self.gpu.read::<[u32; 4]>(&piece.motions)?;
            drops.extend(positions.iter().zip(&motions).map(|(position, motion)| whole(position, motion)));
        }
        if self.plan.is_open() {
            drops.retain(|drop: &StepDrop| drop.kind() != STEP_GONE);
            drops.sort_unstable_by_key(|drop| (drop.last, drop.word));
        }
        Ok(drops)
    }

    /// Number of simulated drops; for a view, number of slots.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.pieces.iter().map(|piece| u64::from(piece.count)).sum()
    }

    /// Minimum diameter, m: smaller drops are unresolved.
    #[must_use]
    pub fn min_diameter(&self) -> f64 {
        self.plan.min_diameter
    }

    /// Drops that a picture of the current time can show, as [`Simulation::visible`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn visible(&self, view: &View) -> Result<VisibleDrops, GpuSimError> {
        self.visible_after(0.0, view, None, None)
    }

    /// Drops that a picture can show some time after the state, s, as [`Simulation::visible_after`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn visible_after(
        &self,
        after_s: f64,
        view: &View,
        map: Option<&CollisionMap>,
        splashes: Option<&SplashOptions>,
    ) -> Result<VisibleDrops, GpuSimError> {
        let listing = Listing { plan: &self.plan, speeds: &self.speeds, view, after_s, map, splashes };
        let kept = if splashes.is_some() { self.kept()? } else { Vec::new() };
        Ok(listed(&listing, &self.drops()?, &kept))
    }

    /// Impacts that may show splashes, by the spans of the plan.
    fn kept(&self) -> Result<Vec<Vec<StepEvent>>, GpuSimError> {
        let (first, room) = (self.plan.options.max_events, self.plan.options.max_kept);
        let counts = self.gpu.read::<u32>(&self.counts)?;
        let held = |(span, &count): (u32, &u32)| match count.min(room) {
            0 => Ok(Vec::new()),
            held => {
                let begin = u64::from(first) + u64::from(span) * u64::from(room);
                self.gpu.read_part(&self.events, begin..begin + u64::from(held))
            }
        };
        Ok((0..).zip(&counts[COUNTS..]).map(held).collect::<Result<_, GpuError>>()?)
    }

    /// Makes ready to list the drops that a picture can show some time after the state. Drops that had no room among those of the rain
    /// are counted in [`DropListOnGpu::counts`](super::DropListOnGpu::counts).
    ///
    /// # Errors
    /// [`SimError::OutOfRange`](crate::SimError::OutOfRange) for an invalid camera; [`GpuError`].
    pub fn list<'a>(
        &'a self,
        buffers: &impl BufferSource,
        picture: &StepPicture<'a>,
    ) -> Result<StepListPass<'a>, GpuSimError> {
        let state = StepBuffers {
            pieces: self.pieces.iter().map(Piece::slots).collect(),
            tables: &self.tables,
            counts: &self.counts,
            events: &self.events,
            nothing: &self.nothing,
            nowhere: &self.nowhere,
        };
        self.lists.prepare(buffers, &self.plan, &state, picture)
    }

    /// Limits of the list of drops that a picture can show.
    #[must_use]
    pub fn resolved(&self, view: &View) -> Resolved {
        self.plan.resolved(view)
    }

    /// Maximum distance from the eye of a view at which a drop is resolved, m.
    #[must_use]
    pub fn farthest_m(&self, view: &View) -> f64 {
        self.plan.farthest(view)
    }

    /// Rate, mm/h, of the drops that fall in the volume, as [`Simulation::measured_rate_mm_h`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> Result<f64, GpuSimError> {
        Ok(crate::disdrometer::rate_mm_h(&self.plan, &self.drops()?, map))
    }

    /// Positions and motions of the drops on the device, piece by piece, with the numbers of drops or slots, for a
    /// renderer. Layout: `step_positions` and `step_motions` of `sim/step.wgsl`; slots whose kind is `STEP_GONE` hold
    /// no drop.
    pub fn buffers(&self) -> impl Iterator<Item = (&wgpu::Buffer, &wgpu::Buffer, u32)> {
        self.pieces.iter().map(|piece| (&piece.positions, &piece.motions, piece.count))
    }
}

/// Number of counters of a step: events; drops through the gauge; their volume, low and high word; drops without a
/// slot.
const COUNTS: usize = STEP_COUNTS as usize;

/// Those, and the numbers of the impacts that each span keeps.
const COUNTERS: usize = STEP_COUNTERS as usize;

/// Creates the pieces of drops on the device; those of a view have free slots.
fn pieces(gpu: &Gpu, plan: &Plan, drops: &[StepDrop]) -> Result<Vec<Piece>, GpuError> {
    let slots = if plan.is_open() {
        let wanted = (drops.len() as f64).max(plan.expected()) * SLOTS_PER_DROP + SPARE_SLOTS;
        (wanted as usize).max(drops.len())
    } else {
        drops.len()
    };
    let free = StepDrop { word: STEP_GONE << STEP_KIND, ..StepDrop::zeroed() };
    let count = slots.div_ceil(PIECE).max(1);
    let per_piece = slots.div_ceil(count);
    (0..count)
        .filter(|_| slots > 0)
        .map(|number| {
            // Equally many drops in each.
            let first = number * per_piece;
            let size = per_piece.min(slots - first);
            let length = if plan.is_open() { drops.len().div_ceil(count) } else { per_piece };
            let begin = (number * length).min(drops.len());
            let held = &drops[begin..(begin + length).min(drops.len())];
            let all = held.iter().chain(std::iter::repeat_n(&free, size.saturating_sub(held.len())));
            let (mut positions, mut motions) = (Vec::with_capacity(size), Vec::with_capacity(size));
            for drop in all {
                let [position, motion] = halves(drop);
                positions.push(position);
                motions.push(motion);
            }
            let bytes = size_of::<StepFrame>() as u64;
            Ok(Piece {
                first: first as u32,
                count: positions.len() as u32,
                frame: gpu.empty_buffer("step frame", bytes, wgpu::BufferUsages::UNIFORM)?,
                claims: gpu.storage_buffer(
                    "claims",
                    &vec![0u32; if plan.is_open() { positions.len() } else { 1 }],
                )?,
                positions: gpu.storage_buffer("drops' positions", &positions)?,
                motions: gpu.storage_buffer("drops' motions", &motions)?,
            })
        })
        .collect()
}

/// Splits a drop into the two arrays of the shader.
fn halves(drop: &StepDrop) -> [[u32; 4]; 2] {
    let ([x, y, z], [u, v, w]) = (drop.position.map(f32::to_bits), drop.velocity.map(f32::to_bits));
    [[x, y, z, drop.word], [u, v, w, drop.last]]
}

fn whole(&[x, y, z, word]: &[u32; 4], &[u, v, w, last]: &[u32; 4]) -> StepDrop {
    StepDrop { position: [x, y, z].map(f32::from_bits), word, velocity: [u, v, w].map(f32::from_bits), last }
}
