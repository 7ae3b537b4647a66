//! Glints of lamps on a drop, pixel by pixel. Twin of `shaders/wgsl/render/drops_glint.wgsl`, where the method is described.

use downpour_shaders::render::rain::{DROPS_GLINT_BOX, DROPS_GLINT_BUMP, DROPS_STILL};
use glam::{Vec2, Vec3, Vec4};

use super::drops_frame::DropsView;
use super::glint::{drop_glint_image, drop_glint_pixel, drop_glint_right, drop_glint_unpack};
use super::streak::{ScreenDrop, streak_mean};

impl DropsView<'_> {
    /// Light of lamps that has no position on a drop, as a radiance over all of it: the mean less its glints. `row` is the light on
    /// the drop: its mean, then its glints.
    pub(super) fn drops_glint_rest(&self, row: &[[f32; 4]]) -> Vec3 {
        let mut light = Vec4::from(row[0]).truncate();
        // An atlas has streaks, and nothing of a drop that stands still but its mean.
        let glints = if self.frame.atlas > 0 { &[] } else { &row[1..] };
        for glint in glints.iter().filter(|glint| glint[3] > 0.0) {
            light -= Vec4::from(*glint).truncate();
        }
        light.max(Vec3::ZERO)
    }

    /// Position on the picture of a point of a drop's disk, pixels from its middle: the disk is drawn out to the drop's oval.
    fn drops_glint_offset(&self, drop: &ScreenDrop, position: Vec2) -> Vec2 {
        let towards = Vec3::from(drop.towards);
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let [wide, tall, middle] = drop.oval;
        let at = (position * Vec2::new(wide, tall) + Vec2::new(0.0, middle)) * drop.slope;
        let camera = &self.frame.camera;
        camera.camera_project(towards + right * at.x + up * at.y) - camera.camera_project(towards)
    }

    /// Light of a drop's glints in a pixel, as a radiance over all of the pixel.
    pub(super) fn drops_glint_light(&self, row: &[[f32; 4]], drop: &ScreenDrop, x: u32, y: u32) -> Vec3 {
        let mut light = Vec3::ZERO;
        if self.frame.atlas > 0 {
            return light;
        }
        let pixels = drop.slope / self.frame.camera.pixel_angle * (drop.oval[0] * drop.oval[1]).sqrt();
        for glint in row[1..].iter().filter(|glint| glint[3] > 0.0) {
            let position = drop_glint_unpack(glint[3]);
            // Images do not reach out of the drop, but for a pixel.
            let room = (1.0 - position.dot(position).sqrt()).max(0.0);
            let image = drop_glint_image(glint[3]);
            let offset = self.drops_glint_offset(drop, position);
            let corner = Vec2::new(x as f32, y as f32);
            let part = if drop.kind == DROPS_STILL {
                let reach = ((DROPS_GLINT_BUMP * image).min(room) * pixels).max(1.0);
                drop_glint_pixel(Vec2::from(drop.position) + offset - corner, reach)
            } else {
                let width = ((DROPS_GLINT_BOX * image).min(2.0 * room) * pixels).max(1.0);
                let from_pixel = Vec2::from(drop.first) + offset - (corner + 0.5);
                drop.fraction * streak_mean(from_pixel, drop.screen_delta.into(), width, drop.weights)
            };
            light += Vec4::from(*glint).truncate() * (drop.area * part);
        }
        light
    }
}
