//! Light of live frames that goes on from frame to frame: less noise, the same light, and none of what no longer shines.

mod hall;

use downpour_render::camera::Viewpoint;
use downpour_render::light::LightSource;
use downpour_render::picture::PictureOptions;
use downpour_render::rain::{DropMasks, RainOptions};
use downpour_trace::data::SceneData;
use downpour_trace::kept::PlateUse;
use downpour_trace::picture::{KeptScene, render_picture_on};
use downpour_trace::running_light::RunningFrame;
use glam::{DVec3, Vec3};
use hall::{SIZE, apart, eye, hall, mean, mean_picture};

/// Live frames one after the other.
struct Live<'a> {
    masks: &'a DropMasks,
    frames: u32,
    kept: KeptScene,
}

impl<'a> Live<'a> {
    /// `frames`: of the mean.
    fn new(masks: &'a DropMasks, frames: u32) -> Self {
        Self { masks, frames, kept: KeptScene::default() }
    }

    /// Radiance of a frame of a seed, and true if it was traced.
    fn frame(&mut self, scene: &SceneData, eye: &Viewpoint, time_s: f64, seed: u64) -> (Vec<f32>, bool) {
        let running = Some(RunningFrame { time_s, origin: DVec3::ZERO, frames: self.frames });
        let of = PlateUse { kept_frames: 1, running, ..PlateUse::default() };
        // Without rain nothing is seen of the environment map.
        let rain = RainOptions { capture_size: 16, ..RainOptions::default() };
        let options = PictureOptions {
            size: SIZE,
            grid: 1,
            sky_rays: 1,
            ray_spacing: 2,
            seed,
            rain,
            ..PictureOptions::default()
        };
        let picture =
            render_picture_on(&mut self.kept, of, scene, eye, &[], self.masks, &options).expect("a picture");
        let traced = picture.passes.iter().any(|(name, _)| *name == "scene");
        (picture.clean.iter().map(|pixel| pixel[1]).collect(), traced)
    }
}

fn walk(step: usize) -> Viewpoint {
    eye(0.02 * step as f32)
}

/// Frames of an eye that walks differ less from those of many rays, and have the same light; so do those of one time, as while the time
/// stands still and the eye does not, and the first after a stand.
#[test]
fn noise_falls_and_the_light_stays() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let scene = hall(1.0, 1.0);
    let mut live = Live::new(&masks, 16);
    let averaged: Vec<Vec<f32>> =
        (0..24).map(|k| live.frame(&scene, &walk(k), k as f64 / 60.0, k as u64).0).collect();
    let own: Vec<Vec<f32>> =
        (0..24).map(|k| Live::new(&masks, 1).frame(&scene, &walk(k), 0.0, k as u64).0).collect();
    assert_eq!(own[0], averaged[0]);
    // The light of a late frame by the mean of many frames of other rays before the same eye.
    let truth: Vec<_> =
        (100..140).map(|seed| Live::new(&masks, 1).frame(&scene, &walk(20), 0.0, seed).0).collect();
    let truth = mean_picture(&truth);
    let before = apart(&truth, &own[20]);
    let after = apart(&truth, &averaged[20]);
    assert!(after < 0.5 * before, "noise {before} becomes {after}");
    // The mean over many frames is that of frames of their own.
    let [of_own, of_averaged] = [&own, &averaged].map(|all| mean(&mean_picture(&all[8..])));
    let ratio = of_averaged / of_own;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    // Time stands still.
    let mut paused = Live::new(&masks, 16);
    let of_pause = (0..=20).map(|k| paused.frame(&scene, &walk(k), 1.0, 7).0).last().expect("a frame");
    let after = apart(&truth, &of_pause);
    assert!(after < 0.55 * before, "noise {before} becomes {after}");
    // The eye stands still: the plate stays, and the mean with it.
    assert!(!paused.frame(&scene, &walk(20), 2.5, 8).1 && !paused.frame(&scene, &walk(20), 4.0, 9).1);
    let on = apart(&truth, &paused.frame(&scene, &walk(20), 5.0, 10).0);
    assert_eq!(on, after);
    let (further, traced) = paused.frame(&scene, &walk(21), 5.5, 11);
    let stepped = mean_picture(
        &(200..224)
            .map(|seed| Live::new(&masks, 1).frame(&scene, &walk(21), 0.0, seed).0)
            .collect::<Vec<_>>(),
    );
    assert!(traced && apart(&stepped, &further) < 0.6 * before, "{} {before}", apart(&stepped, &further));
}

/// A lamp over a scene.
fn with_lamp(scene: &SceneData, intensity: f32) -> SceneData {
    let mut lit = scene.clone();
    lit.set_lights(&[LightSource::Point {
        position: Vec3::new(1.5, 2.8, -2.0),
        radius: 0.0,
        intensity: Vec3::splat(intensity),
        range: 0.0,
    }]);
    lit
}

/// Of a lamp that is switched off little light is left in the next frame and none soon after; none of a scene is in the frames of another
/// one, or of a time that is long ago.
#[test]
fn no_light_is_left_of_what_shone_before() {
    let masks = DropMasks::trace(1.333).expect("masks");
    let dark = hall(0.02, 1.0);
    let [on, off] = [4.0, 0.0].map(|intensity| with_lamp(&dark, intensity));
    let own = |scene: &SceneData, step, seed| Live::new(&masks, 1).frame(scene, &walk(step), 0.0, seed).0;
    let mut live = Live::new(&masks, 16);
    let lit =
        (0..20).map(|k| live.frame(&on, &walk(k), k as f64 / 60.0, k as u64).0).last().expect("a frame");
    let later = live.kept.clone();
    let mut left = |k: usize| {
        let frame = live.frame(&off, &walk(k), k as f64 / 60.0, k as u64).0;
        ((mean(&frame) - mean(&own(&off, k, 8))) / mean(&lit)).abs()
    };
    let left: Vec<f32> = (20..36).map(&mut left).collect();
    assert!(left[0] < 0.4 && left[15] < 0.03, "{left:?}");
    for (scene, time_s) in [(&hall(0.02, 1.0), 20.0 / 60.0), (&on, 60.0), (&on, 0.0)] {
        let mut live = Live { kept: later.clone(), ..Live::new(&masks, 16) };
        assert_eq!(live.frame(scene, &walk(20), time_s, 8).0, own(scene, 20, 8), "{time_s} s");
    }
}
