//! Radiance in a direction: of the picture behind the pane if the direction is in it, else of the environment map.
//! Twin of a part of `shaders/wgsl/render/glass_picture.wgsl`.

use downpour_math::ops;
use downpour_math::packing::{packing_octahedral_encode, packing_octahedral_texel};
use downpour_shaders::render::glass::GLASS_PICTURE_FAR;
use glam::{IVec2, UVec2, Vec2, Vec3, Vec4};

use super::picture::PaneTracer;

impl PaneTracer<'_> {
    /// A texel of a level of the picture; the nearest where there is none.
    pub(super) fn glass_picture_texel(&self, level: u32, column: i32, row: i32) -> Vec4 {
        let [width, height, first, _] = self.glass.frame.levels[level as usize];
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = row.clamp(0, height as i32 - 1) as u32;
        Vec4::from(self.behind[(first + y * width + x) as usize])
    }

    /// A texel of a level of the capture. Beyond an edge, the octahedral map continues mirrored about the edge's middle.
    fn glass_picture_environment_texel(&self, level: u32, column: i32, row: i32) -> Vec4 {
        let whole = self.glass.frame.capture_size;
        let size = whole >> level;
        let [x, y] = packing_octahedral_texel(size, column, row);
        let first = 4 * (whole * whole - size * size) / 3;
        Vec4::from(self.capture[(first + y * size + x) as usize])
    }

    /// A level of the picture or of the capture at a position in [0, 1], bilinear.
    fn glass_picture_level(&self, of_capture: bool, level: u32, position: Vec2) -> Vec3 {
        let frame = &self.glass.frame;
        let size = if of_capture {
            Vec2::splat((frame.capture_size >> level) as f32)
        } else {
            let [width, height, ..] = frame.levels[level as usize];
            UVec2::new(width, height).as_vec2()
        };
        let at = position * size - 0.5;
        let low = at.floor();
        let part = at - low;
        let mut sum = Vec3::ZERO;
        for k in 0..4 {
            let step = IVec2::new(k & 1, k >> 1);
            let fraction_x = if step.x == 1 { part.x } else { 1.0 - part.x };
            let fraction = fraction_x * if step.y == 1 { part.y } else { 1.0 - part.y };
            let cell = low.as_ivec2() + step;
            if fraction > 0.0 {
                let texel = if of_capture {
                    self.glass_picture_environment_texel(level, cell.x, cell.y)
                } else {
                    self.glass_picture_texel(level, cell.x, cell.y)
                };
                sum += texel.truncate() * fraction;
            }
        }
        sum
    }

    /// The picture or the capture at a position of [0, 1], for a footprint in texels of its finest level.
    fn glass_picture_at(&self, of_capture: bool, position: Vec2, footprint: f32) -> Vec3 {
        let frame = &self.glass.frame;
        let last = (if of_capture { frame.capture_last } else { frame.last }) as f32;
        let level = ops::log2(footprint.max(1.0e-6)).clamp(0.0, last);
        let low = level.floor();
        let part = level - low;
        let mut sum = self.glass_picture_level(of_capture, low as u32, position) * (1.0 - part);
        if part > 0.0 {
            sum += self.glass_picture_level(of_capture, low as u32 + 1, position) * part;
        }
        sum
    }

    /// Radiance of the environment map in a direction, averaged over a footprint in radians.
    pub(super) fn glass_picture_environment(&self, direction: Vec3, footprint: f32) -> Vec3 {
        let position = Vec2::from(packing_octahedral_encode(direction.to_array())) * 0.5 + 0.5;
        self.glass_picture_at(true, position, footprint / self.glass.frame.capture_texel)
    }

    /// Projects a direction onto the picture: -1 to 1 right and up, and its depth.
    fn glass_picture_project(&self, direction: Vec3) -> Vec3 {
        let camera = &self.glass.frame.camera;
        let depth = direction.dot(camera.forward);
        camera.camera_place(direction, depth.max(1.0e-6)).extend(depth)
    }

    /// Radiance along a ray that begins at an offset from the eye. Its footprint is an angle.
    pub(super) fn glass_picture_seen(
        &self,
        from_eye: Vec3,
        direction: Vec3,
        shift: Vec2,
        footprint: f32,
    ) -> Vec3 {
        let frame = &self.glass.frame;
        let size = Vec2::new(frame.camera.width as f32, frame.camera.height as f32);
        let guess = self.glass_picture_project(direction);
        let distance = if guess.z > 0.0 && guess.x.abs() < 1.0 && guess.y.abs() < 1.0 {
            let pixel = Vec2::new(0.5 + 0.5 * guess.x, 0.5 - 0.5 * guess.y) * size;
            self.glass_picture_texel(0, pixel.x as i32, pixel.y as i32).w
        } else {
            let square = Vec2::from(packing_octahedral_encode(direction.to_array()));
            let texel = (square * 0.5 + 0.5) * frame.capture_size as f32;
            self.glass_picture_environment_texel(0, texel.x as i32, texel.y as i32).w
        };
        let to = direction + from_eye / distance.clamp(0.1, GLASS_PICTURE_FAR);
        let position = self.glass_picture_project(to);
        let texels = (footprint / frame.camera.pixel_angle).max(1.0);
        // Toward the picture's edge the capture takes over, within the footprint.
        let at = Vec2::new(0.5 + 0.5 * position.x, 0.5 - 0.5 * position.y) + shift / size;
        let inside = (at.x.min(1.0 - at.x) * size.x).min(at.y.min(1.0 - at.y) * size.y);
        let fraction = if position.z > 0.0 { ((inside + 0.5) / texels).clamp(0.0, 1.0) } else { 0.0 };
        let mut sum = Vec3::ZERO;
        if fraction > 0.0 {
            sum = self.glass_picture_at(false, at, texels) * fraction;
        }
        if fraction < 1.0 {
            sum += self.glass_picture_environment(to, footprint) * (1.0 - fraction);
        }
        sum
    }
}
