//! Pixels by rays: of the picture, and of the capture of the surroundings. Twin of `shaders/wgsl/render/trace.wgsl`.
//!
//! Samples of a pixel that meet one surface are shaded once; where the two samples at opposite corners do, the others
//! are taken to do so too. [`skylight`](crate::skylight) takes means of what neighbouring pixels have found of the
//! sky's light.

use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm};
use downpour_shaders::render::scene::{SCENE_FAR, SCENE_OCTAHEDRAL, SCENE_PICTURE};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::rain::capture::{capture_direction, capture_sky, capture_suns};
use crate::scene::{ScenePath, SceneView, scene_lattice};

/// What a pixel has found of the sky's light, for the filter. The same layout as `TraceGather` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceGather {
    /// Light of the sky over pi, and the share of the sky that is seen: means of the samples that have met a surface.
    pub sky: [f32; 4],
    /// What it is multiplied with.
    pub body: [f32; 3],
    /// Share of the samples that have met a surface.
    pub met: f32,
    /// What the square of the open share is multiplied with.
    pub gloss: [f32; 3],
    /// The normal, octahedral, 16 bits each.
    pub normal: u32,
}

impl SceneView<'_> {
    /// The direction of a place of the picture or of the capture, in pixels from the top left.
    fn trace_direction(&self, x: f32, y: f32) -> Vec3 {
        if self.frame.projection == SCENE_OCTAHEDRAL {
            return capture_direction(self.frame, x, y);
        }
        self.scene_direction(x, y)
    }

    /// A pixel: mean radiance, and the distance of what stands nearest in it. In the picture the sky's light on surfaces
    /// is left out; it is the second of the two.
    #[must_use]
    pub fn trace_pixel(&self, x: u32, y: u32) -> (Vec4, TraceGather) {
        let is_picture = self.frame.projection == SCENE_PICTURE;
        let (mut sum, mut nearest) = (Vec3::ZERO, SCENE_FAR);
        let (mut body, mut gloss, mut normal) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        let (mut sky, mut met) = (Vec4::ZERO, 0.0);
        let n = self.frame.grid;
        let eye = Vec3::from(self.frame.eye);
        let mut last = ScenePath::NOTHING;
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
            let random = scene_lattice(self.frame.seed, x, y, place);
            let path = self.scene_path(eye, direction, self.frame.pixel_angle, random, &last);
            sum += if is_picture { path.radiance } else { path.scene_radiance() };
            body += path.body;
            gloss += path.gloss;
            sky += path.sky * path.met;
            normal += path.normal * path.met;
            met += path.met;
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
            let is_sky = nearest >= SCENE_FAR && self.frame.projection == SCENE_OCTAHEDRAL;
            let seen = if is_sky { capture_sky(self, x, y) } else { sum * share };
            let radiance = seen + capture_suns(self, x, y);
            return (radiance.extend(nearest), TraceGather::default());
        }
        let gather = TraceGather {
            sky: (sky / met.max(1.0)).to_array(),
            body: (body * share).to_array(),
            met: met * share,
            gloss: (gloss * share).to_array(),
            normal: packing_pack_snorm(packing_octahedral_encode(normal.to_array())),
        };
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
        let shown = self.skylight(&picture, &gather);
        for (pixel, shown) in picture.iter_mut().zip(shown) {
            for k in 0..3 {
                pixel[k] += shown[k];
            }
        }
        picture
    }
}
