//! The light of lamps and sun on a surface, with rays that find what hides it.

use std::f32::consts::TAU;

use downpour_drop::optics::optics_fresnel;
use downpour_math::ops;
use downpour_render::light::{Light, light_weight};
use downpour_render::plate::Lighting;
use downpour_render::spacing::RaySpacing;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::brdf::{BRDF_GRAZING, BRDF_MIN_DIVISOR};
use downpour_shaders::render::puddle_water::{PUDDLE_WATER_INDEX, PUDDLE_WATER_OUTSIDE};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_DIGIT, SCENE_FAR, SCENE_LAMP_GLASS, SCENE_LARGE_LAMP, SCENE_LATTICE, SCENE_LAYERS,
    SCENE_LIGHT_AREA, SCENE_LIGHT_BODY, SCENE_MIN_COSINE, SCENE_MIN_LAMP, SCENE_MIN_ROUGHNESS,
    SCENE_OTHER_DIGIT, SCENE_OTHER_LATTICE, SCENE_PICTURE, SCENE_SAME_SHADOW, SCENE_SEEN_AREA,
    SCENE_SEEN_BODY, SCENE_SHADOW_M, SCENE_SHADOW_PART, SCENE_SHARP_PIXELS, SCENE_SHEEN,
    SCENE_SHEEN_VARIANCE, SCENE_SPOT_GLASS,
};
use downpour_shaders::render::translucent::TRANSLUCENT_SIDE;
use glam::{Vec2, Vec3};

use super::SceneView;
use crate::brdf::{brdf_direct, brdf_fresnel};
use crate::scatter::scatter_tangent;
use crate::scene::water::{puddle_water_beneath, puddle_water_entry};
use crate::surface::Surface;
use crate::translucent::{
    translucent_behind, translucent_chance, translucent_facet, translucent_is, translucent_part,
};

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

/// Query for the light of lamps on a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneAsked {
    /// Number of lamps that are drawn for all, by what each would give. With 0, or at least as many as there are, all lamps are
    /// asked whether something hides them.
    pub(crate) draws: u32,
    /// Numbers in [0, 1): three for a place of a surface that shines, which is one of the lamps, and one for that draw.
    pub(crate) numbers: [f32; 4],
    /// Standoff and depth of water: see [`SceneView::scene_arrival`].
    pub(crate) standoff: f32,
    pub(crate) under: Vec2,
    /// Width of the pixel, m, on the surface that the camera sees: light without hard shadows is told apart, and rays of its gloss
    /// see what shines. `None` for other surfaces.
    pub(crate) footprint: Option<f32>,
    /// True if no ray asks what hides light without hard shadows.
    pub(crate) spared: bool,
}

/// Light of one lamp if nothing hides it.
struct SceneShare {
    arrival: SceneArrival,
    lit: Vec3,
    glow: Vec3,
    relief: Vec3,
    soft: f32,
    is_area: bool,
}

/// Light of lamps, and of surfaces that shine, at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneDirect {
    /// Toward the viewer.
    pub(crate) lit: Vec3,
    /// On the diffuse base, over pi: of surfaces that shine, and of lamps with soft shadows. Means over neighbors are taken of it.
    pub(crate) glow: Vec3,
    /// Toward the viewer, from a rough gloss that lamps with soft shadows light, and from a wide one that surfaces that shine light: means over
    /// neighbors are taken of it, too.
    pub(crate) sheen: Vec3,
    /// Light of lamps of the latter if nothing hides them: to the facet, and to the surface with its relief.
    pub(crate) flat_light: f32,
    pub(crate) relief_light: f32,
    /// True if another lamp is hidden in part.
    pub(crate) is_soft: bool,
}

impl SceneView<'_> {
    /// Fraction of light that reaches a position from a distance along a direction: surfaces that let light through dim it.
    pub(crate) fn scene_visibility(&self, position: Vec3, direction: Vec3, distance: f32) -> Vec3 {
        let nearest = self.frame.nearest;
        let mut from_distance = nearest;
        let mut visible = Vec3::ONE;
        for _ in 0..SCENE_LAYERS {
            let hit = self.data.surface_blocker(position, direction, from_distance, distance - nearest);
            let Some(hit) = hit else { return visible };
            let material = self.data.material_load(self.data.corners[hit.triangle as usize * 3].material);
            if material.flags & (SCENE_LAMP_GLASS | SCENE_SPOT_GLASS) != 0 {
                // The light of a lamp begins in its glass.
            } else if material.flags & SCENE_BLENDED != 0 {
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

    /// Light of a lamp as it arrives at a surface.
    ///
    /// `standoff`: a lamp that is nearer to the surface's plane than this gives it the same light from so far: a spot close
    /// to a lamp is small, and far brighter than all around it. `under`: the depth of level water over the surface, and how far
    /// the water's surface is over it in the model; light is refracted where it enters, and what Fresnel's equations do not
    /// reflect goes in.
    fn scene_arrival(&self, lamp: &Light, surface: &Surface, standoff: f32, under: Vec2) -> SceneArrival {
        let nearest = self.frame.nearest;
        let mut position = surface.position;
        let mut light = lamp.light_sample(position, 0.0);
        let facet = translucent_facet(surface, light.direction);
        let mut arrival = SceneArrival {
            start: position + facet * nearest,
            distance: light.distance,
            along: light.direction,
            spread: light.spread,
            direction: light.direction,
            diffuse: 1.0,
            irradiance: light.irradiance,
        };
        let height = light.direction.dot(facet) * light.distance;
        let moved = if height > 0.0 && height < standoff { 1 } else { 0 };
        let passes = if under.x > 0.0 { 2 } else { moved };
        for _ in 0..passes {
            position = surface.position - facet * (standoff - height);
            if under.x > 0.0 {
                position =
                    surface.position + Vec3::Y * under.y + puddle_water_entry(light.direction, under.x);
            }
            light = lamp.light_sample(position, 0.0);
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
    /// `out`: [`SceneData::wet_out`](crate::data::SceneData) toward the viewer, of a surface with a film;
    /// `seen`: rays of the gloss see the lamp itself.
    fn scene_lamp(&self, surface: &Surface, view: Vec3, light: &SceneArrival, out: Vec3, seen: bool) -> Vec3 {
        if surface.facet.dot(light.direction) <= 0.0 {
            return Vec3::ZERO;
        }
        if seen {
            return surface.diffuse * self.scene_glow(surface, view, light, out);
        }
        let alpha = scene_alpha(surface.roughness, light.spread, surface.normal.dot(view));
        let (mut base, mut under) = (surface.diffuse * light.diffuse, Vec3::ZERO);
        if surface.film > 0.0 {
            let cosine = surface.normal.dot(light.direction).max(0.0);
            under = base * out * self.data.wet_in(surface, cosine) * (surface.film * cosine);
            base *= 1.0 - surface.film;
        }
        let &Surface { normal_reflectance, film, normal, .. } = surface;
        light.irradiance
            * (under + brdf_direct(base, normal_reflectance, film, alpha, normal, view, light.direction))
    }

    /// Radiance of the disks of suns that the picture shows in a direction.
    pub(crate) fn scene_suns(&self, direction: Vec3) -> Vec3 {
        let mut sum = Vec3::ZERO;
        if self.frame.projection != SCENE_PICTURE {
            return sum;
        }
        for k in 0..self.frame.light_count {
            let lamp = self.data.light_load(k);
            let apart = direction + lamp.axis;
            // A disk whose edge is a chord away takes pi times its square of the sphere.
            let square = lamp.chord * lamp.chord;
            if lamp.is_parallel() && apart.dot(apart) < square {
                sum += lamp.color / square;
            }
        }
        sum
    }

    /// Light that a place of a surface that shines gives to the diffuse base of a surface, over pi and the albedo.
    fn scene_glow(&self, surface: &Surface, view: Vec3, light: &SceneArrival, out: Vec3) -> Vec3 {
        let cosine = surface.normal.dot(light.direction);
        if cosine <= 0.0 || surface.facet.dot(light.direction) <= 0.0 {
            return Vec3::ZERO;
        }
        let sum = view + light.direction;
        let halfway = sum / sum.dot(sum).sqrt().max(BRDF_MIN_DIVISOR);
        let fresnel =
            brdf_fresnel(surface.normal_reflectance, surface.film, view.dot(halfway).clamp(0.0, 1.0));
        let mut enters = Vec3::ONE - fresnel;
        if surface.film > 0.0 {
            enters += (out * self.data.wet_in(surface, cosine) - enters) * surface.film;
        }
        light.irradiance * enters * (cosine * light.diffuse)
    }

    /// Fraction of the light of a lamp that reaches a surface: what a ray to a place on its disk finds.
    fn scene_shadow(&self, light: &SceneArrival, numbers: [f32; 2]) -> Vec3 {
        let (mut along, mut distance) = (light.along, light.distance);
        if light.spread > 0.0 {
            let tangent = scatter_tangent(along);
            let offset = scene_disk(numbers) * light.spread;
            let bent = along + tangent * offset.x + along.cross(tangent) * offset.y;
            let longer = bent.dot(bent).sqrt();
            along = bent / longer;
            distance = if distance >= SCENE_FAR { distance } else { distance * longer };
        }
        self.scene_visibility(light.start, along, distance)
    }

    /// Light of lamps, sun, and surfaces that shine on a surface, toward the viewer.
    pub(crate) fn scene_direct(&self, surface: &Surface, view: Vec3, asked: &SceneAsked) -> SceneDirect {
        let &SceneAsked { draws, numbers, standoff, under, footprint, spared } = asked;
        let is_first = footprint.is_some();
        let lights = self.frame.light_count;
        let mut count = lights;
        let mut place = Light::default();
        if self.frame.emitters > 0 {
            let [x, y, z, w] = numbers;
            let mut normal = surface.normal;
            let mut weight = 1.0;
            if translucent_is(surface) {
                // Those of one side, drawn for both.
                let chance = translucent_chance(surface);
                let is_behind = (w * TRANSLUCENT_SIDE).fract() < chance;
                normal *= if is_behind { -1.0 } else { 1.0 };
                weight = 1.0 / if is_behind { chance } else { 1.0 - chance };
            }
            place = self.data.emitter_draw(surface.position, normal, [x, y, z]);
            // What stands on the other side is drawn with that.
            let is_there = !translucent_is(surface) || (place.position - surface.position).dot(normal) > 0.0;
            place.color *= if is_there { weight } else { 0.0 };
            count += 1;
        }
        let few = draws > 0 && draws < count;
        let glossy = is_first && self.frame.sky_rays > 0 && surface.roughness < SCENE_SEEN_BODY;
        let is_sheen = surface.roughness >= SCENE_SHEEN && surface.variance < SCENE_SHEEN_VARIANCE;
        let mut result = SceneDirect {
            lit: Vec3::ZERO,
            glow: Vec3::ZERO,
            sheen: Vec3::ZERO,
            flat_light: 0.0,
            relief_light: 0.0,
            is_soft: false,
        };
        let mut out = Vec3::ONE;
        if surface.film > 0.0 {
            out = self.data.wet_out(surface, surface.normal.dot(view).max(BRDF_GRAZING));
        }
        let of = |index: u32| {
            let lamp = if index < lights { self.data.light_load(index) } else { place };
            // Areas have a distance of their own within which their light does not grow.
            let is_area = lamp.kind == SCENE_LIGHT_AREA;
            let mut arrival = self.scene_arrival(&lamp, surface, if is_area { 0.0 } else { standoff }, under);
            // The ray ends before the surface that shines.
            arrival.distance -= if is_area { 4.0 * self.frame.nearest } else { 0.0 };
            let mut share = SceneShare {
                arrival,
                lit: Vec3::ZERO,
                glow: Vec3::ZERO,
                relief: Vec3::ZERO,
                soft: 0.0,
                is_area,
            };
            if light_weight(arrival.irradiance) <= 0.0 {
                return share;
            }
            share.soft = match footprint {
                Some(_) if is_area => 1.0,
                Some(footprint) => scene_softness(arrival.distance, arrival.spread, footprint),
                None => 0.0,
            };
            // A lamp behind a leaf lights that side: by the normal for shading, so that no lamp is on neither.
            let (mut surface, mut view, mut part) = (*surface, view, Vec3::ONE);
            if translucent_is(&surface) {
                let facet = translucent_facet(&surface, arrival.direction);
                part = translucent_part(&surface);
                if surface.normal.dot(arrival.direction) < 0.0 {
                    (surface, view) = (translucent_behind(&surface), -view);
                } else {
                    part = Vec3::ONE - part;
                }
                surface.facet = facet;
            }
            // The part that is told apart, with the facet's normal in place of the relief's.
            let mut bare = surface;
            bare.diffuse *= 1.0 - surface.transmission;
            if share.soft > 0.0 {
                share.relief = self.scene_glow(&surface, view, &arrival, out) * part * share.soft;
                share.glow = share.relief;
                if !is_area {
                    let level = Surface { normal: surface.facet, ..surface };
                    share.glow = self.scene_glow(&level, view, &arrival, out) * part * share.soft;
                }
                bare.diffuse *= 1.0 - share.soft;
            }
            // A narrow gloss sees an area by its rays.
            if !(is_first && is_area && surface.roughness < SCENE_SEEN_AREA) {
                let seen = glossy && lamp.kind == SCENE_LIGHT_BODY;
                share.lit = self.scene_lamp(&bare, view, &arrival, out, seen);
            }
            share
        };
        // One of few is drawn while they are added up: what is left of a number that has decided is as good as a new one.
        let one = few && draws == 1;
        let (mut total, mut rest, mut drawn) = (0.0, numbers[3], 0);
        for index in 0..count {
            let share = of(index);
            let fraction = light_weight(share.lit) + light_weight(share.glow);
            total += fraction;
            if one && fraction > 0.0 {
                if rest * total < fraction || total <= fraction {
                    rest *= total / fraction;
                    drawn = index;
                } else {
                    rest = (rest * total - fraction) / (total - fraction);
                }
            }
        }
        if total <= 0.0 {
            return result;
        }
        // Positions at equal steps along what all give together: the lamps that they fall on are drawn.
        let step = total / draws.max(1) as f32;
        let (mut run, mut next) = (0.0, numbers[3] * step);
        for index in if one { drawn..drawn + 1 } else { 0..count } {
            let SceneShare { arrival, lit, glow, relief, soft, is_area } = of(index);
            let fraction = light_weight(lit) + light_weight(glow);
            run += fraction;
            let mut weight = 1.0;
            if one {
                weight = total / fraction;
            } else if few {
                if next >= run || fraction <= 0.0 {
                    continue;
                }
                let times = ((run - next) / step).floor() + 1.0;
                next += times * step;
                weight = times * step / fraction;
            } else if fraction <= total * SCENE_MIN_LAMP {
                continue;
            }
            if !is_area {
                result.flat_light += light_weight(glow);
                result.relief_light += light_weight(relief);
            }
            if spared && light_weight(lit) <= total * SCENE_MIN_LAMP {
                continue;
            }
            // Each lamp has places of its own; they come from other digits of the number that draws a lamp.
            let place_numbers = [(SCENE_DIGIT, SCENE_LATTICE), (SCENE_OTHER_DIGIT, SCENE_OTHER_LATTICE)]
                .map(|(digits, turn)| ((numbers[3] * digits).fract() + index as f32 * turn).fract());
            // On what the camera sees, shadows of a few pixels are in part those of a point: noise of the rest would be seen, and its
            // mean over neighbors is taken of the other part. A lamp that gives little has one ray for both.
            let is_point = is_first && soft < 1.0;
            let both = is_point && soft > 0.0 && arrival.spread > 0.0 && fraction > total * SCENE_LARGE_LAMP;
            let spread = if is_point { 0.0 } else { arrival.spread };
            let seen = self.scene_shadow(&SceneArrival { spread, ..arrival }, place_numbers);
            let blurred = if both { self.scene_shadow(&arrival, place_numbers) } else { seen };
            result.is_soft |= (seen - blurred).abs().max_element() > SCENE_SAME_SHADOW;
            let pane =
                self.pane_shadow_fraction(arrival.start, arrival.along, arrival.distance, arrival.spread);
            let passes = pane * weight;
            if is_sheen && soft >= 1.0 {
                result.sheen += lit * seen * passes;
            } else {
                result.lit += lit * seen * passes;
            }
            result.glow += glow * blurred * passes;
        }
        result
    }
}

/// Part of the light of a lamp at a distance, m, with a disk of a half angle, whose shadows are wide on the picture, 0 to 1: as if what
/// throws them stood a part of the way to it.
#[must_use]
pub fn scene_softness(distance: f32, spread: f32, footprint: f32) -> f32 {
    let away = (distance * SCENE_SHADOW_PART).min(SCENE_SHADOW_M);
    let width = 2.0 * spread * away / footprint.max(1.0e-9);
    ((width - SCENE_SHARP_PIXELS) / SCENE_SHARP_PIXELS).clamp(0.0, 1.0)
}

/// Alpha of the lobe in which a surface shows a disk of a half angle: that of a mirror is as bright as the disk. Seen at a
/// small angle, a lobe is narrower across.
#[must_use]
pub fn scene_alpha(roughness: f32, spread: f32, cosine_view: f32) -> f32 {
    let square = roughness * roughness;
    let least = SCENE_MIN_ROUGHNESS * SCENE_MIN_ROUGHNESS;
    let disk = 0.25 * spread * spread / cosine_view.max(SCENE_MIN_COSINE);
    (square * square + disk).max(least * least).sqrt().min(1.0)
}

/// Place on a unit disk.
#[must_use]
pub fn scene_disk(numbers: [f32; 2]) -> Vec2 {
    let radius = numbers[0].sqrt();
    let angle = TAU * numbers[1];
    Vec2::new(radius * ops::cos(angle), radius * ops::sin(angle))
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

    fn is_covered(&self, point: Vec3, direction: Vec3) -> bool {
        self.data.surface_blocker(point, direction, self.frame.nearest, BVH_FAR).is_some()
    }

    fn first_surface(&self, point: Vec3, direction: Vec3) -> Option<f32> {
        let hit = self.data.surface_hit(point, direction, self.frame.nearest, BVH_FAR);
        hit.map(|hit| hit.distance)
    }

    fn is_open(&self) -> bool {
        self.data.triangles.is_empty()
    }

    fn ray_spacing(&self) -> RaySpacing {
        self.frame.pixels_that_look()
    }
}
