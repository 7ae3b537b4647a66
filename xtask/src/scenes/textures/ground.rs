//! Asphalt, slabs, setts, curb stones and iron covers.
//!
//! Albedos of dry surfaces: worn asphalt 0.10 to 0.13, concrete slabs 0.25 to 0.35, granite 0.25 to 0.30 (Oke 1987, table 1.1,
//! and Levinson & Akbari 2002 for pavements).

use super::Tile;
use crate::scenes::noise::{cellular, fractal, hash, mix, mix3, smooth};
use crate::scenes::raster::Raster;

/// Edges of the tiles, meters.
pub(in crate::scenes) const ASPHALT_M: f32 = 2.4;
/// A whole number of slabs along each edge.
pub(in crate::scenes) const SLABS_M: f32 = 2.4;
pub(in crate::scenes) const SETTS_M: f32 = 0.9;
/// Length of a curb stone; its tile is half as wide.
pub(in crate::scenes) const CURB_M: f32 = 1.0;
pub(in crate::scenes) const COVER_M: f32 = 0.3;

/// Worn asphalt: stones of 10 mm in a dark binder, polished on top.
pub(super) fn asphalt() -> Tile {
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
    let roughness =
        Raster::gray(SIZE, SIZE, |u, v| mix(0.5, 0.95, mottle(u + 0.3, v)) * mix(1.0, 0.85, dome(u, v).0));
    Tile { color, height, roughness }
}

/// Concrete slabs of 60 x 40 cm in half bond.
pub(super) fn slabs() -> Tile {
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
        let ragged = fractal(u, v, [60, 60], 2, 43) * 4.0e-3;
        smooth(0.0025 + ragged, 0.006 + ragged, slab(u, v).0)
    };
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (edge, tone, hue) = slab(u, v);
        let speckle = fractal(u, v, [220, 220], 2, 44);
        let stain = smooth(0.52, 0.8, fractal(u, v, [6, 6], 5, 45));
        let bare = mix3([0.27, 0.265, 0.25], [0.33, 0.315, 0.285], hue);
        let shade = mix(0.82, 1.1, tone) * mix(0.86, 1.14, speckle) * mix(1.0, 0.84, stain);
        let dirt = mix(0.8, 1.0, smooth(0.0, 0.05, edge));
        let top = bare.map(|c| c * shade * dirt);
        let [r, g, b] = mix3([0.06, 0.056, 0.047], top, joint(u, v));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (_, tone, hue) = slab(u, v);
        let tilt = (tone - 0.5) * 1.2e-3 * (u * 12.0).fract() + (hue - 0.5) * 1.5e-3;
        joint(u, v) * (2.5e-3 + tilt) + fractal(u, v, [90, 90], 2, 46) * 0.4e-3
    });
    let roughness = Raster::gray(SIZE, SIZE, |u, v| mix(0.62, 1.0, fractal(u, v, [7, 7], 4, 47)));
    Tile { color, height, roughness }
}

/// Granite setts of 11 cm.
pub(super) fn setts() -> Tile {
    const SIZE: u32 = 256;
    const ROWS: i32 = 8;
    let sett = |u: f32, v: f32| {
        let row = (v * ROWS as f32).floor() as i32;
        let x = u * ROWS as f32 + if row % 2 == 0 { 0.0 } else { 0.47 };
        let column = (x.floor() as i32).rem_euclid(ROWS);
        let (a, b) = (x - x.floor() - 0.5, v * ROWS as f32 - row as f32 - 0.5);
        let wobble = (fractal(u, v, [24, 24], 2, 51) - 0.5) * 0.16;
        // Corners are rounded: a square norm of high order.
        let far = ops_norm(a, b) + wobble;
        (far, hash(column, row, 52), hash(column, row, 53))
    };
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (far, tone, hue) = sett(u, v);
        let grain = mix(0.8, 1.2, fractal(u, v, [110, 110], 2, 54));
        let stone =
            mix3([0.15, 0.15, 0.15], [0.24, 0.215, 0.19], hue).map(|c| c * mix(0.75, 1.15, tone) * grain);
        let [r, g, b] = mix3(stone, [0.045, 0.042, 0.036], smooth(0.38, 0.46, far));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (far, tone, _) = sett(u, v);
        let dome = smooth(0.5, 0.2, far);
        dome * mix(5.0e-3, 8.0e-3, tone) + fractal(u, v, [50, 50], 2, 55) * 1.2e-3
    });
    let roughness = Raster::gray(8, 8, |_, _| 1.0);
    Tile { color, height, roughness }
}

/// Fourth-order norm: a square with rounded corners.
fn ops_norm(a: f32, b: f32) -> f32 {
    let (a, b) = (a * a, b * b);
    (a * a + b * b).sqrt().sqrt()
}

/// Granite of curb stones, one stone long, with a joint at its ends.
pub(super) fn curb() -> Raster {
    Raster::new(256, 128, |u, v| {
        let grain = fractal(u, v, [128, 64], 2, 61);
        let fleck = smooth(0.62, 0.8, fractal(u, v, [90, 45], 2, 62));
        let worn = fractal(u, v, [4, 2], 4, 63);
        let stone = mix3([0.27, 0.265, 0.26], [0.10, 0.10, 0.105], fleck * 0.8);
        let shade = mix(0.75, 1.15, grain) * mix(0.8, 1.15, worn);
        let joint = smooth(0.004, 0.009, u.min(1.0 - u));
        let [r, g, b] = mix3([0.05, 0.047, 0.04], stone.map(|c| c * shade), joint);
        [r, g, b, 1.0]
    })
}

/// Heights of a cast cover: raised studs.
pub(super) fn cover() -> Raster {
    const STUDS: f32 = 10.0;
    Raster::gray(128, 128, |u, v| {
        let row = (v * STUDS).floor();
        let a = (u * STUDS + if row as i32 % 2 == 0 { 0.0 } else { 0.5 }).fract() - 0.5;
        let b = (v * STUDS).fract() - 0.5;
        smooth(0.34, 0.24, ops_norm(a, b)) * 3.0e-3
    })
}

/// Depth of a puddle: pools that run together, 1 where it is deepest.
pub(super) fn puddle() -> Raster {
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
