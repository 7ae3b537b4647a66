//! Makes the means of the streak radiance table. Twin of `shaders/wgsl/render/streak_table.wgsl`, where the method is described.

use downpour_drop::oscillation::drop_oscillation_sine;
use downpour_mask::wobble::{mask_wobble_light, mask_wobble_nearest, mask_wobble_surface};
use downpour_math::ops;
use downpour_shaders::render::rain::{
    DROPS_SHIFT, DROPS_STRAIGHT, STREAK_EXITS, STREAK_MEAN_FIRST, STREAK_MEAN_FOURTH, STREAK_MEAN_GROUP,
    STREAK_MEAN_POINTS, STREAK_MEAN_REACH, STREAK_MEAN_RIM, STREAK_MEAN_SECOND, STREAK_MEAN_THIRD,
    STREAK_MEAN_WIDTH, STREAK_RAYS, STREAK_TURN,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops_frame::DropsView;
use super::drops_mask::drops_mask_unit;
use super::glint::drop_glint_right;
use super::streak_lookup::STREAK_MEAN_ENTRIES;
use super::streak_path::StreakPath;

impl DropsView<'_> {
    /// One of the points of a class's mean: radiance, and 1 if it meets the drop, else 0.
    fn streak_table_point(&self, class: &StreakPath, towards: Vec3, point: u32) -> Vec4 {
        let number = point as f32 + 0.5;
        let phase = |step: f32| (number * step).fract();
        let azimuth = STREAK_TURN * phase(STREAK_MEAN_FOURTH);
        let path = StreakPath { lobe: [ops::cos(azimuth), ops::sin(azimuth)], ..*class };
        let [a20, a31] = path.amplitudes;
        let displacement = [
            a20 * drop_oscillation_sine(phase(STREAK_MEAN_SECOND)),
            a31 * drop_oscillation_sine(phase(STREAK_MEAN_THIRD)),
        ];
        let body = path.streak_path_body(path.coefficients(), displacement);
        // Evenly over a disk that holds the drop.
        let reach = STREAK_MEAN_REACH / body.inverse_wide.min(body.inverse_tall).sqrt();
        let away = (number / STREAK_MEAN_POINTS as f32).sqrt();
        let angle = STREAK_TURN * phase(STREAK_MEAN_FIRST);
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let offset = right * (away * ops::cos(angle)) + up * (away * ops::sin(angle));
        let origin = path.streak_path_turned(offset * reach);
        let direction = path.streak_path_turned(towards);
        let line = [origin.to_array(), direction.to_array()];
        let guess = mask_wobble_nearest(&body, line[0], line[1], 0.0);
        let along = mask_wobble_nearest(&body, line[0], line[1], guess);
        let nearest = (origin + direction * along).to_array();
        if mask_wobble_surface(&body.coefficients, body.state, nearest).excess >= 0.0 {
            return Vec4::ZERO;
        }
        let light = mask_wobble_light(&body, line[0], line[1]);
        // A sphere's deviations and their derivatives, for the footprints.
        let bend = 2.0 / (1.0 - away * away).max(STREAK_MEAN_RIM).sqrt();
        let width = STREAK_MEAN_WIDTH * reach;
        let bends = [
            bend,
            bend - DROPS_STRAIGHT,
            (bend - 2.0 * DROPS_STRAIGHT).abs().max(1.0),
            (bend - 3.0 * DROPS_STRAIGHT).abs().max(1.0),
        ];
        let shifts = self.frame.form == DROPS_SHIFT;
        let (mut sum, mut rest) = (Vec3::ZERO, 1.0);
        for (k, bend) in bends.into_iter().enumerate().take(1 + STREAK_EXITS as usize) {
            if light.interfaces[k] > 0.0 {
                let shown = match (shifts, k) {
                    (true, 1) => 1.0,
                    (true, _) => 0.0,
                    (false, _) => light.fractions[k],
                };
                let seen = path.streak_path_back(light.exits[k].into());
                sum += self.drops_capture_about(towards, seen, width * bend) * shown;
                rest -= light.fractions[k];
            }
        }
        let lost = if shifts { 0.0 } else { rest.max(0.0) };
        sum += self.drops_capture_texel(self.frame.capture_last, 0, 0) * lost;
        sum.extend(1.0)
    }

    /// The mean of a class along a ray.
    fn mean(&self, classes: &[StreakPath], kind: u32, ray: u32) -> [f32; 4] {
        let class = &classes[kind as usize];
        // A class without rows is one that no drop has.
        if class.rows == 0 && kind >= self.frame.made_classes {
            return [0.0; 4];
        }
        let last = (STREAK_RAYS - 1) as f32;
        let position = Vec2::new((ray % STREAK_RAYS) as f32 / last, (ray / STREAK_RAYS) as f32 / last);
        let (x, y) =
            (position.x * self.frame.camera.width as f32, position.y * self.frame.camera.height as f32);
        let towards = drops_mask_unit(self.frame.camera.camera_ray(x, y));
        let mut sum = Vec4::ZERO;
        for part in 0..STREAK_MEAN_GROUP {
            let mut of_part = Vec4::ZERO;
            for point in (part..STREAK_MEAN_POINTS).step_by(STREAK_MEAN_GROUP as usize) {
                of_part += self.streak_table_point(class, towards, point);
            }
            sum += of_part;
        }
        (sum.truncate() / sum.w.max(1.0)).extend(0.0).to_array()
    }

    /// The means of these classes, in parallel; the same bits for any number of threads.
    pub(super) fn streak_means(&self, classes: &[StreakPath]) -> Vec<[f32; 4]> {
        let entries = classes.len() as u32 * STREAK_MEAN_ENTRIES;
        let entry = |k: u32| self.mean(classes, k / STREAK_MEAN_ENTRIES, k % STREAK_MEAN_ENTRIES);
        (0..entries).into_par_iter().map(entry).collect()
    }
}
