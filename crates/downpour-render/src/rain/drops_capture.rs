//! The capture between its texels and its levels. Twin of `shaders/wgsl/render/drops_capture.wgsl`.

use downpour_math::ops;
use downpour_math::packing::{packing_octahedral_encode, packing_octahedral_texel};
use downpour_shaders::render::rain::{DROPS_DIRECTION, DROPS_SHIFT};
use glam::{Vec2, Vec3, Vec4};

use super::drops_frame::DropsView;
use super::glint::drop_glint_right;

impl DropsView<'_> {
    /// A texel of a level of the capture. Beyond an edge, the octahedral map continues mirrored about the edge's middle.
    pub(super) fn drops_capture_texel(&self, level: u32, column: i32, row: i32) -> Vec3 {
        let whole = self.frame.capture_size;
        let size = whole >> level;
        let last = size as i32 - 1;
        let [x, y] = if self.frame.form == DROPS_DIRECTION {
            packing_octahedral_texel(size, column, row)
        } else {
            [column.clamp(0, last) as u32, row.clamp(0, last) as u32]
        };
        let first = 4 * (whole * whole - size * size) / 3;
        Vec4::from(self.capture[(first + y * size + x) as usize]).truncate()
    }

    /// A level of the capture at a position in [0, 1], bilinear.
    pub(super) fn drops_capture_level(&self, level: u32, position: Vec2) -> Vec3 {
        let size = (self.frame.capture_size >> level) as f32;
        let (x, y) = (position.x * size - 0.5, position.y * size - 0.5);
        let (left, top) = (x.floor() as i32, y.floor() as i32);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let texel = |column, row| self.drops_capture_texel(level, column, row);
        let upper = texel(left, top) * (1.0 - fx) + texel(left + 1, top) * fx;
        let lower = texel(left, top + 1) * (1.0 - fx) + texel(left + 1, top + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// The capture at a position of [0, 1], for a footprint of some angle.
    pub(super) fn drops_capture_at(&self, position: Vec2, footprint: f32) -> Vec3 {
        let last = self.frame.capture_last as f32;
        let level = ops::log2((footprint / self.frame.capture_texel).max(1.0e-6)).clamp(0.0, last);
        let low = level.floor();
        let part = level - low;
        let near = self.drops_capture_level(low as u32, position) * (1.0 - part);
        if part == 0.0 {
            return near;
        }
        near + self.drops_capture_level(low as u32 + 1, position) * part
    }

    /// The position in the papers' capture of a ray that is turned by a drop: the refracted ray, in the frame of the drop's view
    /// (right, up, toward the viewer), meets the plane of the capture as far from the ray's own position as the tangent of its
    /// deviation.
    pub(super) fn drops_capture_shifted(&self, ray: Vec3, direction: Vec3) -> Vec2 {
        let frame = self.frame;
        let [right, up, forward] =
            [frame.capture_right, frame.capture_up, frame.capture_forward].map(Vec3::from);
        let depth = ray.dot(forward).max(1.0e-3);
        let deep = (-direction.z).max(1.0e-3);
        let shift =
            Vec2::new(direction.x / deep / right.dot(right).sqrt(), direction.y / deep / up.dot(up).sqrt());
        let position = Vec2::new(ray.dot(right) / right.dot(right), ray.dot(up) / up.dot(up)) / depth + shift;
        Vec2::new(0.5 + 0.5 * position.x, 0.5 - 0.5 * position.y).clamp(Vec2::ZERO, Vec2::ONE)
    }

    /// Radiance of the capture in a direction, for a drop that is seen along `towards`, averaged over a width in radians.
    pub(super) fn drops_capture_about(&self, towards: Vec3, direction: Vec3, width: f32) -> Vec3 {
        if self.frame.form == DROPS_SHIFT {
            let right = drop_glint_right(towards);
            let up = right.cross(towards);
            let turned = Vec3::new(direction.dot(right), direction.dot(up), -direction.dot(towards));
            return self.drops_capture_at(self.drops_capture_shifted(towards, turned), width);
        }
        let position = Vec2::from(packing_octahedral_encode(direction.to_array())) * 0.5 + 0.5;
        self.drops_capture_at(position, width)
    }
}
