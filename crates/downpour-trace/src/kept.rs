//! A picture of a scene that stays from picture to picture: while neither the scene nor the eye changes, it is refined by one more frame of
//! rays each time, up to a number of frames, and then costs nothing.
//!
//! Changes of the scene's light by less than an eye can tell do not count: surfaces that get wetter step by step.

use downpour_math::rng::rng_draw;
use downpour_render::refine::{refine_shift, shifted};

use crate::data::{RenderFrame, SceneData};
use crate::running_light::RunningFrame;
use crate::scene_change::SceneChange;
use crate::temporal::LightWindow;

/// Dimension of the random numbers of the frames of a plate.
const SEED_DIMENSION: u32 = 4121;

/// Parts of a plate that stay for later pictures, and those that earlier ones have left for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlateUse {
    /// Frames of rays over which the plate of a scene that stands still is refined from picture to picture ([`KeptPlate`]); 0: each
    /// picture has one of its own.
    pub kept_frames: u32,
    /// Frames of a clip over which the light of sky and surfaces is averaged ([`temporal`](crate::temporal)). A plate that is refined is
    /// not averaged with others.
    pub light: Option<LightWindow>,
    /// Frames over which the light of a plate that may stay goes on from picture to picture while the eye or the scene moves
    /// ([`running_light`](crate::running_light)).
    pub running: Option<RunningFrame>,
}

impl PlateUse {
    /// Frames over which the light of the plate is averaged: none if it is refined.
    #[must_use]
    pub fn window(&self) -> Option<LightWindow> {
        self.light.filter(|_| self.kept_frames == 0)
    }

    /// Frames from which the light of the plate goes on: none of one that is not kept.
    #[must_use]
    pub fn running(&self) -> Option<RunningFrame> {
        self.running.filter(|running| self.kept_frames > 0 && running.frames > 1)
    }
}

/// A picture of a scene with what it shows; `T` holds its pixels.
#[derive(Clone, Debug)]
pub struct KeptPlate<T> {
    scene: SceneData,
    frame: RenderFrame,
    /// Frames that its picture is the mean of.
    count: u32,
    /// Its pixels.
    pub held: T,
}

impl<T> KeptPlate<T> {
    /// Begins a plate of a scene, of which no frame is taken yet.
    #[must_use]
    pub fn new(scene: &SceneData, frame: &RenderFrame, held: T) -> Self {
        Self { scene: scene.clone(), frame: seedless(frame), count: 0, held }
    }

    /// True if a frame of a scene shows the same.
    #[must_use]
    pub fn shows(&self, scene: &SceneData, frame: &RenderFrame) -> bool {
        bytemuck::bytes_of(&self.frame) == bytemuck::bytes_of(&seedless(frame))
            && has_ripples_alike(&self.scene, scene)
            && self.scene.glazing_rows() == scene.glazing_rows()
            && SceneChange::between(&self.scene, scene) == SceneChange::default()
    }

    /// Number of frames that its picture is the mean of.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The next frame to be taken into the mean, with its number from 1 on; `None` after `max` frames. The first is `frame` itself.
    pub fn next(&mut self, frame: &RenderFrame, max: u32) -> Option<(RenderFrame, u32)> {
        if self.count >= max.max(1) {
            return None;
        }
        self.count += 1;
        Some((refined_frame(frame, self.count), self.count))
    }
}

/// Frame `count` from 1 on of the mean that refines the picture of a frame.
fn refined_frame(frame: &RenderFrame, count: u32) -> RenderFrame {
    if count <= 1 {
        return *frame;
    }
    let camera = shifted(&frame.camera, refine_shift(count));
    let seed = rng_draw([frame.camera.seed, 0], count, 0, SEED_DIMENSION)[0];
    // What stands still is worth the rays of all pixels.
    RenderFrame { camera, ..*frame }.with_ray_spacing(1).with_seed(seed)
}

/// The frame without what differs between the frames that refine a plate.
pub(crate) fn seedless(frame: &RenderFrame) -> RenderFrame {
    frame.with_ray_spacing(1).with_seed(0)
}

/// True if ripples on a device are of one step.
#[cfg(feature = "wgpu")]
fn has_ripples_alike(before: &SceneData, scene: &SceneData) -> bool {
    before.ripples == scene.ripples
}

#[cfg(not(feature = "wgpu"))]
fn has_ripples_alike(_: &SceneData, _: &SceneData) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_render::camera::Viewpoint;
    use glam::Vec3;

    use crate::builder::SceneBuilder;
    use crate::sky_light::SkyLight;
    use crate::wet::SceneWetness;
    use downpour_weather::WetnessAt;

    fn frame_of(scene: &SceneData, eye: Vec3, seed: u64) -> RenderFrame {
        let viewpoint = Viewpoint { eye, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.8 };
        RenderFrame::new(scene, &viewpoint, [64, 36], 1, 1, seed).expect("a frame")
    }

    fn wet(scene: &mut SceneData, since: f64) {
        let at = WetnessAt { before: 0.0, kept: 1.0, since };
        let wetness = SceneWetness { at, towards: Vec3::Y, shift: Vec3::ZERO };
        scene.set_wetness(Some(&wetness));
    }

    #[test]
    fn a_plate_is_kept_while_it_shows_the_same() {
        let scene = SceneBuilder::new().build(&SkyLight::uniform([1.0; 3]));
        let frame = frame_of(&scene, Vec3::ZERO, 1);
        let mut plate = KeptPlate::new(&scene, &frame, ());
        assert!(plate.shows(&scene, &frame_of(&scene, Vec3::ZERO, 2)));
        assert!(!plate.shows(&scene, &frame_of(&scene, Vec3::X, 1)));
        let other = SceneBuilder::new().build(&SkyLight::uniform([2.0; 3]));
        assert!(!plate.shows(&other, &frame));
        // The first frame is that of a picture by itself, the others are seen from it by other rays.
        let (first, count) = plate.next(&frame, 3).expect("a first frame");
        assert_eq!((first.camera, count), (frame.camera, 1));
        let (second, count) = plate.next(&frame, 3).expect("a second frame");
        assert!(second.camera.seed != frame.camera.seed && second.camera.forward != frame.camera.forward);
        assert_eq!((count, second.camera.eye), (2, frame.camera.eye));
        assert!(plate.next(&frame, 3).is_some());
        assert!(plate.next(&frame, 3).is_none());
        assert_eq!(plate.count(), 3);
    }

    /// Rain that runs down panes is seen in the picture, and not in what drops show of the scene.
    #[test]
    fn rain_on_panes_makes_a_plate_anew() {
        let mut scene = SceneBuilder::new().build(&SkyLight::uniform([1.0; 3]));
        wet(&mut scene, 0.5);
        let row = |rained: f32| [[0, 0, rained.to_bits(), 0], [0; 4]];
        scene.set_glazing(&row(1.0));
        let frame = frame_of(&scene, Vec3::ZERO, 1);
        let plate = KeptPlate::new(&scene, &frame, ());
        let mut later = scene.clone();
        later.set_glazing(&row(1.1));
        assert!(plate.shows(&scene, &frame) && !plate.shows(&later, &frame));
        assert_eq!(SceneChange::between(&scene, &later), SceneChange::default());
        later.set_glazing(&[]);
        assert!(SceneChange::between(&scene, &later).rest && later.glazing == 0);
    }

    #[test]
    fn a_wetness_that_nobody_can_tell_does_not_count() {
        let mut scene = SceneBuilder::new().build(&SkyLight::uniform([1.0; 3]));
        wet(&mut scene, 1.0);
        let frame = frame_of(&scene, Vec3::ZERO, 1);
        let plate = KeptPlate::new(&scene, &frame, ());
        let mut later = scene.clone();
        wet(&mut later, 1.005);
        assert!(plate.shows(&later, &frame));
        wet(&mut later, 1.2);
        assert!(!plate.shows(&later, &frame));
        wet(&mut later, 1.0);
        *later.table.last_mut().expect("a row") = [7; 4];
        assert!(!plate.shows(&later, &frame));
    }
}
