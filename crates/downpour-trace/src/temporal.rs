//! Light of sky and surfaces on surfaces over the frames of a clip: a temporal filter. Twin of `shaders/wgsl/render/temporal.wgsl`.
//!
//! Each frame draws other rays, so that what [`skylight`](crate::skylight) leaves of their noise flickers, in patches as wide as its means.
//! Here the light of a frame becomes the mean of its own and of that of some frames before it. The position of a pixel's surface is
//! projected into the picture of each of those frames; the pixel there counts as far as it shows the same surface, which is told as among
//! the neighbors of a pixel, and as far as its mean differs by no more than the noise of both. What has moved, was hidden or was lit
//! otherwise thus has the light of this frame alone. A mirror that shows a diffuse surface is found where the mirror is, by the position of
//! its own base.
//!
//! A frame is averaged with frames at given times before it, not with all that have been drawn: it is the same whether the frames of a clip
//! are rendered one after the other or it is rendered alone, for which the light of those frames is found first.

use bytemuck::Zeroable as _;
use downpour_render::camera::Camera;
use glam::{DVec3, Vec3, Vec4};
use rayon::prelude::*;

use crate::scene::SceneView;
use crate::skylight::{SkylightSlot, skylight_alike, skylight_factor, skylight_same, skylight_slot};
use crate::trace::TraceAmbient;

/// Greatest number of frames over which light is averaged.
pub const MAX_LIGHT_FRAMES: usize = 8;

/// A frame of a clip, and the frames before it with whose light its own is averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightWindow {
    /// Time of the frame, s.
    pub time_s: f64,
    /// Origin of its positions in the world, m.
    pub origin: DVec3,
    /// Times of the frames before it, s, the latest first.
    pub before_s: [Option<f64>; MAX_LIGHT_FRAMES - 1],
}

impl LightWindow {
    /// True if the frame of a time is one of those before it.
    #[must_use]
    pub fn has(&self, time_s: f64) -> bool {
        self.before_s.iter().flatten().any(|before| before.to_bits() == time_s.to_bits())
    }
}

/// Light of sky and surfaces that the pixels of a frame have found.
#[derive(Clone, Debug)]
pub struct FrameLight<T> {
    /// Time of the frame, s.
    pub time_s: f64,
    /// Origin of its positions in the world, m.
    pub origin: DVec3,
    /// Its camera.
    pub camera: Camera,
    /// The light: [`PixelLight`] on the CPU.
    pub held: T,
}

/// The light of the last frames of a clip.
#[derive(Clone, Debug)]
pub struct LightHistory<T>(Vec<FrameLight<T>>);

impl<T> Default for LightHistory<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> LightHistory<T> {
    /// The frame of a time.
    fn find(&self, time_s: f64) -> Option<&FrameLight<T>> {
        self.0.iter().find(|light| light.time_s.to_bits() == time_s.to_bits())
    }

    /// True if it has the frame of a time.
    #[must_use]
    pub fn has(&self, time_s: f64) -> bool {
        self.find(time_s).is_some()
    }

    /// Frames of a window before its own, the latest first, as far as they are there.
    #[must_use]
    pub fn before(&self, window: &LightWindow) -> Vec<(TemporalFrame, &T)> {
        let known: Vec<_> =
            window.before_s.iter().flatten().filter_map(|&time_s| self.find(time_s)).collect();
        let count = known.len() as u32;
        (0..)
            .zip(known)
            .map(|(turn, light)| (TemporalFrame::new(window, light, turn, count), &light.held))
            .collect()
    }

    /// Takes the light of the frame of a window, and gives back what no later frame will ask for: what is not in the window.
    pub fn add(&mut self, window: &LightWindow, camera: Camera, held: T) -> Vec<FrameLight<T>> {
        let (kept, out) = self.0.drain(..).partition(|light| window.has(light.time_s));
        self.0 = kept;
        self.0.push(FrameLight { time_s: window.time_s, origin: window.origin, camera, held });
        out
    }
}

/// Light of sky and surfaces that each pixel of a picture has found.
#[derive(Clone, Debug, Default)]
pub struct PixelLight {
    /// Light that its own rays have found, with its positions.
    pub ambient: Vec<TraceAmbient>,
    /// Means of it over neighbors, and the variance of their luminance: on the diffuse base, and in the first gloss or mirror.
    pub means: Vec<[Vec4; 2]>,
}

/// A frame before another one. The same layout as `TemporalFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TemporalFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Number of frames that have been added before.
    pub turn: u32,
    /// 1: no frame comes after it.
    pub is_last: u32,
    /// Greatest number of frames of a running mean ([`running_light`](crate::running_light)) that count beside a frame; 0: there is none.
    pub max_weight: f32,
    /// Its camera.
    pub camera: Camera,
    /// From positions of the other frame to the same positions in its coordinates, m.
    pub shift: Vec3,
    /// The same of what a gloss mirrors.
    pub max_gloss: f32,
}

impl TemporalFrame {
    /// Frame `turn` of `count` frames before that of a window.
    #[must_use]
    pub fn new<T>(window: &LightWindow, light: &FrameLight<T>, turn: u32, count: u32) -> Self {
        let shift = (window.origin - light.origin).as_vec3();
        let is_last = u32::from(turn + 1 == count);
        Self { camera: light.camera, shift, turn, is_last, ..Self::zeroed() }
    }
}

/// Pixel of a camera's picture that shows a position; (-1, -1): none does.
#[must_use]
pub fn temporal_pixel(camera: &Camera, position: Vec3) -> [i32; 2] {
    let from_eye = position - camera.eye;
    if from_eye.dot(camera.forward) <= 0.0 {
        return [-1; 2];
    }
    let at = camera.camera_project(from_eye).floor();
    let is_inside = at.x >= 0.0 && at.x < camera.width as f32 && at.y >= 0.0 && at.y < camera.height as f32;
    if is_inside { [at.x as i32, at.y as i32] } else { [-1; 2] }
}

/// Position at which another frame shows the surface of a slot; `None`: there is no light on it.
pub(crate) fn temporal_position(own: &TraceAmbient, found: &SkylightSlot, eye: Vec3) -> Option<Vec3> {
    if found.slack <= 0.0 {
        return None;
    }
    if found.roughness > 0.0 {
        return Some(found.position);
    }
    // A mirror's position is that of what it shows: the mirror is where its own base is.
    let base = skylight_slot(own, 0, eye);
    (base.slack > 0.0).then_some(base.position)
}

/// A slot of a pixel of the frame before, with the position that it has in this one.
pub(crate) fn temporal_slot(pixel: &TraceAmbient, slot: usize, eye: Vec3, shift: Vec3) -> SkylightSlot {
    let mut found = skylight_slot(pixel, slot, eye);
    found.position -= shift;
    found
}

impl SceneView<'_> {
    /// The mean of a slot in the frame before, with its weight beside the frame's own: none where that frame does not show the same surface,
    /// or shows it in another light.
    fn temporal_before(
        &self,
        own: &PixelLight,
        before: &PixelLight,
        at: &TemporalFrame,
        pixel: usize,
        slot: usize,
    ) -> Vec4 {
        let eye = self.frame.camera.eye;
        let found: SkylightSlot = skylight_slot(&own.ambient[pixel], slot, eye);
        let Some(position) = temporal_position(&own.ambient[pixel], &found, eye) else { return Vec4::ZERO };
        let [column, row] = temporal_pixel(&at.camera, position + at.shift);
        if column < 0 {
            return Vec4::ZERO;
        }
        let there = row as usize * at.camera.width as usize + column as usize;
        let other = temporal_slot(&before.ambient[there], slot, eye, at.shift);
        let mean = before.means[there][slot];
        let same = skylight_same(&found, &other, self.frame.wetness > 0);
        let weight = same * skylight_alike(own.means[pixel][slot], mean);
        (mean.truncate() * weight).extend(weight)
    }

    /// Change of each pixel of a picture by the light of the frames before it.
    #[must_use]
    pub fn temporal(&self, own: &PixelLight, before: &[(TemporalFrame, &PixelLight)]) -> Vec<Vec3> {
        let eye = self.frame.camera.eye;
        let change = |pixel: usize| {
            let slots = [0, 1].map(|slot| {
                let mean = own.means[pixel][slot].truncate();
                let mut sum = mean.extend(1.0);
                for (at, light) in before {
                    sum += self.temporal_before(own, light, at, pixel, slot);
                }
                skylight_factor(&own.ambient[pixel], slot, eye) * (sum.truncate() / sum.w - mean)
            });
            slots[0] + slots[1]
        };
        (0..own.ambient.len()).into_par_iter().map(change).collect()
    }
}
