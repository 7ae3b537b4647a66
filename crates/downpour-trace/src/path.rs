//! Path of a ray of the camera: surfaces, water, and the light that comes to them from lamps, sky and one another. Twin of
//! `shaders/wgsl/render/path.wgsl`.
//!
//! Both sides trace the same rays through the same hierarchy and filter the same texels, so a machine without a driver
//! makes the same picture. For a ray:
//!
//! - the nearest surface; see-through ones are passed, at most twelve;
//! - the water of a puddle before it: what it mirrors, and what lies beneath, lit through the water
//!   ([`puddle`](crate::puddle));
//! - direct light: each lamp and the sun, with a ray that dims at see-through surfaces ([`scene`](crate::scene));
//! - light of the sky and of other surfaces: rays that are drawn for the diffuse base and for the gloss
//!   ([`scatter`](crate::scatter)). Such a ray finds the sky at the level of its own width, or a surface, which has light of
//!   its own: of one lamp drawn for all, and of the next ray. At most `PATH_BOUNCES` follow each other, and fewer where
//!   surfaces are dark: each survives with the probability of its albedo. The light that falls on the last surface is taken to
//!   be the mean of what the path has met, thrown back and forth.
//!
//! [`skylight`](crate::skylight) takes means of this light over neighboring pixels, but for that of mirrors.
//!
//! Surfaces that shine are lights ([`emitter`](crate::emitter)): rays see them in a gloss only, and the glass of a lamp in a sharp one
//! only, so that each is counted once.
//!
//! Limits: what a diffuse base finds reflects diffusely, by as much as its gloss and its base do (no caustics); rays that look
//! for light do not see the water of puddles.

mod draw;
mod plan;

use downpour_math::ops;
use downpour_render::light::light_weight;
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::path::{
    PATH_BETWEEN, PATH_BOUNCES, PATH_CANDIDATES, PATH_CURVED, PATH_CURVED_FRACTION, PATH_CURVED_PART,
    PATH_LATER_FRACTION, PATH_MIN_FACTOR, PATH_MIRROR_LAMPS, PATH_OCCLUSION, PATH_OPEN, PATH_OTHER,
    PATH_PLAIN_GLOSS, PATH_SAME_FACET, PATH_SAME_PLANE, PATH_SECONDARY_ROUGHNESS,
};
use downpour_shaders::render::puddle_water::{
    PUDDLE_WATER_DOWN, PUDDLE_WATER_INDEX, PUDDLE_WATER_MATERIAL, PUDDLE_WATER_RIPPLED,
};
use downpour_shaders::render::scene::{
    SCENE_ALL_OUT, SCENE_FAR, SCENE_LAMP_GLASS, SCENE_LAYERS, SCENE_NONE, SCENE_PICTURE, SCENE_SEEN_AREA,
    SCENE_SEEN_BODY, SCENE_UNLIT, SKYLIGHT_SLACK, TEXTURE_TAPS,
};
use downpour_shaders::render::translucent::TRANSLUCENT_SIDE;
use downpour_shaders::render::wet::WET_FAR;
use glam::{Vec2, Vec3};

use crate::brdf::brdf_fresnel;
use crate::glazing::{glazing_open, glazing_surface, glazing_through};
use crate::scatter::{ScatterRay, scatter_chance, scatter_draw, scatter_mirror};
use crate::scene::water::{PuddleWater, puddle_water_above, puddle_water_refracted};
use crate::scene::{SceneAsked, SceneView};
use crate::surface::Surface;
use crate::translucent::{
    translucent_behind, translucent_chance, translucent_drawn, translucent_is, translucent_part,
};
use crate::wet::{wet_relief, wet_surface};
pub use downpour_render::path_lattice::{path_lattice_numbers, path_lattice_words};
pub use draw::path_water_rays;
use draw::{path_onward, path_replaced, path_water_fraction, path_water_ray};
pub(crate) use plan::path_max;
use plan::{
    PathPlan, path_albedo, path_ambient, path_cover, path_matte, path_open, path_submerged,
    path_water_surface,
};

/// Result of tracing a ray of the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewPath {
    /// All light except what the fields below hold.
    pub(crate) radiance: Vec3,
    /// Distance of the first surface (`SCENE_FAR` for the sky).
    pub(crate) distance: f32,
    pub(crate) facet: Vec3,
    pub(crate) material: u32,
    pub(crate) position: Vec3,
    /// True if it is the same surface that the sample before has seen.
    pub(crate) again: bool,
    /// True if it looks the same all over a pixel: no mirror, nothing behind a pane.
    pub(crate) plain: bool,
    /// Light of sky and surfaces on the diffuse base of the first opaque surface, over pi.
    pub(crate) base: PathSlot,
    /// Light that the first gloss or mirror shows: of a mirror, on the diffuse base of what stands in it.
    pub(crate) mirror: PathSlot,
}

/// Light of which means are taken over neighboring pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathSlot {
    pub(crate) light: Vec3,
    /// Largest distance of another position from the plane of this one; 0: there is no light.
    pub(crate) slack: f32,
    /// Factor of the light.
    pub(crate) factor: Vec3,
    /// Roughness of a gloss; 0 for light on a diffuse base.
    pub(crate) roughness: f32,
    /// The surface's normal; of a gloss, the direction that a mirror would show.
    pub(crate) normal: Vec3,
    /// True if no ray has looked for the light: it is that of the open sky.
    pub(crate) guessed: bool,
    pub(crate) position: Vec3,
}

impl PathSlot {
    /// No light.
    pub(crate) const NONE: Self = Self {
        light: Vec3::ZERO,
        slack: 0.0,
        factor: Vec3::ZERO,
        roughness: 0.0,
        normal: Vec3::ZERO,
        guessed: false,
        position: Vec3::ZERO,
    };
}

impl ViewPath {
    /// A path that has found nothing.
    pub(crate) const NOTHING: Self = Self {
        radiance: Vec3::ZERO,
        distance: SCENE_FAR,
        facet: Vec3::ZERO,
        material: SCENE_NONE,
        position: Vec3::ZERO,
        again: false,
        plain: false,
        base: PathSlot::NONE,
        mirror: PathSlot::NONE,
    };

    /// All that a path has seen.
    pub(crate) fn path_radiance(&self) -> Vec3 {
        self.radiance + self.base.factor * self.base.light + self.mirror.factor * self.mirror.light
    }
}

/// Light that rays have found for a surface.
#[derive(Clone, Copy, Debug)]
struct PathLight {
    /// On its diffuse base, over pi.
    base: Vec3,
    /// In its gloss.
    mirror: Vec3,
    /// On the diffuse base of what a mirror shows.
    shown: Vec3,
    /// Factor of that light, its distance, and where it is.
    factor: Vec3,
    distance: f32,
    normal: Vec3,
    position: Vec3,
}

impl PathLight {
    const NONE: Self = Self {
        base: Vec3::ZERO,
        mirror: Vec3::ZERO,
        shown: Vec3::ZERO,
        factor: Vec3::ZERO,
        distance: -1.0,
        normal: Vec3::ZERO,
        position: Vec3::ZERO,
    };

    /// With what a ray brings: `of_shown` for the diffuse base of what a mirror shows.
    fn path_accumulated(self, ray: &ScatterRay, radiance: Vec3, of_shown: bool) -> Self {
        let of_base = ray.diffuse * radiance;
        Self {
            base: if of_shown { self.base } else { self.base + of_base },
            shown: if of_shown { self.shown + of_base } else { self.shown },
            mirror: self.mirror + ray.mirror * radiance,
            ..self
        }
    }
}

/// Water that a ray has come through.
#[derive(Clone, Copy, Debug)]
struct PathWater {
    /// The water that was found.
    found: PuddleWater,
    /// Slopes of its surface, and their variance.
    ripple: Vec3,
    /// Height of its surface.
    level: f32,
    /// Fraction of the light of what lies beneath that it lets through.
    clear: f32,
    /// Albedo of the water itself.
    scattering_albedo: Vec3,
}

/// A surface that a ray of the camera has met.
#[derive(Clone, Copy, Debug)]
struct PathMeeting {
    surface: Surface,
    direct: Vec3,
    /// Light of surfaces that shine, and of lamps with soft shadows, on its diffuse base, over pi.
    glow: Vec3,
    /// Light of the latter that its gloss shows, and of the former where it is wide.
    sheen: Vec3,
    /// Part of that light that the relief of the surface leaves.
    relief: f32,
    /// True if a lamp is hidden in part.
    is_soft: bool,
    plan: PathPlan,
    /// True if its light is averaged over neighboring pixels.
    told: bool,
    /// Largest distance from its plane at which the surface of a neighboring pixel may be.
    slack: f32,
}

/// Way a ray leaves the surface that it has met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PathLeave {
    /// It is the first, and looks for the light of the surface that the ray of the camera has met.
    First,
    /// Through it.
    Straight,
    /// Mirrored by a metal in a mirror.
    Mirror,
    /// From what a mirror shows.
    Shown,
    /// As chance has it.
    Onward,
}

/// True if a surface is the same as the one that another sample of the pixel has met.
fn path_same_surface(last: &ViewPath, material: u32, facet: Vec3, position: Vec3, distance: f32) -> bool {
    last.plain
        && last.material == material
        && last.facet.dot(facet) > PATH_SAME_FACET
        && last.facet.dot(position - last.position).abs() < PATH_SAME_PLANE * distance
}

/// The direction that a mirror in the plane of a surface would show.
fn path_mirrored(surface: &Surface, towards: Vec3) -> Vec3 {
    towards - surface.normal * (2.0 * towards.dot(surface.normal))
}

impl SceneView<'_> {
    /// Traces a ray of the camera. If it meets the surface that `last` met, it sees the same. `spared`: light of which means are taken
    /// over neighboring pixels is left to their rays.
    pub(crate) fn path_trace(
        &self,
        origin: Vec3,
        direction: Vec3,
        cone: f32,
        random: [u32; 4],
        last: &ViewPath,
        spared: bool,
    ) -> ViewPath {
        let (frame, data) = (self.frame, self.data);
        let mut path = ViewPath::NOTHING;
        let mut throughput = Vec3::ONE;
        let (mut start, mut towards, mut near) = (origin, direction, frame.nearest);
        // Water that the ray has come through, and whether it has met nothing since.
        let mut water: Option<PathWater> = None;
        let mut under = false;
        let wet = (frame.wetness > 0).then(|| data.wet_load());
        // Widened by drops on panes.
        let mut width = cone;
        for layer in 0..SCENE_LAYERS {
            let Some(hit) = data.surface_hit(start, towards, near, BVH_FAR) else {
                let is_wide = width > cone;
                let beyond = if is_wide {
                    data.sky_cone(towards, width)
                } else {
                    data.sky_level(0, towards) + self.scene_suns(towards)
                };
                path.radiance += throughput * beyond;
                return path;
            };
            let mut material = data.corners[hit.triangle as usize * 3].material;
            let (facet, position) = (data.surface_facet(&hit, towards), start + towards * hit.distance);
            let met = match water {
                None => self.puddle_water_find(position, facet.y),
                Some(_) => None,
            };
            if layer == 0 && met.is_none() && path_same_surface(last, material, facet, position, hit.distance)
            {
                return ViewPath { again: true, ..*last };
            }
            let mut found = data.surface_at(&hit, start, towards, width, TEXTURE_TAPS);
            if let (false, Some(wet)) = (under, &wet) {
                let wetness = self.wet_exposure(&found, wet);
                if wetness > 0.0 {
                    let footprint = width * hit.distance / (-found.facet.dot(towards)).max(0.02).sqrt();
                    let relief = wet_relief(found.position + wet.shift, footprint);
                    found = wet_surface(&found, wetness, towards, &relief);
                }
            }
            let mut drop = None;
            let is_glazed = frame.glazing > 0 && !under && frame.projection == SCENE_PICTURE;
            if let (true, Some(wet)) = (is_glazed, &wet) {
                let footprint = width * hit.distance / (-found.facet.dot(towards)).max(0.1);
                let water = self.glazing_find(&found, material, footprint, wet);
                found = glazing_surface(&found, &water);
                drop = Some(water).filter(|water| water.bend > 0.0);
            }
            let mut distance = hit.distance;
            let mut depth = Vec2::ZERO;
            if let Some(met) = met {
                // Back along the ray to where it came through the surface.
                distance = (hit.distance - met.rise / (-towards.y).max(0.01)).max(near);
                let position = start + towards * distance;
                let footprint = cone * distance / (-towards.y).max(0.02).sqrt();
                let ripple = self.puddle_water_ripple(met.puddle, position, footprint, met.depth, met.open)
                    + self.data.puddle_wake_slope(met.puddle, position, footprint, met.depth);
                found = path_water_surface(start, towards, distance, ripple);
                material = PUDDLE_WATER_MATERIAL;
                water = Some(PathWater {
                    found: met,
                    ripple,
                    level: position.y,
                    clear: 1.0,
                    scattering_albedo: Vec3::ZERO,
                });
            }
            if let (true, Some(water)) = (under, &water) {
                let rise = (water.level - found.position.y).max(0.0);
                depth = Vec2::new(rise + (water.found.depth - water.found.rise).max(0.0), rise);
                found = path_submerged(&found, water.clear, water.scattering_albedo);
            }
            if layer == 0 {
                path.distance = distance;
                path.material = material;
                path.facet = found.facet;
                path.position = found.position;
            }
            let is_shown = frame.impostors > 0 && !under && frame.projection == SCENE_PICTURE;
            if let (true, Some(_), Some(water)) = (is_shown, met, &water) {
                let fraction = path_water_fraction(water.ripple, -towards);
                path.radiance +=
                    throughput * self.impostor_mirrored(found.facet, found.normal, towards) * fraction;
                found.flags |= SCENE_UNLIT;
            } else if is_shown && found.film > 0.0 && found.porosity > 0.0 {
                // What is smooth shows its own rays, as it does when it is dry.
                let gloss = self.path_gloss(&found, (-found.normal.dot(towards)).max(0.0));
                path.radiance +=
                    throughput * self.impostor_mirrored(found.facet, found.normal, towards) * gloss;
                found = path_matte(&found, gloss);
            }
            near = hit.distance + frame.nearest;
            let told = path.base.slack == 0.0 && path_cover(&found) == 1.0 && found.transmission == 0.0;
            let unlit = found.flags & SCENE_UNLIT != 0;
            let (mut direct, mut glow, mut is_soft, mut relief) = (found.diffuse, Vec3::ZERO, false, 1.0);
            let mut sheen = Vec3::ZERO;
            if !unlit {
                let is_lamp = found.flags & SCENE_LAMP_GLASS != 0;
                // Drops are lit by lamps on their own.
                let all_out = frame.suns_out == SCENE_ALL_OUT;
                let left_out =
                    (is_lamp || all_out) && frame.projection != SCENE_PICTURE && frame.suns_out > 0;
                // The lattice has few points along its third axis: each pixel is somewhere between them.
                // Of lamps no means over neighbors are taken, where a lattice would be seen.
                let [x, y, z, w] = path_lattice_numbers(random, 0, 0, 0, 1);
                let numbers = [x, y, (w + z * PATH_BETWEEN).fract(), z];
                let footprint = Some(cone * hit.distance);
                let spared = spared && told;
                let asked = SceneAsked { draws: 0, numbers, standoff: 0.0, under: depth, footprint, spared };
                let lamplight = self.scene_direct(&found, -towards, &asked);
                direct = if left_out { Vec3::ZERO } else { found.emission } + lamplight.lit;
                // What is told apart goes with the rest of the light on the diffuse base, which has the material's occlusion.
                (glow, is_soft) = (lamplight.glow / found.occlusion.max(PATH_OCCLUSION), lamplight.is_soft);
                sheen = lamplight.sheen;
                let rest = light_weight(data.sky_irradiance(found.normal)).max(1.0e-9);
                relief = (rest + lamplight.relief_light) / (rest + lamplight.flat_light);
            }
            let free = path.mirror.slack == 0.0;
            let mut plan = PathPlan::NONE;
            if let (Some(_), Some(water), false) = (met, &water, unlit) {
                let rippled = water.ripple.z > PUDDLE_WATER_RIPPLED;
                let mirrors = path_water_rays(frame.sky_rays, frame.ray_spacing, rippled);
                let (drawn, replaced) = (rippled && free, !rippled && free);
                plan = PathPlan {
                    mirrors,
                    gloss: Vec3::ONE,
                    fraction: 1.0,
                    drawn,
                    kept: drawn,
                    replaced,
                    ..plan
                };
            } else if !unlit {
                plan = self.path_plan(&found, -towards, cone * hit.distance, told, free && !under);
                if spared && told && frame.sky_rays > 0 {
                    plan = plan.path_spared();
                }
            }
            plan.shown_spared = spared && plan.replaced && frame.sky_rays > 0;
            // Neighboring pixels are on one plane if they are no farther from it than this.
            let from_eye = found.position - origin;
            let slack = from_eye.dot(from_eye).sqrt() * (cone * 2.0 + SKYLIGHT_SLACK);
            let ripple = if met.is_some() { water.map(|water| water.ripple) } else { None };
            let meeting =
                PathMeeting { surface: found, direct, glow, sheen, relief, is_soft, plan, told, slack };
            let light = self.path_light(&meeting, towards, cone, random, ripple, under);
            if let (Some(_), Some(water)) = (met, &mut water) {
                let fraction = path_water_fraction(water.ripple, -towards);
                path.path_show_water(&meeting, &light, fraction, towards, throughput);
                throughput *= 1.0 - fraction;
                // On beneath the surface. Ground that the model does not have is where it would be, seen in the model.
                let puddle = data.puddle_load(water.found.puddle);
                towards = puddle_water_refracted(towards, found.normal);
                let steep = (-towards.y).max(0.1);
                water.scattering_albedo = puddle.scattering_albedo;
                water.clear =
                    ops::exp(-puddle.extinction * water.found.depth * (1.0 / steep + PUDDLE_WATER_DOWN));
                let aside = (water.found.depth - water.found.rise).max(0.0) / steep;
                start = found.position + Vec3::new(towards.x * aside, 0.0, towards.z * aside)
                    - towards * (4.0 * frame.nearest);
                near = frame.nearest;
                under = true;
                continue;
            }
            self.path_show(&mut path, &meeting, &light, towards, layer, throughput);
            under = false;
            let open = path_open(&found);
            throughput *= open;
            if let Some(drop) = drop {
                width *= 1.0 + (PUDDLE_WATER_INDEX - 1.0) * drop.bend * (near - frame.nearest);
                throughput *= glazing_open(&found, meeting.plan.gloss, towards, open);
                let facet = if found.facet.dot(drop.normal) > 0.0 { found.facet } else { -found.facet };
                towards = glazing_through(towards, drop.normal, facet);
                start = found.position;
                near = 4.0 * frame.nearest;
            }
            if path_max(throughput) < 1.0e-3 {
                return path;
            }
        }
        path
    }

    /// Light that rays find for a surface: turns 1 and on of the loop of `path_trace` in WGSL.
    fn path_light(
        &self,
        meeting: &PathMeeting,
        towards: Vec3,
        cone: f32,
        random: [u32; 4],
        ripple: Option<Vec3>,
        under: bool,
    ) -> PathLight {
        let (frame, data) = (self.frame, self.data);
        let plan = &meeting.plan;
        let mut light = PathLight::NONE;
        for turn in 1..=plan.mirrors + plan.rays {
            let (mut at, mut view) = (meeting.surface, -towards);
            let mut ray = ScatterRay::ALL;
            let (mut from, mut leaves, mut given) = (at.position, PathLeave::First, Vec3::ZERO);
            // Roughness of the gloss that the ray follows.
            let mut followed = 1.0f32;
            let is_mirror = turn <= plan.mirrors;
            let of_shown = plan.replaced && is_mirror;
            let (index, count) =
                if is_mirror { (turn - 1, plan.mirrors) } else { (turn - 1 - plan.mirrors, plan.rays) };
            for bounce in 0..PATH_BOUNCES {
                let numbers = path_lattice_numbers(random, turn, bounce, index, count);
                if leaves != PathLeave::Straight {
                    let mut next = match (leaves, ripple) {
                        (PathLeave::First, Some(ripple)) => {
                            path_water_ray(ripple, at.roughness, view, cone, numbers[0], numbers[1])
                        }
                        (PathLeave::First, None) if is_mirror && !plan.drawn => scatter_mirror(&at, view),
                        (PathLeave::Mirror, _) => scatter_mirror(&at, view),
                        _ => self.path_draw(&at, view, plan, leaves, is_mirror, numbers),
                    };
                    let behind = translucent_is(&at) && at.facet.dot(next.along) < 0.0;
                    from = at.position + at.facet * if behind { -frame.nearest } else { frame.nearest };
                    match leaves {
                        PathLeave::First => {
                            if under && is_mirror {
                                next.along = puddle_water_above(next.along);
                                next.mirror *= if next.along.y > 0.0 { 1.0 } else { 0.0 };
                            }
                            ray = next;
                            ray.width += cone + plan.spread;
                            followed = at.roughness;
                        }
                        PathLeave::Mirror => {
                            let cosine = at.normal.dot(view).max(0.0);
                            next.mirror = ray.mirror * brdf_fresnel(at.normal_reflectance, at.film, cosine);
                            next.width += ray.width;
                            ray = next;
                            followed = followed.max(at.roughness);
                        }
                        PathLeave::Shown => (ray, followed) = (path_replaced(&ray, &next), 1.0),
                        _ => (ray, followed) = (path_onward(&ray, &next, &at, numbers[2]), 1.0),
                    }
                    if path_max(ray.diffuse + ray.mirror) <= 0.0 {
                        break;
                    }
                }
                let Some(hit) = data.surface_hit(from, ray.along, frame.nearest, BVH_FAR) else {
                    let beyond = data.sky_cone(ray.along, ray.width);
                    light = light.path_accumulated(&ray, beyond, of_shown);
                    break;
                };
                let mut found = data.surface_at(&hit, from, ray.along, ray.width, 1.0);
                if frame.wetness > 0 && bounce == 0 && !under {
                    let wet = data.wet_load();
                    let wetness = self.wet_exposure(&found, &wet);
                    if wetness > 0.0 {
                        let relief = wet_relief(found.position + wet.shift, WET_FAR);
                        found = wet_surface(&found, wetness, ray.along, &relief);
                    }
                }
                let mut found = self.path_secondary(&found, ray.along, ray.roughness);
                let mut seen_from = -ray.along;
                if translucent_is(&found) {
                    let facet = found.facet;
                    found = translucent_drawn(&found, (numbers[3] * TRANSLUCENT_SIDE).fract());
                    seen_from *= found.facet.dot(facet).signum();
                }
                let lamps = if ray.roughness < PATH_SECONDARY_ROUGHNESS { PATH_MIRROR_LAMPS } else { 1 };
                let standoff = hit.distance * ray.width * 0.5;
                // Surfaces that shine are lights: rays see them in a gloss only.
                let is_lamp = found.flags & SCENE_LAMP_GLASS != 0;
                if followed < if is_lamp { SCENE_SEEN_BODY } else { SCENE_SEEN_AREA } {
                    light.mirror += ray.mirror * found.emission * path_cover(&found);
                }
                let unlit = found.flags & SCENE_UNLIT != 0;
                let mut lit = found.diffuse;
                if !unlit {
                    let [x, y, z, w] = numbers;
                    let [x, y, z] = [x, y, z].map(|number| (number * PATH_OTHER).fract());
                    let asked = SceneAsked {
                        draws: lamps,
                        numbers: [x, y, z, w],
                        standoff,
                        under: Vec2::ZERO,
                        footprint: None,
                        spared: false,
                    };
                    lit = self.scene_direct(&found, seen_from, &asked).lit;
                }
                let cover = path_cover(&found);
                light = light.path_accumulated(&ray, lit * cover, of_shown);
                if unlit && cover == 1.0 {
                    break;
                }
                let open = path_open(&found);
                let mut ambient = Vec3::ZERO;
                leaves = PathLeave::Onward;
                if path_max(open) > PATH_OPEN {
                    leaves = PathLeave::Straight;
                    if !unlit {
                        // What it reflects of the sky itself: half of the whole.
                        ambient = data.sky_irradiance(found.normal) * (0.5 * found.occlusion * cover);
                    }
                } else if of_shown && light.distance < 0.0 {
                    leaves = PathLeave::Mirror;
                    if path_max(path_albedo(&found)) > 0.0 || found.roughness >= PATH_SECONDARY_ROUGHNESS {
                        leaves = PathLeave::Shown;
                        found = self.path_secondary(&found, ray.along, 1.0);
                        light.factor = ray.mirror * path_albedo(&found);
                        light.distance = hit.distance;
                        light.normal = found.normal;
                        light.position = found.position;
                        if plan.shown_spared {
                            light.shown = data.sky_irradiance(found.normal);
                            break;
                        }
                    }
                } else if bounce + 1 == PATH_BOUNCES {
                    ambient = path_ambient(&found, (given + lit) / (bounce + 1) as f32);
                }
                let own = (path_albedo(&found) + found.normal_reflectance) * ambient;
                light = light.path_accumulated(&ray, own, of_shown);
                given += lit;
                if leaves == PathLeave::Straight {
                    ray.diffuse *= open;
                    ray.mirror *= open;
                    from = found.position;
                }
                (at, view) = (found, seen_from);
            }
        }
        light
    }

    /// A ray drawn for a surface.
    fn path_draw(
        &self,
        at: &Surface,
        view: Vec3,
        plan: &PathPlan,
        leaves: PathLeave,
        is_mirror: bool,
        numbers: [f32; 4],
    ) -> ScatterRay {
        let [mut a, mut b, number, other] = numbers;
        let (mut at, mut view) = (*at, view);
        // Factors of the light on the diffuse base, and in the gloss.
        let (mut of_side, mut of_gloss) = (Vec3::ONE, 1.0);
        let mut gloss = Vec3::ONE;
        let mut chance = scatter_chance(at.diffuse, at.normal_reflectance);
        let (mut fraction, mut weight) = (PATH_LATER_FRACTION, 1.0);
        if leaves == PathLeave::Shown {
            chance = 0.0;
        }
        if leaves == PathLeave::First {
            gloss = plan.gloss;
            chance = if is_mirror { 1.0 } else { plan.chance };
            fraction = plan.fraction;
            if translucent_is(&at) && !is_mirror {
                // One side is drawn, with the gloss for the viewer's.
                let behind = (1.0 - chance) * translucent_chance(&at);
                let part = translucent_part(&at);
                if (other * PATH_OTHER).fract() < behind {
                    of_side = part / behind;
                    (at, view, chance) = (translucent_behind(&at), -view, 0.0);
                } else {
                    of_side = (Vec3::ONE - part) / (1.0 - behind);
                    of_gloss = 1.0 / (1.0 - behind);
                    chance *= of_gloss;
                }
            }
            if is_mirror && !plan.kept {
                // Few rays: far out in the lobe they would be noise.
                (fraction, a) = (PATH_CURVED_FRACTION, a * PATH_CURVED_PART);
            }
            if a >= chance {
                let own = (a - chance) / (1.0 - chance);
                let (numbers, factor) = self.path_candidate(&at, own, b, number, fraction);
                (a, b, weight) = (chance + numbers.x * (1.0 - chance), numbers.y, factor);
                fraction /= PATH_CANDIDATES as f32;
            }
        }
        let mut ray = scatter_draw(self.data, &at, view, gloss, chance, [a, b], fraction);
        ray.diffuse *= of_side * weight;
        ray.mirror *= of_gloss * weight;
        ray
    }

    /// Adds what a surface shows to a path.
    fn path_show(
        &self,
        path: &mut ViewPath,
        meeting: &PathMeeting,
        light: &PathLight,
        towards: Vec3,
        layer: u32,
        throughput: Vec3,
    ) {
        let PathMeeting { surface, direct, glow, sheen, relief, is_soft, mut plan, told, slack } = *meeting;
        let cover = path_cover(&surface);
        path.radiance += throughput * direct * cover;
        if surface.flags & SCENE_UNLIT != 0 {
            return;
        }
        let mirrored = path_mirrored(&surface, towards);
        let of_gloss = if plan.chance > 0.0 { plan.rays } else { plan.mirrors };
        let mut base = light.base / plan.rays.max(1) as f32 + glow;
        let mut mirror = light.mirror / of_gloss.max(1) as f32;
        let in_mirror = || self.data.sky_cone(mirrored, scatter_mirror(&surface, -towards).width);
        if plan.spared {
            base = self.data.translucent_sky(&surface) + glow;
            if plan.kept {
                mirror = in_mirror();
            }
        }
        if plan.mirrors + plan.rays == 0 && !plan.spared {
            base = self.data.translucent_sky(&surface) * (Vec3::ONE - plan.gloss) + glow;
            mirror = in_mirror();
        } else if plan.mirrors == 0 && plan.chance == 0.0 && !(plan.spared && plan.kept) {
            // Too faint to trace rays for it.
            base -= glow * plan.gloss / (plan.body + plan.gloss).max(Vec3::splat(1.0e-9));
            plan.body += plan.gloss;
            plan.gloss = Vec3::ZERO;
        }
        let is_faint = path_max(plan.gloss) <= 0.0;
        if plan.kept && plan.gloss.min_element() > PATH_MIN_FACTOR {
            mirror += sheen / plan.gloss;
        } else if told && is_faint && plan.body.min_element() * relief > PATH_MIN_FACTOR {
            base += sheen / (plan.body * relief);
        } else {
            path.radiance += throughput * sheen * cover;
        }
        let of_base = throughput * plan.body * (cover * relief);
        let of_gloss = throughput * plan.gloss * cover;
        let slot = PathSlot { slack, position: surface.position, guessed: plan.spared, ..PathSlot::NONE };
        if told {
            path.base = PathSlot { light: base, factor: of_base, normal: surface.normal, ..slot };
            let mirrors = (plan.mirrors > 0 || plan.spared && path_max(plan.body) <= 0.0)
                && (surface.roughness < PATH_CURVED || !plan.kept)
                && path_max(plan.gloss) > PATH_PLAIN_GLOSS;
            path.plain = !(mirrors || layer > 0 || is_soft);
        } else {
            path.radiance += of_base * base;
        }
        if plan.kept {
            let roughness = surface.roughness;
            path.mirror = PathSlot { light: mirror, factor: of_gloss, roughness, normal: mirrored, ..slot };
        } else {
            path.radiance += of_gloss * mirror;
            path.path_show_mirrored(light, of_gloss, meeting);
        }
    }
}

impl ViewPath {
    /// Adds the light on what a mirror shows.
    fn path_show_mirrored(&mut self, light: &PathLight, gloss: Vec3, meeting: &PathMeeting) {
        if light.distance < 0.0 {
            return;
        }
        self.mirror = PathSlot {
            light: light.shown,
            factor: gloss * light.factor,
            slack: meeting.slack + light.distance * (2.0 * meeting.plan.spread + SKYLIGHT_SLACK),
            roughness: 0.0,
            normal: light.normal,
            guessed: meeting.plan.shown_spared,
            position: light.position,
        };
    }

    /// Adds what water mirrors, which is a fraction of the light.
    fn path_show_water(
        &mut self,
        meeting: &PathMeeting,
        light: &PathLight,
        fraction: f32,
        towards: Vec3,
        throughput: Vec3,
    ) {
        let surface = &meeting.surface;
        let all = meeting.plan.mirrors.max(1) as f32;
        self.radiance += throughput * (meeting.direct + meeting.sheen);
        if meeting.plan.kept {
            self.mirror = PathSlot {
                light: light.mirror / (all * fraction).max(1.0e-6),
                factor: throughput * fraction,
                slack: meeting.slack,
                roughness: surface.roughness,
                normal: path_mirrored(surface, towards),
                guessed: false,
                position: surface.position,
            };
        } else {
            self.radiance += throughput * light.mirror / all;
            self.path_show_mirrored(light, throughput / all, meeting);
        }
    }
}
