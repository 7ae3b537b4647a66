//! The picture of a scene: rays from the eye, light of lamps and sun with shadow rays, light of the sky with rays
//! that find what hides it.
//!
//! Twin of `shaders/wgsl/render/scene.wgsl`. Both sides trace the same rays through the same hierarchy and filter
//! the same texels, so a machine without a driver makes the same picture. Per sample of a pixel:
//!
//! - the nearest surface; see-through ones are passed, at most twelve;
//! - direct light: each lamp and the sun, with a ray that dims at see-through surfaces ([`brdf`](crate::brdf));
//! - light of the sky: cosine-weighted rays; one that is stopped brings the light of what it meets, lit by one lamp drawn
//!   for all and by half of the sky's irradiance, so that a shadow is not black; [`skylight`](crate::skylight) takes
//!   means of what neighbouring pixels have found;
//! - reflection of the sky, prefiltered by roughness, where it is not hidden.
//!
//! Samples of a pixel that meet one surface are shaded once.
//!
//! Limits: one bounce; reflections show the sky, not the scene.

use downpour_math::ops;
use downpour_math::packing::{packing_octahedral_encode, packing_pack_snorm, packing_sign};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::mask::MASK_BVH_FAR;
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_FAR, SCENE_GLANCE_CONE, SCENE_LAYERS, SCENE_LEAST_LAMP, SCENE_LEAST_ROUGHNESS,
    SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS, SCENE_MATERIAL_ROWS, SCENE_NONE, SCENE_RANDOM_DIMENSION,
    SCENE_SAME_FACET, SCENE_SAME_PLANE, SCENE_SKY_LEVELS, SCENE_UNLIT,
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::brdf::{brdf_direct, brdf_environment};
use crate::data::{RenderFrame, SceneData};
use crate::surface::Surface;

/// A lamp as a surface sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneLight {
    pub(crate) direction: Vec3,
    pub(crate) distance: f32,
    pub(crate) irradiance: Vec3,
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
    pub(crate) fn scene_light(&self, index: u32, place: Vec3) -> SceneLight {
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
    fn scene_direct(&self, surface: &Surface, view: Vec3, all: bool, chance: f32) -> Vec3 {
        let start = surface.position + surface.facet * self.frame.nearest;
        let count = self.frame.light_count;
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        let (mut rest, mut chosen) = (chance, count);
        // Once for what each would give, and to draw one; then the rays.
        for k in 0..count {
            let light = self.scene_light(k, surface.position);
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
            let light = self.scene_light(k, surface.position);
            let lit = self.scene_lamp(surface, view, &light);
            let share = scene_share(lit);
            if share <= total * SCENE_LEAST_LAMP {
                continue;
            }
            let visible = self.scene_visibility(start, light.direction, light.distance);
            sum += lit * visible * if all { 1.0 } else { total / share };
        }
        sum
    }

    /// What a ray sees. Where it meets the surface that `last` met, it sees the same.
    fn scene_path(
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
        for layer in 0..SCENE_LAYERS {
            let Some(hit) = data.surface_hit(origin, direction, from_distance, MASK_BVH_FAR) else {
                path.radiance += throughput * data.sky_level(0, direction);
                return path;
            };
            let surface = data.surface_at(&hit, origin, direction, cone);
            let material = data.corners[hit.triangle as usize * 3].material;
            if layer == 0 {
                if scene_goes_on(last, material, surface.facet, surface.position, hit.distance) {
                    return *last;
                }
                path.distance = hit.distance;
                path.material = material;
                path.facet = surface.facet;
                path.place = surface.position;
                path.normal = surface.normal;
            }
            let unlit = surface.flags & SCENE_UNLIT != 0;
            let mut direct = surface.diffuse + surface.normal_reflectance;
            let mut sky = Vec4::ZERO;
            if !unlit {
                let chance = rng_unit(random[2]);
                direct = surface.emission + self.scene_direct(&surface, -direction, true, chance);
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
                let cosine = surface.normal.dot(-direction).max(0.0);
                let mirrored = direction - surface.normal * (2.0 * direction.dot(surface.normal));
                let gloss = brdf_environment(surface.normal_reflectance, surface.roughness, cosine);
                let reflection = gloss * data.sky_reflection(mirrored, surface.roughness) * surface.occlusion;
                let body =
                    surface.diffuse * (1.0 - surface.transmission) * (Vec3::ONE - gloss) * surface.occlusion;
                // Where the sky is hidden, so is most of its reflection.
                path.radiance += throughput * share * (direct + reflection * 0.1);
                if layer == 0 && share == 1.0 && surface.transmission == 0.0 {
                    path.body = body;
                    path.gloss = reflection * 0.9;
                    path.sky = sky;
                    path.met = 1.0;
                } else {
                    let open = 0.9 * sky.w * sky.w;
                    path.radiance += throughput * share * (body * sky.truncate() + reflection * open);
                }
            }
            throughput *= tint * (1.0 - share) + surface.diffuse * surface.transmission * share;
            if throughput.max_element() < 1.0e-3 {
                break;
            }
            from_distance = hit.distance + frame.nearest;
        }
        path
    }

    /// Light of the sky on a surface over pi, and, in w, the share of the sky that is seen: turns 1 and on of the loop of
    /// `scene_path` in WGSL.
    fn scene_sky_light(&self, surface: &Surface, random: [u32; 4]) -> Vec4 {
        let rays = self.frame.sky_rays;
        if rays == 0 {
            return self.data.sky_irradiance(surface.normal).extend(1.0);
        }
        let nearest = self.frame.nearest;
        let start = surface.position + surface.facet * nearest;
        let (mut sum, mut seen) = (Vec3::ZERO, 0.0);
        for k in 0..rays {
            let along = scene_hemisphere(surface.normal, k, rays, random);
            if along.dot(surface.facet) <= 0.0 {
                continue;
            }
            match self.data.surface_hit(start, along, nearest, self.frame.sky_reach) {
                None => {
                    sum += self.data.sky_level(SCENE_SKY_LEVELS - 1, along);
                    seen += 1.0;
                }
                Some(hit) => {
                    let found = self.data.surface_at(&hit, start, along, SCENE_GLANCE_CONE);
                    let colour = found.diffuse + found.normal_reflectance;
                    if found.flags & SCENE_UNLIT != 0 {
                        sum += colour;
                        continue;
                    }
                    let chance = rng_unit(random[2].wrapping_add((k + 1).wrapping_mul(2_654_435_769)));
                    // What it has of the sky itself: half of the whole.
                    let own = self.data.sky_irradiance(found.normal) * (0.5 * found.occlusion);
                    sum += found.emission + self.scene_direct(&found, -along, false, chance) + colour * own;
                }
            }
        }
        sum.extend(seen) / rays as f32
    }

    /// What a ray sees, and the distance of the first surface (`SCENE_FAR` for the sky). `cone` is the width of the ray
    /// at distance 1.
    #[must_use]
    pub fn scene_radiance(&self, origin: Vec3, direction: Vec3, cone: f32, random: [u32; 4]) -> Vec4 {
        let path = self.scene_path(origin, direction, cone, random, &ScenePath::NOTHING);
        let open = path.sky.w * path.sky.w;
        (path.radiance + path.body * path.sky.truncate() + path.gloss * open).extend(path.distance)
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

    /// A pixel: mean radiance without the sky's light on surfaces, and the distance of what stands nearest in it; and
    /// what it has found of the sky's light.
    #[must_use]
    pub fn scene_pixel(&self, x: u32, y: u32) -> (Vec4, SceneGather) {
        let (mut sum, mut nearest) = (Vec3::ZERO, SCENE_FAR);
        let (mut body, mut gloss, mut normal) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        let (mut sky, mut met) = (Vec4::ZERO, 0.0);
        let n = self.frame.grid;
        let eye = Vec3::from(self.frame.eye);
        let mut last = ScenePath::NOTHING;
        for k in 0..n * n {
            let dx = ((k % n) as f32 + 0.5) / n as f32;
            let dy = ((k / n) as f32 + 0.5) / n as f32;
            let direction = self.scene_direction(x as f32 + dx, y as f32 + dy);
            let random = scene_lattice(self.frame.seed, x, y, k);
            last = self.scene_path(eye, direction, self.frame.pixel_angle, random, &last);
            sum += last.radiance;
            body += last.body;
            gloss += last.gloss;
            sky += last.sky * last.met;
            normal += last.normal * last.met;
            met += last.met;
            nearest = nearest.min(last.distance);
        }
        let share = 1.0 / (n * n) as f32;
        let gather = SceneGather {
            sky: (sky / met.max(1.0)).to_array(),
            body: (body * share).to_array(),
            met: met * share,
            gloss: (gloss * share).to_array(),
            normal: packing_pack_snorm(packing_octahedral_encode(normal.to_array())),
        };
        ((sum * share).extend(nearest), gather)
    }

    /// The whole picture, rows from the top, in parallel; the same bits for any number of threads.
    #[must_use]
    pub fn picture(&self) -> Vec<[f32; 4]> {
        let width = self.frame.width;
        let (mut picture, gather): (Vec<[f32; 4]>, Vec<SceneGather>) = (0..self.frame.height)
            .into_par_iter()
            .flat_map_iter(|y| {
                (0..width).map(move |x| {
                    let (pixel, gather) = self.scene_pixel(x, y);
                    (pixel.to_array(), gather)
                })
            })
            .unzip();
        let shown = self.skylight(&picture, &gather);
        for (pixel, shown) in picture.iter_mut().zip(shown) {
            for k in 0..3 {
                pixel[k] += shown[k];
            }
        }
        picture
    }
}

/// What a ray of the camera finds.
#[derive(Clone, Copy, Debug)]
struct ScenePath {
    /// All light but that of the sky on the first surface.
    radiance: Vec3,
    /// Distance of the first surface (`SCENE_FAR` for the sky).
    distance: f32,
    /// What the sky's light on the first surface is multiplied with.
    body: Vec3,
    /// 1 if there is a surface whose light of the sky is told apart.
    met: f32,
    /// What the square of the open share of the sky is multiplied with.
    gloss: Vec3,
    material: u32,
    /// Light of the sky over pi, and the share of the sky that is seen.
    sky: Vec4,
    normal: Vec3,
    facet: Vec3,
    place: Vec3,
}

impl ScenePath {
    /// A path that has found nothing.
    const NOTHING: Self = Self {
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
    };
}

/// What a pixel has found of the sky's light, for the filter. The same layout as `SceneGather` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SceneGather {
    /// Light of the sky over pi, and the share of the sky that is seen: means of the samples that have met a surface.
    pub sky: [f32; 4],
    /// What it is multiplied with.
    pub body: [f32; 3],
    /// Share of the samples that have met a surface.
    pub met: f32,
    /// What the square of the open share is multiplied with.
    pub gloss: [f32; 3],
    /// The normal, octahedral, 16 bits each.
    pub normal: u32,
}

/// What a colour weighs when lamps are compared.
fn scene_share(colour: Vec3) -> f32 {
    colour.x + colour.y + colour.z
}

/// Whether a surface goes on where another sample of the pixel has met it.
fn scene_goes_on(last: &ScenePath, material: u32, facet: Vec3, place: Vec3, distance: f32) -> bool {
    last.met > 0.0
        && last.material == material
        && last.facet.dot(facet) > SCENE_SAME_FACET
        && last.facet.dot(place - last.place).abs() < SCENE_SAME_PLANE * distance
}

/// Numbers for the rays of sample k of a pixel, as words: additive recurrences in x, y and k (the powers of the plastic
/// and the golden number), so that neighbours share the hemisphere among them.
#[must_use]
pub fn scene_lattice(seed: u32, x: u32, y: u32, k: u32) -> [u32; 4] {
    let seed = rng_draw([seed, 0], k, 0, SCENE_RANDOM_DIMENSION);
    let step =
        |a: u32, b: u32, start: u32| x.wrapping_mul(a).wrapping_add(y.wrapping_mul(b)).wrapping_add(start);
    [
        step(3_242_174_889, 2_447_445_414, seed[0]),
        step(2_700_274_807, 2_313_257_606, seed[1]),
        step(1_640_531_527, 3_510_702_301, seed[2]),
        seed[3],
    ]
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
