//! What a ray sees of a scene: light of lamps and sun with shadow rays, light of the sky with rays that find what hides
//! it.
//!
//! Twin of `shaders/wgsl/render/scene.wgsl`. Both sides trace the same rays through the same hierarchy and filter
//! the same texels, so a machine without a driver makes the same picture. For a ray:
//!
//! - the nearest surface; see-through ones are passed, at most twelve;
//! - direct light: each lamp and the sun, with a ray that dims at see-through surfaces ([`brdf`](crate::brdf));
//! - light of the sky: cosine-weighted rays; one that is stopped brings the light of what it meets, lit by one lamp drawn
//!   for all and by half of the sky's irradiance, so that a shadow is not black;
//! - reflection of the sky, prefiltered by roughness, where it is not hidden.
//!
//! Limits: one bounce; reflections show the sky, not the scene.

use downpour_math::ops;
use downpour_math::packing::packing_sign;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_FAR, SCENE_GLANCE_CONE, SCENE_GLANCE_NEAREST, SCENE_LATTICE_SCATTER,
    SCENE_LATTICE_SECOND, SCENE_LATTICE_THIRD, SCENE_LAYERS, SCENE_LEAST_LAMP, SCENE_LEAST_ROUGHNESS,
    SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_ROWS, SCENE_MATERIAL_ROWS, SCENE_NONE, SCENE_RANDOM_DIMENSION,
    SCENE_SAME_FACET, SCENE_SAME_PLANE, SCENE_SKY_LEVELS, SCENE_UNLIT, SKYLIGHT_RADIUS,
};
use glam::{Vec3, Vec4};

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
            sum += lit * visible * if all { 1.0 } else { total / share };
        }
        sum
    }

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
        for layer in 0..SCENE_LAYERS {
            let Some(hit) = data.surface_hit(origin, direction, from_distance, BVH_FAR) else {
                path.radiance += throughput * data.sky_level(0, direction);
                return path;
            };
            let surface = data.surface_at(&hit, origin, direction, cone);
            let material = data.corners[hit.triangle as usize * 3].material;
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
                    let mut found = self.data.surface_at(&hit, start, along, SCENE_GLANCE_CONE);
                    // The mirror image of a lamp, met by chance, would be noise.
                    found.roughness = 1.0;
                    let mut lit = found.diffuse + found.normal_reflectance;
                    if found.flags & SCENE_UNLIT == 0 {
                        let chance = rng_unit(random[2].wrapping_add((k + 1).wrapping_mul(2_654_435_769)));
                        // What it has of the sky itself: half of the whole.
                        let own = self.data.sky_irradiance(found.normal) * (0.5 * found.occlusion);
                        // Where there are lamps, they stand for what shines; small bright things would be noise.
                        let shines = self.frame.light_count == 0;
                        let emission = if shines { found.emission } else { Vec3::ZERO };
                        lit = emission + self.scene_direct(&found, -along, false, chance) + lit * own;
                    }
                    // What a see-through surface lets pass comes from the sky behind it.
                    let blended = found.flags & SCENE_BLENDED != 0;
                    let share = if blended { found.alpha.clamp(0.0, 1.0) } else { 1.0 };
                    sum += lit * share + self.data.sky_level(SCENE_SKY_LEVELS - 1, along) * (1.0 - share);
                    seen += 1.0 - share;
                }
            }
        }
        sum.extend(seen) / rays as f32
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

/// What a colour weighs when lamps are compared.
pub(crate) fn scene_share(colour: Vec3) -> f32 {
    colour.x + colour.y + colour.z
}

/// Whether a surface goes on where another sample of the pixel has met it.
fn scene_goes_on(last: &ScenePath, material: u32, facet: Vec3, place: Vec3, distance: f32) -> bool {
    last.met > 0.0
        && last.material == material
        && last.facet.dot(facet) > SCENE_SAME_FACET
        && last.facet.dot(place - last.place).abs() < SCENE_SAME_PLANE * distance
}

/// Numbers for the rays of sample k of a pixel, as words. The pixels of any window of the filter's size have all the
/// points of one lattice of rank 1 among them, each once: their mean has no pattern.
#[must_use]
pub fn scene_lattice(seed: u32, x: u32, y: u32, k: u32) -> [u32; 4] {
    let seed = rng_draw([seed, 0], k, 0, SCENE_RANDOM_DIMENSION);
    let edge = 2 * SKYLIGHT_RADIUS + 1;
    let points = edge * edge;
    // Scattered, so that a part of the window has points from everywhere.
    let index = ((x % edge) * edge + y % edge) * SCENE_LATTICE_SCATTER % points;
    let step = u32::MAX / points;
    [
        (index * step).wrapping_add(seed[0]),
        (index * SCENE_LATTICE_SECOND % points * step).wrapping_add(seed[1]),
        (index * SCENE_LATTICE_THIRD % points * step).wrapping_add(seed[2]),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_window_has_every_point_of_the_lattice_once() {
        let edge = 2 * SKYLIGHT_RADIUS + 1;
        for (left, top) in [(0, 0), (3, 5), (1000, 77)] {
            for number in 0..3 {
                let mut words: Vec<u32> = (0..edge * edge)
                    .map(|i| scene_lattice(9, left + i % edge, top + i / edge, 2)[number])
                    .collect();
                words.sort_unstable();
                let step = u32::MAX / (edge * edge);
                let gaps = words.windows(2).map(|w| w[1] - w[0]);
                assert!(gaps.clone().min() >= Some(step), "{number}");
                assert!(gaps.max() <= Some(step + edge * edge), "{number}");
            }
        }
    }
}
