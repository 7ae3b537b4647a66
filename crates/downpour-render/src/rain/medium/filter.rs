//! The light of lamps on unresolved drops, smoothed where it is shadowed. Twin of
//! `shaders/wgsl/render/medium_filter.wgsl`, where the method is described.

use downpour_math::packing::packing_pack_half;
use downpour_shaders::render::scene::SKYLIGHT_RADIUS;
use glam::{Vec3, Vec4};

use super::light::MediumLight;
use super::spread::medium_spread_alike;
use crate::light::light_weight;
use crate::spacing::window;

/// Light and optical depth before a pixel, or sums of them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rows {
    /// Light of lamps if nothing hid them, below 0 where others look for it; optical depth, or in a sum the weight.
    pub(super) whole: Vec4,
    /// Light of lamps that one ray has seen, and its mean distance.
    seen: Vec4,
}

/// A plate's picture with its distances, and what was found before its pixels ([`MediumLight::found`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter<'a> {
    pub(super) light: &'a MediumLight<'a>,
    pub(super) clean: &'a [[f32; 4]],
    pub(super) found: &'a [[f32; 4]],
}

impl Filter<'_> {
    /// Light and optical depth before a pixel.
    fn medium_filter_rows(&self, index: usize) -> Rows {
        let at = self.light.grid_rows() + 2 * index;
        Rows { whole: self.found[at].into(), seen: self.found[at + 1].into() }
    }

    /// Weight of a neighbor.
    pub(super) fn alike(&self, index: usize, other: usize) -> f32 {
        medium_spread_alike(self.clean[index][3], self.clean[other][3])
    }

    /// Light and optical depth before a pixel, or those of the pixels around it that have looked for them.
    pub(super) fn medium_filter_own(&self, x: u32, y: u32) -> Rows {
        let index = (y * self.light.camera.width + x) as usize;
        let own = self.medium_filter_rows(index);
        if own.whole.x >= 0.0 {
            return own;
        }
        let (mut light, mut weights) = (Vec4::ZERO, 0.0);
        for corner in 0..4 {
            let (other, weight) = self.light.medium_spread_corner(x, y, corner);
            let weight = weight * self.alike(index, other);
            if weight > 0.0 {
                let rows = self.medium_filter_rows(other);
                light += rows.whole.truncate().extend(rows.seen.w) * weight;
                weights += weight;
            }
        }
        light /= f32::max(weights, 1.0e-20);
        Rows { whole: light.truncate().extend(own.whole.w), seen: Vec3::ZERO.extend(light.w) }
    }

    /// Of the pixels of a window around a pixel that look for light, or of all: the part of their light that was seen.
    fn medium_filter_seen(&self, x: u32, y: u32, all: bool) -> Rows {
        let rays = self.light.lighting.ray_spacing();
        let [width, height] = self.light.camera.size();
        let index = (y * width + x) as usize;
        let apart = if all { 1 } else { rays.spacing() };
        let [first_column, first_row] = rays.place();
        // Where fewer look, they are looked for farther away.
        let reach = SKYLIGHT_RADIUS + 2 * (apart - 1);
        let mut sum = Rows::default();
        for row in window(y, apart, reach, first_row, height) {
            for column in window(x, apart, reach, first_column, width) {
                let other = (row * width + column) as usize;
                let weight = self.alike(index, other);
                let found = self.medium_filter_rows(other);
                if weight > 0.0 && found.whole.x >= 0.0 {
                    sum.whole += found.whole.truncate().extend(1.0) * weight;
                    sum.seen += found.seen * weight;
                }
            }
        }
        sum
    }

    /// The part of the light before a pixel that the pixels around it have seen.
    pub(super) fn medium_filter_part(&self, x: u32, y: u32) -> Vec3 {
        let mut sum = self.medium_filter_seen(x, y, false);
        if sum.whole.w <= 0.0 {
            sum = self.medium_filter_seen(x, y, true);
        }
        sum.seen.truncate() / sum.whole.truncate().max(Vec3::splat(1.0e-30))
    }

    /// The light before a pixel, and two halves: mean distance and optical depth.
    pub(super) fn medium_filter_pixel(&self, x: u32, y: u32) -> Vec4 {
        let own = self.medium_filter_own(x, y);
        let light = own.whole.truncate();
        let packed = medium_filter_packed(&own);
        if light_weight(light) <= 0.0 {
            return Vec3::ZERO.extend(packed);
        }
        (light * self.medium_filter_part(x, y)).extend(packed)
    }
}

/// Mean distance and optical depth of what was found before a pixel, as halves.
pub(super) fn medium_filter_packed(own: &Rows) -> f32 {
    f32::from_bits(packing_pack_half([own.seen.w.min(6.0e4), own.whole.w.min(6.0e4)]))
}
