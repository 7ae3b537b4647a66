//! Random numbers of a pixel's rays, and rays that go on.

use downpour_drop::optics::optics_fresnel;
use downpour_math::rng::{rng_draw, rng_pcg4d, rng_unit};
use downpour_shaders::render::path::{
    PATH_CANDIDATES, PATH_DIMENSION, PATH_FLOOR, PATH_JITTER, PATH_LATTICE_SCATTER, PATH_LATTICE_SECOND, PATH_LATTICE_THIRD,
};
use downpour_shaders::render::puddle_water::{PUDDLE_WATER_CONE, PUDDLE_WATER_GRAZING, PUDDLE_WATER_INDEX};
use downpour_shaders::render::scene::SKYLIGHT_RADIUS;
use downpour_shaders::render::scatter::SCATTER_DISC;
use glam::{Vec2, Vec3};

use super::plan::{path_albedo, path_most};
use crate::puddle::water::{puddle_water_mirrored, puddle_water_normal};
use crate::scatter::{ScatterRay, scatter_hemisphere};
use crate::scene::SceneView;
use crate::surface::Surface;

/// Words for the rays of sample k of a pixel. The first three are those of a lattice of rank 1, of which the pixels of any
/// window of the filter's size have each point once: their mean has no pattern. The last is the pixel's own.
#[must_use]
pub fn path_lattice(seed: u32, x: u32, y: u32, k: u32) -> [u32; 4] {
    let seed = rng_draw([seed, 0], k, 0, PATH_DIMENSION);
    let edge = 2 * SKYLIGHT_RADIUS + 1;
    let points = edge * edge;
    // Scattered, so that a part of the window has points from everywhere.
    let index = ((x % edge) * edge + y % edge) * PATH_LATTICE_SCATTER % points;
    let step = u32::MAX / points;
    [
        (index * step).wrapping_add(seed[0]),
        (index * PATH_LATTICE_SECOND % points * step).wrapping_add(seed[1]),
        (index * PATH_LATTICE_THIRD % points * step).wrapping_add(seed[2]),
        rng_pcg4d([x, y, k, seed[3]])[0],
    ]
}

/// Numbers in [0, 1) for ray `index` of `count` of a turn: two for its direction, one for whether it goes on, one for a lamp.
#[must_use]
pub fn path_numbers(random: [u32; 4], turn: u32, bounce: u32, index: u32, count: u32) -> [f32; 4] {
    let own = rng_pcg4d([random[3], turn, bounce, PATH_DIMENSION]).map(rng_unit);
    if bounce > 0 {
        return own;
    }
    let fract = |x: f32| x - x.floor();
    // Not quite on the lattice's points, so that their images are not seen one by one.
    let a = fract(rng_unit(random[0]) + own[0] * PATH_JITTER);
    let b = fract(rng_unit(random[1]) + own[1] * PATH_JITTER);
    let k = index as f32;
    [
        fract((k + a) / count as f32),
        fract(k * 0.618_034 + b),
        own[2],
        fract(k * 0.618_034 + rng_unit(random[2])),
    ]
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
    let share = optics_fresnel(view.dot(normal).max(PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    ScatterRay {
        along,
        width: cone + PUDDLE_WATER_CONE,
        diffuse: Vec3::ZERO,
        roughness,
        mirror: Vec3::splat(share),
    }
}

/// A ray that goes on from what a mirror shows, whose diffuse base takes the mirror's place.
pub(super) fn path_replaced(ray: &ScatterRay, next: &ScatterRay) -> ScatterRay {
    ScatterRay {
        diffuse: next.diffuse,
        mirror: ray.mirror * next.mirror,
        roughness: ray.roughness.max(next.roughness),
        ..*next
    }
}

/// A ray that goes on from a surface that the ray before has met; without weight if it does not.
pub(super) fn path_onward(ray: &ScatterRay, next: &ScatterRay, surface: &Surface, number: f32) -> ScatterRay {
    let factor = path_albedo(surface) * next.diffuse + next.mirror;
    let probability = path_most(factor).min(1.0);
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
        share: f32,
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
            let width = (SCATTER_DISC * share / (PATH_CANDIDATES as f32 * (1.0 - x).max(0.01).sqrt())).sqrt();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_window_has_every_point_of_the_lattice_once() {
        let edge = 2 * SKYLIGHT_RADIUS + 1;
        for (left, top) in [(0, 0), (3, 5), (1000, 77)] {
            for number in 0..3 {
                let mut words: Vec<u32> = (0..edge * edge)
                    .map(|i| path_lattice(9, left + i % edge, top + i / edge, 2)[number])
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
