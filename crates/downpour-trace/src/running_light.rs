//! Light of sky and surfaces on surfaces in live frames: a running mean over the frames. Twin of `shaders/wgsl/render/running_light.wgsl`.
//!
//! Rays of few pixels of a single frame leave their noise as blotches that change from frame to frame. Where a frame may depend on those
//! before it, its light becomes the mean of its own and of all that was found before on the same surface, up to a number of frames. Other
//! than [`temporal`](crate::temporal), which a frame of a clip has alike whether it is rendered alone or not, this keeps one frame: the
//! one before, with the mean that it had.
//!
//! The position of a pixel's surface is projected into that frame. Of the four pixels around that place each counts as far as it shows
//! the same surface ([`skylight`](crate::skylight)), so that the mean does not wander over the surface as the eye moves; and over no more
//! frames than what a gloss mirrors stays within its lobe. What was hidden or has moved begins anew. A second mean, of the last few
//! frames alone, tells whether light has changed: where both differ by more than their noise, it takes the place of the first. One frame
//! tells only much of a change: rays that seldom find light may find none in it.
//!
//! The rays of a frame that goes on from others are drawn anew even if its time is the same.

use std::sync::Arc;

use bytemuck::Zeroable as _;
use downpour_bvh::BvhTriangle;
use downpour_math::rng::rng_draw;
use downpour_render::camera::Camera;
use downpour_shaders::render::scene::{RUNNING_DOUBT, RUNNING_LOBE, RUNNING_RECENT, SKYLIGHT_LOBE};
use glam::{DVec3, UVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use crate::data::{RenderFrame, SceneData};
use crate::scene::SceneView;
use crate::skylight::{SkylightSlot, skylight_alike, skylight_factor, skylight_same, skylight_slot};
use crate::still_part::StillPart;
use crate::temporal::{PixelLight, TemporalFrame, temporal_position, temporal_slot};
use crate::trace::TraceAmbient;

/// Dimension of the random numbers of the frames of a running mean.
const SEED_DIMENSION: u32 = 4122;

/// Time between two frames up to which the second goes on from the first, s.
const MAX_GAP_S: f64 = 2.0;

/// Number of frames before a frame over which what a gloss mirrors is averaged where lamps may move: their images are bright, and move with
/// them.
const MAX_MOVING_GLOSS: f32 = 5.0;

/// A frame whose light goes on from that of the frames before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunningFrame {
    /// Time of the frame, s.
    pub time_s: f64,
    /// Origin of its positions in the world, m.
    pub origin: DVec3,
    /// Number of frames in the mean, with the frame itself; 1: its own light.
    pub frames: u32,
}

/// Running means of a slot of a pixel. The same layout as `RunningMean` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct RunningMean {
    /// Over all frames that count.
    pub color: Vec3,
    /// Number of these; 0: there are none.
    pub weight: f32,
    /// Over the last few.
    pub recent: Vec3,
    /// Variance of the luminance of one frame, over the last few.
    pub variance: f32,
}

/// Running means of the slots of all pixels, with what these have found in the last frame.
#[derive(Clone, Debug, Default)]
pub struct PixelRunning {
    /// Light that the rays of the last frame have found, with its positions.
    pub ambient: Vec<TraceAmbient>,
    /// The running means.
    pub means: Vec<[RunningMean; 2]>,
}

/// What frames of one scene share.
#[derive(Clone, Debug)]
struct Lit {
    /// Of a scene that moves, what stands still.
    still: Option<Arc<StillPart>>,
    triangles: Arc<Vec<BvhTriangle>>,
    texels: Arc<Vec<u32>>,
    sky: Arc<Vec<[f32; 4]>>,
}

impl Lit {
    fn of(scene: &SceneData) -> Self {
        let SceneData { still, triangles, texels, sky, .. } = scene;
        Self {
            still: still.clone(),
            triangles: Arc::clone(triangles),
            texels: Arc::clone(texels),
            sky: Arc::clone(sky),
        }
    }

    /// True if a scene is of the same model under the same sky; its lamps may differ.
    fn is_that_of(&self, scene: &SceneData) -> bool {
        let is_same = match (&self.still, &scene.still) {
            (Some(before), Some(now)) => Arc::ptr_eq(&before.part, &now.part),
            (None, None) => {
                Arc::ptr_eq(&self.triangles, &scene.triangles) && Arc::ptr_eq(&self.texels, &scene.texels)
            }
            _ => false,
        };
        is_same && (Arc::ptr_eq(&self.sky, &scene.sky) || self.sky == scene.sky)
    }
}

/// The running mean that the last frame has left; `T` holds it: [`PixelRunning`] on the CPU.
#[derive(Clone, Debug)]
pub struct RunningLight<T> {
    time_s: f64,
    origin: DVec3,
    camera: Camera,
    /// The scene.
    scene: Lit,
    /// Number of frames since it began.
    count: u32,
    /// The means.
    pub held: T,
}

impl<T> RunningLight<T> {
    /// The mean after a frame: `before` is the one that it went on from.
    #[must_use]
    pub fn after<B>(
        before: Option<&RunningLight<B>>,
        of: &RunningFrame,
        scene: &SceneData,
        frame: &RenderFrame,
        held: T,
    ) -> Self {
        Self {
            time_s: of.time_s,
            origin: of.origin,
            camera: frame.camera,
            scene: Lit::of(scene),
            count: before.map_or(1, |before| before.count.saturating_add(1)),
            held,
        }
    }

    /// Forgets a mean from which a picture does not go on. `next` is the frame to be traced and its number among those that refine its plate
    /// ([`KeptPlate::next`](crate::kept::KeptPlate::next)), which have a mean of their own: the first of them is taken into this one, for
    /// which it gets other rays. Returns what it is taken in with.
    pub fn follow(
        kept: &mut Option<Self>,
        of: Option<RunningFrame>,
        scene: &SceneData,
        next: Option<&mut (RenderFrame, u32)>,
    ) -> Option<RunningFrame> {
        let of = of?;
        *kept = kept.take().filter(|before| before.goes_on(&of, scene));
        match (next, kept) {
            (Some((frame, 1)), before) => {
                if let Some(before) = before {
                    let seed = rng_draw([frame.camera.seed, 0], before.count, 0, SEED_DIMENSION)[0];
                    *frame = frame.with_seed(seed);
                }
                return Some(of);
            }
            // Nothing differs: it holds for those that come later.
            (_, Some(before)) => before.time_s = of.time_s,
            (_, None) => {}
        }
        None
    }

    /// True if a frame of a scene may go on from it: of the same model under the same sky, not earlier and not much later.
    fn goes_on(&self, of: &RunningFrame, scene: &SceneData) -> bool {
        self.scene.is_that_of(scene) && (0.0..=MAX_GAP_S).contains(&(of.time_s - self.time_s))
    }

    /// The frame that left it, for one that goes on from it.
    #[must_use]
    pub fn before(&self, of: &RunningFrame) -> TemporalFrame {
        let max_weight = of.frames.saturating_sub(1) as f32;
        TemporalFrame {
            camera: self.camera,
            shift: (of.origin - self.origin).as_vec3(),
            max_weight,
            max_gloss: if self.scene.still.is_some() { max_weight.min(MAX_MOVING_GLOSS) } else { max_weight },
            ..TemporalFrame::zeroed()
        }
    }
}

/// What stands in place of the frame before the first one.
#[must_use]
pub fn no_frame_before(frame: &RenderFrame) -> TemporalFrame {
    TemporalFrame { camera: frame.camera, ..TemporalFrame::zeroed() }
}

/// Number of frames over which what a gloss mirrors stays within its lobe, if the direction turns by a chord per frame.
#[must_use]
pub fn running_light_steady(chord: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    RUNNING_LOBE * alpha * (2.0 * SKYLIGHT_LOBE).sqrt() / chord.max(1.0e-6)
}

/// Part of a mean of the light before that counts beside a newer one: all of it up to a difference that noise makes. Both have the variance
/// of their luminance.
#[must_use]
pub fn running_light_kept(newer: Vec4, before: Vec4) -> f32 {
    (4.0 * skylight_alike(newer, before)).min(1.0)
}

/// Running means with one more frame, whose mean has a variance.
#[must_use]
pub fn running_light_next(before: &RunningMean, mean: Vec4) -> RunningMean {
    let own = mean.truncate();
    let last = before.weight.min(RUNNING_RECENT);
    let variance = (mean.w + before.variance * last) / (1.0 + last);
    // Light that has changed by much is not waited for.
    let of_before = before.color.extend(variance / before.weight.max(1.0));
    let weight = before.weight * running_light_kept(own.extend(RUNNING_DOUBT * variance), of_before);
    let few = weight.min(RUNNING_RECENT);
    let recent = (own + before.recent * few) / (1.0 + few);
    let color = (own + before.color * weight) / (1.0 + weight);
    // Where the last few frames say that it has changed, only they count.
    let kept =
        running_light_kept(recent.extend(variance / (1.0 + few)), color.extend(variance / (1.0 + weight)));
    RunningMean { color: recent + (color - recent) * kept, weight: 1.0 + weight * kept, recent, variance }
}

fn unit(v: Vec3) -> Vec3 {
    v / v.dot(v).sqrt().max(1.0e-20)
}

impl SceneView<'_> {
    /// The running means of the frame before, where a slot's surface was in it.
    fn running_light_before(
        &self,
        own: &TraceAmbient,
        before: &PixelRunning,
        at: &TemporalFrame,
        slot: usize,
        found: &SkylightSlot,
    ) -> RunningMean {
        let eye = self.frame.camera.eye;
        let Some(sought) = temporal_position(own, found, eye) else { return RunningMean::default() };
        let from_eye = sought + at.shift - at.camera.eye;
        if at.max_weight <= 0.0 || from_eye.dot(at.camera.forward) <= 0.0 {
            return RunningMean::default();
        }
        let place = at.camera.camera_project(from_eye) - Vec2::splat(0.5);
        let size = UVec2::from(at.camera.size()).as_vec2();
        let corner = place.floor();
        let part = place - corner;
        let (mut sum, mut counted) = (RunningMean::default(), 0.0);
        for k in 0..4 {
            let step = UVec2::new(k & 1, k >> 1).as_vec2();
            let place = corner + step;
            if !(place.cmpge(Vec2::ZERO).all() && place.cmplt(size).all()) {
                continue;
            }
            let there = place.y as usize * at.camera.width as usize + place.x as usize;
            let other = temporal_slot(&before.ambient[there], slot, eye, at.shift);
            let same = skylight_same(found, &other, self.frame.wetness > 0);
            let near = Vec2::ONE - (part - step).abs();
            let counts = near.x * near.y * same;
            let its = &before.means[there][slot];
            sum.color += its.color * counts;
            sum.recent += its.recent * counts;
            sum.variance += its.variance * counts;
            sum.weight += its.weight * same * counts;
            counted += counts;
        }
        if counted <= 0.0 {
            return RunningMean::default();
        }
        let mut max = at.max_weight;
        if found.roughness > 0.0 {
            let turned = unit(found.position - eye) - unit(from_eye);
            max = at.max_gloss.min(running_light_steady(turned.dot(turned).sqrt(), found.roughness));
        }
        RunningMean {
            color: sum.color / counted,
            weight: (sum.weight / counted).min(max),
            recent: sum.recent / counted,
            variance: sum.variance / counted,
        }
    }

    /// Running means with this frame, and the change of each pixel of its picture by them.
    #[must_use]
    pub fn running_light(
        &self,
        own: &PixelLight,
        before: &PixelRunning,
        at: &TemporalFrame,
    ) -> (Vec<[RunningMean; 2]>, Vec<Vec3>) {
        let eye = self.frame.camera.eye;
        let of_pixel = |pixel: usize| {
            let found = &own.ambient[pixel];
            let means = [0, 1].map(|slot| {
                let its = skylight_slot(found, slot, eye);
                if its.slack <= 0.0 {
                    return RunningMean::default();
                }
                let before = self.running_light_before(found, before, at, slot, &its);
                running_light_next(&before, own.means[pixel][slot])
            });
            let [of_base, of_mirror] = [0, 1].map(|slot| {
                skylight_factor(found, slot, eye) * (means[slot].color - own.means[pixel][slot].truncate())
            });
            (means, of_base + of_mirror)
        };
        (0..own.ambient.len()).into_par_iter().map(of_pixel).unzip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over so many frames the agreement of mirrored directions falls by a quarter.
    #[test]
    fn a_gloss_is_averaged_within_its_lobe() {
        use crate::skylight::skylight_lobe;
        for (degrees, roughness) in [(0.3_f32, 0.3), (0.1, 0.15), (2.0, 0.7)] {
            let angle = degrees.to_radians();
            let frames = running_light_steady(angle, roughness);
            let cosine = downpour_math::ops::cos(angle * frames);
            let left = skylight_lobe(cosine, roughness);
            assert!((left - 0.75).abs() < 0.02, "{degrees} {roughness}: {frames} frames, {left}");
        }
    }
}
