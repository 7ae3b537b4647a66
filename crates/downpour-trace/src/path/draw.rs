//! Sampling of rays, and their continuation.

use downpour_drop::optics::optics_fresnel;
use downpour_shaders::render::path::{PATH_CANDIDATES, PATH_FLOOR, PATH_WATER_FACETS};
use downpour_shaders::render::puddle_water::{
    PUDDLE_WATER_CONE, PUDDLE_WATER_GRAZING, PUDDLE_WATER_INDEX, PUDDLE_WATER_RAYS, PUDDLE_WATER_RIPPLED,
};
use downpour_shaders::render::scatter::SCATTER_DISK;
use glam::{Vec2, Vec3};

use super::plan::{path_albedo, path_max};
use crate::scatter::{ScatterRay, scatter_hemisphere};
use crate::scene::SceneView;
use crate::scene::water::{puddle_water_mirrored, puddle_water_normal};
use crate::surface::Surface;

/// Number of rays that water mirrors, where so many of a pixel look for light in one of `spacing` times `spacing` pixels: of ripples several, or
/// as many fewer as pixels look for light less often.
#[must_use]
pub fn path_water_rays(rays: u32, spacing: u32, rippled: bool) -> u32 {
    rays.max(if rippled { (PUDDLE_WATER_RAYS / spacing).max(1) } else { 1 })
}

/// A ray that water mirrors: drawn from its ripples. Its weight is Fresnel's.
pub(super) fn path_water_ray(
    ripple: Vec3,
    roughness: f32,
    view: Vec3,
    cone: f32,
    a: f32,
    b: f32,
) -> ScatterRay {
    let normal = puddle_water_normal(ripple, a, b);
    let along = puddle_water_mirrored(-view, normal);
    let fraction = optics_fresnel(view.dot(normal).max(PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    ScatterRay {
        along,
        width: cone + PUDDLE_WATER_CONE,
        diffuse: Vec3::ZERO,
        roughness,
        mirror: Vec3::splat(fraction),
    }
}

/// Fraction of light that water mirrors toward a viewer: Fresnel's, in the mean over its ripples. Always the same of them: it
/// has no noise.
pub(super) fn path_water_fraction(ripple: Vec3, view: Vec3) -> f32 {
    let count = if ripple.z > PUDDLE_WATER_RIPPLED { PATH_WATER_FACETS } else { 1 };
    let mut sum = 0.0;
    for k in 0..count {
        let turn = k as f32 * 0.618_034;
        let normal = puddle_water_normal(ripple, (k as f32 + 0.5) / count as f32, turn - turn.floor());
        sum += optics_fresnel(view.dot(normal).max(PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    }
    sum / count as f32
}

/// Continuation of a ray from the surface that a mirror shows; its diffuse base replaces the mirror.
pub(super) fn path_replaced(ray: &ScatterRay, next: &ScatterRay) -> ScatterRay {
    ScatterRay {
        diffuse: next.diffuse,
        mirror: ray.mirror * next.mirror,
        roughness: ray.roughness.max(next.roughness),
        ..*next
    }
}

/// Continuation of a ray from the surface that it met; has no weight if the ray ends there.
pub(super) fn path_onward(ray: &ScatterRay, next: &ScatterRay, surface: &Surface, number: f32) -> ScatterRay {
    let factor = path_albedo(surface) * next.diffuse + next.mirror;
    let probability = path_max(factor).min(1.0);
    let weight = if number < probability { 1.0 / probability.max(1.0e-6) } else { 0.0 };
    ScatterRay {
        diffuse: ray.diffuse * factor * weight,
        mirror: ray.mirror * factor * weight,
        roughness: ray.roughness.max(next.roughness),
        ..*next
    }
}

impl SceneView<'_> {
    /// A direction for a ray of the diffuse base, as numbers for [`scatter_hemisphere`], drawn among some of the hemisphere by
    /// the light of the open sky from each: numbers, and the factor of the ray's weight. What is drawn often counts less
    /// (J. Talbot et al., EGSR 2005).
    ///
    /// [`scatter_hemisphere`]: crate::scatter::scatter_hemisphere
    pub(super) fn path_candidate(
        &self,
        surface: &Surface,
        a: f32,
        b: f32,
        number: f32,
        fraction: f32,
    ) -> (Vec2, f32) {
        let sky = self.data.sky_irradiance(surface.normal);
        let floor = (sky.x + sky.y + sky.z) * PATH_FLOOR + 1.0e-6;
        let fract = |x: f32| x - x.floor();
        let (mut sum, mut chosen, mut weight, mut rest) = (0.0, Vec2::new(a, b), 0.0, number);
        for k in 0..PATH_CANDIDATES {
            let x = fract(a + k as f32 / PATH_CANDIDATES as f32);
            let y = fract(b + k as f32 * 0.618_034);
            let along = scatter_hemisphere(surface.normal, x, y);
            if surface.facet.dot(along) <= 0.0 {
                continue;
            }
            let width =
                (SCATTER_DISK * fraction / (PATH_CANDIDATES as f32 * (1.0 - x).max(0.01).sqrt())).sqrt();
            let seen = self.data.sky_cone(along, width);
            let light = seen.x + seen.y + seen.z + floor;
            sum += light;
            // The part of the interval that is left is as good as a new number.
            if rest * sum < light {
                rest = rest * sum / light;
                (chosen, weight) = (Vec2::new(x, y), light);
            } else {
                rest = (rest * sum - light) / (sum - light);
            }
        }
        (chosen, if weight > 0.0 { sum / (PATH_CANDIDATES as f32 * weight) } else { 0.0 })
    }
}
