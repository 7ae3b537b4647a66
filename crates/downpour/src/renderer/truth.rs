//! Truth about the pixels of a frame.

use std::sync::Arc;

use downpour_render::file::Samples;
use downpour_render::picture::{Picture, PictureOptions};
use downpour_render::rain::{DropMasks, Rain};
use downpour_sim::field::VisibleDrops;
use downpour_trace::frame_scene::FrameScene;
use downpour_trace::picture::picture_frame;
use downpour_trace::scene::SceneView;
use downpour_trace::truth::SurfaceTruth;

use super::RendererError;

/// Drop that a pixel shows most of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelDrop {
    /// Its id, as in the list of drops.
    pub id: u64,
    /// Volume-equivalent diameter, m; 0 where no drop is drawn.
    pub diameter: f32,
    /// Distance before the pixel, m.
    pub distance: f32,
    /// Fraction of the pixel's light that comes by way of it, 0 to 1.
    pub alpha: f32,
}

/// Truth about the pixels of a frame, rows from the top: behind a pane, if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The drop that each pixel shows most of.
    pub drops: Vec<PixelDrop>,
    /// The surface behind each pixel.
    pub surfaces: Vec<SurfaceTruth>,
}

impl Truth {
    /// Channels of a file.
    pub(super) fn channels(&self) -> Vec<(&'static str, Samples)> {
        let of_drop = |of: fn(&PixelDrop) -> f32| Samples::F32(self.drops.iter().map(of).collect());
        let half =
            |shift: u32| Samples::U32(self.drops.iter().map(|drop| (drop.id >> shift) as u32).collect());
        let of_surface = |of: fn(&SurfaceTruth) -> f32| Samples::F32(self.surfaces.iter().map(of).collect());
        vec![
            ("drop.id_low", half(0)),
            ("drop.id_high", half(32)),
            ("drop.diameter_mm", of_drop(|drop| drop.diameter * 1.0e3)),
            ("drop.distance_m", of_drop(|drop| drop.distance)),
            ("drop.alpha", of_drop(|drop| drop.alpha)),
            ("wetness.Y", of_surface(|surface| surface.wetness)),
            ("water.depth_mm", of_surface(|surface| surface.water_depth * 1.0e3)),
            ("motion.X", of_surface(|surface| surface.motion.x)),
            ("motion.Y", of_surface(|surface| surface.motion.y)),
        ]
    }
}

/// Everything that the truth about a frame is found from.
#[derive(Debug)]
pub(super) struct TruthOf {
    pub(super) frame_scene: FrameScene,
    pub(super) masks: Arc<DropMasks>,
    pub(super) options: PictureOptions,
}

impl TruthOf {
    /// The truth about a frame with its drops.
    pub(super) fn find(&self, picture: &Picture, drops: &VisibleDrops) -> Result<Truth, RendererError> {
        let Self { frame_scene, masks, options } = self;
        let frame = picture_frame(&frame_scene.data, &frame_scene.viewpoint, options)?;
        let placed = frame_scene.place(&drops.drops);
        let rain =
            Rain::new(&frame.camera, frame_scene.viewpoint.eye.as_dvec3(), &placed, masks, &options.rain);
        let shown = rain.truth(&picture.clean);
        let pixel = |shown: Option<downpour_render::rain::DropTruth>| {
            let Some(shown) = shown else { return PixelDrop::default() };
            let drop = drops.drops.get(shown.drop as usize);
            drop.map_or_else(PixelDrop::default, |drop| PixelDrop {
                id: drop.id,
                diameter: drop.diameter,
                distance: shown.distance,
                alpha: shown.alpha,
            })
        };
        Ok(Truth {
            drops: shown.into_iter().map(pixel).collect(),
            surfaces: SceneView { data: &frame_scene.data, frame: &frame }.truth(&frame_scene.motion),
        })
    }
}
