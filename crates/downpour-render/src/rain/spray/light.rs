//! Light of lamps and sun that spray scatters toward the eye. Twin of `shaders/wgsl/render/spray_light.wgsl`, where the method is
//! described.

use std::f32::consts::PI;

use downpour_math::rng::rng_unit;
use downpour_shaders::render::medium::{MEDIUM_DARK, MEDIUM_SPOTS};
use downpour_shaders::render::spray::{SPRAY_LAMP_MIN, SPRAY_LATTICE};
use glam::Vec3;
use rayon::prelude::*;

use crate::light::{Light, light_weight};
use crate::path_lattice::path_lattice_words;
use crate::rain::glint::drop_glint_angle;
use crate::rain::medium::MediumLight;
use crate::rain::medium::phase::medium_phase_at;

/// Light of all lamps at a place of a ray if nothing hid them, and the part of it that comes from one, which a number of [0, 1) draws; that
/// lamp.
struct SprayLight {
    whole: Vec3,
    drawn: Vec3,
    lamp: u32,
}

impl MediumLight<'_> {
    /// Light of a lamp at a place of a ray of unit direction.
    fn spray_light_lamp(&self, lamp: &Light, place: Vec3, direction: Vec3) -> Vec3 {
        if self.medium.lit == MEDIUM_SPOTS && (lamp.is_parallel() || lamp.cone[0] <= 0.0) {
            return Vec3::ZERO;
        }
        let light = lamp.light_sample(place, SPRAY_LAMP_MIN);
        let phase = medium_phase_at(&self.phase, drop_glint_angle(light.direction, direction) * PI);
        light.irradiance * PI * phase.truncate()
    }

    fn spray_light_at(&self, place: Vec3, direction: Vec3, number: f32) -> SprayLight {
        let mut sum = SprayLight { whole: Vec3::ZERO, drawn: Vec3::ZERO, lamp: 0 };
        let mut rest = number;
        for k in 0..self.lighting.light_count() {
            let given = self.spray_light_lamp(&self.lighting.light(k), place, direction);
            let fraction = light_weight(given);
            if fraction > 0.0 {
                sum.whole += given;
                let chance = fraction / light_weight(sum.whole);
                if rest < chance {
                    rest /= chance;
                    sum.drawn = given;
                    sum.lamp = k;
                } else {
                    rest = (rest - chance) / (1.0 - chance).max(1.0e-9);
                }
            }
        }
        sum
    }

    /// Light on the spray before a pixel, and in front of it what was found of it.
    fn spray_light_pixel(&self, x: u32, y: u32, found: &mut [[f32; 4]; 2]) {
        let [depth, distance] = [found[0][3], found[1][3]];
        if depth <= 0.0 || self.medium.lit == MEDIUM_DARK {
            return;
        }
        let direction = self.camera.camera_direction(x as f32 + 0.5, y as f32 + 0.5);
        let place = Vec3::from(self.medium.eye) + direction * distance;
        let number = rng_unit(path_lattice_words(self.camera.seed, x, y, SPRAY_LATTICE)[1]);
        let sum = self.spray_light_at(place, direction, number);
        let fraction = light_weight(sum.drawn);
        let mut seen = Vec3::ZERO;
        if fraction > 0.0 {
            let light = self.lighting.light(sum.lamp).light_sample(place, SPRAY_LAMP_MIN);
            seen = self.lighting.visibility(place, light.direction, light.distance)
                * sum.drawn
                * (light_weight(sum.whole) / fraction);
        }
        *found = [sum.whole.extend(depth), seen.extend(distance)].map(Into::into);
    }

    /// Lights the spray before the pixels of a picture: rows as [`SprayView::found`](super::SprayView::found) gives them. The same bits for
    /// any number of threads.
    pub fn light_spray(&self, found: &mut [[f32; 4]]) {
        let width = self.camera.width;
        let (pixels, _) = found.as_chunks_mut::<2>();
        pixels.par_iter_mut().enumerate().for_each(|(index, pixel)| {
            self.spray_light_pixel(index as u32 % width, index as u32 / width, pixel);
        });
    }
}
