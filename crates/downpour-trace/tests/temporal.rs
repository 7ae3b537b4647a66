//! Light over the frames of a clip: less noise, the same light, and no trace of what has gone.

mod hall;

use downpour_render::camera::Viewpoint;
use downpour_render::picture::PictureOptions;
use downpour_render::rain::{DropMasks, RainOptions};
use downpour_trace::data::SceneData;
use downpour_trace::kept::PlateUse;
use downpour_trace::picture::{KeptScene, find_light, render_picture_on};
use downpour_trace::temporal::LightWindow;
use glam::DVec3;
use hall::{SIZE, apart, eye, hall, mean, mean_picture};

/// Frames that are averaged.
const FRAMES: usize = 4;

/// A clip of scenes and eyes.
struct Clip<'a> {
    masks: &'a DropMasks,
    scene: &'a dyn Fn(usize) -> SceneData,
    eye: &'a dyn Fn(usize) -> Viewpoint,
    frames: usize,
}

impl Clip<'_> {
    fn window(&self, number: usize) -> LightWindow {
        let before_s =
            std::array::from_fn(|k| (k + 1 < self.frames && k < number).then(|| (number - 1 - k) as f64));
        LightWindow { time_s: number as f64, origin: DVec3::ZERO, before_s }
    }

    fn options(number: usize) -> PictureOptions {
        // Without rain nothing is seen of the environment map.
        let rain = RainOptions { capture_size: 16, ..RainOptions::default() };
        PictureOptions {
            size: SIZE,
            grid: 1,
            sky_rays: 1,
            seed: number as u64,
            rain,
            ..PictureOptions::default()
        }
    }

    /// Radiance of a frame over what the frames before have left.
    fn frame(&self, kept: &mut KeptScene, number: usize) -> Vec<f32> {
        let of = PlateUse { light: Some(self.window(number)), ..PlateUse::default() };
        let (scene, eye) = ((self.scene)(number), (self.eye)(number));
        let picture = render_picture_on(kept, of, &scene, &eye, &[], self.masks, &Self::options(number))
            .expect("a picture");
        picture.clean.iter().map(|pixel| pixel[1]).collect()
    }

    fn find(&self, kept: &mut KeptScene, number: usize) {
        let (scene, eye) = ((self.scene)(number), (self.eye)(number));
        find_light(kept, &self.window(number), &scene, &eye, &Self::options(number)).expect("light");
    }

    fn all(&self, count: usize) -> Vec<Vec<f32>> {
        let mut kept = KeptScene::default();
        (0..count).map(|number| self.frame(&mut kept, number)).collect()
    }
}

/// Frames of an eye that walks differ less from those of many rays, and have the same light.
#[test]
fn noise_falls_and_the_light_stays() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let still = hall(1.0, 1.0);
    let scene = |_: usize| still.clone();
    let walk = |number: usize| eye(0.03 * number as f32);
    let of = |frames| Clip { masks: &masks, scene: &scene, eye: &walk, frames };
    let (own, averaged) = (of(1).all(20), of(FRAMES).all(20));
    assert_eq!(own[0], averaged[0]);
    // The light of the last frame by the mean of many frames of other rays before the same eye.
    let last = |_: usize| walk(5);
    let truth = Clip { masks: &masks, scene: &scene, eye: &last, frames: 1 }.all(24);
    let truth = mean_picture(&truth);
    let [before, after] = [&own[5], &averaged[5]].map(|picture| apart(&truth, picture));
    assert!(after < 0.75 * before, "noise {before} becomes {after}");
    // The mean over many frames is that of frames of their own.
    let [of_own, of_averaged] = [&own, &averaged].map(|clip| mean(&mean_picture(&clip[4..])));
    let ratio = of_averaged / of_own;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

/// A frame alone, for which the light of the frames before it is found first, is that of the clip to the bit.
#[test]
fn a_frame_alone_is_that_of_the_clip() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let scene = |number: usize| hall(1.0, 1.0 - 0.1 * number as f32);
    let walk = |number: usize| eye(0.03 * number as f32);
    let clip = Clip { masks: &masks, scene: &scene, eye: &walk, frames: FRAMES };
    let all = clip.all(6);
    let mut kept = KeptScene::default();
    for number in 2..5 {
        clip.find(&mut kept, number);
    }
    assert!(clip.frame(&mut kept, 5) == all[5]);
}

/// Of light that is switched off hardly any is left in the next frame.
#[test]
fn no_light_is_left_of_what_shone_before() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let scene = |number: usize| hall(if number < 4 { 1.0 } else { 0.02 }, 1.0);
    let still = |_: usize| eye(0.0);
    let of = |frames| Clip { masks: &masks, scene: &scene, eye: &still, frames }.all(5);
    let (own, averaged) = (of(1), of(FRAMES));
    let left = (mean(&averaged[4]) - mean(&own[4])) / mean(&own[3]);
    assert!(left.abs() < 0.03, "{left}");
}

/// A board that moves leaves no trace of itself on the wall behind it.
#[test]
fn what_has_moved_leaves_no_trace() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let scene = |number: usize| hall(1.0, 1.6 - 0.4 * number as f32);
    let still = |_: usize| eye(0.0);
    let of = |frames| Clip { masks: &masks, scene: &scene, eye: &still, frames };
    let averaged = &of(FRAMES).all(5)[4];
    // The same place of the board in all frames.
    let rest = |_: usize| scene(4);
    let truth = Clip { masks: &masks, scene: &rest, eye: &still, frames: 1 }.all(16);
    let truth = mean_picture(&truth);
    let own = &of(1).all(5)[4];
    let [before, after] = [own, averaged].map(|picture| apart(&truth, picture));
    assert!(after < before, "noise {before} becomes {after}");
    // Where the board was one frame before, wall is seen as bright as ever.
    let worst = truth.iter().zip(averaged).map(|(a, b)| (b - a).abs() / mean(&truth)).fold(0.0, f32::max);
    let worst_own = truth.iter().zip(own).map(|(a, b)| (b - a).abs() / mean(&truth)).fold(0.0, f32::max);
    assert!(worst < 1.2 * worst_own, "{worst} {worst_own}");
}
