//! Twigs with leaves and coverage, and bark.

use downpour_math::ops;

use crate::noise::{fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Twigs along each edge of the picture.
pub(crate) const TWIGS: u32 = 2;
/// Texels along each edge of the picture.
const TEXELS: u32 = 512;
/// Leaves of a twig.
const LEAVES: i32 = 17;

/// Where the twig is at a height, 0 at its foot to 1 at its tip.
fn stem(twig: i32, height: f32) -> f32 {
    let r = |n: i32| hash(twig, n, 142) - 0.5;
    0.5 + r(0) * 0.16 * height + 0.05 * r(1) * ops::sin(5.0 * height)
}

/// A leaf of a twig: leaves are on alternate sides, smaller toward the tip, the last one at it.
struct Leaf {
    foot: [f32; 2],
    way: [f32; 2],
    length: f32,
    width: f32,
    /// Fractions of light that it scatters, to both sides together.
    color: [f32; 3],
}

impl Leaf {
    fn new(twig: i32, k: i32) -> Self {
        let r = |n: i32| hash(k + 100 * twig, n, 141);
        let height = mix(0.10, 0.76, (k as f32 + 0.6 * (r(0) - 0.5)).max(0.0) / (LEAVES - 1) as f32);
        let side = if k + 1 == LEAVES {
            0.0
        } else if k % 2 == 0 {
            1.0
        } else {
            -1.0
        };
        // From the twig's direction; those near its tip stand closer to it.
        let turn = side * mix(1.35, 0.55, height) + 0.7 * (r(1) - 0.5);
        let way = [ops::sin(turn), ops::cos(turn)];
        // A stalk first.
        let stalk = mix(0.03, 0.10, r(2));
        let foot = [stem(twig, height) + stalk * way[0], height + stalk * way[1]];
        // It ends within its card.
        let room =
            |at: f32, way: f32| (if way > 0.0 { 0.98 - at } else { at - 0.02 }) / way.abs().max(1.0e-3);
        let room = room(foot[0], way[0]).min(room(foot[1], way[1]));
        let green = mix3([0.117, 0.187, 0.050], [0.208, 0.300, 0.087], r(4));
        let old = mix3(green, [0.37, 0.32, 0.092], smooth(0.88, 1.0, r(5)) * 0.8);
        Self {
            foot,
            way,
            length: (mix(0.27, 0.18, height) * mix(0.85, 1.15, r(3))).min(room),
            // Seen aslant, most are narrower than they are.
            width: mix(0.55, 1.0, r(6).sqrt()),
            color: old.map(|c| c * mix(0.72, 1.15, r(7))),
        }
    }

    /// Its color at a point, if it is there: heart-shaped, toothed, with a rib and veins, one half folded up.
    fn at(&self, u: f32, v: f32) -> Option<[f32; 3]> {
        let (dx, dy) = (u - self.foot[0], v - self.foot[1]);
        let (along, across) =
            (dx * self.way[0] + dy * self.way[1], (dx * self.way[1] - dy * self.way[0]) / self.width);
        let t = along / self.length;
        if !(0.0..1.0).contains(&t) {
            return None;
        }
        let teeth = 1.0 + 0.06 * ops::sin(70.0 * t);
        if across.abs() > self.length * 1.06 * t.sqrt() * (1.0 - t) * teeth {
            return None;
        }
        let rib = 1.0 - smooth(0.003, 0.009, across.abs());
        let vein_at = (along - 1.2 * across.abs()) * 42.0;
        let vein = (1.0 - smooth(0.0, 0.18, (vein_at - vein_at.round()).abs())) * 0.35;
        let fold = if across > 0.0 { 1.10 } else { 0.90 };
        Some(self.color.map(|c| c * fold * (1.0 + 0.35 * rib.max(vein))))
    }
}

/// Color of a twig at a point, `v` from its foot to its tip, if anything is there: leaves over the stem.
fn twig(leaves: &[Leaf], number: i32, u: f32, v: f32) -> Option<[f32; 3]> {
    let leaf = leaves.iter().rev().find_map(|leaf| leaf.at(u, v));
    let on_stem = v < 0.82 && (u - stem(number, v)).abs() < mix(0.010, 0.005, v);
    leaf.or(on_stem.then_some([0.25, 0.19, 0.125]))
}

/// Leaves of all twigs, twig by twig.
fn all_leaves() -> Vec<Vec<Leaf>> {
    let each = 0..(TWIGS * TWIGS) as i32;
    each.map(|number| (0..LEAVES).map(|k| Leaf::new(number, k)).collect()).collect()
}

/// Twigs with leaves, 512 texels square; outside them the color continues so that edges do not turn dark.
pub(crate) fn leaves() -> Raster {
    let all = all_leaves();
    Raster::new(TEXELS, TEXELS, |u, v| {
        let (x, y) = (u * TWIGS as f32, v * TWIGS as f32);
        let number = x.floor() as usize + TWIGS as usize * y.floor() as usize;
        match twig(&all[number], number as i32, x.fract(), 1.0 - y.fract()) {
            Some([r, g, b]) => [r, g, b, 1.0],
            None => [0.158, 0.233, 0.070, 0.0],
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

    /// Rays pass a dozen holes: a twig must not be mostly air, nor a full square.
    #[test]
    fn a_twig_covers_a_third_of_its_card() {
        let n = 64;
        for (number, leaves) in all_leaves().iter().enumerate() {
            let at = |k: i32| {
                let (u, v) = ((k % n) as f32 / n as f32, (k / n) as f32 / n as f32);
                twig(leaves, number as i32, u, v)
            };
            let fraction = (0..n * n).filter(|&k| at(k).is_some()).count() as f32 / (n * n) as f32;
            assert!((0.25..0.45).contains(&fraction), "{number} {fraction}");
        }
    }

    /// No leaf is cut off by the edge of its card.
    #[test]
    fn leaves_end_within_their_card() {
        for (number, leaves) in all_leaves().iter().enumerate() {
            for k in 0..256 {
                let t = k as f32 / 255.0;
                for [u, v] in [[0.002, t], [0.998, t], [t, 0.998]] {
                    assert!(twig(leaves, number as i32, u, v).is_none(), "{number} {u} {v}");
                }
            }
        }
    }
}
