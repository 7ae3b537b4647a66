//! Light of sky and surfaces on surfaces: the mean of what the pixels round a pixel have found on the same surface. Twin of
//! `shaders/wgsl/render/skylight.wgsl`.
//!
//! A neighbour counts as far as its normal agrees and as it is on the plane through the pixel's place; in the gloss, as far
//! as it mirrors the same direction, within the lobe.

use downpour_math::packing::{packing_octahedral_decode, packing_unpack_snorm};
use downpour_shaders::render::scene::{SKYLIGHT_LOBE, SKYLIGHT_RADIUS};
use glam::Vec3;
use rayon::prelude::*;

use crate::path::path_most;
use crate::scene::SceneView;
use crate::trace::TraceGather;

/// A picture without this light, and what its pixels have found of it.
struct Pixels<'a> {
    view: &'a SceneView<'a>,
    /// For each pixel its normal, and what a mirror would show.
    surfaces: Vec<(Vec3, Vec3)>,
    gather: &'a [TraceGather],
}

impl SceneView<'_> {
    /// What the light of sky and surfaces adds to each pixel.
    pub(crate) fn skylight(&self, gather: &[TraceGather]) -> Vec<[f32; 3]> {
        let (width, height) = (self.frame.width, self.frame.height);
        let unpacked = |word: u32| Vec3::from(packing_octahedral_decode(packing_unpack_snorm(word)));
        let surfaces =
            gather.par_iter().map(|gather| (unpacked(gather.normal), unpacked(gather.mirrored))).collect();
        let pixels = &Pixels { view: self, surfaces, gather };
        let shown = |x, y| {
            let own = &gather[(y * width + x) as usize];
            if own.met <= 0.0 && path_most(own.gloss.into()) <= 0.0 {
                return [0.0; 3];
            }
            pixels.skylight_mean(x, y).to_array()
        };
        (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| shown(x, y))).collect()
    }
}

/// How far two mirrored directions agree within the lobe of a roughness.
#[must_use]
pub fn skylight_lobe(cosine: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    (1.0 - (1.0 - cosine) / (SKYLIGHT_LOBE * alpha * alpha).max(1.0e-7)).max(0.0)
}

impl Pixels<'_> {
    /// What the light of sky and surfaces makes of a pixel, from the pixels round it.
    fn skylight_mean(&self, x: u32, y: u32) -> Vec3 {
        let frame = self.view.frame;
        let index = |x: u32, y: u32| (y * frame.width + x) as usize;
        let own = &self.gather[index(x, y)];
        let (normal, mirrored) = self.surfaces[index(x, y)];
        let place = Vec3::from(own.place);
        let glossy = path_most(own.gloss.into());
        let (mut sky, mut met) = (Vec3::from(own.sky) * own.met, own.met);
        let (mut mirror, mut weight) = (Vec3::from(own.mirror) * glossy, glossy);
        let around =
            |at: u32, size: u32| at.saturating_sub(SKYLIGHT_RADIUS)..=(at + SKYLIGHT_RADIUS).min(size - 1);
        for row in around(y, frame.height) {
            for column in around(x, frame.width) {
                let other = &self.gather[index(column, row)];
                let its_gloss = path_most(other.gloss.into());
                if (other.met <= 0.0 && its_gloss <= 0.0) || (row == y && column == x) {
                    continue;
                }
                let (its_normal, its_mirrored) = self.surfaces[index(column, row)];
                let agrees = normal.dot(its_normal).max(0.0);
                let fourth = agrees * agrees * agrees * agrees;
                let off = normal.dot(Vec3::from(other.place) - place).abs();
                let near = (1.0 - off / own.slack).max(0.0);
                let counts = fourth * fourth * near * other.met;
                sky += Vec3::from(other.sky) * counts;
                met += counts;
                if glossy > 0.0 && its_gloss > 0.0 {
                    let same = skylight_lobe(mirrored.dot(its_mirrored), own.roughness) * near * its_gloss;
                    mirror += Vec3::from(other.mirror) * same;
                    weight += same;
                }
            }
        }
        Vec3::from(own.body) * (sky / met.max(1.0e-6)) + Vec3::from(own.gloss) * (mirror / weight.max(1.0e-6))
    }
}
