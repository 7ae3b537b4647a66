//! Pixels by rays: of the picture, and of the capture of the surroundings. Twin of `shaders/wgsl/render/trace.wgsl`.
//!
//! Samples of a pixel that meet one surface are shaded once; where the two samples at opposite corners do, the others
//! are taken to do so too. [`skylight`](crate::skylight) takes means of what neighbouring pixels have found of the light of
//! sky and surfaces.

use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm};
use downpour_shaders::render::scene::{SCENE_FAR, SCENE_OCTAHEDRAL, SCENE_PICTURE};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::path::{PathSlot, ViewPath, path_lattice, path_most};
use crate::rain::capture::{capture_direction, capture_suns};
use crate::scene::SceneView;

/// Light of which means are taken over neighbouring pixels. The same layout as `TraceSlot` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceSlot {
    /// The light: the mean of the samples that have found some.
    pub light: [f32; 3],
    /// The surface's normal; of a gloss, the direction that a mirror would show. Octahedral, 16 bits each.
    pub normal: u32,
    /// What it is multiplied with.
    pub factor: [f32; 3],
    /// How far from the plane another place may be; 0: there is no light.
    pub slack: f32,
    /// Where it is, metres.
    pub place: [f32; 3],
    /// Roughness of a gloss; 0 for light on a diffuse base.
    pub roughness: f32,
}

/// Light of sky and surfaces that a pixel shows. The same layout as `TraceGather` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceGather {
    /// On the diffuse base of the first opaque surface, over pi.
    pub base: TraceSlot,
    /// In the first gloss or mirror.
    pub mirror: TraceSlot,
}

/// Cosine of the angle between normals up to which samples of a pixel are of one surface.
const TRACE_SAME_NORMAL: f32 = 0.9;

/// The sum of what samples have found, each with its weight.
#[derive(Clone, Copy, Debug)]
struct TraceSum {
    slot: PathSlot,
    weight: f32,
}

impl TraceSum {
    const NONE: Self = Self { slot: PathSlot::NONE, weight: 0.0 };

    /// The sum with a sample. Where it is, is where the first sample is that has some.
    fn trace_add(&self, sample: &PathSlot) -> Self {
        if sample.slack <= 0.0 {
            return *self;
        }
        let first = if self.weight > 0.0 { self.slot } else { *sample };
        // Another surface's light is not told apart, and taken to be the same.
        let off = first.normal.dot(sample.place - first.place).abs();
        let same = off < first.slack && first.normal.dot(sample.normal) > TRACE_SAME_NORMAL;
        let weight = if same { path_most(sample.factor).max(1.0e-6) } else { 0.0 };
        Self {
            slot: PathSlot {
                light: self.slot.light + sample.light * weight,
                factor: self.slot.factor + sample.factor,
                ..first
            },
            weight: self.weight + weight,
        }
    }

    /// The mean, where `share` is one over the number of all samples.
    fn trace_mean(&self, share: f32) -> TraceSlot {
        if self.weight <= 0.0 {
            return TraceSlot::default();
        }
        let slot = &self.slot;
        TraceSlot {
            light: (slot.light / self.weight).to_array(),
            normal: packing_pack_snorm(packing_octahedral_encode(slot.normal.to_array())),
            factor: (slot.factor * share).to_array(),
            slack: slot.slack,
            place: slot.place.to_array(),
            roughness: slot.roughness,
        }
    }
}

impl SceneView<'_> {
    /// The direction of a place of the picture or of the capture, in pixels from the top left.
    fn trace_direction(&self, x: f32, y: f32) -> Vec3 {
        if self.frame.projection == SCENE_OCTAHEDRAL {
            return capture_direction(self.frame, x, y);
        }
        self.scene_direction(x, y)
    }

    /// A pixel: mean radiance, and the distance of what stands nearest in it. In the picture the light of sky and
    /// surfaces on the first surface is left out; it is the second of the two.
    #[must_use]
    pub fn trace_pixel(&self, x: u32, y: u32) -> (Vec4, TraceGather) {
        let is_picture = self.frame.projection == SCENE_PICTURE;
        let (mut sum, mut nearest) = (Vec3::ZERO, SCENE_FAR);
        let (mut base, mut mirror) = (TraceSum::NONE, TraceSum::NONE);
        let n = self.frame.grid;
        let eye = Vec3::from(self.frame.eye);
        let mut last = ViewPath::NOTHING;
        let mut count = 0u16;
        for k in 0..n * n {
            // First the opposite corners.
            let place = match k {
                0 => 0,
                1 => n * n - 1,
                _ => k - 1,
            };
            let dx = ((place % n) as f32 + 0.5) / n as f32;
            let dy = ((place / n) as f32 + 0.5) / n as f32;
            let direction = self.trace_direction(x as f32 + dx, y as f32 + dy);
            let random = path_lattice(self.frame.seed, x, y, place);
            let path = self.path_trace(eye, direction, self.frame.pixel_angle, random, &last);
            sum += if is_picture { path.radiance } else { path.path_radiance() };
            base = base.trace_add(&path.base);
            mirror = mirror.trace_add(&path.mirror);
            nearest = nearest.min(path.distance);
            count += 1;
            let both_sky = path.distance >= SCENE_FAR && last.distance >= SCENE_FAR;
            if k == 1 && (path.again || both_sky) {
                break;
            }
            last = path;
        }
        let share = 1.0 / f32::from(count);
        if !is_picture {
            let radiance = sum * share + capture_suns(self, x, y);
            return (radiance.extend(nearest), TraceGather::default());
        }
        let gather = TraceGather { base: base.trace_mean(share), mirror: mirror.trace_mean(share) };
        ((sum * share).extend(nearest), gather)
    }

    /// The whole picture, rows from the top, in parallel; the same bits for any number of threads.
    #[must_use]
    pub fn picture(&self) -> Vec<[f32; 4]> {
        let width = self.frame.width;
        let (mut picture, gather): (Vec<[f32; 4]>, Vec<TraceGather>) = (0..self.frame.height)
            .into_par_iter()
            .flat_map_iter(|y| {
                (0..width).map(move |x| {
                    let (pixel, gather) = self.trace_pixel(x, y);
                    (pixel.to_array(), gather)
                })
            })
            .unzip();
        let shown = self.skylight(&gather);
        for (pixel, shown) in picture.iter_mut().zip(shown) {
            for k in 0..3 {
                pixel[k] += shown[k];
            }
        }
        picture
    }
}
