//! Frames drawn by a GPU.

use std::cell::RefCell;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use downpour_gpu::{Gpu, made_once};
use downpour_lattice::gpu::puddle::PuddleKernels;
use downpour_render::gpu::{BehindGlass, EnvironmentMap, GlassRenderer};
use downpour_render::picture::PictureOptions;
use downpour_render::rain::DropMasks;
use downpour_render::tone::Tone;
use downpour_sim::field::{EyeDrop, RainField};
use downpour_sim::gpu::{DripPipeline, DripSearch, DripsOnGpu, FieldOnGpu, FieldSearch, StepPicture};
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::gpu::{
    DisplayReadback, FieldDrops, PictureDrops, PictureOnGpu, PictureRenderer, PictureUse,
};
use downpour_trace::kept::PlateUse;
use downpour_trace::wet_ground::WetGround;

use super::RendererError;
use super::computer::{Painted, PaneView, ThroughGlass};
use super::drops::Drops;
use super::flash::FlashPicture;
use crate::shower::{DripView, ShowerRain, ShowerView};

/// A GPU with its pipelines.
pub(super) struct OnGpu {
    gpu: Gpu,
    renderer: PictureRenderer,
    /// Made for the first frame that is seen through a pane.
    glass: OnceLock<GlassRenderer>,
    /// The rain in closed form of the last frame, and the same on the device.
    field: RefCell<Option<(Arc<RainField>, FieldOnGpu)>>,
    /// Made for the first points that drip.
    drip_pipeline: OnceLock<DripPipeline>,
    /// The points that drip in the last frame with some, on the device.
    drips: RefCell<Option<DripsOnGpu>>,
    /// True if ripples of puddles stay on the device.
    holds_ripples: bool,
    /// Made for the first puddles.
    puddles: OnceLock<PuddleKernels>,
}

impl OnGpu {
    /// `drives_ripples`: a software driver holds the ripples of puddles, too.
    pub(super) fn new(gpu: Gpu, renderer: PictureRenderer, drives_ripples: bool) -> Self {
        let holds_ripples = drives_ripples || !gpu.adapter().is_software();
        Self {
            gpu,
            renderer,
            glass: OnceLock::new(),
            field: RefCell::default(),
            drip_pipeline: OnceLock::new(),
            drips: RefCell::default(),
            holds_ripples,
            puddles: OnceLock::new(),
        }
    }

    /// True if ripples of puddles stay on the device.
    pub(super) fn holds_ripples(&self) -> bool {
        self.holds_ripples
    }

    /// Moves the ripples of puddles to the device.
    pub(super) fn hold_ripples(&self, ground: &mut WetGround) -> Result<(), RendererError> {
        let kernels = made_once(&self.puddles, || PuddleKernels::new(&self.gpu))?;
        Ok(ground.move_to_device(kernels)?)
    }

    pub(super) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Pipelines of pictures.
    pub(super) fn renderer(&self) -> &PictureRenderer {
        &self.renderer
    }

    /// Drops that have room on the device.
    pub(super) fn max_drops(&self) -> u32 {
        self.renderer.max_drops()
    }

    /// Draws a frame for a display, with flashes of lightning if there are any.
    pub(super) fn display(
        &self,
        of: PlateUse,
        tone: &Tone,
        (frame_scene, drops): (&FrameScene, &Drops),
        (masks, options): (&DropMasks, &PictureOptions),
        flashes: &[FlashPicture],
    ) -> Result<Option<DisplayReadback>, RendererError> {
        let alone = flashes.is_empty();
        let of_frame = PictureUse { plate: of, tone: alone.then_some(*tone) };
        let mut picture = self.drawn(of_frame, frame_scene, drops, masks, options)?;
        for FlashPicture { frame_scene, drops, options } in flashes {
            let light = self.drawn(PictureUse::default(), frame_scene, drops, masks, options)?;
            self.renderer.add_light(&mut picture, light)?;
        }
        if !alone {
            self.renderer.show(&mut picture, tone)?;
        }
        Ok(picture.begin_display()?)
    }

    fn drawn(
        &self,
        of: PictureUse,
        frame_scene: &FrameScene,
        drops: &Drops,
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<PictureOnGpu, RendererError> {
        match drops {
            Drops::Listed(drops) => {
                let drops = frame_scene.place(&drops.drops);
                let drops = PictureDrops::Listed(&drops);
                Ok(self.renderer.draw_for(
                    of,
                    &frame_scene.data,
                    &frame_scene.viewpoint,
                    drops,
                    masks,
                    options,
                )?)
            }
            Drops::OfDevice(shown) => self.draw(of, frame_scene, shown, masks, options),
        }
    }

    /// Draws a frame, seen through a pane if there is one.
    pub(super) fn paint(
        &self,
        of: PlateUse,
        frame_scene: &FrameScene,
        drops: &Drops,
        masks: &DropMasks,
        options: &PictureOptions,
        through: Option<&PaneView>,
    ) -> Result<Painted, RendererError> {
        let of = PictureUse { plate: of, tone: None };
        let mut drawn = self.drawn(of, frame_scene, drops, masks, options)?;
        let Some(PaneView { glass, environment, glow, camera }) = through else {
            return Ok(Painted::OnItsWay { read: Box::new(drawn.begin_read()?), through_glass: None });
        };
        // The passes before it have times of their own.
        self.gpu.wait()?;
        let begin = Instant::now();
        let behind = drawn.behind_glass();
        let environment =
            environment.as_ref().map_or(behind.environment, |texels| EnvironmentMap::Texels(texels));
        let seen = self.pane()?.through(glass, &BehindGlass { environment, ..behind })?;
        drawn.passes.push(("glass", begin.elapsed().as_secs_f64() * 1.0e3));
        let through_glass = Some(Box::new(ThroughGlass { seen, glow: *glow, camera: *camera }));
        Ok(Painted::OnItsWay { read: Box::new(drawn.begin_read()?), through_glass })
    }

    /// Draws a frame whose drops the device finds.
    fn draw(
        &self,
        of: PictureUse,
        frame_scene: &FrameScene,
        shown: &ShowerView,
        masks: &DropMasks,
        options: &PictureOptions,
    ) -> Result<PictureOnGpu, RendererError> {
        let known: Vec<EyeDrop> =
            shown.droplets.iter().map(|drop| EyeDrop::new(drop, shown.view.eye)).collect();
        let mut kept_drips = self.drips.borrow_mut();
        self.follow_drips(&mut kept_drips, shown)?;
        let drips = shown.drips.as_ref().zip(kept_drips.as_ref());
        let drips = drips.map(|(shown_drips, drips)| {
            let DripView { view, least_pixels, splashes, .. } = shown_drips;
            let (least_pixels, splashes) = (*least_pixels, splashes.as_ref());
            DripSearch { drips, view, least_pixels, time_s: shown.time_s, splashes }
        });
        let pane = shown.pane.map(|pane| pane.outward.extend(pane.distance).to_array());
        let max_room = self.renderer.max_drops();
        let draw = |drops: PictureDrops<'_>| {
            self.renderer.draw_for(of, &frame_scene.data, &frame_scene.viewpoint, drops, masks, options)
        };
        let (field, splashes, bounce) = match &shown.rain {
            ShowerRain::Closed { field, splashes, bounce, .. } => (field, splashes, bounce),
            ShowerRain::Stepped { picture, splashes } => {
                return Ok(picture.with(|simulation, after_s, map| {
                    let view = &shown.view;
                    let splashes = splashes.as_ref();
                    let known = &known;
                    let picture = StepPicture { view, after_s, map, pane, known, drips, splashes, max_room };
                    draw(PictureDrops::Stepped(simulation, picture))
                })?);
            }
        };
        let mut last = self.field.borrow_mut();
        let kept = last.take().filter(|(known, _)| Arc::ptr_eq(known, field));
        let kept = match kept {
            Some(kept) => kept,
            None => (Arc::clone(field), self.renderer.upload_field(field)?),
        };
        let (rain, on_gpu) = last.insert(kept);
        let search = FieldSearch {
            view: &shown.view,
            time_s: shown.time_s,
            max_room,
            pane,
            known: &known,
            drips,
            splashes: splashes.as_ref(),
            bounce: bounce.as_ref(),
        };
        let origin = frame_scene.origin;
        Ok(draw(PictureDrops::Field(FieldDrops { field: rain, on_gpu, search, origin }))?)
    }

    /// Brings the points that drip in a picture to the device, unless they are there.
    fn follow_drips(&self, kept: &mut Option<DripsOnGpu>, shown: &ShowerView) -> Result<(), RendererError> {
        let Some(DripView { drips, .. }) = &shown.drips else { return Ok(()) };
        if kept.as_ref().is_none_or(|kept| !Arc::ptr_eq(kept.drips(), drips)) {
            let pipeline = made_once(&self.drip_pipeline, || DripPipeline::new(&self.gpu))?;
            *kept = pipeline.upload(drips)?;
        }
        Ok(())
    }

    /// The pipelines of panes.
    fn pane(&self) -> Result<&GlassRenderer, RendererError> {
        Ok(made_once(&self.glass, || GlassRenderer::new(&self.gpu))?)
    }
}
