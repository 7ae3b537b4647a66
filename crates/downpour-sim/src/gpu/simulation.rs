//! A rain on a GPU: the same steps as [`Simulation`](crate::simulation::Simulation), on drops that stay on the device.

use downpour_drop::distribution::DropSizeDistribution;
use downpour_gpu::timing::PassTime;
use downpour_gpu::{ComputeKernel, Dispatch, Gpu, GpuError, wgpu};
use downpour_shaders::sim::step::STEP_KERNEL;
use downpour_wind::field::WindFieldGrid;
use glam::{DVec3, Vec3};

use super::{GpuCollisionMap, GpuSimError};
use crate::field::VisibleDrops;
use crate::plan::Plan;
use crate::simulation::{Happened, Moment, Simulation, SimulationOptions, measured, visible};
use crate::step::{StepCaught, StepDrop, StepEvent, StepFrame};
use crate::view::View;

/// Drops of a piece: two buffers of 64 MiB, which every device binds.
const PIECE: usize = 1 << 22;

/// Drops of a workgroup.
const GROUP: u32 = 256;

/// Workgroups along the first axis.
const GROUPS: u32 = 1 << 12;

/// Impacts that the buffer holds at most: 64 MiB.
const MOST_EVENTS: u32 = 1 << 21;

/// What there is at the end of a step. Wind and map are relative to `origin`.
#[derive(Clone, Copy, Debug)]
pub struct GpuMoment<'a> {
    /// The camera.
    pub view: &'a View,
    /// What single precision is relative to, m.
    pub origin: DVec3,
    /// The wind where there is no field, m/s.
    pub wind: Vec3,
    /// The wind: its grid, and the cells in its order.
    pub field: Option<(&'a WindFieldGrid, &'a wgpu::Buffer)>,
    /// What stops drops.
    pub map: Option<&'a GpuCollisionMap>,
}

/// Some of the drops.
struct Piece {
    first: u32,
    count: u32,
    frame: wgpu::Buffer,
    places: wgpu::Buffer,
    motions: wgpu::Buffer,
}

/// A rain on a GPU.
pub struct GpuSimulation {
    gpu: Gpu,
    plan: Plan,
    pieces: Vec<Piece>,
    speeds: wgpu::Buffer,
    events: wgpu::Buffer,
    counts: wgpu::Buffer,
    /// Stands for what is not there.
    nothing: wgpu::Buffer,
    nowhere: wgpu::Buffer,
    /// By whether there is a wind field, and a map.
    kernels: [Option<ComputeKernel>; 4],
    drops: u64,
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
        let Simulation { mut plan, speeds, drops } = simulation.clone();
        let most_events = plan.options.most_events.min(MOST_EVENTS);
        plan.options.most_events = most_events;
        let pieces = (0u32..).step_by(PIECE).zip(drops.chunks(PIECE)).map(|(first, drops)| {
            let places: Vec<[u32; 4]> = drops.iter().map(|d| halves(d)[0]).collect();
            let motions: Vec<[u32; 4]> = drops.iter().map(|d| halves(d)[1]).collect();
            Ok(Piece {
                first,
                count: drops.len() as u32,
                frame: gpu.empty_buffer(
                    "step frame",
                    size_of::<StepFrame>() as u64,
                    wgpu::BufferUsages::UNIFORM,
                )?,
                places: gpu.storage_buffer("drops' places", &places)?,
                motions: gpu.storage_buffer("drops' motions", &motions)?,
            })
        });
        let event_bytes = u64::from(most_events.max(1)) * size_of::<StepEvent>() as u64;
        Ok(Self {
            pieces: pieces.collect::<Result<_, GpuError>>()?,
            speeds: gpu.storage_buffer("terminal speeds", &speeds)?,
            events: gpu.empty_buffer("impacts", event_bytes, wgpu::BufferUsages::STORAGE)?,
            counts: gpu.storage_buffer("counts of a step", &[0u32; 4])?,
            nothing: gpu.storage_buffer("nothing", &[0u32; 64])?,
            nowhere: gpu.uniform_buffer("nowhere", &[0u32; 64])?,
            kernels: [const { None }; 4],
            drops: drops.len() as u64,
            gpu: gpu.clone(),
            plan,
        })
    }

    /// Lets time pass, up to 1 s; the camera comes to the moment's. Returns when the work is submitted.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and [`GpuError`].
    pub fn advance(&mut self, time_s: f64, moment: &GpuMoment<'_>) -> Result<(), GpuSimError> {
        let frames = self.plan.frames(time_s, moment.view, moment.origin, moment.wind)?;
        let (kernel, bound) = self.bound(moment)?;
        for frame in &frames {
            self.gpu.submit(&self.dispatches(frame, &kernel, &bound))?;
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
        let frames = self.plan.frames(time_s, moment.view, moment.origin, moment.wind)?;
        let (kernel, bound) = self.bound(moment)?;
        let dispatches = frames.first().map(|frame| self.dispatches(frame, &kernel, &bound));
        Ok(self.gpu.time(&dispatches.unwrap_or_default(), repeats)?)
    }

    /// The step for what there is, and the bindings of each piece.
    fn bound(&mut self, moment: &GpuMoment<'_>) -> Result<(ComputeKernel, Vec<wgpu::BindGroup>), GpuError> {
        let variant = usize::from(moment.field.is_some()) + 2 * usize::from(moment.map.is_some());
        let kernel = match &self.kernels[variant] {
            Some(kernel) => kernel.clone(),
            None => {
                let on = |there: bool| f64::from(u8::from(there));
                let constants =
                    [("STEP_FIELD", on(moment.field.is_some())), ("STEP_COLLIDES", on(moment.map.is_some()))];
                let kernel = ComputeKernel::new(&self.gpu, &STEP_KERNEL, &constants)?;
                self.kernels[variant].insert(kernel).clone()
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
            let Piece { frame: of_piece, places, motions, .. } = piece;
            let counts = [&self.events, &self.counts];
            let state = [of_piece, places, motions, &self.speeds, cells];
            kernel.bind(&self.gpu, &[&state[..], &counts[..], &[grid, frame, texels]].concat())
        };
        let bound = self.pieces.iter().map(bind).collect::<Result<_, _>>()?;
        Ok((kernel, bound))
    }

    /// The work of a step; its frame is written before the next submission.
    fn dispatches<'a>(
        &self,
        frame: &StepFrame,
        kernel: &'a ComputeKernel,
        bound: &'a [wgpu::BindGroup],
    ) -> Vec<Dispatch<'a>> {
        let dispatch = |(piece, bindings): (&Piece, &'a wgpu::BindGroup)| {
            let of_piece = StepFrame { first: piece.first, count: piece.count, ..*frame };
            self.gpu.queue().write_buffer(&piece.frame, 0, bytemuck::bytes_of(&of_piece));
            let groups = piece.count.div_ceil(GROUP);
            kernel.dispatch(bindings, [groups.min(GROUPS), groups.div_ceil(GROUPS), 1])
        };
        self.pieces.iter().zip(bound).map(dispatch).collect()
    }

    /// What has happened since the last call. Impacts are in the order of the drops' numbers; of more than the buffer holds,
    /// which are noted varies.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn happened(&self) -> Result<Happened, GpuSimError> {
        let counts = self.gpu.read::<u32>(&self.counts)?;
        let &[events, drops, low, high] = &counts[..] else { return Ok(Happened::default()) };
        let noted = events.min(self.plan.options.most_events);
        let mut list = if noted > 0 { self.gpu.read::<StepEvent>(&self.events)? } else { Vec::new() };
        list.truncate(noted as usize);
        list.sort_by_key(|event| (event.drop & 0x3fff_ffff, event.drop >> 30, event.place.map(f32::to_bits)));
        self.gpu.queue().write_buffer(&self.counts, 0, bytemuck::bytes_of(&[0u32; 4]));
        let caught = StepCaught { drops: drops.into(), volume: u64::from(high) << 32 | u64::from(low) };
        Ok(Happened { events: list, overflow: (events - noted).into(), caught })
    }

    /// The state, in the order of the drops' numbers.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn drops(&self) -> Result<Vec<StepDrop>, GpuSimError> {
        let mut drops = Vec::with_capacity(self.drops as usize);
        for piece in &self.pieces {
            let places = self.gpu.read::<[u32; 4]>(&piece.places)?;
            let motions = self.gpu.read::<[u32; 4]>(&piece.motions)?;
            drops.extend(places.iter().zip(&motions).map(|(place, motion)| whole(place, motion)));
        }
        Ok(drops)
    }

    /// How many drops are simulated.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.drops
    }

    /// The least diameter, m: smaller drops are left to extinction.
    #[must_use]
    pub fn least_diameter(&self) -> f64 {
        self.plan.least_diameter
    }

    /// The drops that a picture can show.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn visible(&self, view: &View) -> Result<VisibleDrops, GpuSimError> {
        Ok(visible(&self.plan, &self.drops()?, view))
    }

    /// The rate, mm/h, of the drops in the volume, those that something hides among them.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn measured_rate_mm_h(&self) -> Result<f64, GpuSimError> {
        Ok(measured(&self.plan, &self.drops()?))
    }

    /// The drops' places and motions on the device, piece by piece, with the numbers of drops: what a renderer reads. Layout:
    /// `step_places` and `step_motions` of `sim/step.wgsl`.
    pub fn buffers(&self) -> impl Iterator<Item = (&wgpu::Buffer, &wgpu::Buffer, u32)> {
        self.pieces.iter().map(|piece| (&piece.places, &piece.motions, piece.count))
    }
}

/// A drop as the two arrays of the shader hold it.
fn halves(drop: &StepDrop) -> [[u32; 4]; 2] {
    let ([x, y, z], [u, v, w]) = (drop.place.map(f32::to_bits), drop.velocity.map(f32::to_bits));
    [[x, y, z, drop.word], [u, v, w, drop.seconds.to_bits()]]
}

fn whole(&[x, y, z, word]: &[u32; 4], &[u, v, w, seconds]: &[u32; 4]) -> StepDrop {
    StepDrop {
        place: [x, y, z].map(f32::from_bits),
        word,
        velocity: [u, v, w].map(f32::from_bits),
        seconds: f32::from_bits(seconds),
    }
}
