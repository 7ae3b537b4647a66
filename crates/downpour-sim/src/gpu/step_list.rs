//! Drops of a state of stepped rain that a picture shows, listed by a device: those that
//! [`Simulation::visible_after`](crate::simulation::Simulation::visible_after) lists on the CPU.

use std::sync::OnceLock;

use bytemuck::Zeroable as _;
use downpour_gpu::{BufferSource, ComputeKernel, Dispatch, made_once, wgpu, workgroups_for};
use downpour_shaders::sim::step_list::{STEP_LIST_CLEAR_KERNEL, STEP_LIST_KERNEL, STEP_SPLASH_KERNEL};

use super::list::BoundKernel;
use super::simulation::StepBuffers;
use super::{CollisionMapOnGpu, DripSearch, DropListOnGpu, GpuSimError};
use crate::SimError;
use crate::field::EyeDrop;
use crate::impacts::SplashOptions;
use crate::impacts::splash_frame::SplashFrame;
use crate::plan::Plan;
use crate::recent::SPANS;
use crate::step_list::StepListFrame;
use crate::step_splash::StepSplashFrame;
use crate::view::View;

/// A picture of stepped rain.
#[derive(Clone, Copy, Debug)]
pub struct StepPicture<'a> {
    /// The picture.
    pub view: &'a View,
    /// Time from the state to the picture, s: at least half of its exposure.
    pub after_s: f64,
    /// Collision map at the time of the picture.
    pub map: Option<&'a CollisionMapOnGpu>,
    /// A pane before the eye: its unit normal, away from the eye, and its distance, m; drops on the eye's side are not listed.
    pub pane: Option<[f32; 4]>,
    /// Drops that are known already, at the beginning of the list.
    pub known: &'a [EyeDrop],
    /// Points whose drops are listed as well.
    pub drips: Option<DripSearch<'a>>,
    /// Splashes whose crowns are listed as well; `None`: there are none.
    pub splashes: Option<&'a SplashOptions>,
    /// Drops that may have room.
    pub max_room: u32,
}

/// The kernels, made when they are first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct StepListKernels {
    clear: OnceLock<ComputeKernel>,
    /// Without and with a collision map.
    list: [OnceLock<ComputeKernel>; 2],
    splash: OnceLock<ComputeKernel>,
}

/// The list of a picture's drops, ready to be made.
#[derive(Debug)]
pub struct StepListPass<'a> {
    clear: BoundKernel<'a>,
    /// The drops of each piece, the crowns of earlier impacts, and drops that drip.
    finders: Vec<BoundKernel<'a>>,
    list: DropListOnGpu,
}

impl StepListKernels {
    /// Makes ready to list the drops of a state.
    pub(super) fn prepare<'a>(
        &'a self,
        buffers: &impl BufferSource,
        plan: &Plan,
        state: &StepBuffers<'_>,
        picture: &StepPicture<'a>,
    ) -> Result<StepListPass<'a>, GpuSimError> {
        picture.view.check()?;
        let gpu = buffers.gpu();
        let slots: u32 = state.pieces.iter().map(|piece| piece.count).sum();
        let dripping = picture.drips.map(|drips| Ok::<_, SimError>((drips, drips.query()?))).transpose()?;
        let dripped = dripping.map_or(0, |(_, query)| query.room);
        let most = picture.max_room.saturating_sub(picture.known.len() as u32 + dripped);
        let room = slots.min(most).max(1) + dripped;
        let list = DropListOnGpu::new(buffers, picture.known, room)?;
        let frame = StepListFrame {
            pane: picture.pane.unwrap_or_default(),
            known: list.known(),
            room,
            ..StepListFrame::new(plan, picture.view, picture.after_s)
        };
        let kernel = &self.list[usize::from(picture.map.is_some())];
        let kernel = made_once(kernel, || {
            let collides = f64::from(u8::from(picture.map.is_some()));
            ComputeKernel::new(gpu, &STEP_LIST_KERNEL, &[("STEP_FIELD", 0.0), ("STEP_COLLIDES", collides)])
        })?;
        let (map, texels) =
            picture.map.map_or((state.nowhere, state.nothing), |map| (map.frame(), map.texels()));
        let listed = (12, list.drops());
        let counted = (13, list.counts());
        let splash = SplashFrame {
            pane: picture.pane.unwrap_or_default(),
            ..SplashFrame::of_picture(picture.splashes, picture.view)
        };
        let splash = buffers.uniform("splash frame", &splash)?;
        let mut finders = Vec::new();
        for piece in &state.pieces {
            let frame = StepListFrame { count: piece.count, first: piece.first, ..frame };
            let frame = buffers.uniform("step list frame", &frame)?;
            let of_state = [(1, piece.positions), (2, piece.motions), (3, state.tables)];
            let others = [(0, &splash), (8, map), (9, texels), (11, &frame), listed, counted];
            let bindings = kernel.bind_at(buffers, of_state.into_iter().chain(others))?;
            let groups = workgroups_for(piece.count);
            finders.push((kernel, bindings, groups));
        }
        let max_kept = plan.options.max_kept;
        if picture.splashes.is_some() && max_kept > 0 {
            let kernel = made_once(&self.splash, || ComputeKernel::new(gpu, &STEP_SPLASH_KERNEL, &[]))?;
            let frame_of_splashes = StepSplashFrame {
                spans: plan.recent.before(picture.after_s, picture.view.eye),
                first: plan.options.max_events,
                room: max_kept,
                ..StepSplashFrame::zeroed()
            };
            let frame_of_list = buffers.uniform("step list frame", &frame)?;
            let of_splashes = buffers.uniform("step splash frame", &frame_of_splashes)?;
            let bound = [(0, &splash), (5, state.events), (6, state.counts), (11, &frame_of_list)];
            let rest = [listed, counted, (14, &of_splashes)];
            let bindings = kernel.bind_at(buffers, bound.into_iter().chain(rest))?;
            finders.push((kernel, bindings, workgroups_for(SPANS as u32 * max_kept)));
        }
        if let Some((drips, query)) = dripping.filter(|(_, query)| query.room > 0) {
            finders.extend(drips.prepare(buffers, &query, &list, picture.pane)?);
        }
        let kernel = made_once(&self.clear, || ComputeKernel::new(gpu, &STEP_LIST_CLEAR_KERNEL, &[]))?;
        let frame = buffers.uniform("step list frame", &frame)?;
        let bindings = kernel.bind_at(buffers, [(6, state.counts), (11, &frame), listed, counted])?;
        Ok(StepListPass { clear: (kernel, bindings, workgroups_for(room)), finders, list })
    }
}

/// Drops of a state on the device.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepPiece<'a> {
    pub(super) positions: &'a wgpu::Buffer,
    pub(super) motions: &'a wgpu::Buffer,
    /// Number of drops or slots, and the number of the first.
    pub(super) count: u32,
    pub(super) first: u32,
}

impl StepListPass<'_> {
    /// The dispatches in stages, one after another.
    #[must_use]
    pub fn stages(&self) -> [Vec<Dispatch<'_>>; 2] {
        let (kernel, bindings, groups) = &self.clear;
        let finders =
            self.finders.iter().map(|(kernel, bindings, groups)| kernel.dispatch(bindings, *groups));
        [vec![kernel.dispatch(bindings, *groups)], finders.collect()]
    }

    /// The same with another dispatch beside those that list the drops.
    #[must_use]
    pub fn stages_beside<'a>(&'a self, other: Dispatch<'a>) -> [Vec<Dispatch<'a>>; 2] {
        let mut stages = self.stages();
        stages[1].push(other);
        stages
    }

    /// The list that they fill.
    #[must_use]
    pub fn list(&self) -> &DropListOnGpu {
        &self.list
    }
}
