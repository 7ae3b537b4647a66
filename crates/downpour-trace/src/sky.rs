//! The light of the sky: an equirectangular map, the same at coarser levels, and its irradiance.
//!
//! +Y is up; u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top. Twin of
//! `shaders/wgsl/render/sky.wgsl`.

use downpour_math::equirect::equirect_coordinates;
use downpour_math::ops;
use downpour_shaders::render::scene::{SCENE_SKY_LEVELS, SKY_CONE_TEXELS};
use glam::{Vec2, Vec3};

use crate::data::SceneData;

impl SceneData {
    /// A level of the sky in a direction, bilinear.
    #[must_use]
    pub fn sky_level(&self, level: u32, direction: Vec3) -> Vec3 {
        let size = self.sky_levels[level as usize];
        let uv = Vec2::from(equirect_coordinates(direction.to_array()));
        let (width, height) = (size[0] as i32, size[1] as i32);
        let x = uv.x * size[0] as f32 - 0.5;
        let y = (uv.y * size[1] as f32 - 0.5).clamp(0.0, size[1] as f32 - 1.0);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let left = (x.floor() as i32).rem_euclid(width);
        let right = (left + 1) % width;
        let above = y.floor() as i32 * width;
        let below = (y.floor() as i32 + 1).min(height - 1) * width;
        let at = |i: i32| {
            let [r, g, b, _] = self.sky[(size[2] as i32 + i) as usize];
            Vec3::new(r, g, b)
        };
        (at(above + left) * (1.0 - fx) + at(above + right) * fx) * (1.0 - fy)
            + (at(below + left) * (1.0 - fx) + at(below + right) * fx) * fy
    }

    /// Radiance of the sky for a ray of width `width` at distance 1.
    #[must_use]
    pub fn sky_cone(&self, direction: Vec3, width: f32) -> Vec3 {
        // Texels of the map across the ray; a texel between its neighbors is wider than one alone.
        let texels = width * self.sky_levels[0][1] as f32 * SKY_CONE_TEXELS;
        let level = ops::log2(texels.max(1.0)).min((SCENE_SKY_LEVELS - 1) as f32);
        let below = level as u32;
        let fraction = level - below as f32;
        let near = self.sky_level(below, direction);
        if fraction == 0.0 {
            return near;
        }
        near * (1.0 - fraction) + self.sky_level(below + 1, direction) * fraction
    }

    /// Irradiance over pi of the whole sky on a surface: what a white diffuse surface shows.
    #[must_use]
    pub fn sky_irradiance(&self, normal: Vec3) -> Vec3 {
        let Vec3 { x, y, z } = normal;
        let basis = [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y];
        let mut sum = Vec3::ZERO;
        for ([r, g, b, _], factor) in self.sky_irradiance.iter().zip(basis) {
            sum += Vec3::new(*r, *g, *b) * factor;
        }
        sum.max(Vec3::ZERO)
    }
}
