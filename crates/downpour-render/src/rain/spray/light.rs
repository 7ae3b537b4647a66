//! Light of lamps and sun that spray scatters toward the eye. Twin of `shaders/wgsl/render/spray_light.wgsl`, where the method is
//! described.

use std::f32::consts::PI;

use downpour_math::packing::packing_unpack_half;
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

/// Light of all lamps on spray if nothing hid them, and the part of it that comes from one of them to one place.
#[derive(Clone, Copy, Debug, Default)]
struct SprayLight {
    whole: Vec3,
    /// Part of the random number that is left.
    rest: f32,
    drawn: Vec3,
    lamp: u32,
    /// Distance of that place.
    at: f32,
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

    /// Adds the light of all lamps at a place of a ray, of which a share counts.
    fn spray_light_add(&self, sum: SprayLight, direction: Vec3, at: f32, share: f32) -> SprayLight {
        let mut next = sum;
        if share <= 0.0 {
            return next;
        }
        let place = Vec3::from(self.medium.eye) + direction * at;
        for k in 0..self.lighting.light_count() {
            let given = self.spray_light_lamp(&self.lighting.light(k), place, direction) * share;
            let fraction = light_weight(given);
            if fraction > 0.0 {
                next.whole += given;
                let chance = fraction / light_weight(next.whole);
                if next.rest < chance {
                    next.rest /= chance;
                    (next.drawn, next.lamp, next.at) = (given, k, at);
                } else {
                    next.rest = (next.rest - chance) / (1.0 - chance).max(1.0e-9);
                }
            }
        }
        next
    }

    /// Light on the spray before a pixel, and in front of it what was found of it.
    fn spray_light_pixel(&self, x: u32, y: u32, found: &mut [[f32; 4]; 2]) {
        // Optical depth and share of the nearer place; places.
        let [[depth, nearer], [near, far]] = found.map(|row| packing_unpack_half(row[3].to_bits()));
        if depth <= 0.0 || self.medium.lit == MEDIUM_DARK {
            return;
        }
        let direction = self.camera.camera_direction(x as f32 + 0.5, y as f32 + 0.5);
        let rest = rng_unit(path_lattice_words(self.camera.seed, x, y, SPRAY_LATTICE)[0]);
        let mut sum = SprayLight { rest, ..SprayLight::default() };
        sum = self.spray_light_add(sum, direction, near, nearer);
        sum = self.spray_light_add(sum, direction, far, 1.0 - nearer);
        let fraction = light_weight(sum.drawn);
        // Below 0: the pixels around it look.
        let looks = self.lighting.ray_spacing().spacing_looks(x, y);
        let mut seen = if looks { Vec3::ZERO } else { Vec3::NEG_ONE };
        if looks && fraction > 0.0 {
            let place = Vec3::from(self.medium.eye) + direction * sum.at;
            let light = self.lighting.light(sum.lamp).light_sample(place, SPRAY_LAMP_MIN);
            seen = self.lighting.visibility(place, light.direction, light.distance)
                * sum.drawn
                * (light_weight(sum.whole) / fraction);
        }
        *found = [sum.whole.extend(found[0][3]), seen.extend(found[1][3])].map(Into::into);
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
