//! Asphalt, slabs, setts, curb stones and iron covers.
//!
//! Albedos of dry surfaces: worn asphalt 0.10 to 0.13, concrete slabs 0.25 to 0.35, granite 0.25 to 0.30 (Oke 1987, table 1.1,
//! and Levinson & Akbari 2002 for pavements).

use super::Tile;
use crate::noise::{cellular, fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Edges of the tiles, meters.
pub(crate) const ASPHALT_M: f32 = 2.4;
/// A whole number of slabs along each edge.
pub(crate) const SLABS_M: f32 = 2.4;
pub(crate) const SETTS_M: f32 = 2.0;
/// Length of a curb stone; its tile is half as wide.
pub(crate) const CURB_M: f32 = 1.0;
pub(crate) const COVER_M: f32 = 0.3;

/// Worn asphalt: stones of 10 mm in a dark binder, polished on top.
pub(crate) fn asphalt() -> Tile {
    const SIZE: u32 = 512;
    const STONES: [i32; 2] = [230, 230];
    // A stone's dome, 0 in the binder to 1.
    let dome = |u: f32, v: f32| {
        let stone = cellular(u, v, STONES, 11);
        let radius = mix(0.28, 0.62, stone.id);
        (smooth(radius, radius * 0.35, stone.nearest), stone.id)
    };
    let mottle = |u: f32, v: f32| fractal(u, v, [5, 5], 5, 21);
    let color = Raster::gray(SIZE, SIZE, |u, v| {
        let (dome, id) = dome(u, v);
        let stone = mix(0.09, 0.20, id * id);
        let fines = mix(0.055, 0.085, fractal(u, v, [120, 120], 2, 23));
        mix(fines, stone, dome * 0.8) * mix(0.86, 1.14, mottle(u, v))
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (dome, id) = dome(u, v);
        dome * mix(0.5e-3, 1.1e-3, id) + fractal(u, v, [14, 14], 3, 31) * 1.6e-3
    });
    // Tops are polished by tires; water is between them.
    let roughness = Raster::gray(SIZE / 2, SIZE / 2, |u, v| {
        mix(0.5, 0.95, mottle(u + 0.3, v)) * mix(1.0, 0.85, dome(u, v).0)
    });
    Tile { color, height, roughness }
}

/// Concrete slabs of 60 x 40 cm in half bond.
pub(crate) fn slabs() -> Tile {
    const SIZE: u32 = 512;
    const ROWS: i32 = 6;
    const COLUMNS: i32 = 4;
    // Position within a slab in meters from its edges, and its number.
    let slab = |u: f32, v: f32| {
        let row = (v * ROWS as f32).floor();
        let shift = if (row as i32) % 2 == 0 { 0.0 } else { 0.5 };
        let x = u * COLUMNS as f32 + shift;
        let column = (x.floor() as i32).rem_euclid(COLUMNS);
        let (a, b) = ((x - x.floor()) * 0.6, (v * ROWS as f32 - row) * 0.4);
        let edge = a.min(0.6 - a).min(b).min(0.4 - b);
        (edge, hash(column, row as i32, 41), hash(column, row as i32, 42))
    };
    let joint = |u: f32, v: f32| {
        let ragged = fractal(u, v, [60, 60], 2, 43) * 5.0e-3;
        smooth(0.004 + ragged, 0.009 + ragged, slab(u, v).0)
    };
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (edge, tone, hue) = slab(u, v);
        let speckle = fractal(u, v, [220, 220], 2, 44);
        let stain = smooth(0.52, 0.8, fractal(u, v, [6, 6], 5, 45));
        let bare = mix3([0.262, 0.256, 0.246], [0.322, 0.307, 0.278], hue);
        let shade = mix(0.68, 1.1, tone) * mix(0.86, 1.14, speckle) * mix(1.0, 0.84, stain);
        let dirt = mix(0.8, 1.0, smooth(0.0, 0.05, edge));
        let top = bare.map(|c| c * shade * dirt);
        let [r, g, b] = mix3([0.045, 0.042, 0.035], top, joint(u, v));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        // Each slab leans its way.
        let row = (v * ROWS as f32).floor();
        let x = u * COLUMNS as f32 + if (row as i32) % 2 == 0 { 0.0 } else { 0.5 };
        let (a, b) = (x - x.floor() - 0.5, v * ROWS as f32 - row - 0.5);
        let (_, tone, hue) = slab(u, v);
        let tilt = (tone - 0.5) * 9.0e-3 * a + (hue - 0.5) * 8.0e-3 * b;
        joint(u, v) * (4.0e-3 + tilt)
            + fractal(u, v, [90, 90], 2, 46) * 0.5e-3
            + fractal(u, v, [9, 9], 3, 48) * 1.5e-3
    });
    let roughness = Raster::gray(SIZE, SIZE, |u, v| mix(0.66, 0.98, fractal(u, v, [7, 7], 4, 47)));
    Tile { color, height, roughness }
}

/// Granite setts of 10 x 12 to 20 cm in rows, worn round, with sand and moss in the joints.
pub(super) fn setts() -> Tile {
    const SIZE: u32 = 512;
    const ROWS: i32 = 20;
    // Distance to the joint in meters, position in the stone from its middle, two random numbers.
    let sett = |u: f32, v: f32| {
        let sway =
            (fractal(u, v, [4, 4], 2, 50) - 0.5) * 0.018 + (fractal(u, v, [26, 26], 2, 51) - 0.5) * 0.012;
        let y = (v + sway) * ROWS as f32;
        let row = y.floor() as i32;
        let own = row.rem_euclid(ROWS);
        let count = 12 + (hash(own, 0, 56) * 3.0) as i32;
        let x = (u + hash(own, 1, 56) + sway * 0.5) * count as f32;
        let stone = x.floor() as i32;
        // Ends of the stones are moved at random.
        let end = |k: i32| k as f32 + 0.42 * (hash(k.rem_euclid(count), own, 57) - 0.5);
        let stone = if x < end(stone) {
            stone - 1
        } else if x >= end(stone + 1) {
            stone + 1
        } else {
            stone
        };
        let (from, to) = (end(stone), end(stone + 1));
        let meters = 2.0 / count as f32;
        let (a, b) = ((x - from) * meters, (to - x) * meters);
        let (c, d) = ((y - row as f32) * 0.1, (1.0 - y + row as f32) * 0.1);
        let (near_x, near_y) = (a.min(b), c.min(d));
        // Corners are rounded.
        let (p, q) = ((0.022 - near_x).max(0.0), (0.022 - near_y).max(0.0));
        let edge = 0.022 - (p * p + q * q).sqrt();
        let edge = if p == 0.0 && q == 0.0 { near_x.min(near_y) } else { edge };
        let id = stone.rem_euclid(count);
        (edge, [a - b, c - d], hash(id, own, 52), hash(id, own, 53))
    };
    let top = |edge: f32| smooth(0.004, 0.011, edge);
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (edge, _, tone, hue) = sett(u, v);
        let grain = mix(0.78, 1.22, fractal(u, v, [150, 150], 2, 54));
        const STONES: [[f32; 3]; 6] = [
            [0.165, 0.163, 0.160],
            [0.142, 0.146, 0.152],
            [0.182, 0.172, 0.156],
            [0.150, 0.139, 0.128],
            [0.112, 0.112, 0.113],
            [0.198, 0.194, 0.186],
        ];
        let base = STONES[((hue * 6.0) as usize).min(5)];
        let worn = mix(0.82, 1.06, smooth(0.004, 0.03, edge));
        let stone = base.map(|c| c * mix(0.80, 1.14, tone) * grain * worn);
        let sand = mix3(
            [0.105, 0.092, 0.072],
            [0.055, 0.068, 0.030],
            smooth(0.48, 0.62, fractal(u, v, [5, 5], 4, 58)),
        );
        let [r, g, b] = mix3(sand.map(|c| c * grain), stone, top(edge));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (edge, [a, c], tone, hue) = sett(u, v);
        let dome = smooth(0.0, 0.030, edge) * 0.008 + top(edge) * 0.006;
        let lean = (tone - 0.5) * 0.06 * a + (hue - 0.5) * 0.08 * c;
        dome + top(edge) * (lean + tone * 3.0e-3) + fractal(u, v, [70, 70], 2, 55) * 1.6e-3
    });
    let roughness = Raster::gray(SIZE, SIZE, |u, v| {
        let (edge, _, tone, _) = sett(u, v);
        mix(0.98, mix(0.55, 0.78, tone), smooth(0.006, 0.025, edge))
    });
    Tile { color, height, roughness }
}

/// Fourth-order norm: a square with rounded corners.
fn ops_norm(a: f32, b: f32) -> f32 {
    let (a, b) = (a * a, b * b);
    (a * a + b * b).sqrt().sqrt()
}

/// Granite of curb stones, one stone long; u runs along the stone. Joints are in the mesh.
pub(super) fn curb() -> Tile {
    let color = Raster::new(256, 256, |u, v| {
        let grain = fractal(u, v, [110, 110], 2, 61);
        let fleck = smooth(0.60, 0.78, fractal(u, v, [80, 80], 2, 62));
        let worn = fractal(u, v, [4, 4], 4, 63);
        let stone = mix3([0.30, 0.29, 0.28], [0.13, 0.13, 0.135], fleck * 0.8);
        let [r, g, b] = stone.map(|c| c * mix(0.8, 1.12, grain) * mix(0.78, 1.12, worn));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(256, 256, |u, v| {
        fractal(u, v, [60, 60], 2, 64) * 0.9e-3 + fractal(u, v, [7, 7], 3, 65) * 4.0e-3
    });
    Tile::plain(color, height)
}

/// Heights of a cast cover: raised studs.
pub(crate) fn cover() -> Raster {
    const STUDS: f32 = 10.0;
    Raster::gray(128, 128, |u, v| {
        let row = (v * STUDS).floor();
        let a = (u * STUDS + if row as i32 % 2 == 0 { 0.0 } else { 0.5 }).fract() - 0.5;
        let b = (v * STUDS).fract() - 0.5;
        smooth(0.34, 0.24, ops_norm(a, b)) * 3.0e-3
    })
}

/// Depth of a puddle: pools that run together, 1 where it is deepest.
pub(crate) fn puddle() -> Raster {
    Raster::gray(128, 384, |u, v| {
        let (x, y) = ((u - 0.5) * 1.3, (v - 0.5) * 4.0);
        let ragged = (fractal(u, v, [3, 9], 4, 171) - 0.5) * 0.5;
        let pool = |cx: f32, cy: f32, rx: f32, ry: f32| {
            let (a, b) = ((x - cx) / rx, (y - cy) / ry);
            1.0 - (a * a + b * b)
        };
        let depth = pool(-0.08, -0.75, 0.40, 0.75)
            .max(pool(0.12, 0.35, 0.36, 0.70))
            .max(pool(-0.15, 1.2, 0.28, 0.36));
        smooth(0.0, 0.9, depth + ragged)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean albedos are those of the surfaces that the tiles show.
    #[test]
    fn grounds_reflect_what_real_ones_do() {
        for (name, tile, low, high) in
            [("asphalt", asphalt(), 0.07, 0.13), ("slabs", slabs(), 0.2, 0.35), ("setts", setts(), 0.1, 0.25)]
        {
            for mean in tile.color.mean() {
                assert!((low..high).contains(&mean), "{name}: {mean}");
            }
        }
    }
}
