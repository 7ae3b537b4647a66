//! Random numbers of a pixel's rays, of which the mean over a window of pixels has no pattern. Twin of
//! `shaders/wgsl/render/path_lattice.wgsl`.

use downpour_math::rng::{rng_draw, rng_pcg4d, rng_unit};
use downpour_shaders::render::path::{
    PATH_DIMENSION, PATH_JITTER, PATH_LATTICE_SCATTER, PATH_LATTICE_SECOND, PATH_LATTICE_THIRD,
};
use downpour_shaders::render::scene::SKYLIGHT_RADIUS;

/// Words for the rays of sample k of a pixel. The first three are those of a rank-1 lattice, of which the pixels of any
/// window of the filter's size have each point once: their mean has no pattern. The last is the pixel's own.
#[must_use]
pub fn path_lattice_words(seed: u32, x: u32, y: u32, k: u32) -> [u32; 4] {
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

/// Numbers in [0, 1) for ray `index` of `count` of a turn: two for its direction, one for its survival, one for a lamp.
#[must_use]
pub fn path_lattice_numbers(random: [u32; 4], turn: u32, bounce: u32, index: u32, count: u32) -> [f32; 4] {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_window_has_every_point_of_the_lattice_once() {
        let edge = 2 * SKYLIGHT_RADIUS + 1;
        for (left, top) in [(0, 0), (3, 5), (1000, 77)] {
            for number in 0..3 {
                let mut words: Vec<u32> = (0..edge * edge)
                    .map(|i| path_lattice_words(9, left + i % edge, top + i / edge, 2)[number])
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
