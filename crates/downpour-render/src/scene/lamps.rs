//! The light of lamps and sun on a surface, with rays that find what hides it.

use downpour_shaders::render::pane_shadow::PANE_SHADOW_SUN;
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_FAR, SCENE_GLANCE_NEAREST, SCENE_LAYERS, SCENE_LEAST_LAMP, SCENE_LEAST_ROUGHNESS,
    SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS, SCENE_MATERIAL_ROWS,
};
use glam::{Vec3, Vec4};

use super::SceneView;
use crate::brdf::brdf_direct;
use crate::surface::Surface;

/// A lamp as a surface sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneLight {
    pub(crate) direction: Vec3,
    pub(crate) distance: f32,
    pub(crate) irradiance: Vec3,
    /// Half the angle that the light takes.
    pub(crate) spread: f32,
}

impl SceneView<'_> {
    /// The light of row `index` at a place. A lamp that is nearer than `least` is as bright as from there.
    pub(crate) fn scene_light(&self, index: u32, place: Vec3, least: f32) -> SceneLight {
        let row = (self.data.lights + index * SCENE_LIGHT_ROWS) as usize;
        let numbers = |k: usize| Vec4::from(self.data.table[row + k].map(f32::from_bits));
        let (position, axis, colour, cone) = (numbers(0), numbers(1), numbers(2), numbers(3));
        if self.data.table[row][3] == SCENE_LIGHT_DIRECTIONAL {
            return SceneLight {
                direction: -axis.truncate(),
                distance: SCENE_FAR,
                irradiance: colour.truncate(),
                spread: PANE_SHADOW_SUN,
            };
        }
        let offset = position.truncate() - place;
        let square = offset.dot(offset).max((least * least).max(1.0e-8));
        let distance = offset.dot(offset).max(1.0e-8).sqrt();
        let direction = offset / distance;
        // glTF's window: no light beyond the range, if there is one.
        let part = distance / colour.w.max(1.0e-6);
        let fourth = part * part * part * part;
        let window = if colour.w > 0.0 { (1.0 - fourth).clamp(0.0, 1.0) } else { 1.0 };
        let edge = ((-direction).dot(axis.truncate()) * cone.x + cone.y).clamp(0.0, 1.0);
        let irradiance = colour.truncate() * (window * edge * edge / square);
        SceneLight { direction, distance, irradiance, spread: 0.0 }
    }

    /// Share of light that reaches a place from a distance along a direction: surfaces that let light through dim it.
    pub(crate) fn scene_visibility(&self, place: Vec3, direction: Vec3, distance: f32) -> Vec3 {
        let nearest = self.frame.nearest;
        let mut from_distance = nearest;
        let mut visible = Vec3::ONE;
        for _ in 0..SCENE_LAYERS {
            let hit = self.data.surface_hit(place, direction, from_distance, distance - nearest);
            let Some(hit) = hit else { return visible };
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

    /// Light of one lamp on a surface, towards the viewer, if nothing is between them.
    fn scene_lamp(&self, surface: &Surface, view: Vec3, light: &SceneLight) -> Vec3 {
        if surface.facet.dot(light.direction) <= 0.0 {
            return Vec3::ZERO;
        }
        let alpha =
            (surface.roughness * surface.roughness).max(SCENE_LEAST_ROUGHNESS * SCENE_LEAST_ROUGHNESS);
        let (diffuse, normal_reflectance) = (surface.diffuse, surface.normal_reflectance);
        light.irradiance
            * brdf_direct(diffuse, normal_reflectance, alpha, surface.normal, view, light.direction)
    }

    /// Light of lamps and sun on a surface, towards the viewer. Lamps are asked in turn whether something hides them;
    /// with `all` false only one is, drawn by what each would give (`chance` in [0, 1)), for all of them.
    pub(super) fn scene_direct(&self, surface: &Surface, view: Vec3, all: bool, chance: f32) -> Vec3 {
        let start = surface.position + surface.facet * self.frame.nearest;
        // At a glance a spot close to a lamp would be noise: it is small, and far brighter than all round it.
        let least = if all { 0.0 } else { self.frame.sky_reach * SCENE_GLANCE_NEAREST };
        let count = self.frame.light_count;
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        let (mut rest, mut chosen) = (chance, count);
        // Once for what each would give, and to draw one; then the rays.
        for k in 0..count {
            let light = self.scene_light(k, surface.position, least);
            let share = scene_share(self.scene_lamp(surface, view, &light));
            total += share;
            if share > 0.0 && rest * total < share {
                // The part of the interval that is left is as good as a new number.
                rest = rest * total / share;
                chosen = k;
            } else if share > 0.0 {
                rest = (rest * total - share) / (total - share);
            }
        }
        let lamps = if all { 0..count } else { chosen..(chosen + 1).min(count) };
        for k in lamps {
            let light = self.scene_light(k, surface.position, least);
            let lit = self.scene_lamp(surface, view, &light);
            let share = scene_share(lit);
            if share <= total * SCENE_LEAST_LAMP {
                continue;
            }
            let visible = self.scene_visibility(start, light.direction, light.distance);
            let pane = self.pane_shadow_share(start, light.direction, light.distance, light.spread);
            sum += lit * visible * (pane * if all { 1.0 } else { total / share });
        }
        sum
    }
}

/// What a colour weighs when lamps are compared.
pub(crate) fn scene_share(colour: Vec3) -> f32 {
    colour.x + colour.y + colour.z
}
