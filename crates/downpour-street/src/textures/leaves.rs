//! A spray of leaves with coverage, and bark.

use downpour_math::ops;

use crate::noise::{fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Leaves of a spray.
const LEAVES: i32 = 62;

/// Color of a leaf at a point of the spray, if one is there: the topmost.
fn leaf(u: f32, v: f32) -> Option<([f32; 3], f32)> {
    (0..LEAVES).rev().find_map(|k| {
        let r = |n: i32| hash(k, n, 141);
        // Leaves are around the middle, denser inside.
        let turn = r(0) * std::f32::consts::TAU;
        let reach = 0.40 * r(1).sqrt();
        let (cx, cy) = (0.5 + reach * ops::cos(turn), 0.5 + reach * ops::sin(turn));
        let lean = turn + (r(2) - 0.5) * 2.2;
        let (c, s) = (ops::cos(lean), ops::sin(lean));
        let (dx, dy) = (u - cx, v - cy);
        let (along, across) = (dx * c + dy * s, -dx * s + dy * c);
        let length = mix(0.15, 0.22, r(3));
        let t = along / length + 0.5;
        if !(0.0..1.0).contains(&t) {
            return None;
        }
        // Broad near the stalk, pointed at the tip.
        let half = length * 0.62 * t.sqrt() * (1.0 - t) * 1.3;
        if across.abs() > half {
            return None;
        }
        let vein = 1.0 - smooth(0.0, 0.008, across.abs()) * 0.9;
        let green = mix3([0.050, 0.088, 0.026], [0.088, 0.125, 0.040], r(4));
        let old = mix3(green, [0.14, 0.13, 0.04], smooth(0.8, 1.0, r(5)) * 0.7);
        Some((old.map(|c| c * mix(0.72, 1.15, r(6)) * (1.0 + 0.35 * vein)), 1.0))
    })
}

/// A spray of leaves, 256 texels square; outside the leaves the color continues so that edges do not turn dark.
pub(crate) fn leaves() -> Raster {
    Raster::new(256, 256, |u, v| match leaf(u, v) {
        Some(([r, g, b], a)) => [r, g, b, a],
        None => [0.068, 0.106, 0.033, 0.0],
    })
}

/// Bark: ridges along v.
pub(crate) fn bark() -> Raster {
    Raster::gray(128, 128, |u, v| {
        let ridge = fractal(u, v, [16, 4], 4, 151);
        let flake = fractal(u, v, [6, 10], 3, 152);
        mix(0.25, 0.95, ridge) * mix(0.7, 1.05, flake)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays pass a dozen holes: a spray must not be mostly air.
    #[test]
    fn a_spray_covers_a_third_of_its_card() {
        let n = 64;
        let there = (0..n * n)
            .filter(|k| leaf((k % n) as f32 / n as f32, (k / n) as f32 / n as f32).is_some())
            .count();
        let fraction = there as f32 / (n * n) as f32;
        assert!((0.25..0.6).contains(&fraction), "{fraction}");
    }
}
