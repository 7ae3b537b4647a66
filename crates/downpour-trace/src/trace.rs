//! Pixels by rays: of the picture, and of the environment capture. Twin of `shaders/wgsl/render/trace.wgsl`.
//!
//! Samples of a pixel that meet one surface are shaded once. Light of sky and surfaces is kept apart for the surface of a pixel's first
//! sample and for another one, if it shows more: [`skylight`](crate::skylight) takes means of what neighboring pixels have found of it.

use downpour_math::packing::{
    packing_octahedral_decode, packing_octahedral_encode, packing_pack_half, packing_pack_snorm,
    packing_unpack_half, packing_unpack_snorm,
};
use downpour_shaders::render::scene::{
    SCENE_FAR, SCENE_OCTAHEDRAL, SCENE_PICTURE, SKYLIGHT_FILM, TRACE_SAME_NORMAL,
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use std::sync::Arc;

use crate::capture::{capture_direction, capture_sky, capture_suns};
use crate::data::{RenderFrame, SceneData};
use crate::path::{PathSlot, ViewPath, path_lattice_words, path_max};
use crate::scene::SceneView;
use crate::temporal::PixelLight;

/// Light that is denoised over neighboring pixels, packed. The same layout as `TraceSlot` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceSlot {
    /// Position, m.
    pub position: [f32; 3],
    /// The surface's normal; of a gloss, the direction that a mirror would show. Octahedral, 16 bits each.
    pub normal: u32,
    /// Sum of the light's red, green and blue: the mean of the samples that have found some. Below zero if it is guessed: no ray has
    /// looked for it.
    pub light: f32,
    /// Fractions of it that are red and green, 12 bits each, and the roughness of a gloss, 8 bits; 0: a diffuse base.
    pub look: u32,
    /// Factor of the light, and largest distance from the plane of another position on the same surface, per distance from
    /// the eye (0: there is no light), as halves.
    pub factor: [u32; 2],
}

/// Ambient sample of a pixel: light of sky and surfaces. The same layout as `TraceAmbient` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceAmbient {
    /// On the diffuse base of the first opaque surface, over pi.
    pub base: TraceSlot,
    /// In the first gloss or mirror.
    pub mirror: TraceSlot,
}

/// A slot, packed, as an eye sees it.
fn trace_pack(slot: &PathSlot, eye: Vec3) -> TraceSlot {
    if slot.slack <= 0.0 {
        return TraceSlot::default();
    }
    let sum = slot.light.x + slot.light.y + slot.light.z;
    let scale = 1.0 / sum.max(1.0e-30);
    let part = |x: f32| ((x * scale).clamp(0.0, 1.0) * 4095.0 + 0.5) as u32;
    let rough = if slot.roughness <= 0.0 {
        0
    } else {
        ((slot.roughness.clamp(0.0, 1.0) * 255.0 + 0.5) as u32).max(1)
    };
    let from_eye = slot.position - eye;
    let slack = (slot.slack / from_eye.dot(from_eye).sqrt().max(1.0e-20)).clamp(1.0e-4, 6.0e4);
    let factor = slot.factor.min(Vec3::splat(6.0e4));
    TraceSlot {
        position: slot.position.to_array(),
        normal: packing_pack_snorm(packing_octahedral_encode(slot.normal.to_array())),
        light: if slot.guessed { -sum.max(1.0e-30) } else { sum },
        look: part(slot.light.x) | part(slot.light.y) << 12 | rough << 24,
        factor: [packing_pack_half([factor.x, factor.y]), packing_pack_half([factor.z, slack])],
    }
}

/// A slot as it was before it was packed.
pub(crate) fn trace_unpack(slot: &TraceSlot, eye: Vec3) -> PathSlot {
    let sum = slot.light.abs();
    let red = (slot.look & 4095) as f32 * (sum / 4095.0);
    let green = (slot.look >> 12 & 4095) as f32 * (sum / 4095.0);
    let [low, high] = slot.factor.map(packing_unpack_half);
    let position = Vec3::from(slot.position);
    let from_eye = position - eye;
    PathSlot {
        light: Vec3::new(red, green, (sum - red - green).max(0.0)),
        slack: high[1] * from_eye.dot(from_eye).sqrt(),
        factor: Vec3::new(low[0], low[1], high[0]),
        roughness: (slot.look >> 24) as f32 / 255.0,
        normal: Vec3::from(packing_octahedral_decode(packing_unpack_snorm(slot.normal))),
        guessed: slot.light < 0.0,
        position,
    }
}

/// The sum of what samples have found, each with its weight.
#[derive(Clone, Copy, Debug)]
struct TraceSum {
    slot: PathSlot,
    weight: f32,
}

impl TraceSum {
    const NONE: Self = Self { slot: PathSlot::NONE, weight: 0.0 };

    /// True if the gloss of a sample of a wet scene and that of the sum are of a film and of what is dry.
    fn trace_apart(&self, sample: &PathSlot, frame: &RenderFrame) -> bool {
        let (own, other) = (self.slot.roughness, sample.roughness);
        frame.wetness > 0 && own.min(other) > 0.0 && (own - other).abs() > SKYLIGHT_FILM * own.max(other)
    }

    /// True if a sample shows the surface of the sum.
    fn trace_same(&self, sample: &PathSlot, frame: &RenderFrame) -> bool {
        let slot = &self.slot;
        let off = slot.normal.dot(sample.position - slot.position).abs();
        off < slot.slack
            && (slot.roughness > 0.0) == (sample.roughness > 0.0)
            && slot.normal.dot(sample.normal) > TRACE_SAME_NORMAL
            && !self.trace_apart(sample, frame)
    }

    /// True if a sample shows the surface of the sum, or there is none yet.
    fn trace_takes(&self, sample: &PathSlot, frame: &RenderFrame) -> bool {
        self.weight <= 0.0 || self.trace_same(sample, frame)
    }

    /// The sum with a sample. Where it is, is where the first sample is.
    fn trace_sum(&self, sample: &PathSlot) -> Self {
        let mut next = *self;
        if self.weight <= 0.0 {
            next.slot = PathSlot { light: Vec3::ZERO, factor: Vec3::ZERO, ..*sample };
        }
        let weight = path_max(sample.factor).max(1.0e-6);
        next.slot.light += sample.light * weight;
        next.slot.factor += sample.factor;
        next.weight += weight;
        next
    }

    /// The mean, where `fraction` is one over the number of all samples.
    fn trace_mean(&self, fraction: f32, eye: Vec3) -> TraceSlot {
        if self.weight <= 0.0 {
            return TraceSlot::default();
        }
        let slot = &self.slot;
        let mean = PathSlot { light: slot.light / self.weight, factor: slot.factor * fraction, ..*slot };
        trace_pack(&mean, eye)
    }
}

/// Sums of the light of a pixel's samples: on the surface that the first of them shows, and on another one.
#[derive(Clone, Copy, Debug)]
struct TracePair {
    first: TraceSum,
    other: TraceSum,
    /// Sum of the light on what else there is, as it is seen.
    rest: Vec3,
}

impl TracePair {
    const NONE: Self = Self { first: TraceSum::NONE, other: TraceSum::NONE, rest: Vec3::ZERO };

    /// With one more sample. Light on a third surface is seen as it is, with the noise of its rays.
    fn trace_add(mut self, sample: &PathSlot, frame: &RenderFrame) -> Self {
        if sample.slack <= 0.0 {
            return self;
        }
        if self.first.trace_takes(sample, frame) {
            self.first = self.first.trace_sum(sample);
        } else if self.other.trace_takes(sample, frame) {
            self.other = self.other.trace_sum(sample);
        } else {
            self.rest += sample.light * sample.factor;
        }
        self
    }
}

/// Light that goes from a pixel to the filter: of the surface that its first sample shows, and of another one.
#[derive(Clone, Copy, Debug, Default)]
pub struct TraceFound {
    /// Of the first one.
    pub first: TraceAmbient,
    /// Of the other one.
    pub other: TraceAmbient,
}

/// A pixel with some of its samples.
struct TraceState {
    sum: Vec3,
    nearest: f32,
    base: TracePair,
    mirror: TracePair,
    last: ViewPath,
}

impl TraceState {
    /// A pixel before its first sample.
    fn trace_begin() -> Self {
        Self {
            sum: Vec3::ZERO,
            nearest: SCENE_FAR,
            base: TracePair::NONE,
            mirror: TracePair::NONE,
            last: ViewPath::NOTHING,
        }
    }
}

impl SceneView<'_> {
    /// The direction of a position of the picture or of the capture, in pixels from the top left.
    fn trace_direction(&self, x: f32, y: f32) -> Vec3 {
        if self.frame.projection == SCENE_OCTAHEDRAL {
            return capture_direction(self.frame, x, y);
        }
        self.frame.camera.camera_direction(x, y)
    }

    /// A texel of the capture: the mean of what its samples have found, where the sky is that of all directions in it, and the
    /// suns.
    fn trace_captured(&self, mean: Vec3, nearest: f32, x: u32, y: u32) -> Vec3 {
        let is_sky = nearest >= SCENE_FAR && self.frame.projection == SCENE_OCTAHEDRAL;
        let seen = if is_sky { capture_sky(self, x, y) } else { mean };
        seen + capture_suns(self, x, y)
    }

    /// The pixel with sample `k` of it.
    fn trace_sample(&self, state: &mut TraceState, x: u32, y: u32, k: u32) {
        let n = self.frame.grid;
        let dx = ((k % n) as f32 + 0.5) / n as f32;
        let dy = ((k / n) as f32 + 0.5) / n as f32;
        let direction = self.trace_direction(x as f32 + dx, y as f32 + dy);
        let random = path_lattice_words(self.frame.camera.seed, x, y, k);
        let camera = &self.frame.camera;
        let spared = !self.frame.pixels_that_look().spacing_looks(x, y);
        let path = self.path_trace(camera.eye, direction, camera.pixel_angle, random, &state.last, spared);
        let is_picture = self.frame.projection == SCENE_PICTURE;
        state.sum += if is_picture { path.radiance } else { path.path_radiance() };
        state.base = state.base.trace_add(&path.base, self.frame);
        state.mirror = state.mirror.trace_add(&path.mirror, self.frame);
        state.nearest = state.nearest.min(path.distance);
        state.last = path;
        if k > 0 && !path.again {
            // A pixel of more than one surface is worth the rays of all its samples.
            state.last.plain = false;
        }
        if k + 1 == n * n && !is_picture {
            state.sum = self.trace_captured(state.sum * (1.0 / (n * n) as f32), state.nearest, x, y);
        }
    }

    /// A pixel with all its samples: mean radiance, and the distance of what stands nearest in it. In the picture the light of sky and
    /// surfaces on its surfaces is left out; it is the second of the two.
    fn trace_seen(&self, state: &TraceState) -> (Vec4, TraceFound) {
        if self.frame.projection != SCENE_PICTURE {
            return (state.sum.extend(state.nearest), TraceFound::default());
        }
        let fraction = 1.0 / (self.frame.grid * self.frame.grid) as f32;
        let mean = |sum: &TraceSum| sum.trace_mean(fraction, self.frame.camera.eye);
        let (base, mirror) = (&state.base, &state.mirror);
        let found = TraceFound {
            first: TraceAmbient { base: mean(&base.first), mirror: mean(&mirror.first) },
            other: TraceAmbient { base: mean(&base.other), mirror: mean(&mirror.other) },
        };
        let seen = state.sum + (base.rest + mirror.rest);
        ((seen * fraction).extend(state.nearest), found)
    }

    /// A pixel with all its samples: radiance and distance, and what light of sky and surfaces goes to the filter.
    #[must_use]
    pub fn trace_pixel(&self, x: u32, y: u32) -> (Vec4, TraceFound) {
        let mut state = TraceState::trace_begin();
        for k in 0..self.frame.grid * self.frame.grid {
            self.trace_sample(&mut state, x, y, k);
        }
        self.trace_seen(&state)
    }

    /// The whole picture, rows from the top, in parallel; the same bits for any number of threads.
    #[must_use]
    pub fn picture(&self) -> Vec<[f32; 4]> {
        self.picture_and_light().0
    }

    /// The same, and the light of sky and surfaces in it.
    #[must_use]
    pub fn picture_and_light(&self) -> (Vec<[f32; 4]>, PixelLight) {
        if self.frame.impostors > 0 {
            let impostor_picture = Arc::new(self.mirrored_picture());
            let data = SceneData { impostor_picture, ..self.data.clone() };
            return SceneView { data: &data, frame: self.frame }.pixels_and_light();
        }
        self.pixels_and_light()
    }

    /// The same, with the reflection buffer at hand.
    fn pixels_and_light(&self) -> (Vec<[f32; 4]>, PixelLight) {
        let width = self.frame.camera.width;
        let (mut picture, found): (Vec<[f32; 4]>, Vec<TraceFound>) = (0..self.frame.camera.height)
            .into_par_iter()
            .flat_map_iter(|y| {
                (0..width).map(move |x| {
                    let (pixel, found) = self.trace_pixel(x, y);
                    (pixel.to_array(), found)
                })
            })
            .unzip();
        let (ambient, others): (Vec<_>, Vec<_>) =
            found.into_par_iter().map(|found| (found.first, found.other)).unzip();
        let (means, light) = self.skylight(&ambient, &others);
        picture.par_iter_mut().zip(light).for_each(|(pixel, light)| add_light(pixel, light));
        (picture, PixelLight { ambient, means })
    }
}

/// Adds light to a pixel with its distance.
pub(crate) fn add_light(pixel: &mut [f32; 4], light: Vec3) {
    for (k, light) in light.to_array().into_iter().enumerate() {
        pixel[k] += light;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_is_unpacked_as_it_was() {
        let eye = Vec3::new(3.0, 1.0, -2.0);
        let slot = PathSlot {
            light: Vec3::new(3.0e5, 100.0, 2.0e4),
            slack: 0.02,
            factor: Vec3::new(0.5, 0.02, 0.9),
            roughness: 0.4,
            normal: Vec3::new(0.6, -0.64, 0.48),
            guessed: false,
            position: Vec3::new(7.0, 1.0, 1.0),
        };
        let found = trace_unpack(&trace_pack(&slot, eye), eye);
        // 12 bits of the sum; 11 of a half; 8 of the roughness; 16 of the normal.
        assert!((found.light - slot.light).abs().max_element() < 3.3e5 / 4095.0, "{found:?}");
        assert!(((found.factor - slot.factor) / slot.factor).abs().max_element() < 5.0e-4, "{found:?}");
        assert!((found.slack / slot.slack - 1.0).abs() < 5.0e-4, "{found:?}");
        assert!((found.roughness - slot.roughness).abs() <= 0.5 / 255.0, "{found:?}");
        assert!(
            (found.normal - slot.normal).length() < 1.0e-4 && found.position == slot.position,
            "{found:?}"
        );
        assert!(!found.guessed);
        let guessed = trace_unpack(&trace_pack(&PathSlot { guessed: true, ..slot }, eye), eye);
        assert!(guessed.guessed && guessed.light == found.light);
        let dark = PathSlot { guessed: true, light: Vec3::ZERO, ..slot };
        assert!(trace_unpack(&trace_pack(&dark, eye), eye).guessed);
        // A smooth gloss stays one.
        let smooth = trace_unpack(&trace_pack(&PathSlot { roughness: 1.0e-4, ..slot }, eye), eye);
        assert!(smooth.roughness > 0.0);
        assert_eq!(trace_pack(&PathSlot::NONE, eye), TraceSlot::default());
    }
}
