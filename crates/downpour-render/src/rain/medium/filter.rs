//! The light of lamps on unresolved drops, smoothed where it is shadowed. Twin of
//! `shaders/wgsl/render/medium_filter.wgsl`, where the method is described.

use downpour_math::packing::packing_pack_half;
use downpour_shaders::render::medium::MEDIUM_LAMP_REACH;
use downpour_shaders::render::scene::SKYLIGHT_RADIUS;
use glam::{Vec3, Vec4};

use super::light::MediumLight;
use crate::light::light_weight;

/// Weight of a neighbor, 0 to 1: 1 if its ray is as long, 0 from a relative difference of 20 %.
fn medium_filter_weight(own: f32, other: f32) -> f32 {
    let (reach, far) = (own.min(MEDIUM_LAMP_REACH), other.min(MEDIUM_LAMP_REACH));
    (1.0 - (reach - far).abs() / (0.2 * reach.max(far))).max(0.0)
}

impl MediumLight<'_> {
    /// The light before a pixel, and two halves: mean distance and optical depth.
    pub(super) fn medium_filter_pixel(&self, clean: &[[f32; 4]], found: &[[f32; 4]], x: u32, y: u32) -> Vec4 {
        let [width, height] = self.camera.size();
        let first = self.grid_rows();
        let rows = |index: u32| {
            let at = first + 2 * index as usize;
            (Vec4::from(found[at]), Vec4::from(found[at + 1]))
        };
        let index = y * width + x;
        let (own, seen) = rows(index);
        let packed = f32::from_bits(packing_pack_half([seen.w.min(6.0e4), own.w.min(6.0e4)]));
        if light_weight(own.truncate()) <= 0.0 {
            return Vec3::ZERO.extend(packed);
        }
        let (mut whole, mut lit) = (Vec3::ZERO, Vec3::ZERO);
        let left = x.max(SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
        let top = y.max(SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
        for row in top..=(y + SKYLIGHT_RADIUS).min(height - 1) {
            for column in left..=(x + SKYLIGHT_RADIUS).min(width - 1) {
                let other = row * width + column;
                let weight = medium_filter_weight(clean[index as usize][3], clean[other as usize][3]);
                if weight > 0.0 {
                    let (found, seen) = rows(other);
                    whole += found.truncate() * weight;
                    lit += seen.truncate() * weight;
                }
            }
        }
        (own.truncate() * lit / whole.max(Vec3::splat(1.0e-30))).extend(packed)
    }
}
