//! A scene in the light of lightning alone: parallel light, and the clouds that it lights.
//!
//! Light adds up, so that a picture with a flash is the sum of the picture without it and of one that has no other light. So
//! the second one has an exposure of its own: streaks are as long as the flash, and what a flash lights is as sharp as it is short.

use std::sync::{Arc, OnceLock};

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::light::LightSource;
use downpour_weather::{FlashLight, Weather};
use glam::{DVec3, Vec2, Vec3};

use super::FrameScene;
use crate::sky_light::{SkyLight, direction_of};
use crate::wet::SceneWetness;

/// Columns and rows of the map of the lit clouds.
const WIDTH: u32 = 256;
const HEIGHT: u32 = 128;

/// Fraction of a flash's light that spreads through the clouds evenly.
const EVEN: f32 = 0.25;

/// Width of the rest: the cosine of the angle to the flash falls by this where the light falls to 1/e.
const LOBE: f32 = 0.12;

/// Height by which the plane of the clouds is bent at the horizon, over its height.
const BENT: f32 = 0.15;

/// Billows of the clouds per height of theirs, octaves, and the logarithm of the contrast.
const BILLOWS: f32 = 1.4;
const OCTAVES: u32 = 5;
const CONTRAST: f32 = 2.2;

/// Seed of the billows.
const CLOUD_SEED: [u32; 2] = [2003, 1982];

impl FrameScene {
    /// The scene in the light of flashes alone, at the time in seconds at which this one is: no sky, sun, lamp or surface shines but
    /// the flashes and the clouds that they light. Puddles and a pane are removed.
    #[must_use]
    pub fn in_flash(&self, weather: &Weather, time_s: f64, flashes: &[FlashLight]) -> Self {
        let mut frame_scene = self.clone();
        let lights: Vec<LightSource> = flashes
            .iter()
            .map(|flash| LightSource::Directional {
                direction: -DVec3::from(flash.towards).as_vec3(),
                irradiance: irradiance(flash),
            })
            .collect();
        let sky = lit_clouds(flashes);
        let data = &mut frame_scene.data;
        data.remove_emission();
        let panes = data.glazing_rows().to_vec();
        data.set_lights(&lights);
        data.set_wetness(SceneWetness::of_falling(weather, time_s, self.origin, &self.fall).as_ref());
        data.set_glazing(&panes);
        data.sky = Arc::new(sky.texels);
        data.sky_levels = sky.levels;
        data.sky_irradiance = sky.irradiance;
        frame_scene
    }
}

/// Irradiance of a surface that faces a flash.
fn irradiance(flash: &FlashLight) -> Vec3 {
    (DVec3::from(flash.color) * flash.illuminance_lux).as_vec3()
}

/// The sky of clouds that flashes light: brightest about them, nothing below the horizon.
fn lit_clouds(flashes: &[FlashLight]) -> SkyLight {
    let billows = billows();
    let mut radiance = vec![[0.0f32; 3]; billows.len()];
    for flash in flashes.iter().filter(|flash| flash.clouds > 0.0) {
        let towards = DVec3::from(flash.towards).as_vec3();
        let shape: Vec<f32> = billows
            .iter()
            .map(|(along, billow, _)| {
                let lobe = ops::exp((along.dot(towards) - 1.0) / LOBE);
                billow * (EVEN + (1.0 - EVEN) * lobe)
            })
            .collect();
        let level: f32 = shape.iter().zip(billows).map(|(part, (_, _, weight))| part * weight).sum();
        let color = irradiance(flash) * (flash.clouds as f32 / level.max(f32::MIN_POSITIVE));
        for (sum, part) in radiance.iter_mut().zip(shape) {
            *sum = (Vec3::from(*sum) + color * part).into();
        }
    }
    // The lower half is dark.
    radiance.resize((WIDTH * HEIGHT) as usize, [0.0; 3]);
    SkyLight::new(WIDTH, HEIGHT, &radiance)
}

/// The upper half of the map: of each texel its direction, its billows, and what its radiance adds to the irradiance of level
/// ground.
fn billows() -> &'static [(Vec3, f32, f32)] {
    static BILLOWED: OnceLock<Vec<(Vec3, f32, f32)>> = OnceLock::new();
    BILLOWED.get_or_init(|| {
        let edge = std::f32::consts::PI / HEIGHT as f32;
        (0..HEIGHT / 2 * WIDTH)
            .map(|k| {
                let along = direction_of(k % WIDTH, k / WIDTH, WIDTH, HEIGHT);
                let flat = Vec2::new(along.x, along.z).length();
                (along, billow(along), edge * edge * flat * along.y)
            })
            .collect()
    })
}

/// Brightness of a cloud in a direction: noise in the plane of the clouds, of unit order, evener toward the horizon.
fn billow(along: Vec3) -> f32 {
    let mut at = Vec2::new(along.x, along.z) * (BILLOWS / (along.y + BENT));
    let (mut sum, mut weight) = (0.0, 0.5);
    for octave in 0..OCTAVES {
        sum += weight * (noise(at, octave) - 0.5);
        at = Vec2::new(1.6 * at.x + 1.2 * at.y, 1.6 * at.y - 1.2 * at.x);
        weight *= 0.55;
    }
    let near = (along.y * 4.0).min(1.0);
    ops::exp(CONTRAST * near * sum)
}

/// Noise between random numbers at whole positions, 0 to 1.
fn noise(at: Vec2, octave: u32) -> f32 {
    let low = at.floor();
    let part = at - low;
    let part = part * part * (Vec2::splat(3.0) - part * 2.0);
    let number = |x: i32, y: i32| {
        let (column, row) = (low.x as i32 + x, low.y as i32 + y);
        let [word, ..] = rng_draw(CLOUD_SEED, column.cast_unsigned(), row.cast_unsigned(), octave);
        rng_unit(word)
    };
    let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
    mix(mix(number(0, 0), number(1, 0), part.x), mix(number(0, 1), number(1, 1), part.x), part.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flash(clouds: f64, lux: f64) -> FlashLight {
        FlashLight { towards: [0.6, 0.8, 0.0], color: [1.0, 0.5, 0.25], illuminance_lux: lux, clouds }
    }

    /// Irradiance over pi of a level surface that looks up, from all texels.
    fn ground(sky: &SkyLight) -> Vec3 {
        let (mut sum, edge) = (Vec3::ZERO, std::f32::consts::PI / HEIGHT as f32);
        for (k, [r, g, b, _]) in (0..WIDTH * HEIGHT).zip(&sky.texels) {
            let elevation = (0.5 * HEIGHT as f32 - (k / WIDTH) as f32 - 0.5) * edge;
            let up = ops::sin(elevation).max(0.0);
            sum += Vec3::new(*r, *g, *b) * (edge * edge * ops::cos(elevation) * up);
        }
        sum
    }

    /// The clouds light level ground by what is asked for, in proportion, in the color of the flash; brightest about it.
    #[test]
    fn clouds_give_the_light_that_is_asked_for() {
        for (clouds, lux) in [(0.5, 300.0), (0.5, 600.0), (2.0, 300.0)] {
            let found = ground(&lit_clouds(&[flash(clouds, lux)])) / (clouds * lux) as f32;
            assert!((found - Vec3::new(1.0, 0.5, 0.25)).abs().max_element() < 1.0e-3, "{found}");
        }
        let two = ground(&lit_clouds(&[flash(0.5, 100.0), flash(0.25, 100.0)]));
        assert!((two.x - 75.0).abs() < 0.1, "{two}");
        let sky = lit_clouds(&[flash(0.5, 100.0)]);
        let mean = |of: &dyn Fn(Vec3) -> bool| {
            let inside = billows().iter().zip(&sky.texels).filter(|((along, ..), _)| of(*along));
            let parts: Vec<f32> = inside.map(|(_, texel)| texel[0]).collect();
            parts.iter().sum::<f32>() / parts.len() as f32
        };
        let towards = Vec3::new(0.6, 0.8, 0.0);
        let (near, far) = (mean(&|along| along.dot(towards) > 0.95), mean(&|along| along.dot(towards) < 0.2));
        assert!(near > 2.5 * far, "{near} {far}");
        assert!(lit_clouds(&[flash(0.0, 100.0)]).texels.iter().all(|texel| texel[0] == 0.0));
    }
}
