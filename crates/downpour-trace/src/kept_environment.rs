//! An environment map that stays from picture to picture: while only its eye moves, a part of its rows is traced anew for each picture,
//! and no row is older than a few pictures. Drops show the map much smaller than it is, so that nobody can tell.
//!
//! A jump of the eye, another light or another size makes all rows anew. Where surfaces get wetter and puddles rise, rows follow in their
//! turn; waves on puddles are smaller than drops can show.

use std::ops::Range;

use bytemuck::Zeroable as _;
use downpour_render::camera::Camera;
use downpour_render::rain::{EnvironmentFrame, RefractionForm};
use glam::Vec3;

use crate::data::{RenderFrame, SceneData};
use crate::scene_change::SceneChange;

/// Bands of rows of a map.
const BANDS: u32 = 8;

/// Bands that are traced for a picture.
const BANDS_PER_PICTURE: usize = 2;

/// Distance between the eyes of a map's rows and the picture's from which all rows are traced, m.
const MAX_EYE_DISTANCE: f32 = 0.5;

/// An environment map with what it shows; `T` holds its texels.
#[derive(Clone, Debug)]
pub struct KeptEnvironment<T> {
    scene: SceneData,
    frame: RenderFrame,
    environment: EnvironmentFrame,
    /// Eye of each band of rows, once it is traced.
    eyes: Vec<Option<Vec3>>,
    /// Bands that show the scene before its water has changed.
    is_old: Vec<bool>,
    /// The band that is the next one to be traced.
    next: usize,
    /// The texels.
    pub held: T,
}

impl<T> KeptEnvironment<T> {
    /// Begins a map of a scene, of which nothing is traced yet.
    #[must_use]
    pub fn new(scene: &SceneData, frame: &RenderFrame, environment: &EnvironmentFrame, held: T) -> Self {
        let count = environment.size.div_ceil(band_rows(environment.size)) as usize;
        Self {
            scene: scene.clone(),
            frame: poseless(frame),
            environment: *environment,
            eyes: vec![None; count],
            is_old: vec![false; count],
            next: 0,
            held,
        }
    }

    /// True if a map that shows the same scene, with as many texels, can go on from this one: then it follows the scene, whose water may have
    /// changed.
    #[must_use]
    pub fn follow(&mut self, scene: &SceneData, frame: &RenderFrame, environment: &EnvironmentFrame) -> bool {
        let before = &self.environment;
        let is_alike = match environment.form {
            // The axes of the camera do not matter.
            RefractionForm::Direction => {
                let EnvironmentFrame { right, up, forward, .. } = *environment;
                EnvironmentFrame { right, up, forward, ..*before } == *environment
            }
            RefractionForm::Rousseau2006 => before == environment,
        };
        let is_near = |eye: &Option<Vec3>| {
            eye.is_none_or(|eye| eye.distance_squared(frame.camera.eye) < MAX_EYE_DISTANCE * MAX_EYE_DISTANCE)
        };
        let is_near = self.eyes.iter().all(is_near);
        let is_seen_alike =
            is_alike && is_near && bytemuck::bytes_of(&self.frame) == bytemuck::bytes_of(&poseless(frame));
        if !is_seen_alike {
            return false;
        }
        let change = SceneChange::between(&self.scene, scene);
        if !change.rest && (change.water || change.wetness) {
            self.scene = scene.clone();
            self.is_old.fill(true);
        }
        !change.rest
    }

    /// The rows that are to be traced for a picture of an eye: all at first, then some of those that another eye has seen, or that show
    /// other water.
    pub fn next(&mut self, eye: Vec3) -> Vec<Range<u32>> {
        let count = self.eyes.len();
        let is_first = self.eyes.iter().all(Option::is_none);
        let most = if is_first { count } else { BANDS_PER_PICTURE };
        let from = self.next;
        let is_wanted = |band: &usize| self.is_old[*band] || self.eyes[*band] != Some(eye);
        let wanted = (from..from + count).map(|band| band % count).filter(is_wanted);
        let mut bands: Vec<usize> = wanted.take(most).collect();
        if let Some(last) = bands.last() {
            self.next = (last + 1) % count;
        }
        bands.sort_unstable();
        let rows = band_rows(self.environment.size);
        let mut traced: Vec<Range<u32>> = Vec::new();
        for band in bands {
            self.eyes[band] = Some(eye);
            self.is_old[band] = false;
            let first = band as u32 * rows;
            let end = (first + rows).min(self.environment.size);
            match traced.last_mut() {
                Some(last) if last.end == first => last.end = end,
                _ => traced.push(first..end),
            }
        }
        traced
    }
}

/// Rows of a band: whole workgroups.
fn band_rows(size: u32) -> u32 {
    size.div_ceil(BANDS).next_multiple_of(8)
}

/// The frame without what an environment map does not depend on, and without its eye.
fn poseless(frame: &RenderFrame) -> RenderFrame {
    RenderFrame {
        camera: Camera::zeroed(),
        grid: 0,
        nearest: 0.0,
        impostors: 0,
        impostor_edge: 0.0,
        ..frame.with_ray_spacing(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_render::camera::Viewpoint;
    use downpour_render::rain::RainOptions;
    use glam::Vec2;

    use crate::builder::SceneBuilder;
    use crate::puddle::{Ground, PuddleLook, PuddleMap, PuddleRows};
    use crate::sky_light::SkyLight;

    fn frame_of(scene: &SceneData, eye: Vec3, forward: Vec3, seed: u64) -> RenderFrame {
        let viewpoint = Viewpoint { eye, forward, up: Vec3::Y, fov_y: 0.8 };
        RenderFrame::new(scene, &viewpoint, [64, 36], 1, 1, seed).expect("a frame")
    }

    /// A map of an even sky, of which nothing is traced yet.
    struct Begun {
        scene: SceneData,
        frame: RenderFrame,
        layout: EnvironmentFrame,
        map: KeptEnvironment<()>,
    }

    fn begun() -> Begun {
        let scene = SceneBuilder::new().build(&SkyLight::uniform([1.0; 3]));
        let frame = frame_of(&scene, Vec3::ZERO, Vec3::NEG_Z, 1);
        let layout = EnvironmentFrame::new(&frame.camera, &RainOptions::default());
        let map = KeptEnvironment::new(&scene, &frame, &layout, ());
        Begun { scene, frame, layout, map }
    }

    #[test]
    fn all_rows_come_round() {
        let Begun { layout, mut map, .. } = begun();
        assert_eq!(map.next(Vec3::ZERO), vec![Range { start: 0, end: layout.size }]);
        assert!(map.next(Vec3::ZERO).is_empty());
        // Four pictures of an eye that has moved make all of it anew, and then nothing is left to do.
        let eye = Vec3::new(0.1, 0.0, 0.0);
        let mut rows: Vec<u32> = (0..4).flat_map(|_| map.next(eye).into_iter().flatten()).collect();
        rows.sort_unstable();
        assert_eq!(rows, (0..layout.size).collect::<Vec<u32>>());
        assert!(map.next(eye).is_empty());
        // While the eye goes on moving, each row has its turn as well.
        let mut last = vec![0; layout.size as usize];
        for step in 1..20u32 {
            let eye = Vec3::new(0.1 + 0.01 * step as f32, 0.0, 0.0);
            for row in map.next(eye).into_iter().flatten() {
                last[row as usize] = step;
            }
            assert!(step < 4 || last.iter().all(|traced| step - traced < 4), "{step}: {last:?}");
        }
    }

    #[test]
    fn a_map_goes_on_while_only_its_eye_moves() {
        let Begun { scene, frame, layout, mut map } = begun();
        map.next(Vec3::ZERO);
        // It turns and walks; a jump is too far.
        for (eye, fits) in [(Vec3::ZERO, true), (Vec3::X * 0.3, true), (Vec3::X, false)] {
            let moved = frame_of(&scene, eye, Vec3::X, 2);
            let turned = EnvironmentFrame::new(&moved.camera, &RainOptions::default());
            assert_eq!(map.follow(&scene, &moved, &turned), fits, "{eye}");
        }
        let smaller =
            EnvironmentFrame::new(&frame.camera, &RainOptions { capture_size: 64, ..RainOptions::default() });
        assert!(!map.follow(&scene, &frame, &smaller));
        let brighter = SceneBuilder::new().build(&SkyLight::uniform([2.0; 3]));
        assert!(!map.follow(&brighter, &frame, &layout));
    }

    /// Water that rises is shown a few pictures later; waves on it are not.
    #[test]
    fn rows_follow_the_water() {
        let Begun { mut scene, frame, layout, .. } = begun();
        let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(2.0), turn: 0.0, reach: 0.2 };
        let filled = |depth: f32| PuddleMap {
            ground,
            size: [2, 2],
            cells: vec![[0.0, 0.0, depth, 1.0]; 4].into(),
            flow: None,
        };
        let set = |scene: &mut SceneData, depth: f32, time_s: f64, look: PuddleLook| {
            scene.set_puddles(&PuddleRows {
                puddles: &[(filled(depth), look)],
                shape: (0, 1, 0.1),
                slopes: &[],
                shift: Vec3::ZERO,
                rings: None,
                wakes: &[],
                time_s,
            });
        };
        let look = PuddleLook::default();
        set(&mut scene, 0.01, 0.0, look);
        let mut map = KeptEnvironment::new(&scene, &frame, &layout, ());
        let mut rows = |scene: &SceneData| {
            assert!(map.follow(scene, &frame, &layout));
            let rows = |_| map.next(Vec3::ZERO).into_iter().flatten().count() as u32;
            (0..6).map(rows).collect::<Vec<u32>>()
        };
        let (all, part) = (layout.size, layout.size / 4);
        assert_eq!(rows(&scene), [all, 0, 0, 0, 0, 0]);
        set(&mut scene, 0.01, 0.37, look);
        assert_eq!(rows(&scene), [0; 6], "water that runs");
        set(&mut scene, 0.02, 0.37, look);
        assert_eq!(rows(&scene), [part, part, part, part, 0, 0], "water that rises");
        set(&mut scene, 0.02, 0.37, PuddleLook { influence: 0.3, ..look });
        assert_eq!(rows(&scene), [part, part, part, part, 0, 0], "another look");
    }
}
