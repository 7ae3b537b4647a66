//! What a ray sees of a scene: light of lamps and sun with shadow rays, light of the sky with rays that find what hides
//! it.
//!
//! Twin of `shaders/wgsl/render/scene.wgsl`. Both sides trace the same rays through the same hierarchy and filter
//! the same texels, so a machine without a driver makes the same picture. For a ray:
//!
//! - the nearest surface; see-through ones are passed, at most twelve;
//! - the water of a puddle before it: what it mirrors, and what lies beneath ([`puddle`](crate::puddle));
//! - direct light: each lamp and the sun, with a ray that dims at see-through surfaces ([`brdf`](crate::brdf));
//! - light of the sky: cosine-weighted rays; one that is stopped brings the light of what it meets, lit by one lamp drawn
//!   for all and by half of the sky's irradiance, so that a shadow is not black;
//! - reflection of the sky, prefiltered by roughness, where it is not hidden.
//!
//! Limits: one bounce; reflections show the sky, not the scene, but for those of water.

mod lamps;
mod sky;
mod water;

use downpour_math::rng::rng_unit;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_MATERIAL;
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_FAR, SCENE_LAYERS, SCENE_NONE, SCENE_SAME_FACET, SCENE_SAME_PLANE, SCENE_UNLIT,
};
use glam::{Vec3, Vec4};

use crate::brdf::brdf_environment;
use crate::data::{RenderFrame, SceneData};
pub(crate) use lamps::scene_share;
pub use sky::{scene_hemisphere, scene_lattice};
use water::Beneath;

/// A scene and a frame: what a ray needs.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// The scene.
    pub data: &'a SceneData,
    /// The frame.
    pub frame: &'a RenderFrame,
}

impl SceneView<'_> {
    /// What a ray sees. Where it meets the surface that `last` met, it sees the same.
    pub(crate) fn scene_path(
        &self,
        origin: Vec3,
        direction: Vec3,
        cone: f32,
        random: [u32; 4],
        last: &ScenePath,
    ) -> ScenePath {
        let (frame, data) = (self.frame, self.data);
        let mut path = ScenePath::NOTHING;
        let mut throughput = Vec3::ONE;
        let mut from_distance = frame.nearest;
        let (mut from_place, mut towards) = (origin, direction);
        // Water that the ray has come through, and whether it was the first thing that it met.
        let mut water: Option<Beneath> = None;
        let (mut under, mut first_is_water) = (false, false);
        for layer in 0..SCENE_LAYERS {
            let Some(hit) = data.surface_hit(from_place, towards, from_distance, BVH_FAR) else {
                path.radiance += throughput * data.sky_level(0, towards);
                return path;
            };
            let mut surface = data.surface_at(&hit, from_place, towards, cone);
            let material = data.corners[hit.triangle as usize * 3].material;
            let found = match water {
                None => self.puddle_water_find(surface.position, surface.facet.y),
                Some(_) => None,
            };
            if let Some(found) = found {
                let seen = self.water_seen(&found, from_place, towards, &hit, cone, random);
                if layer == 0 {
                    path.distance = seen.distance;
                    path.material = PUDDLE_WATER_MATERIAL;
                    path.facet = Vec3::Y;
                    path.place = seen.place;
                    path.normal = seen.normal;
                }
                path.radiance += throughput * seen.radiance;
                throughput *= seen.transmitted;
                (from_place, towards) = (seen.beneath.origin, seen.beneath.direction);
                from_distance = frame.nearest;
                water = Some(seen.beneath);
                under = true;
                first_is_water = layer == 0;
                continue;
            }
            if layer == 0 {
                if scene_goes_on(last, material, surface.facet, surface.position, hit.distance) {
                    return ScenePath { again: true, ..*last };
                }
                path.distance = hit.distance;
                path.material = material;
                path.facet = surface.facet;
                path.place = surface.position;
                path.normal = surface.normal;
            }
            if let (true, Some(water)) = (under, &water) {
                water.soak(&mut surface);
                path.normal = surface.normal;
            }
            let unlit = surface.flags & SCENE_UNLIT != 0;
            let mut direct = surface.diffuse + surface.normal_reflectance;
            let mut sky = Vec4::ZERO;
            if !unlit {
                let chance = rng_unit(random[2]);
                direct = surface.emission + self.scene_direct(&surface, -towards, true, chance);
                sky = self.scene_sky_light(&surface, random);
            }
            let (mut share, mut tint) = (1.0, Vec3::ZERO);
            if surface.flags & SCENE_BLENDED != 0 {
                share = surface.alpha.clamp(0.0, 1.0);
                tint = Vec3::ONE;
            }
            if unlit {
                path.radiance += throughput * direct * share;
            } else {
                let cosine = surface.normal.dot(-towards).max(0.0);
                let mirrored = towards - surface.normal * (2.0 * towards.dot(surface.normal));
                let gloss = brdf_environment(surface.normal_reflectance, surface.roughness, cosine);
                let reflection = gloss * data.sky_reflection(mirrored, surface.roughness) * surface.occlusion;
                let body =
                    surface.diffuse * (1.0 - surface.transmission) * (Vec3::ONE - gloss) * surface.occlusion;
                // Where the sky is hidden, so is most of its reflection.
                path.radiance += throughput * share * (direct + reflection * 0.1);
                let is_first = layer == 0 || (under && first_is_water);
                if is_first && share == 1.0 && surface.transmission == 0.0 {
                    path.body = throughput * body;
                    path.gloss = throughput * reflection * 0.9;
                    path.sky = sky;
                    path.met = 1.0;
                } else {
                    let open = 0.9 * sky.w * sky.w;
                    path.radiance += throughput * share * (body * sky.truncate() + reflection * open);
                }
            }
            under = false;
            throughput *= tint * (1.0 - share) + surface.diffuse * surface.transmission * share;
            if throughput.max_element() < 1.0e-3 {
                break;
            }
            from_distance = hit.distance + frame.nearest;
        }
        path
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
}

/// What a ray of the camera finds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScenePath {
    /// All light but that of the sky on the first surface.
    pub(crate) radiance: Vec3,
    /// Distance of the first surface (`SCENE_FAR` for the sky).
    pub(crate) distance: f32,
    /// What the sky's light on the first surface is multiplied with.
    pub(crate) body: Vec3,
    /// 1 if there is a surface whose light of the sky is told apart.
    pub(crate) met: f32,
    /// What the square of the open share of the sky is multiplied with.
    pub(crate) gloss: Vec3,
    pub(crate) material: u32,
    /// Light of the sky over pi, and the share of the sky that is seen.
    pub(crate) sky: Vec4,
    pub(crate) normal: Vec3,
    pub(crate) facet: Vec3,
    pub(crate) place: Vec3,
    /// Whether it is what the sample before has seen.
    pub(crate) again: bool,
}

impl ScenePath {
    /// A path that has found nothing.
    pub(crate) const NOTHING: Self = Self {
        radiance: Vec3::ZERO,
        distance: SCENE_FAR,
        body: Vec3::ZERO,
        met: 0.0,
        gloss: Vec3::ZERO,
        material: SCENE_NONE,
        sky: Vec4::ZERO,
        normal: Vec3::ZERO,
        facet: Vec3::ZERO,
        place: Vec3::ZERO,
        again: false,
    };

    /// All that a path has seen.
    pub(crate) fn scene_radiance(&self) -> Vec3 {
        self.radiance + self.body * self.sky.truncate() + self.gloss * (self.sky.w * self.sky.w)
    }
}

/// Whether a surface goes on where another sample of the pixel has met it.
fn scene_goes_on(last: &ScenePath, material: u32, facet: Vec3, place: Vec3, distance: f32) -> bool {
    last.met > 0.0
        && last.material == material
        && last.facet.dot(facet) > SCENE_SAME_FACET
        && last.facet.dot(place - last.place).abs() < SCENE_SAME_PLANE * distance
}
