//! Pixels by rays: of the picture, and of the capture of the surroundings. Twin of `shaders/wgsl/render/trace.wgsl`.
//!
//! Samples of a pixel that meet one surface are shaded once; where the two samples at opposite corners do, the others
//! are taken to do so too. [`skylight`](crate::skylight) takes means of what neighbouring pixels have found of the light of
//! sky and surfaces.

use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm};
use downpour_shaders::render::scene::{SCENE_FAR, SCENE_OCTAHEDRAL, SCENE_PICTURE};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::rain::capture::{capture_direction, capture_suns};
use crate::path::{ViewPath, path_lattice, path_most};
use crate::scene::SceneView;

/// Light that a pixel's surface has of sky and other surfaces, for the filter. The same layout as `TraceGather` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TraceGather {
    /// On the diffuse base, over pi: the mean of the samples that have met a surface.
    pub sky: [f32; 3],
    /// Roughness of the gloss.
    pub roughness: f32,
    /// What it is multiplied with.
    pub body: [f32; 3],
    /// Share of the samples that have met a surface.
    pub met: f32,
    /// In the gloss.
    pub mirror: [f32; 3],
    /// The direction that a mirror would show, octahedral, 16 bits each.
    pub mirrored: u32,
    /// What it is multiplied with.
    pub gloss: [f32; 3],
    /// The normal, octahedral, 16 bits each.
    pub normal: u32,
    /// The place.
    pub place: [f32; 3],
    /// How far from its plane another place may be.
    pub slack: f32,
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
        let (mut body, mut gloss, mut sky, mut mirror) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        let (mut normal, mut mirrored, mut roughness) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        let (mut met, mut glossy) = (0.0, 0.0);
        let (mut place_shown, mut slack) = (Vec3::ZERO, 0.0);
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
            body += path.body;
            gloss += path.gloss;
            sky += path.sky * path.met;
            let weight = path_most(path.gloss);
            normal += path.normal * path.met.max(weight);
            if slack == 0.0 && path.met.max(weight) > 0.0 {
                (place_shown, slack) = (path.shown, path.slack);
            }
            met += path.met;
            mirror += path.mirror * weight;
            mirrored += path.mirrored * weight;
            roughness += path.roughness * weight;
            glossy += weight;
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
        let per_met = 1.0 / met.max(1.0);
        let per_gloss = 1.0 / glossy.max(1.0e-6);
        let packed = |direction: Vec3| packing_pack_snorm(packing_octahedral_encode(direction.to_array()));
        let gather = TraceGather {
            sky: (sky * per_met).to_array(),
            roughness: roughness * per_gloss,
            body: (body * share).to_array(),
            met: met * share,
            mirror: (mirror * per_gloss).to_array(),
            mirrored: packed(mirrored),
            gloss: (gloss * share).to_array(),
            normal: packed(normal),
            place: place_shown.to_array(),
            slack,
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
        let shown = self.skylight(&gather);
        for (pixel, shown) in picture.iter_mut().zip(shown) {
            for k in 0..3 {
                pixel[k] += shown[k];
            }
        }
        picture
    }
}
