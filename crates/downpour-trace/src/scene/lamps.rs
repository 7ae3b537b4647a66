//! The light of lamps and sun on a surface, with rays that find what hides it.

use downpour_drop::optics::optics_fresnel;
use downpour_render::light::{Light, light_weight};
use downpour_render::plate::Lighting;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::brdf::BRDF_GRAZING;
use downpour_shaders::render::puddle_water::{PUDDLE_WATER_INDEX, PUDDLE_WATER_OUTSIDE};
use downpour_shaders::render::scene::{SCENE_BLENDED, SCENE_LAYERS, SCENE_MIN_LAMP, SCENE_MIN_ROUGHNESS};
use glam::{Vec2, Vec3};

use super::SceneView;
use crate::brdf::brdf_direct;
use crate::scene::water::{puddle_water_beneath, puddle_water_entry};
use crate::surface::Surface;

/// Light of a lamp that arrives at a surface, in air or under water.
#[derive(Clone, Copy, Debug)]
struct SceneArrival {
    /// Position where the ray to the lamp begins.
    start: Vec3,
    /// Distance from there.
    distance: f32,
    /// Direction to the lamp in air.
    along: Vec3,
    /// Half the angle that the light takes.
    spread: f32,
    /// Direction from which the light falls on the surface.
    direction: Vec3,
    /// Factor of the albedo.
    diffuse: f32,
    /// Irradiance over pi on a surface that faces it.
    irradiance: Vec3,
}

impl SceneView<'_> {
    /// Fraction of light that reaches a position from a distance along a direction: surfaces that let light through dim it.
    pub(crate) fn scene_visibility(&self, position: Vec3, direction: Vec3, distance: f32) -> Vec3 {
        let nearest = self.frame.nearest;
        let mut from_distance = nearest;
        let mut visible = Vec3::ONE;
        for _ in 0..SCENE_LAYERS {
            let hit = self.data.surface_hit(position, direction, from_distance, distance - nearest);
            let Some(hit) = hit else { return visible };
            let material = self.data.material_load(self.data.corners[hit.triangle as usize * 3].material);
            if material.flags & SCENE_BLENDED != 0 {
                visible *= 1.0 - self.data.surface_alpha(&material, &hit).clamp(0.0, 1.0);
            } else if material.transmission > 0.0 {
                visible *= material.base.truncate() * material.transmission;
            } else {
                return Vec3::ZERO;
            }
            from_distance = hit.distance + nearest;
        }
        Vec3::ZERO
    }

    /// Light of row `index` as it arrives at a surface.
    ///
    /// `standoff`: a lamp that is nearer to the surface's plane than this gives it the same light from so far: a spot close
    /// to a lamp is small, and far brighter than all around it. `under`: the depth of level water over the surface, and how far
    /// the water's surface is over it in the model; light is refracted where it enters, and what Fresnel's equations do not
    /// reflect goes in.
    fn scene_arrival(&self, index: u32, surface: &Surface, standoff: f32, under: Vec2) -> SceneArrival {
        let nearest = self.frame.nearest;
        let mut position = surface.position;
        let mut light = self.data.light_load(index).light_sample(position, 0.0);
        let mut arrival = SceneArrival {
            start: position + surface.facet * nearest,
            distance: light.distance,
            along: light.direction,
            spread: light.spread,
            direction: light.direction,
            diffuse: 1.0,
            irradiance: light.irradiance,
        };
        let height = light.direction.dot(surface.facet) * light.distance;
        let moved = if height > 0.0 && height < standoff { 1 } else { 0 };
        let passes = if under.x > 0.0 { 2 } else { moved };
        for _ in 0..passes {
            position = surface.position - surface.facet * (standoff - height);
            if under.x > 0.0 {
                position =
                    surface.position + Vec3::Y * under.y + puddle_water_entry(light.direction, under.x);
            }
            light = self.data.light_load(index).light_sample(position, 0.0);
        }
        arrival.direction = light.direction;
        arrival.irradiance = light.irradiance;
        if under.x > 0.0 {
            arrival.start = position + Vec3::Y * nearest;
            arrival.distance = light.distance;
            arrival.along = light.direction;
            arrival.direction = puddle_water_beneath(light.direction);
            let cosine = light.direction.y.max(0.0);
            // The light within is of a narrower cone: what comes out of it again is spread over a wider one.
            let square = PUDDLE_WATER_INDEX * PUDDLE_WATER_INDEX;
            let enters = (1.0 - optics_fresnel(cosine, PUDDLE_WATER_INDEX)) * cosine
                / (arrival.direction.y.max(0.1) * square);
            arrival.irradiance *= enters;
            // The albedo of what lies under water has the mean over all directions in it.
            arrival.diffuse = square / (1.0 - PUDDLE_WATER_OUTSIDE);
        }
        arrival
    }

    /// Light of one lamp on a surface, toward the viewer, if nothing is between them.
    /// `out`: [`SceneData::wet_out`](crate::data::SceneData) toward the viewer, of a surface with a film.
    fn scene_lamp(&self, surface: &Surface, view: Vec3, light: &SceneArrival, out: Vec3) -> Vec3 {
        if surface.facet.dot(light.direction) <= 0.0 {
            return Vec3::ZERO;
        }
        let alpha = (surface.roughness * surface.roughness).max(SCENE_MIN_ROUGHNESS * SCENE_MIN_ROUGHNESS);
        let (diffuse, normal_reflectance) = (surface.diffuse * light.diffuse, surface.normal_reflectance);
        let (mut base, mut under) = (diffuse, Vec3::ZERO);
        if surface.film > 0.0 {
            let cosine = surface.normal.dot(light.direction).max(0.0);
            under = base * out * self.data.wet_in(surface, cosine) * (surface.film * cosine);
            base *= 1.0 - surface.film;
        }
        light.irradiance
            * (under + brdf_direct(base, normal_reflectance, alpha, surface.normal, view, light.direction))
    }

    /// Light of lamps and sun on a surface, toward the viewer. With `draws` of 0, or of at least as many as there are, all
    /// lamps are asked whether something hides them; else so many are drawn by what each would give (`chance` in [0, 1)),
    /// for all of them. `standoff` and `under`: [`SceneView::scene_arrival`].
    pub(crate) fn scene_direct(
        &self,
        surface: &Surface,
        view: Vec3,
        draws: u32,
        chance: f32,
        standoff: f32,
        under: Vec2,
    ) -> Vec3 {
        let count = self.frame.light_count;
        let few = draws > 0 && draws < count;
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        let mut out = Vec3::ONE;
        if surface.film > 0.0 {
            out = self.data.wet_out(surface, surface.normal.dot(view).max(BRDF_GRAZING));
        }
        for k in 0..count {
            let arrival = self.scene_arrival(k, surface, standoff, under);
            total += light_weight(self.scene_lamp(surface, view, &arrival, out));
        }
        // Positions at equal steps along what all give together: the lamps that they fall on are drawn.
        let step = total / draws.max(1) as f32;
        let (mut run, mut next) = (0.0, chance * step);
        for k in 0..count {
            let arrival = self.scene_arrival(k, surface, standoff, under);
            let lit = self.scene_lamp(surface, view, &arrival, out);
            let fraction = light_weight(lit);
            run += fraction;
            let mut weight = 1.0;
            if few {
                if next >= run {
                    continue;
                }
                let times = ((run - next) / step).floor() + 1.0;
                next += times * step;
                weight = times * step / fraction;
            } else if fraction <= total * SCENE_MIN_LAMP {
                continue;
            }
            let visible = self.scene_visibility(arrival.start, arrival.along, arrival.distance);
            let pane =
                self.pane_shadow_fraction(arrival.start, arrival.along, arrival.distance, arrival.spread);
            sum += lit * visible * (pane * weight);
        }
        sum
    }
}

impl Lighting for SceneView<'_> {
    fn light_count(&self) -> u32 {
        self.data.light_count
    }

    fn light(&self, index: u32) -> Light {
        self.data.light_load(index)
    }

    fn visibility(&self, point: Vec3, direction: Vec3, distance: f32) -> Vec3 {
        self.scene_visibility(point, direction, distance)
    }

    fn obstacle(&self, point: Vec3, direction: Vec3) -> Option<f32> {
        self.data.surface_hit(point, direction, self.frame.nearest, BVH_FAR).map(|hit| hit.distance)
    }

    fn is_open(&self) -> bool {
        self.data.triangles.is_empty()
    }
}
