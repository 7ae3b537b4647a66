//! Light of lamps on the unresolved drops before pixels that do not look for it. Twin of `shaders/wgsl/render/medium_spread.wgsl`, where the
//! method is described.

use downpour_shaders::render::medium::{MEDIUM_LAMP_REACH, MEDIUM_SPREAD_CELLS, MEDIUM_SPREAD_MIN};
use glam::Vec3;

use super::light::MediumLight;

/// Weight of a neighbor, 0 to 1: 1 if its ray is as long, 0 from a relative difference of 20 %.
#[must_use]
pub fn medium_spread_alike(own: f32, other: f32) -> f32 {
    let (reach, far) = (own.min(MEDIUM_LAMP_REACH), other.min(MEDIUM_LAMP_REACH));
    (1.0 - (reach - far).abs() / (0.2 * reach.max(far))).max(0.0)
}

/// A column (or row) that looks for light, before or after one of `size`, where those that do lie `spacing` apart with one of them at
/// `place`; and its weight in a mean of both, 0 to `spacing`: 0 beside the edge of the picture, where there are not both.
#[must_use]
pub fn medium_spread_side(at: u32, size: u32, spacing: u32, place: u32, after: bool) -> [u32; 2] {
    let past = (at + spacing - place) % spacing;
    let next = at + spacing - past;
    let has_both = at >= past && (past == 0 || next < size);
    let weight = if after { past } else { spacing - past };
    [if after { next } else { at.saturating_sub(past) }, if has_both { weight } else { 0 }]
}

impl MediumLight<'_> {
    /// The index of one of the four pixels around a pixel that look for light, and its weight, 0 to the square of the spacing.
    pub(super) fn medium_spread_corner(&self, x: u32, y: u32, corner: u32) -> (usize, f32) {
        let rays = self.lighting.ray_spacing();
        let [width, height] = self.camera.size();
        let [column, row] = rays.place();
        let column = medium_spread_side(x, width, rays.spacing(), column, (corner & 1) == 1);
        let row = medium_spread_side(y, height, rays.spacing(), row, corner >= 2);
        let weight = column[1] * row[1];
        (if weight > 0 { (row[0] * width + column[0]) as usize } else { 0 }, weight as f32)
    }

    /// True if no lamp is so near a ray that the pixels around it could not stand for it.
    fn medium_spread_is_even(&self, direction: Vec3) -> bool {
        let cell =
            MEDIUM_SPREAD_CELLS * self.lighting.ray_spacing().spacing() as f32 * self.camera.pixel_angle;
        (0..self.lighting.light_count())
            .map(|k| self.lighting.light(k))
            .filter(|lamp| !lamp.is_parallel())
            .all(|lamp| {
                let offset = lamp.position - Vec3::from(self.medium.eye);
                let nearest = offset.dot(direction);
                let aside = offset - direction * nearest;
                nearest <= 0.0 || aside.dot(aside) > (cell * nearest) * (cell * nearest)
            })
    }

    /// True if the pixels around a pixel that look for light do so for it.
    pub(super) fn medium_light_is_spared(&self, clean: &[[f32; 4]], at: [u32; 2], direction: Vec3) -> bool {
        let rays = self.lighting.ray_spacing();
        let [x, y] = at;
        if rays.spacing_looks(x, y) {
            return false;
        }
        let own = clean[(y * self.camera.width + x) as usize][3];
        let corners = (0..4).map(|k| self.medium_spread_corner(x, y, k));
        let alike: f32 = corners.map(|(at, weight)| weight * medium_spread_alike(own, clean[at][3])).sum();
        let whole = (rays.spacing() * rays.spacing()) as f32;
        alike >= MEDIUM_SPREAD_MIN * whole && self.medium_spread_is_even(direction)
    }
}
