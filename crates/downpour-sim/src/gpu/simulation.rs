//! A rain on a GPU: the same steps as [`Simulation`](crate::simulation::Simulation), on drops that stay on the device.
//!
//! The drops of a view are in slots, more than there are drops: those that are gone leave theirs free for those that come
//! in. Which slot a drop has depends on the device; which drops there are does not.

use bytemuck::Zeroable as _;
use downpour_drop::distribution::DropSizeDistribution;
use downpour_gpu::timing::PassTime;
use downpour_gpu::{ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::sim::enter::ENTER_KERNEL;
use downpour_shaders::sim::step::{STEP_GONE, STEP_KERNEL, STEP_KIND};
use downpour_wind::UniformWindAt;
use downpour_wind::field::WindFieldGrid;
use glam::{DVec3, Vec3};

use super::{GpuCollisionMap, GpuSimError};
use crate::collision::CollisionMap;
use crate::enter::EnterRegion;
use crate::field::VisibleDrops;
use crate::fill::fill;
use crate::list::{Listing, listed};
use crate::plan::{AirAtEye, Plan, Turn, lags};
use crate::simulation::{Happened, Moment, Simulation, SimulationOptions};
use crate::step::{StepCaught, StepDrop, StepEvent, StepFrame, StepWorld};
use crate::view::View;

/// Drops of a piece: two buffers of 64 MiB, which every device binds.
const PIECE: usize = 1 << 22;

/// Drops of a workgroup.
const GROUP: u32 = 256;

/// Workgroups along the first axis.
const GROUPS: u32 = 1 << 12;

/// Impacts that the buffer holds at most: 64 MiB.
const MAX_EVENTS: u32 = 1 << 21;

/// Slots per drop of a view that is expected, and some more.
const SLOTS_PER_DROP: f64 = 1.5;
const SPARE_SLOTS: f64 = 1024.0;

/// Slots are made anew where fewer are left per drop that is expected.
const LEAST_SLOTS_PER_DROP: f64 = 1.2;

/// Regions that the tables hold: six of each bin of sizes, and one that marks their end.
const REGIONS_PER_BIN: usize = 6;

/// What there is at the end of a step. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct GpuMoment<'a> {
    /// The camera; for a view the one in the middle of the time that pictures of this state cover.
    pub view: &'a View,
    /// What single precision is relative to, m.
    pub origin: DVec3,
    /// The wind where there is no field, m/s; with a field, that at the eye.
    pub wind: Vec3,
    /// The wind: its grid, and the cells in its order.
    pub field: Option<(&'a WindFieldGrid, &'a wgpu::Buffer)>,
    /// Bounds on the difference of the field from the wind at the eye: per m of distance, 1/s, and at most, m/s
    /// ([`WindField::spread`](downpour_wind::WindField::spread)). Views alone need it.
    pub spread: [f32; 2],
    /// What stops drops.
    pub map: Option<&'a GpuCollisionMap>,
    /// The part of the wind that is the same everywhere, as it changes (see `Moment`).
    pub air: Option<&'a UniformWindAt<'a>>,
}

impl<'a> GpuMoment<'a> {
    /// A camera in a wind that is the same everywhere and does not change; nothing stops drops.
    #[must_use]
    pub fn new(view: &'a View, origin: DVec3, wind: Vec3) -> Self {
        Self { view, origin, wind, field: None, spread: [0.0; 2], map: None, air: None }
    }

    fn air_at_eye(&self) -> AirAtEye {
        AirAtEye { wind: self.wind, spread: self.spread, lags: lags(self.air) }
    }
}

/// Some of the drops.
struct Piece {
    first: u32,
    /// Drops, or slots.
    count: u32,
    frame: wgpu::Buffer,
    places: wgpu::Buffer,
    motions: wgpu::Buffer,
    /// The step in which each slot was last taken.
    claims: wgpu::Buffer,
}

/// Kernels for what there is: a step, and what comes in.
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
    /// Terminal speeds, sizes of the bins, regions of what comes in.
    tables: wgpu::Buffer,
    events: wgpu::Buffer,
    counts: wgpu::Buffer,
    /// Stands for what is not there.
    nothing: wgpu::Buffer,
    nowhere: wgpu::Buffer,
    /// By whether there is a wind field, and a map.
    kernels: [Option<Kernels>; 4],
}

impl GpuSimulation {
    /// The rain of a distribution. The moment's wind field and map are those of the CPU: they say how drops begin.
    ///
    /// # Errors
    /// As [`Simulation::new`]; [`GpuError`] for what the device does not hold.
    pub fn new(
        gpu: &Gpu,
        rain: &DropSizeDistribution,
        options: &SimulationOptions,
        moment: &Moment<'_>,
    ) -> Result<Self, GpuSimError> {
        Ok(Self::from_cpu(gpu, &Simulation::new(rain, options, moment)?)?)
    }

    /// A rain that goes on where one on the CPU is.
    ///
    /// # Errors
    /// [`GpuError`] for what the device does not hold.
    pub fn from_cpu(gpu: &Gpu, simulation: &Simulation) -> Result<Self, GpuError> {
        let Simulation { mut plan, speeds, drops, .. } = simulation.clone();
        let most_events = plan.options.most_events.min(MAX_EVENTS);
        plan.options.most_events = most_events;
        let mut tables: Vec<u32> = speeds.iter().map(|speed| speed.to_bits()).collect();
        tables.extend(plan.sizes().as_flattened().iter().map(|size| size.to_bits()));
        let regions = plan.bins.len() * REGIONS_PER_BIN + 1;
        tables.resize(tables.len() + regions * size_of::<EnterRegion>() / size_of::<u32>(), 0);
        let event_bytes = u64::from(most_events.max(1)) * size_of::<StepEvent>() as u64;
        Ok(Self {
            pieces: pieces(gpu, &plan, &drops)?,
            tables: gpu.storage_buffer("tables of the rain", &tables)?,
            speeds,
            events: gpu.empty_buffer("impacts", event_bytes, wgpu::BufferUsages::STORAGE)?,
            counts: gpu.storage_buffer("counts of a step", &[0u32; COUNTS])?,
            nothing: gpu.storage_buffer("nothing", &[0u32; 64])?,
            nowhere: gpu.uniform_buffer("nowhere", &[0u32; 64])?,
            kernels: [const { None }; 4],
            gpu: gpu.clone(),
            plan,
        })
    }

    /// Lets time pass, up to 1 s; the camera comes to the moment's. Returns when the work is submitted.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and [`GpuError`].
    pub fn advance(&mut self, time_s: f64, moment: &GpuMoment<'_>) -> Result<(), GpuSimError> {
        let turns = self.plan.turns(time_s, moment.view, moment.origin, moment.air_at_eye())?;
        for turn in &turns {
            self.make_room(turn)?;
            let (kernels, bound) = self.bound(moment)?;
            let dispatches = self.dispatches(turn, &kernels, &bound);
            self.gpu.submit(&dispatches)?;
        }
        Ok(())
    }

    /// Repeats one step, up to 1/30 s, and gives the mean time of one.
    ///
    /// # Errors
    /// As [`GpuSimulation::advance`].
    pub fn time(
        &mut self,
        time_s: f64,
        moment: &GpuMoment<'_>,
        repeats: u32,
    ) -> Result<PassTime, GpuSimError> {
        let turns = self.plan.turns(time_s, moment.view, moment.origin, moment.air_at_eye())?;
        let (kernels, bound) = self.bound(moment)?;
        let dispatches = turns.first().map(|turn| self.dispatches(turn, &kernels, &bound));
        Ok(self.gpu.time(&dispatches.unwrap_or_default(), repeats)?)
    }

    /// Drops of a view anew where the eye is elsewhere altogether, and slots for them where it has come to see more.
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
        } else if self.count() as f64 - SPARE_SLOTS < LEAST_SLOTS_PER_DROP * self.plan.expected() {
            let drops = self.drops()?;
            self.pieces = pieces(&self.gpu, &self.plan, &drops)?;
        }
        Ok(())
    }

    /// The kernels for what there is, and the bindings of each piece.
    #[expect(clippy::type_complexity, reason = "the bindings of the two kernels")]
    fn bound(
        &mut self,
        moment: &GpuMoment<'_>,
    ) -> Result<(Kernels, Vec<(wgpu::BindGroup, Option<wgpu::BindGroup>)>), GpuError> {
        let variant = usize::from(moment.field.is_some()) + 2 * usize::from(moment.map.is_some());
        let kernels = match &self.kernels[variant] {
            Some(kernels) => kernels.clone(),
            None => {
                let on = |there: bool| f64::from(u8::from(there));
                let constants =
                    [("STEP_FIELD", on(moment.field.is_some())), ("STEP_COLLIDES", on(moment.map.is_some()))];
                let step = ComputeKernel::new(&self.gpu, &STEP_KERNEL, &constants)?;
                let enter = self
                    .plan
                    .is_open()
                    .then(|| ComputeKernel::new(&self.gpu, &ENTER_KERNEL, &constants))
                    .transpose()?;
                self.kernels[variant].insert(Kernels { step, enter }).clone()
            }
        };
        let grid = match moment.field {
            Some((grid, _)) => &self.gpu.uniform_buffer("wind grid", grid)?,
            None => &self.nowhere,
        };
        let cells = moment.field.map_or(&self.nothing, |(_, cells)| cells);
        let (frame, texels) =
            moment.map.map_or((&self.nowhere, &self.nothing), |map| (map.frame(), map.texels()));
        let bind = |piece: &Piece| {
            let Piece { frame: of_piece, places, motions, claims, .. } = piece;
            let counts = [&self.events, &self.counts];
            let state = [of_piece, places, motions, &self.tables, cells];
            let shared = [&state[..], &counts[..], &[grid, frame, texels]].concat();
            let step = kernels.step.bind(&self.gpu, &shared)?;
            let all = [&shared[..], &[claims]].concat();
            let enter = kernels.enter.as_ref().map(|enter| enter.bind(&self.gpu, &all)).transpose()?;
            Ok::<_, GpuError>((step, enter))
        };
        let bound = self.pieces.iter().map(bind).collect::<Result<_, _>>()?;
        Ok((kernels, bound))
    }

    /// The work of a step; its frame is written before the next submission.
    fn dispatches<'a>(
        &self,
        turn: &Turn,
        kernels: &'a Kernels,
        bound: &'a [(wgpu::BindGroup, Option<wgpu::BindGroup>)],
    ) -> Vec<Dispatch<'a>> {
        let queue = self.gpu.queue();
        let mut work = Vec::new();
        let pieces = self.pieces.len() as u32;
        let open = self.plan.is_open();
        if !turn.regions.is_empty() {
            let first = u64::from(turn.frame.regions_first) * size_of::<u32>() as u64;
            queue.write_buffer(&self.tables, first, bytemuck::cast_slice(&turn.regions));
        }
        let groups = |count: u32| {
            let groups = count.div_ceil(GROUP);
            [groups.min(GROUPS), groups.div_ceil(GROUPS), 1]
        };
        for (number, (piece, (step, enter))) in (0..).zip(self.pieces.iter().zip(bound)) {
            let first = if open { 0 } else { piece.first };
            let frame = StepFrame { first, count: piece.count, pieces, piece: number, ..turn.frame };
            queue.write_buffer(&piece.frame, 0, bytemuck::bytes_of(&frame));
            work.push(kernels.step.dispatch(step, groups(piece.count)));
            if let (Some(kernel), Some(bindings), 1..) = (&kernels.enter, enter, turn.frame.candidates) {
                work.push(kernel.dispatch(bindings, groups(turn.frame.candidates.div_ceil(pieces))));
            }
        }
        work
    }

    /// What has happened since the last call. Impacts are in the order of the drops' numbers; of more than the buffer holds,
    /// which are noted varies.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn happened(&self) -> Result<Happened, GpuSimError> {
        let counts = self.gpu.read::<u32>(&self.counts)?;
        let &[events, drops, low, high, lost] = &counts[..] else { return Ok(Happened::default()) };
        let noted = events.min(self.plan.options.most_events);
        let mut list = if noted > 0 { self.gpu.read::<StepEvent>(&self.events)? } else { Vec::new() };
        list.truncate(noted as usize);
        list.sort_by_key(|event| (event.drop & 0x3fff_ffff, event.drop >> 30, event.place.map(f32::to_bits)));
        self.gpu.queue().write_buffer(&self.counts, 0, bytemuck::bytes_of(&[0u32; COUNTS]));
        let caught = StepCaught { drops: drops.into(), volume: u64::from(high) << 32 | u64::from(low) };
        Ok(Happened { events: list, overflow: (events - noted).into(), caught, lost: lost.into() })
    }

    /// The state: of a view in the order of the steps in which drops came, and of their words; else in the order of their
    /// numbers.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn drops(&self) -> Result<Vec<StepDrop>, GpuSimError> {
        let mut drops = Vec::new();
        for piece in &self.pieces {
            let places = self.gpu.read::<[u32; 4]>(&piece.places)?;
            let motions = self.gpu.read::<[u32; 4]>(&piece.motions)?;
            drops.extend(places.iter().zip(&motions).map(|(place, motion)| whole(place, motion)));
        }
        if self.plan.is_open() {
            drops.retain(|drop: &StepDrop| drop.kind() != STEP_GONE);
            drops.sort_unstable_by_key(|drop| (drop.last, drop.word));
        }
        Ok(drops)
    }

    /// How many drops are simulated; of a view, how many slots there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.pieces.iter().map(|piece| u64::from(piece.count)).sum()
    }

    /// The least diameter, m: smaller drops are unresolved.
    #[must_use]
    pub fn least_diameter(&self) -> f64 {
        self.plan.least_diameter
    }

    /// The drops that a picture of now can show, as [`Simulation::visible`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn visible(&self, view: &View) -> Result<VisibleDrops, GpuSimError> {
        self.visible_after(0.0, view, None)
    }

    /// The drops that a picture can show some time after the state, s, as [`Simulation::visible_after`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn visible_after(
        &self,
        after_s: f64,
        view: &View,
        map: Option<&CollisionMap>,
    ) -> Result<VisibleDrops, GpuSimError> {
        let listing = Listing { plan: &self.plan, speeds: &self.speeds, view, after_s, map };
        Ok(listed(&listing, &self.drops()?))
    }

    /// The rate, mm/h, of the drops that fall in the volume, as [`Simulation::measured_rate_mm_h`].
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn measured_rate_mm_h(&self, map: Option<&CollisionMap>) -> Result<f64, GpuSimError> {
        Ok(crate::disdrometer::rate_mm_h(&self.plan, &self.drops()?, map))
    }

    /// The drops' places and motions on the device, piece by piece, with the numbers of drops or slots: what a renderer
    /// reads. Layout: `step_places` and `step_motions` of `sim/step.wgsl`; slots whose kind is `STEP_GONE` hold no drop.
    pub fn buffers(&self) -> impl Iterator<Item = (&wgpu::Buffer, &wgpu::Buffer, u32)> {
        self.pieces.iter().map(|piece| (&piece.places, &piece.motions, piece.count))
    }
}

/// Counts of a step: events; drops through the gauge; their volume, low and high word; drops that found no slot.
const COUNTS: usize = 5;

/// Drops in pieces on the device; those of a view have free slots among them.
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
            // As many of the drops in each.
            let first = number * per_piece;
            let size = per_piece.min(slots - first);
            let share = if plan.is_open() { drops.len().div_ceil(count) } else { per_piece };
            let begin = (number * share).min(drops.len());
            let held = &drops[begin..(begin + share).min(drops.len())];
            let all = held.iter().chain(std::iter::repeat_n(&free, size.saturating_sub(held.len())));
            let (mut places, mut motions) = (Vec::with_capacity(size), Vec::with_capacity(size));
            for drop in all {
                let [place, motion] = halves(drop);
                places.push(place);
                motions.push(motion);
            }
            let bytes = size_of::<StepFrame>() as u64;
            Ok(Piece {
                first: first as u32,
                count: places.len() as u32,
                frame: gpu.empty_buffer("step frame", bytes, wgpu::BufferUsages::UNIFORM)?,
                claims: gpu
                    .storage_buffer("claims", &vec![0u32; if plan.is_open() { places.len() } else { 1 }])?,
                places: gpu.storage_buffer("drops' places", &places)?,
                motions: gpu.storage_buffer("drops' motions", &motions)?,
            })
        })
        .collect()
}

/// A drop as the two arrays of the shader hold it.
fn halves(drop: &StepDrop) -> [[u32; 4]; 2] {
    let ([x, y, z], [u, v, w]) = (drop.place.map(f32::to_bits), drop.velocity.map(f32::to_bits));
    [[x, y, z, drop.word], [u, v, w, drop.last]]
}

fn whole(&[x, y, z, word]: &[u32; 4], &[u, v, w, last]: &[u32; 4]) -> StepDrop {
    StepDrop { place: [x, y, z].map(f32::from_bits), word, velocity: [u, v, w].map(f32::from_bits), last }
}
