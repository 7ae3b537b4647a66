//! The surface of a puddle: what it mirrors, and the ray that goes on beneath it.

use downpour_bvh::Hit;
use downpour_drop::optics::optics_fresnel;
use downpour_math::ops;
use downpour_math::rng::rng_unit;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::puddle_water::{
    PUDDLE_WATER_CONE, PUDDLE_WATER_DOWN, PUDDLE_WATER_GRAZING, PUDDLE_WATER_INDEX, PUDDLE_WATER_NORMAL,
    PUDDLE_WATER_RAYS, PUDDLE_WATER_RIPPLED, PUDDLE_WATER_ROWS,
};
use downpour_shaders::render::scene::{SCENE_BLENDED, SCENE_UNLIT};
use glam::{Vec3, Vec4};

use super::SceneView;
use crate::puddle::water::{
    PuddleWater, puddle_water_albedo, puddle_water_mirrored, puddle_water_normal, puddle_water_reflectance,
    puddle_water_refracted,
};
use crate::surface::Surface;

/// What a ray sees of the surface of a puddle.
pub(super) struct SceneWater {
    pub(super) distance: f32,
    pub(super) place: Vec3,
    pub(super) normal: Vec3,
    pub(super) radiance: Vec3,
    /// Share of the light from beneath that comes out.
    pub(super) transmitted: f32,
    pub(super) beneath: Beneath,
}

/// A ray beneath the surface, and what the water does to what it meets.
pub(super) struct Beneath {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// Share of the light of what lies beneath that the water lets through.
    clear: f32,
    /// Albedo of the water itself.
    murk: Vec3,
}

impl Beneath {
    /// The surface as it looks under water.
    pub(super) fn soak(&self, surface: &mut Surface) {
        let Self { clear, murk, .. } = *self;
        surface.diffuse = puddle_water_albedo(surface.diffuse * clear + murk * (1.0 - clear));
        surface.normal_reflectance = puddle_water_reflectance(surface.normal_reflectance) * clear;
        surface.emission *= clear;
    }
}

/// The surface of water at a place.
fn scene_water(place: Vec3) -> Surface {
    Surface {
        position: place,
        alpha: 1.0,
        normal: Vec3::Y,
        roughness: 0.0,
        facet: Vec3::Y,
        occlusion: 1.0,
        diffuse: Vec3::ZERO,
        flags: 0,
        normal_reflectance: Vec3::splat(PUDDLE_WATER_NORMAL),
        transmission: 0.0,
        emission: Vec3::ZERO,
    }
}

impl SceneView<'_> {
    /// Water that a ray has come through before it met something.
    pub(super) fn water_seen(
        &self,
        found: &PuddleWater,
        origin: Vec3,
        direction: Vec3,
        hit: &Hit,
        cone: f32,
        random: [u32; 4],
    ) -> SceneWater {
        let nearest = self.frame.nearest;
        // Back along the ray to where it came through the surface.
        let distance = (hit.distance - found.rise / (-direction.y).max(0.01)).max(nearest);
        let mut surface = scene_water(origin + direction * distance);
        let footprint = cone * distance / (-direction.y).max(0.02).sqrt();
        let ripple =
            self.puddle_water_ripple(found.puddle, surface.position, footprint, found.depth, found.open);
        surface.normal = puddle_water_normal(Vec3::new(ripple.x, ripple.y, 0.0), 0.0, 0.0);
        // Beckmann's alpha squared is the variance of the slope.
        surface.roughness = ripple.z.sqrt().sqrt().clamp(0.0, 1.0);
        let direct = self.scene_direct(&surface, -direction, true, rng_unit(random[2]));
        let turns =
            self.frame.sky_rays.max(if ripple.z > PUDDLE_WATER_RIPPLED { PUDDLE_WATER_RAYS } else { 1 });
        let (mut sum, mut mirrored_share) = (Vec3::ZERO, 0.0);
        let fract = |x: f32| x - x.floor();
        for k in 1..=turns {
            let a = fract(rng_unit(random[0]) + k as f32 * 0.618_034);
            let b = fract(rng_unit(random[1]) + k as f32 * 0.754_877_7);
            let normal = puddle_water_normal(ripple, a, b);
            let along = puddle_water_mirrored(direction, normal);
            let cosine = (-direction.dot(normal)).max(PUDDLE_WATER_GRAZING);
            let share = optics_fresnel(cosine, PUDDLE_WATER_INDEX);
            mirrored_share += share;
            sum += self.water_mirrored(&surface, along, cone, random, k) * share;
        }
        let mirrored = 1.0 / turns as f32;

        // On beneath the surface. Ground that the model does not have is where it would be, seen in the model.
        let row = self.frame.puddles + found.puddle * PUDDLE_WATER_ROWS;
        let look = Vec4::from(self.data.table[row as usize + 4].map(f32::from_bits));
        let below = puddle_water_refracted(direction, surface.normal);
        let steep = (-below.y).max(0.1);
        let clear = ops::exp(-look.w * found.depth * (1.0 / steep + PUDDLE_WATER_DOWN));
        let aside = (found.depth - found.rise).max(0.0) / steep;
        let origin =
            surface.position + Vec3::new(below.x * aside, 0.0, below.z * aside) - below * (4.0 * nearest);
        SceneWater {
            distance,
            place: surface.position,
            normal: surface.normal,
            radiance: direct + sum * mirrored,
            transmitted: 1.0 - mirrored_share * mirrored,
            beneath: Beneath { origin, direction: below, clear, murk: look.truncate() },
        }
    }

    /// What water mirrors from a direction: turns 1 and on of the loop of `scene_path` in WGSL.
    fn water_mirrored(&self, water: &Surface, along: Vec3, cone: f32, random: [u32; 4], k: u32) -> Vec3 {
        let (data, nearest) = (self.data, self.frame.nearest);
        let start = water.position + water.facet * nearest;
        let beyond = data.sky_level(0, along);
        let Some(hit) = data.surface_hit(start, along, nearest, BVH_FAR) else { return beyond };
        let mut found = data.surface_at(&hit, start, along, cone + PUDDLE_WATER_CONE);
        // The mirror image of a lamp, met by chance, would be noise.
        found.roughness = 1.0;
        let mut lit = found.diffuse + found.normal_reflectance;
        if found.flags & SCENE_UNLIT == 0 {
            let chance = rng_unit(random[2].wrapping_add(k.wrapping_mul(2_654_435_769)));
            // What it has of the sky itself: half of the whole.
            let own = data.sky_irradiance(found.normal) * (0.5 * found.occlusion);
            lit = found.emission + self.scene_direct(&found, -along, false, chance) + lit * own;
        }
        // What a see-through surface lets pass comes from the sky behind it.
        let blended = found.flags & SCENE_BLENDED != 0;
        let share = if blended { found.alpha.clamp(0.0, 1.0) } else { 1.0 };
        lit * share + beyond * (1.0 - share)
    }
}
