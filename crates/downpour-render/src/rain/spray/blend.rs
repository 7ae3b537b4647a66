//! Spray behind the rain of a picture. Twin of `shaders/wgsl/render/spray_blend.wgsl`, where the method is described.

use downpour_math::ops;
use downpour_math::packing::packing_unpack_half;
use downpour_shaders::render::scene::SKYLIGHT_RADIUS;
use downpour_shaders::render::spray::SPRAY_ALIKE;
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::SprayFrame;
use crate::light::light_weight;
use crate::rain::drops_frame::DropsView;
use crate::rain::drops_medium::drops_medium;
use crate::rain::medium::MediumFrame;
use crate::rain::{DropsFrame, EnvironmentMap, StreakTable};
use crate::spacing::window;

/// Spray that was found and lit before the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SprayBlend<'a> {
    /// The frame of the spray, with the pixels that look.
    pub(crate) frame: &'a SprayFrame,
    /// Two rows for each pixel.
    pub(crate) found: &'a [[f32; 4]],
    /// The drops before it, and what they show.
    pub(crate) drops: &'a DropsFrame,
    pub(crate) environment: &'a EnvironmentMap,
    pub(crate) table: &'a StreakTable,
    pub(crate) medium: &'a MediumFrame,
}

impl SprayBlend<'_> {
    fn rows(&self, x: u32, y: u32) -> [Vec4; 2] {
        let at = 2 * (y * self.drops.camera.width + x) as usize;
        [self.found[at].into(), self.found[at + 1].into()]
    }

    /// Optical depth of the spray before a pixel, and its mean distance.
    fn spray_blend_place(&self, x: u32, y: u32) -> Vec2 {
        let [[depth, nearer], [near, far]] = self.rows(x, y).map(|row| packing_unpack_half(row.w.to_bits()));
        Vec2::new(depth, near * nearer + far * (1.0 - nearer))
    }

    /// Of the pixels of a window around a pixel that look for what hides lamps: their light if nothing did, and what was seen of it. `alike`: of
    /// those whose spray is as far away.
    fn spray_blend_window(&self, x: u32, y: u32, alike: bool) -> [Vec3; 2] {
        let [width, height] = self.drops.camera.size();
        let distance = self.spray_blend_place(x, y).y;
        let SprayFrame { ray_spacing: apart, ray_column, ray_row, .. } = *self.frame;
        // Where fewer look, they are looked for farther away.
        let reach = SKYLIGHT_RADIUS + 2 * (apart - 1);
        let mut sum = [Vec3::ZERO; 2];
        for row in window(y, apart, reach, ray_row, height) {
            for column in window(x, apart, reach, ray_column, width) {
                let place = self.spray_blend_place(column, row);
                let difference =
                    (distance - place.y).abs() / (SPRAY_ALIKE * distance.max(place.y).max(1.0e-6));
                let weight = if alike { (1.0 - difference).max(0.0) } else { 1.0 };
                let [other, by_ray] = self.rows(column, row);
                if weight > 0.0 && place.x > 0.0 && by_ray.x >= 0.0 {
                    sum[0] += other.truncate() * weight;
                    sum[1] += by_ray.truncate() * weight;
                }
            }
        }
        sum
    }

    /// Light of lamps on the spray before a pixel, as far as it is seen.
    fn spray_blend_light(&self, x: u32, y: u32) -> Vec3 {
        let whole = self.rows(x, y)[0].truncate();
        if light_weight(whole) <= 0.0 {
            return Vec3::ZERO;
        }
        let mut sum = self.spray_blend_window(x, y, true);
        if light_weight(sum[0]) <= 0.0 {
            sum = self.spray_blend_window(x, y, false);
        }
        whole * sum[1] / sum[0].max(Vec3::splat(1.0e-30))
    }

    /// The rain of a pixel with the spray behind it.
    fn spray_blend_pixel(&self, x: u32, y: u32, rain: Vec4) -> Vec4 {
        let depth = self.spray_blend_place(x, y).x;
        if depth <= 0.0 {
            return rain;
        }
        let view = DropsView { frame: self.drops, masks: &[], capture: &self.environment.texels };
        let left = ops::exp(-depth);
        let shown = (drops_medium(&view, self.table, self.medium, x, y) + self.spray_blend_light(x, y))
            * (1.0 - left);
        (rain.truncate() + shown * rain.w).extend(rain.w * left)
    }

    /// Puts the spray behind rain: radiance, and the transmittance of the scene behind it. The same bits for any number of threads.
    pub(crate) fn behind(&self, rain: &mut [[f32; 4]]) {
        let width = self.drops.camera.width;
        rain.par_iter_mut().enumerate().for_each(|(index, pixel)| {
            let [x, y] = [index as u32 % width, index as u32 / width];
            *pixel = self.spray_blend_pixel(x, y, Vec4::from(*pixel)).to_array();
        });
    }
}
