//! The light of the sky on surfaces: the mean of what the pixels round a pixel have found on the same surface. Twin of
//! `shaders/wgsl/render/skylight.wgsl`.

use downpour_math::packing::{packing_octahedral_decode, packing_unpack_snorm};
use downpour_shaders::render::scene::{SKYLIGHT_RADIUS, SKYLIGHT_SLACK};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::scene::SceneView;
use crate::trace::TraceGather;

/// A picture without the sky's light, and what its pixels have found of it.
struct Pixels<'a> {
    view: &'a SceneView<'a>,
    /// For each pixel its normal and its place relative to the eye.
    surfaces: Vec<(Vec3, Vec3)>,
    gather: &'a [TraceGather],
}

impl SceneView<'_> {
    /// What the sky adds to each pixel.
    pub(crate) fn skylight(&self, picture: &[[f32; 4]], gather: &[TraceGather]) -> Vec<[f32; 3]> {
        let (width, height) = (self.frame.width, self.frame.height);
        let surfaces = gather
            .par_iter()
            .enumerate()
            .map(|(i, gather)| {
                let (x, y) = (i as u32 % width, i as u32 / width);
                let normal = packing_octahedral_decode(packing_unpack_snorm(gather.normal));
                (Vec3::from(normal), self.skylight_place(picture, x, y))
            })
            .collect();
        let pixels = &Pixels { view: self, surfaces, gather };
        let shown = |x, y| {
            let own = &gather[(y * width + x) as usize];
            if own.met <= 0.0 {
                return [0.0; 3];
            }
            let sky = pixels.skylight_mean(x, y);
            (Vec3::from(own.body) * sky.truncate() + Vec3::from(own.gloss) * (sky.w * sky.w)).to_array()
        };
        (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| shown(x, y))).collect()
    }

    /// The place that a pixel shows, relative to the eye.
    fn skylight_place(&self, picture: &[[f32; 4]], x: u32, y: u32) -> Vec3 {
        self.scene_direction(x as f32 + 0.5, y as f32 + 0.5) * picture[(y * self.frame.width + x) as usize][3]
    }
}

impl Pixels<'_> {
    /// Light of the sky over pi, and the open share of the sky, over the pixels round a pixel.
    fn skylight_mean(&self, x: u32, y: u32) -> Vec4 {
        let frame = self.view.frame;
        let index = |x: u32, y: u32| (y * frame.width + x) as usize;
        let own = &self.gather[index(x, y)];
        let (normal, place) = self.surfaces[index(x, y)];
        let distance = place.dot(place).sqrt();
        // How far from the plane a neighbour may be: what two pixels are apart, and a little more where it is slanted.
        let slack = distance * (frame.pixel_angle * 2.0 + SKYLIGHT_SLACK);
        let mut sum = Vec4::from(own.sky) * own.met;
        let mut weight = own.met;
        let around =
            |at: u32, size: u32| at.saturating_sub(SKYLIGHT_RADIUS)..=(at + SKYLIGHT_RADIUS).min(size - 1);
        for row in around(y, frame.height) {
            for column in around(x, frame.width) {
                let other = &self.gather[index(column, row)];
                if other.met <= 0.0 || (row == y && column == x) {
                    continue;
                }
                let (its_normal, its_place) = self.surfaces[index(column, row)];
                let agrees = normal.dot(its_normal).max(0.0);
                let fourth = agrees * agrees * agrees * agrees;
                let off = normal.dot(its_place - place).abs();
                let near = (1.0 - off / slack).max(0.0);
                let counts = fourth * fourth * near * other.met;
                sum += Vec4::from(other.sky) * counts;
                weight += counts;
            }
        }
        sum / weight.max(1.0e-6)
    }
}
