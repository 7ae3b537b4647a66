//! The capture between its texels and its levels. Twin of `shaders/wgsl/render/drops_capture.wgsl`.

use downpour_math::ops;
use downpour_shaders::render::rain::DROPS_DIRECTION;
use glam::{Vec2, Vec3, Vec4};

use super::drops_frame::DropsView;

impl DropsView<'_> {
    /// A texel of a level of the capture. Beyond an edge the octahedral map goes on at the edge's mirror image.
    pub(super) fn drops_capture_texel(&self, level: u32, column: i32, row: i32) -> Vec3 {
        let whole = self.frame.capture_size;
        let size = whole >> level;
        let edge = size as i32;
        let (mut x, mut y) = (column, row);
        if self.frame.form == DROPS_DIRECTION {
            if x < 0 || x >= edge {
                x = x.clamp(0, edge - 1);
                y = edge - 1 - y;
            }
            if y < 0 || y >= edge {
                y = y.clamp(0, edge - 1);
                x = edge - 1 - x;
            }
        }
        let (x, y) = (x.clamp(0, edge - 1) as u32, y.clamp(0, edge - 1) as u32);
        let first = 4 * (whole * whole - size * size) / 3;
        Vec4::from(self.capture[(first + y * size + x) as usize]).truncate()
    }

    /// A level of the capture at a place of [0, 1], bilinear.
    pub(super) fn drops_capture_level(&self, level: u32, place: Vec2) -> Vec3 {
        let size = (self.frame.capture_size >> level) as f32;
        let (x, y) = (place.x * size - 0.5, place.y * size - 0.5);
        let (left, top) = (x.floor() as i32, y.floor() as i32);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |column, row| self.drops_capture_texel(level, column, row);
        let upper = texel(left, top) * (1.0 - fx) + texel(left + 1, top) * fx;
        let lower = texel(left, top + 1) * (1.0 - fx) + texel(left + 1, top + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// The capture at a place of [0, 1], for a footprint of some angle.
    pub(super) fn drops_capture_at(&self, place: Vec2, footprint: f32) -> Vec3 {
        let last = self.frame.capture_last as f32;
        let level = ops::log2((footprint / self.frame.capture_texel).max(1.0e-6)).clamp(0.0, last);
        let low = level.floor();
        let part = level - low;
        let near = self.drops_capture_level(low as u32, place) * (1.0 - part);
        if part == 0.0 {
            return near;
        }
        near + self.drops_capture_level(low as u32 + 1, place) * part
    }
}
