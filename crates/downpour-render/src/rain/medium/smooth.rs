//! The part of the light of lamps that is seen, in fog. Twin of `shaders/wgsl/render/medium_smooth.wgsl`, where the method is described.

use downpour_shaders::render::scene::SKYLIGHT_RADIUS;
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::filter::{Filter, medium_filter_packed};
use crate::light::light_weight;
use crate::spacing::window;

/// Light and optical depth before the pixels of a picture, and the part of their light that the window of each has seen, with 1 if there is light.
#[derive(Clone, Debug)]
pub(super) struct Smooth<'a> {
    filter: &'a Filter<'a>,
    parts: Vec<Vec4>,
}

impl<'a> Smooth<'a> {
    /// The parts of all pixels. The same bits for any number of threads.
    pub(super) fn new(filter: &'a Filter<'a>) -> Self {
        let [width, height] = filter.light.camera.size();
        let part = |x, y| {
            let own = filter.medium_filter_own(x, y);
            if light_weight(own.whole.truncate()) > 0.0 {
                filter.medium_filter_part(x, y).extend(1.0)
            } else {
                Vec4::ZERO
            }
        };
        let parts = (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| part(x, y)));
        Self { filter, parts: parts.collect() }
    }

    /// The mean of the parts of the pixels around a pixel whose rays are as long.
    fn medium_smooth_part(&self, x: u32, y: u32) -> Vec3 {
        let [width, height] = self.filter.light.camera.size();
        let index = (y * width + x) as usize;
        let mut sum = Vec4::ZERO;
        for row in window(y, 1, SKYLIGHT_RADIUS, 0, height) {
            for column in window(x, 1, SKYLIGHT_RADIUS, 0, width) {
                let other = (row * width + column) as usize;
                let part = self.parts[other];
                sum += part.truncate().extend(1.0) * (self.filter.alike(index, other) * part.w);
            }
        }
        sum.truncate() / sum.w.max(1.0e-20)
    }

    /// The light before a pixel, and two halves: mean distance and optical depth.
    pub(super) fn medium_smooth_pixel(&self, x: u32, y: u32) -> Vec4 {
        let own = self.filter.medium_filter_own(x, y);
        let light = own.whole.truncate();
        let packed = medium_filter_packed(&own);
        if light_weight(light) <= 0.0 {
            return Vec3::ZERO.extend(packed);
        }
        (light * self.medium_smooth_part(x, y)).extend(packed)
    }
}
