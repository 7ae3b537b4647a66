//! The picture of a scene: rays from the eye, light of lamps and sun with shadow rays, light of the sky with rays
//! that find what hides it.
//!
//! Twin of `shaders/wgsl/render/scene.wgsl`. Both sides trace the same rays through the same hierarchy and filter
//! the same texels, so a machine without a driver makes the same picture. Per sample of a pixel:
//!
//! - the nearest surface; see-through ones are passed, at most twelve;
//! - direct light: each lamp and the sun, with a ray that dims at see-through surfaces ([`brdf`](crate::brdf));
//! - light of the sky: cosine-weighted rays; one that is stopped brings the light of what it meets, lit by the lamps
//!   and by half of the sky's irradiance, so that a shadow is not black;
//! - reflection of the sky, prefiltered by roughness, where it is not hidden.
//!
//! Limits: one bounce; reflections show the sky, not the scene.

use downpour_math::ops;
use downpour_math::packing::packing_sign;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_FAR, SCENE_LAYERS, SCENE_LEAST_ROUGHNESS, SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS,
    SCENE_MATERIAL_ROWS, SCENE_RANDOM_DIMENSION, SCENE_SKY_LEVELS, SCENE_UNLIT,
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::brdf::{brdf_direct, brdf_environment};
use crate::data::{RenderFrame, SceneData};
use crate::surface::Surface;

/// A lamp as a surface sees it.
#[derive(Clone, Copy, Debug)]
struct SceneLight {
    direction: Vec3,
    distance: f32,
    irradiance: Vec3,
}

/// A scene and a frame: what a ray needs.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// The scene.
    pub data: &'a SceneData,
    /// The frame.
    pub frame: &'a RenderFrame,
}

impl SceneView<'_> {
    /// The light of row `index` at a place.
    fn scene_light(&self, index: u32, place: Vec3) -> SceneLight {
        let row = (self.data.lights + index * SCENE_LIGHT_ROWS) as usize;
        let numbers = |k: usize| Vec4::from(self.data.table[row + k].map(f32::from_bits));
        let (position, axis, colour, cone) = (numbers(0), numbers(1), numbers(2), numbers(3));
        if self.data.table[row][3] == SCENE_LIGHT_DIRECTIONAL {
            return SceneLight {
                direction: -axis.truncate(),
                distance: SCENE_FAR,
                irradiance: colour.truncate(),
            };
        }
        let offset = position.truncate() - place;
        let square = offset.dot(offset).max(1.0e-8);
        let distance = square.sqrt();
        let direction = offset / distance;
        // glTF's window: no light beyond the range, if there is one.
        let part = distance / colour.w.max(1.0e-6);
        let fourth = part * part * part * part;
        let window = if colour.w > 0.0 { (1.0 - fourth).clamp(0.0, 1.0) } else { 1.0 };
        let edge = ((-direction).dot(axis.truncate()) * cone.x + cone.y).clamp(0.0, 1.0);
        SceneLight { direction, distance, irradiance: colour.truncate() * (window * edge * edge / square) }
    }

    /// Share of light that reaches a place from a distance along a direction: surfaces that let light through dim it.
    fn scene_visibility(&self, place: Vec3, direction: Vec3, distance: f32) -> Vec3 {
        let nearest = self.frame.nearest;
        let mut from_distance = nearest;
        let mut visible = Vec3::ONE;
        for _ in 0..SCENE_LAYERS {
            let hit = self.data.surface_hit(place, direction, from_distance);
            let Some(hit) = hit.filter(|h| h.distance < distance - nearest) else { return visible };
            let material = self.data.corners[hit.triangle as usize * 3].material;
            let row = (material * SCENE_MATERIAL_ROWS) as usize;
            let [flags, through, ..] = self.data.table[row + 3];
            let through = f32::from_bits(through);
            let base = Vec4::from(self.data.table[row].map(f32::from_bits));
            if flags & SCENE_BLENDED != 0 {
                visible *= 1.0 - base.w;
            } else if through > 0.0 {
                visible *= base.truncate() * through;
            } else {
                return Vec3::ZERO;
            }
            from_distance = hit.distance + nearest;
        }
        Vec3::ZERO
    }

    /// Light of lamps and sun on a surface, towards the viewer.
    fn scene_direct(&self, surface: &Surface, view: Vec3) -> Vec3 {
        let alpha =
            (surface.roughness * surface.roughness).max(SCENE_LEAST_ROUGHNESS * SCENE_LEAST_ROUGHNESS);
        let start = surface.position + surface.facet * self.frame.nearest;
        let mut sum = Vec3::ZERO;
        for k in 0..self.frame.light_count {
            let light = self.scene_light(k, surface.position);
            if surface.facet.dot(light.direction) <= 0.0 || light.irradiance.dot(Vec3::ONE) <= 0.0 {
                continue;
            }
            let reflected = brdf_direct(
                surface.diffuse,
                surface.normal_reflectance,
                alpha,
                surface.normal,
                view,
                light.direction,
            );
            if reflected.dot(Vec3::ONE) <= 0.0 {
                continue;
            }
            let visible = self.scene_visibility(start, light.direction, light.distance);
            sum += reflected * light.irradiance * visible;
        }
        sum
    }

    /// What a surface shows at a glance: lamps, and half of the whole sky.
    fn scene_glance(&self, surface: &Surface, view: Vec3) -> Vec3 {
        if surface.flags & SCENE_UNLIT != 0 {
            return surface.diffuse + surface.normal_reflectance;
        }
        let sky = self.data.sky_irradiance(surface.normal) * surface.occlusion;
        surface.emission
            + self.scene_direct(surface, view)
            + (surface.diffuse + surface.normal_reflectance) * sky * 0.5
    }

    /// Light of the sky on a surface over pi, and, in w, the share of the sky that is seen.
    fn scene_sky_light(&self, surface: &Surface, random: [u32; 4]) -> Vec4 {
        let rays = self.frame.sky_rays;
        if rays == 0 {
            return self.data.sky_irradiance(surface.normal).extend(1.0);
        }
        let nearest = self.frame.nearest;
        let start = surface.position + surface.facet * nearest;
        let (mut sum, mut seen) = (Vec3::ZERO, 0.0);
        for k in 0..rays {
            let direction = scene_hemisphere(surface.normal, k, rays, random);
            if direction.dot(surface.facet) <= 0.0 {
                continue;
            }
            let hit = self.data.surface_hit(start, direction, nearest);
            match hit.filter(|h| h.distance <= self.frame.sky_reach) {
                None => {
                    sum += self.data.sky_level(SCENE_SKY_LEVELS - 1, direction);
                    seen += 1.0;
                }
                Some(hit) => {
                    let other = self.data.surface_at(&hit, start, direction, 0.05);
                    sum += self.scene_glance(&other, -direction);
                }
            }
        }
        sum.extend(seen) / rays as f32
    }

    /// What a ray sees, and the distance of the first surface (`SCENE_FAR` for the sky). `cone` is the width of the ray
    /// at distance 1.
    #[must_use]
    pub fn scene_radiance(&self, origin: Vec3, direction: Vec3, cone: f32, random: [u32; 4]) -> Vec4 {
        let nearest = self.frame.nearest;
        let mut throughput = Vec3::ONE;
        let mut radiance = Vec3::ZERO;
        let mut from_distance = nearest;
        let mut first = SCENE_FAR;
        for _ in 0..SCENE_LAYERS {
            let Some(hit) = self.data.surface_hit(origin, direction, from_distance) else {
                return (radiance + throughput * self.data.sky_level(0, direction)).extend(first);
            };
            first = first.min(hit.distance);
            let surface = self.data.surface_at(&hit, origin, direction, cone);
            let mut shown = surface.diffuse + surface.normal_reflectance;
            if surface.flags & SCENE_UNLIT == 0 {
                let view = -direction;
                let sky = self.scene_sky_light(&surface, random);
                let cosine = surface.normal.dot(view).max(0.0);
                let mirrored = direction - surface.normal * (2.0 * direction.dot(surface.normal));
                // Where the sky is hidden, so is most of its reflection.
                let open = sky.w * sky.w * 0.9 + 0.1;
                let reflection = self.data.sky_reflection(mirrored, surface.roughness) * open;
                let gloss = brdf_environment(surface.normal_reflectance, surface.roughness, cosine);
                let body = surface.diffuse * (1.0 - surface.transmission) * (Vec3::ONE - gloss);
                shown = surface.emission
                    + self.scene_direct(&surface, view)
                    + (body * sky.truncate() + gloss * reflection) * surface.occlusion;
            }
            let (mut share, mut tint) = (1.0, Vec3::ZERO);
            if surface.flags & SCENE_BLENDED != 0 {
                share = surface.alpha.clamp(0.0, 1.0);
                tint = Vec3::ONE;
            }
            radiance += throughput * shown * share;
            let through = tint * (1.0 - share) + surface.diffuse * surface.transmission * share;
            throughput *= through;
            if throughput.max_element() < 1.0e-3 {
                break;
            }
            from_distance = hit.distance + nearest;
        }
        radiance.extend(first)
    }

    /// The direction of the ray through a place of the picture, in pixels from the top left.
    #[must_use]
    pub fn scene_direction(&self, x: f32, y: f32) -> Vec3 {
        let frame = self.frame;
        let u = 2.0 * x / frame.width as f32 - 1.0;
        let v = 1.0 - 2.0 * y / frame.height as f32;
        let direction = Vec3::from(frame.forward) + Vec3::from(frame.right) * u + Vec3::from(frame.up) * v;
        direction / direction.dot(direction).sqrt()
    }

    /// A pixel: mean radiance, and the distance of what stands nearest in it.
    #[must_use]
    pub fn scene_pixel(&self, x: u32, y: u32) -> Vec4 {
        let (mut sum, mut nearest) = (Vec3::ZERO, SCENE_FAR);
        let n = self.frame.grid;
        for k in 0..n * n {
            let id = y * self.frame.width + x;
            let random = rng_draw([self.frame.seed, 0], id, k, SCENE_RANDOM_DIMENSION);
            let dx = ((k % n) as f32 + 0.5) / n as f32;
            let dy = ((k / n) as f32 + 0.5) / n as f32;
            let direction = self.scene_direction(x as f32 + dx, y as f32 + dy);
            let seen =
                self.scene_radiance(Vec3::from(self.frame.eye), direction, self.frame.pixel_angle, random);
            sum += seen.truncate();
            nearest = nearest.min(seen.w);
        }
        (sum / (n * n) as f32).extend(nearest)
    }

    /// The whole picture, rows from the top, in parallel; the same bits for any number of threads.
    #[must_use]
    pub fn picture(&self) -> Vec<[f32; 4]> {
        let width = self.frame.width;
        (0..self.frame.height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| self.scene_pixel(x, y).to_array()))
            .collect()
    }
}

/// Direction `k` of `n` over the hemisphere round a normal, cosine-weighted, for a pixel's random words.
#[must_use]
pub fn scene_hemisphere(normal: Vec3, k: u32, n: u32, random: [u32; 4]) -> Vec3 {
    let fract = |x: f32| x - x.floor();
    // A golden-ratio sequence, shifted for each pixel.
    let a = fract((k as f32 + rng_unit(random[0])) / n as f32);
    let b = fract(k as f32 * 0.618_034 + rng_unit(random[1]));
    let radius = a.sqrt();
    let angle = std::f32::consts::TAU * b;
    let height = (1.0 - a).max(0.0).sqrt();
    // An orthonormal frame (T. Duff et al., JCGT 6(1), 2017).
    let side = packing_sign(normal.z);
    let p = -1.0 / (side + normal.z);
    let q = normal.x * normal.y * p;
    let tangent = Vec3::new(1.0 + side * normal.x * normal.x * p, side * q, -side * normal.x);
    let other = Vec3::new(q, side + normal.y * normal.y * p, -normal.y);
    tangent * (radius * ops::cos(angle)) + other * (radius * ops::sin(angle)) + normal * height
}
