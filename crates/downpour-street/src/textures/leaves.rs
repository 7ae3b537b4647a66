//! Clusters of leaves with coverage, and bark.

use downpour_math::ops;

use crate::noise::{fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Clusters of leaves along each edge of the picture.
pub(crate) const CLUSTERS: u32 = 2;
/// Leaves of a cluster.
const LEAVES: i32 = 11;

/// Color of a leaf at a point of a cluster, if one is there: the topmost.
fn leaf(cluster: i32, u: f32, v: f32) -> Option<[f32; 3]> {
    (0..LEAVES).rev().find_map(|k| {
        let r = |n: i32| hash(k + 100 * cluster, n, 141);
        // Stalks start around the middle, tips point away from it.
        let turn = (k as f32 + 0.8 * r(0)) * 2.4;
        let reach = mix(0.06, 0.27, r(1).sqrt());
        let (cx, cy) = (0.5 + reach * ops::cos(turn), 0.5 + reach * ops::sin(turn));
        let lean = turn + (r(2) - 0.5) * 1.6;
        let (c, s) = (ops::cos(lean), ops::sin(lean));
        let (dx, dy) = (u - cx, v - cy);
        let (along, across) = (dx * c + dy * s, -dx * s + dy * c);
        let length = mix(0.30, 0.42, r(3));
        let t = along / length + 0.5;
        if !(0.0..1.0).contains(&t) {
            return None;
        }
        // Heart-shaped: broad near the stalk, pointed at the tip; the edge is toothed.
        let teeth = 1.0 + 0.05 * ops::sin(60.0 * t);
        let half = length * 1.02 * t.sqrt() * (1.0 - t) * teeth;
        if across.abs() > half {
            return None;
        }
        let rib = 1.0 - smooth(0.004, 0.012, across.abs());
        let side = (along - 1.3 * across.abs()) * 34.0;
        let vein = (1.0 - smooth(0.0, 0.16, (side - side.round()).abs())) * 0.4;
        let green = mix3([0.074, 0.098, 0.036], [0.118, 0.138, 0.054], r(4));
        let old = mix3(green, [0.16, 0.135, 0.045], smooth(0.86, 1.0, r(5)) * 0.7);
        // One half of a leaf is folded up: a little brighter.
        let fold = if across > 0.0 { 1.07 } else { 0.93 };
        Some(old.map(|c| c * mix(0.75, 1.12, r(6)) * fold * (1.0 + 0.30 * rib.max(vein))))
    })
}

/// Clusters of leaves, 256 texels square; outside the leaves the color continues so that edges do not turn dark.
pub(crate) fn leaves() -> Raster {
    Raster::new(256, 256, |u, v| {
        let (x, y) = (u * CLUSTERS as f32, v * CLUSTERS as f32);
        match leaf((x.floor() + CLUSTERS as f32 * y.floor()) as i32, x.fract(), y.fract()) {
            Some([r, g, b]) => [r, g, b, 1.0],
            None => [0.09, 0.112, 0.042, 0.0],
        }
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

    /// Rays pass a dozen holes: a cluster must not be mostly air, nor a full square.
    #[test]
    fn a_cluster_covers_a_third_of_its_card() {
        let n = 64;
        for cluster in 0..(CLUSTERS * CLUSTERS) as i32 {
            let at = |k: i32| leaf(cluster, (k % n) as f32 / n as f32, (k / n) as f32 / n as f32);
            let fraction = (0..n * n).filter(|&k| at(k).is_some()).count() as f32 / (n * n) as f32;
            assert!((0.3..0.7).contains(&fraction), "{cluster} {fraction}");
        }
    }
}
