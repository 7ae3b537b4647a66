//! The light of the sky on a surface, by rays that find what hides it.

use downpour_math::ops;
use downpour_math::packing::packing_sign;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::render::scene::{
    SCENE_BLENDED, SCENE_GLANCE_CONE, SCENE_LATTICE_SCATTER, SCENE_LATTICE_SECOND, SCENE_LATTICE_THIRD,
    SCENE_RANDOM_DIMENSION, SCENE_SKY_LEVELS, SCENE_UNLIT, SKYLIGHT_RADIUS,
};
use glam::{Vec3, Vec4};

use super::SceneView;
use crate::surface::Surface;

impl SceneView<'_> {
    /// Light of the sky on a surface over pi, and, in w, the share of the sky that is seen: turns 1 and on of the loop of
    /// `scene_path` in WGSL.
    pub(super) fn scene_sky_light(&self, surface: &Surface, random: [u32; 4]) -> Vec4 {
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
