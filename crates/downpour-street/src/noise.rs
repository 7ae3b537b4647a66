//! Noise on lattices that repeat: textures that tile, and variation of surfaces that is the same on every machine.
//!
//! Only the four operations and integer hashes are used, so results have the same bits everywhere.

use downpour_math::rng::{rng_pcg4d, rng_unit};

/// A random number in [0, 1) for a point of a lattice.
pub(crate) fn hash(x: i32, y: i32, seed: u32) -> f32 {
    rng_unit(rng_pcg4d([x as u32, y as u32, seed, 0x5CE9E])[0])
}

/// Hermite ramp from 0 below `low` to 1 above `high`.
pub(crate) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Linear mix of two numbers.
pub(crate) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Linear mix of two colors.
pub(crate) fn mix3(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|k| mix(a[k], b[k], t))
}

/// Value noise in [0, 1) at a point in grid units; repeats after `period` cells along each axis.
pub(crate) fn value(x: f32, y: f32, period: [i32; 2], seed: u32) -> f32 {
    let (cx, cy) = (x.floor(), y.floor());
    let (fx, fy) = (x - cx, y - cy);
    let ease = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, v) = (ease(fx), ease(fy));
    let at = |dx: i32, dy: i32| {
        hash((cx as i32 + dx).rem_euclid(period[0]), (cy as i32 + dy).rem_euclid(period[1]), seed)
    };
    mix(mix(at(0, 0), at(1, 0), u), mix(at(0, 1), at(1, 1), u), v)
}

/// Sum of octaves of value noise, in [0, 1), mean 1/2: each octave has twice the cells and half the amplitude of the last.
///
/// `u` and `v` run over [0, 1) for one tile, `cells` are those of the first octave.
pub(crate) fn fractal(u: f32, v: f32, cells: [i32; 2], octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut all) = (0.0, 1.0, 0.0);
    let mut n = cells;
    for octave in 0..octaves {
        sum += weight * value(u * n[0] as f32, v * n[1] as f32, n, seed + octave);
        all += weight;
        weight *= 0.5;
        n = [n[0] * 2, n[1] * 2];
    }
    sum / all
}

/// Value noise over world coordinates in meters, octaves from `size_m` down, in [0, 1).
pub(crate) fn world(x: f32, y: f32, size_m: f32, octaves: u32, seed: u32) -> f32 {
    const NO_PERIOD: i32 = 1 << 20;
    let (mut sum, mut weight, mut all, mut scale) = (0.0, 1.0, 0.0, 1.0 / size_m);
    for octave in 0..octaves {
        sum += weight * value(x * scale + 0.37, y * scale + 0.71, [NO_PERIOD; 2], seed + octave);
        all += weight;
        weight *= 0.5;
        scale *= 2.0;
    }
    sum / all
}

/// The nearest two of points scattered one to a cell: distances in cells, and a random number of the nearest.
pub(crate) struct Cells {
    /// Distance to the nearest point, in cells.
    pub(crate) nearest: f32,
    /// Distance to the second nearest point, in cells.
    pub(crate) second: f32,
    /// Random number of the nearest point, in [0, 1).
    pub(crate) id: f32,
}

/// Cellular noise (Worley 1996) that repeats; `u` and `v` run over [0, 1) for one tile of `cells`.
pub(crate) fn cellular(u: f32, v: f32, cells: [i32; 2], seed: u32) -> Cells {
    let (x, y) = (u * cells[0] as f32, v * cells[1] as f32);
    let (cx, cy) = (x.floor() as i32, y.floor() as i32);
    let mut found = Cells { nearest: f32::MAX, second: f32::MAX, id: 0.0 };
    for dy in -1..=1 {
        for dx in -1..=1 {
            let (i, j) = ((cx + dx).rem_euclid(cells[0]), (cy + dy).rem_euclid(cells[1]));
            let (px, py) = ((cx + dx) as f32 + hash(i, j, seed), (cy + dy) as f32 + hash(i, j, seed + 1));
            let distance = ((px - x) * (px - x) + (py - y) * (py - y)).sqrt();
            if distance < found.nearest {
                (found.second, found.nearest) = (found.nearest, distance);
                found.id = hash(i, j, seed + 2);
            } else if distance < found.second {
                found.second = distance;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_and_stays_in_its_range() {
        for k in 0..200 {
            let (u, v) = (hash(k, 0, 1), hash(k, 1, 1));
            let noise = fractal(u, v, [5, 7], 4, 9);
            assert!((0.0..1.0).contains(&noise));
            assert!((noise - fractal(u + 1.0, v, [5, 7], 4, 9)).abs() < 1e-3);
            assert!((noise - fractal(u, v + 1.0, [5, 7], 4, 9)).abs() < 1e-3);
            let cell = cellular(u, v, [6, 6], 3);
            assert!(cell.nearest <= cell.second && cell.second < 2.0);
        }
    }

    #[test]
    fn noise_has_the_mean_of_a_half() {
        let n = 64;
        let mean: f32 = (0..n * n)
            .map(|k| fractal((k % n) as f32 / n as f32, (k / n) as f32 / n as f32, [16, 16], 3, 4))
            .sum::<f32>()
            / (n * n) as f32;
        assert!((mean - 0.5).abs() < 0.03, "{mean}");
    }
}
