//! Drops of a rain in closed form on a GPU: those that [`RainField::visible_among`] lists on the CPU.

use std::collections::BTreeMap;
use std::mem::offset_of;
use std::sync::OnceLock;

use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, Gpu, GpuError, made_once, wgpu, workgroups_for};
use downpour_shaders::sim::bounce::{
    BOUNCE_CLEAR_KERNEL, BOUNCE_FIND_KERNEL, BOUNCE_HIT_AMONG_HOLES_KERNEL, BOUNCE_HIT_KERNEL, BOUNCE_LANES,
    BOUNCE_LIST_KERNEL, BOUNCE_SLICE,
};
use downpour_shaders::sim::field::{
    FIELD_CLEAR_KERNEL, FIELD_FIND_KERNEL, FIELD_LANES, SHELTER_AMONG_HOLES_KERNEL, SHELTER_KERNEL,
};
use downpour_shaders::sim::splash::SPLASH_FIND_KERNEL;
use downpour_wind::UniformWind;
use glam::{DVec3, Vec3};

use super::list::{BoundKernel, DropListOnGpu, list_buffer};
use super::{DripSearch, GpuSimError};
use crate::SimError;
use crate::drift::Drift;
use crate::field::frame::{FieldQuery, ShelterFrame};
use crate::field::{EyeDrop, RainField, check_time};
use crate::impacts::SplashOptions;
use crate::impacts::bounce_frame::{BounceParts, BounceSearch, MAX_DROPLETS};
use crate::impacts::splash_search::SplashSearch;
use crate::options::Bounce;
use crate::resolved::Resolved;
use crate::shelter::{CUT_S, MAX_BACK_S, number_of_cuts};
use crate::view::View;

/// Obstacles on the device: the nodes and triangles of a `downpour_bvh::Bvh`.
#[derive(Clone, Copy, Debug)]
pub struct ObstaclesOnGpu<'a> {
    /// Nodes; at least one.
    pub nodes: &'a wgpu::Buffer,
    /// Triangles; at least one.
    pub triangles: &'a wgpu::Buffer,
    /// Their holes; `None` without any.
    pub holes: Option<HolesOnGpu<'a>>,
    /// Bounds of all, m, relative to `origin`; `None` without obstacles.
    pub bounds: Option<[Vec3; 2]>,
    /// Origin, m.
    pub origin: DVec3,
}

impl<'a> ObstaclesOnGpu<'a> {
    /// Their buffers, by the bindings of the kernels that ask for them.
    fn bindings(&self) -> Vec<(u32, &'a wgpu::Buffer)> {
        let mut bound = vec![(1, self.nodes), (2, self.triangles)];
        if let Some(HolesOnGpu { corners, table, texels }) = self.holes {
            bound.extend([(3, corners), (4, table), (5, texels)]);
        }
        bound
    }
}

/// Holes of triangles on the device, as painted leaves have them: the buffers of a scene, in the layout of
/// `shaders/wgsl/render/data.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct HolesOnGpu<'a> {
    /// Corners of the triangles.
    pub corners: &'a wgpu::Buffer,
    /// Materials and textures.
    pub table: &'a wgpu::Buffer,
    /// Texels.
    pub texels: &'a wgpu::Buffer,
}

/// A search for the drops of a picture.
#[derive(Clone, Copy, Debug)]
pub struct FieldSearch<'a> {
    /// The picture.
    pub view: &'a View,
    /// Its time, s.
    pub time_s: f64,
    /// Drops that may have room.
    pub max_room: u32,
    /// A pane before the eye: its unit normal, away from the eye, and its distance, m; drops on the eye's side are not listed.
    pub pane: Option<[f32; 4]>,
    /// Drops that are known already, at the beginning of the list.
    pub known: &'a [EyeDrop],
    /// Points whose drops are searched for as well.
    pub drips: Option<DripSearch<'a>>,
    /// Splashes that are searched for as well, where there are obstacles, whose triangles are numbered by their places in the list.
    pub splashes: Option<&'a SplashOptions>,
    /// Rebounds whose droplets are searched for as well, where there are obstacles, numbered as for splashes.
    pub bounce: Option<&'a Bounce>,
}

/// The pipelines of the closed form.
#[derive(Clone, Debug)]
pub struct FieldPipeline {
    gpu: Gpu,
    clear: ComputeKernel,
    find: ComputeKernel,
    shelter: ComputeKernel,
    /// Made for the first obstacles with holes.
    among_holes: OnceLock<ComputeKernel>,
    splash: ComputeKernel,
    /// Made for the first droplets that are searched for: clear, find, list.
    bounce: OnceLock<[ComputeKernel; 3]>,
    bounce_hit: OnceLock<ComputeKernel>,
    bounce_hit_among_holes: OnceLock<ComputeKernel>,
}

/// A rain on the device.
#[derive(Clone, Debug)]
pub struct FieldOnGpu {
    nodes: wgpu::Buffer,
    thresholds: wgpu::Buffer,
    /// Times and parts of a rate that changes; one of each without.
    begins: wgpu::Buffer,
    parts: wgpu::Buffer,
    /// Drift of drops up to whole sixteenths of a second, by their numbers.
    drifts: BTreeMap<i64, Drift>,
}

/// Times up to which drift is kept, s: the paths of drops are divided there.
const SIXTEENTH_S: f64 = BOUNCE_SLICE as f64;

/// Sixteenths of a second from one cut of a path to the sky to the next.
const SIXTEENTHS_OF_CUT: i64 = (CUT_S / SIXTEENTH_S) as i64;

/// Buffers in which drops are listed and counted.
#[derive(Clone, Copy)]
struct ListOnGpu<'a> {
    drops: &'a wgpu::Buffer,
    found: &'a wgpu::Buffer,
}

/// A search for drops, ready to be made.
#[derive(Debug)]
struct Search<'a> {
    clear: (wgpu::BindGroup, [u32; 3]),
    find: Option<(wgpu::BindGroup, [u32; 3])>,
    shelter: Option<(&'a ComputeKernel, wgpu::BindGroup, [u32; 3])>,
}

/// The search for the drops of a picture, ready to be made.
#[derive(Debug)]
pub struct FieldPass<'a> {
    pipeline: &'a FieldPipeline,
    search: Search<'a>,
    splashes: Vec<(Search<'a>, wgpu::BindGroup, [u32; 3])>,
    /// Of the search for droplets: a kernel for each stage, or none.
    bounces: Vec<BoundKernel<'a>>,
    /// The search for drops that drip, and for their crowns.
    drips: Vec<BoundKernel<'a>>,
    list: DropListOnGpu,
    resolved: Resolved,
    columns: u32,
}

impl FieldPipeline {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |kernel| ComputeKernel::new(gpu, kernel, &[]);
        Ok(Self {
            gpu: gpu.clone(),
            clear: kernel(&FIELD_CLEAR_KERNEL)?,
            find: kernel(&FIELD_FIND_KERNEL)?,
            shelter: kernel(&SHELTER_KERNEL)?,
            among_holes: OnceLock::new(),
            splash: kernel(&SPLASH_FIND_KERNEL)?,
            bounce: OnceLock::new(),
            bounce_hit: OnceLock::new(),
            bounce_hit_among_holes: OnceLock::new(),
        })
    }

    /// Brings a rain to the device.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn upload(&self, field: &RainField) -> Result<FieldOnGpu, GpuError> {
        let nodes: Vec<[u32; 2]> =
            field.classes.iter().flat_map(|class| class.sizes.nodes.iter().copied()).collect();
        let rows = field.classes.iter().flat_map(|class| class.count.thresholds.iter().flatten());
        let thresholds: Vec<[u32; 2]> = rows.map(|&word| [(word >> 32) as u32, word as u32]).collect();
        let (mut begins, mut parts) = (vec![[0; 4]], vec![0]);
        if let Some(thinning) = &field.thinning {
            // A buffer is never empty.
            let times = thinning.begins.iter();
            begins.splice(0..0, times.map(|time| [time.seconds, time.fraction, time.is_before, 0]));
            parts.splice(0..0, thinning.kept.iter().copied());
        }
        Ok(FieldOnGpu {
            begins: BufferSource::storage(&self.gpu, "times of rates", &begins)?,
            parts: BufferSource::storage(&self.gpu, "parts of the drops that fall", &parts)?,
            nodes: BufferSource::storage(&self.gpu, "sizes of drops", &nodes)?,
            thresholds: BufferSource::storage(&self.gpu, "numbers of chains", &thresholds)?,
            drifts: BTreeMap::new(),
        })
    }

    /// Makes ready to find the drops of a picture; `on` is that of `field`.
    ///
    /// # Errors
    /// As [`RainField::visible`]; or what the GPU says.
    pub fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        (field, on): (&RainField, &mut FieldOnGpu),
        obstacles: &ObstaclesOnGpu<'_>,
        search: &FieldSearch<'a>,
    ) -> Result<FieldPass<'a>, GpuSimError> {
        let slices = match (search.splashes, obstacles.bounds) {
            (Some(splashes), Some(bounds)) => {
                search.view.check()?;
                check_time(search.time_s)?;
                splashes.searches(field, search.view, search.time_s, (bounds, obstacles.origin))
            }
            _ => Vec::new(),
        };
        let crowns = SplashOptions::room(&slices);
        let bounce = search.bounce.filter(|bounce| bounce.fraction > 0.0).zip(obstacles.bounds);
        let dripping = search.drips.map(|drips| Ok::<_, SimError>((drips, drips.query()?))).transpose()?;
        let dripping = dripping.filter(|(_, query)| query.room > 0);
        let dripped = dripping.map_or(0, |(_, query)| query.room);
        let kept_free = crowns + dripped + if bounce.is_some() { MAX_DROPLETS } else { 0 };
        let mut query =
            field.query(search.view, search.time_s, search.max_room.saturating_sub(kept_free).max(1))?;
        let least_pixels = query.resolved.least_pixels;
        let bounce = bounce.map(|(bounce, bounds)| {
            let drift_of = |number: i64| on.drift(&field.wind, number).clone();
            let (view, obstacles) = ((search.view, least_pixels), (bounds, obstacles.origin));
            bounce.search(field, view, search.time_s, obstacles, drift_of)
        });
        query.frame.room += crowns + dripped + bounce.as_ref().map_or(0, |bounce| bounce.frame.room);
        let (known, room) = (search.known.len() as u32, query.frame.room);
        query.frame.first = known;
        query.frame.pane = search.pane.unwrap_or_default();
        let list = DropListOnGpu::new(buffers, search.known, room)?;
        let (drops, found) = (list.drops(), list.counts());
        let to = ListOnGpu { drops, found };
        let (resolved, columns) = (query.resolved, query.frame.columns);
        let of_picture = self.search(
            buffers,
            (field, on),
            obstacles,
            (search.view, search.time_s),
            (&query, Wants::All),
            to,
        )?;
        let drips = dripping.map(|(drips, query)| drips.prepare(buffers, &query, &list, search.pane));
        let mut splashes = Vec::new();
        for slice in slices {
            let SplashSearch { slice, view, query, mut frame } = slice;
            let of_slice = list_buffer(buffers, "drops of a slice", query.frame.room, 0)?;
            let counts = buffers.buffer(
                "number of drops of a slice",
                DropListOnGpu::COUNTS_BYTES,
                wgpu::BufferUsages::STORAGE,
            )?;
            let from = ListOnGpu { drops: &of_slice, found: &counts };
            let time_s = slice.middle_s();
            let searched = self.search(
                buffers,
                (field, on),
                obstacles,
                (&view, time_s),
                (&query, Wants::Stopped),
                from,
            )?;
            (frame.first, frame.room) = (known, room);
            frame.pane = search.pane.unwrap_or_default();
            let uniform = buffers.uniform("splash frame", &frame)?;
            let bound = [&uniform, obstacles.nodes, obstacles.triangles, &of_slice, &counts, drops, found];
            let groups = workgroups_for(frame.drops);
            splashes.push((searched, self.splash.bind(buffers, &bound)?, groups));
        }
        let bounces = match bounce {
            Some(mut bounce) if bounce.query.frame.columns > 0 => {
                (bounce.frame.first, bounce.frame.room) = (known, room);
                bounce.frame.pane = search.pane.unwrap_or_default();
                self.bounces(buffers, (field, on), obstacles, &bounce, to)?
            }
            _ => Vec::new(),
        };
        on.forget_far_from(search.time_s);
        let (pipeline, search, drips) = (self, of_picture, drips.transpose()?.unwrap_or_default());
        Ok(FieldPass { pipeline, search, splashes, bounces, drips, list, resolved, columns })
    }

    /// Makes ready to find some drops.
    fn search(
        &self,
        buffers: &impl BufferSource,
        (field, on): (&RainField, &mut FieldOnGpu),
        obstacles: &ObstaclesOnGpu<'_>,
        (view, time_s): (&View, f64),
        (query, wants): (&FieldQuery, Wants),
        to: ListOnGpu<'_>,
    ) -> Result<Search<'_>, GpuSimError> {
        let ListOnGpu { drops, found } = to;
        let room = query.frame.room;
        let uniform = buffers.uniform("field frame", &query.frame)?;
        let clear = self.clear.bind_at(buffers, [(0, &uniform), (5, drops), (6, found)])?;
        let mut find = None;
        if query.frame.columns > 0 {
            let classes = buffers.constants("classes of the field", &query.classes)?;
            let drift = buffers.constants("drift of drops", &query.drift)?;
            let (nodes, thresholds) = (&on.nodes, &on.thresholds);
            let bound = [&uniform, &classes, nodes, thresholds, &drift, drops, found, &on.begins, &on.parts];
            find = Some((
                self.find.bind(buffers, &bound)?,
                workgroups_for(query.frame.columns.saturating_mul(FIELD_LANES)),
            ));
        }
        let mut shelter = None;
        if let Some(bounds) = obstacles.bounds {
            let (mut frame, drift) = shelter_frame(field, on, query, (obstacles, bounds), (view, time_s));
            frame.stopped = wants.into();
            let uniform = buffers.uniform("shelter frame", &frame)?;
            let drift = buffers.constants("drift of paths", &drift)?;
            let mut bound = obstacles.bindings();
            bound.extend([(6, &uniform), (7, drops), (8, &drift)]);
            let kernel = self.shelter(obstacles.holes.is_some())?;
            shelter = Some((kernel, kernel.bind_at(buffers, bound)?, workgroups_for(room)));
        }
        Ok(Search { clear: (clear, workgroups_for(room)), find, shelter })
    }

    /// Makes ready to find droplets.
    fn bounces(
        &self,
        buffers: &impl BufferSource,
        (field, on): (&RainField, &mut FieldOnGpu),
        obstacles: &ObstaclesOnGpu<'_>,
        search: &BounceSearch,
        to: ListOnGpu<'_>,
    ) -> Result<Vec<BoundKernel<'_>>, GpuSimError> {
        let Some(bounds) = obstacles.bounds else { return Ok(Vec::new()) };
        let BounceSearch { end_s, view, query, frame, rows } = search;
        let field_frame = buffers.uniform("field frame of droplets", &query.frame)?;
        let classes = buffers.constants("classes of droplets", &query.classes)?;
        let drift = buffers.constants("drift of drops with droplets", &query.drift)?;
        let bounce_frame = buffers.uniform("bounce frame", frame)?;
        let rows = buffers.constants("motion by the wind", rows)?;
        let before = offset_of!(BounceParts, drops) as u64;
        let parts = list_buffer(buffers, "parts of paths", frame.parts, before)?;
        let (shelter, paths) = shelter_frame(field, on, query, (obstacles, bounds), (view, *end_s));
        let shelter = buffers.uniform("shelter frame of droplets", &shelter)?;
        let paths = buffers.constants("drift of paths of drops with droplets", &paths)?;
        let [clear, find, list] = self.bounce_kernels()?;
        let hit = self.bounce_hit(obstacles.holes.is_some())?;
        let of_find = [
            (0, &field_frame),
            (1, &classes),
            (2, &on.nodes),
            (3, &on.thresholds),
            (4, &drift),
            (7, &on.begins),
            (8, &on.parts),
            (9, &bounce_frame),
            (10, &rows),
            (11, &parts),
        ];
        let mut of_hit = obstacles.bindings();
        of_hit.extend([(6, &shelter), (8, &paths), (9, &bounce_frame), (10, &rows), (11, &parts)]);
        let of_list = [(9, &bounce_frame), (11, &parts), (12, to.drops), (13, to.found)];
        let groups = workgroups_for(frame.parts);
        Ok(vec![
            (clear, clear.bind_at(buffers, [(11, &parts)])?, [1; 3]),
            (
                find,
                find.bind_at(buffers, of_find)?,
                workgroups_for(query.frame.columns.saturating_mul(BOUNCE_LANES)),
            ),
            (hit, hit.bind_at(buffers, of_hit)?, groups),
            (list, list.bind_at(buffers, of_list)?, groups),
        ])
    }

    /// The kernels of droplets that do not ask for obstacles: clear, find, list.
    fn bounce_kernels(&self) -> Result<&[ComputeKernel; 3], GpuError> {
        let kernel = |kernel| ComputeKernel::new(&self.gpu, kernel, &[]);
        made_once(&self.bounce, || {
            Ok([kernel(&BOUNCE_CLEAR_KERNEL)?, kernel(&BOUNCE_FIND_KERNEL)?, kernel(&BOUNCE_LIST_KERNEL)?])
        })
    }

    /// The kernel that follows drops and droplets among obstacles, with holes or without.
    fn bounce_hit(&self, has_holes: bool) -> Result<&ComputeKernel, GpuError> {
        let (kept, kernel) = if has_holes {
            (&self.bounce_hit_among_holes, &BOUNCE_HIT_AMONG_HOLES_KERNEL)
        } else {
            (&self.bounce_hit, &BOUNCE_HIT_KERNEL)
        };
        made_once(kept, || ComputeKernel::new(&self.gpu, kernel, &[]))
    }

    /// The kernel that asks for obstacles, with holes or without.
    fn shelter(&self, has_holes: bool) -> Result<&ComputeKernel, GpuError> {
        if !has_holes {
            return Ok(&self.shelter);
        }
        made_once(&self.among_holes, || ComputeKernel::new(&self.gpu, &SHELTER_AMONG_HOLES_KERNEL, &[]))
    }
}

/// The frame of the search for what obstacles stop, and the drift of paths relative to that up to the picture's time.
fn shelter_frame(
    field: &RainField,
    on: &mut FieldOnGpu,
    query: &FieldQuery,
    (obstacles, [low, high]): (&ObstaclesOnGpu<'_>, [Vec3; 2]),
    (view, time_s): (&View, f64),
) -> (ShelterFrame, Vec<[f32; 4]>) {
    let half = 0.5 * view.shutter_s;
    let open_s = time_s - half;
    let last = (open_s / CUT_S).floor();
    let height = f64::from(high.y) + obstacles.origin.y - query.deepest;
    let cuts = number_of_cuts(&field.wind, height, query.slowest) as i64;
    let numbers = last as i64 - cuts + 1..=last as i64;
    let open = Drift::new(&field.wind, open_s);
    let row = |drift: &Drift| -> Vec<[f32; 4]> {
        let pairs = drift.entries().zip(query.now.entries());
        pairs.map(|(then, now)| (then[0] - now[0]).as_vec3().extend(0.0).to_array()).collect()
    };
    let mut drift = row(&open);
    drift.extend(numbers.rev().flat_map(|number| row(on.drift(&field.wind, number * SIXTEENTHS_OF_CUT))));
    let frame = ShelterFrame {
        eye: (view.eye - obstacles.origin).as_vec3(),
        half_shutter: half as f32,
        low,
        since_cut: (open_s - last * CUT_S) as f32,
        high,
        cuts: cuts as u32,
        room: query.frame.room,
        first: query.frame.first,
        stopped: 0,
        unread: 0,
    };
    (frame, drift)
}

/// Drops that a search is for.
#[derive(Clone, Copy, Debug)]
enum Wants {
    /// All that obstacles have not stopped when the shutter opens.
    All,
    /// Those of them that are stopped while it is open.
    Stopped,
}

impl From<Wants> for u32 {
    fn from(wants: Wants) -> Self {
        match wants {
            Wants::All => 0,
            Wants::Stopped => 1,
        }
    }
}

impl FieldOnGpu {
    /// Drift of drops in a wind up to a whole sixteenth of a second, by its number.
    fn drift(&mut self, wind: &UniformWind, number: i64) -> &Drift {
        self.drifts.entry(number).or_insert_with(|| Drift::new(wind, number as f64 * SIXTEENTH_S))
    }

    /// Forgets the drift that no picture near a time, s, needs.
    fn forget_far_from(&mut self, time_s: f64) {
        let [longest, after] = [MAX_BACK_S + 2.0, 2.0];
        let near = [time_s - longest, time_s + after].map(|time| (time / SIXTEENTH_S) as i64);
        self.drifts.retain(|number, _| (near[0]..near[1]).contains(number));
    }
}

impl Search<'_> {
    /// Its dispatches, one after another: clear, find, ask for obstacles.
    fn stages<'a>(&'a self, pipeline: &'a FieldPipeline) -> [Option<Dispatch<'a>>; 3] {
        let (clear, find, shelter) = (&self.clear, self.find.as_ref(), self.shelter.as_ref());
        [
            Some(pipeline.clear.dispatch(&clear.0, clear.1)),
            find.map(|(bindings, groups)| pipeline.find.dispatch(bindings, *groups)),
            shelter.map(|(kernel, bindings, groups)| kernel.dispatch(bindings, *groups)),
        ]
    }
}

impl FieldPass<'_> {
    /// The dispatches in stages, one after another: those of a stage write different buffers, but for those of the last, which add
    /// splashes, droplets and drops that drip to the list.
    #[must_use]
    pub fn stages(&self) -> [Vec<Dispatch<'_>>; 4] {
        let mut stages: [Vec<Dispatch<'_>>; 4] = Default::default();
        for search in std::iter::once(&self.search).chain(self.splashes.iter().map(|(search, ..)| search)) {
            for (stage, dispatch) in stages.iter_mut().zip(search.stages(self.pipeline)) {
                stage.extend(dispatch);
            }
        }
        let crowns = self.splashes.iter();
        stages[3]
            .extend(crowns.map(|(_, bindings, groups)| self.pipeline.splash.dispatch(bindings, *groups)));
        for (stage, (kernel, bindings, groups)) in stages.iter_mut().zip(&self.bounces) {
            stage.push(kernel.dispatch(bindings, *groups));
        }
        stages[3].extend(self.drips.iter().map(|(kernel, bound, groups)| kernel.dispatch(bound, *groups)));
        stages
    }

    /// The same with another dispatch beside those that ask for obstacles, which take longest and leave room on a large device.
    #[must_use]
    pub fn stages_beside<'a>(&'a self, other: Dispatch<'a>) -> [Vec<Dispatch<'a>>; 4] {
        let mut stages = self.stages();
        stages[2].push(other);
        stages
    }

    /// The dispatches, in this order.
    #[must_use]
    pub fn dispatches(&self) -> Vec<Dispatch<'_>> {
        self.stages().concat()
    }

    /// The list that they fill.
    #[must_use]
    pub fn list(&self) -> &DropListOnGpu {
        &self.list
    }

    /// Columns that are searched.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.columns
    }

    /// Limits of the list.
    #[must_use]
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// Reads the drops, and how many were found before obstacles stopped some of them, and how many were looked at.
    ///
    /// # Errors
    /// Returns the error of the GPU.
    pub fn read(&self) -> Result<(Vec<EyeDrop>, [u32; 2]), GpuError> {
        self.list.read(&self.pipeline.gpu)
    }
}
