//! Bricks in a bond, plaster, stone, roof tiles and wood.
//!
//! Albedos: red brick 0.2 to 0.3, buff brick 0.3 to 0.4, mortar 0.4, light plaster 0.6 to 0.8 before its paint (Oke 1987, table
//! 1.1; CIBSE code for lighting).

use super::Tile;
use crate::scenes::noise::{fractal, hash, mix, mix3, smooth};
use crate::scenes::raster::Raster;

/// Edges of the tiles, meters.
pub(in crate::scenes) const BRICK_M: f32 = 1.35;
pub(in crate::scenes) const PLASTER_M: f32 = 3.0;
pub(in crate::scenes) const ROOF_M: f32 = 1.32;

/// Colors of bricks: two ends of their range, that of overburnt ones, and the mortar's.
pub(super) struct Bricks {
    colors: [[f32; 3]; 2],
    burnt: [f32; 3],
    mortar: [f32; 3],
}

/// Red bricks.
pub(super) const RED: Bricks = Bricks {
    colors: [[0.33, 0.135, 0.085], [0.25, 0.095, 0.062]],
    burnt: [0.12, 0.06, 0.05],
    mortar: [0.33, 0.305, 0.265],
};
/// Buff stock bricks.
pub(super) const PALE: Bricks = Bricks {
    colors: [[0.42, 0.325, 0.205], [0.33, 0.245, 0.155]],
    burnt: [0.19, 0.135, 0.095],
    mortar: [0.36, 0.335, 0.29],
};

/// Flemish bond: stretchers of 215 mm and headers of 102.5 mm take turns, joints of 10 mm, courses of 75 mm.
pub(super) fn brick(look: &Bricks) -> Tile {
    const SIZE: u32 = 512;
    const COURSES: i32 = 18;
    const PAIRS: i32 = 4;
    // Distance to the nearest edge of the brick, meters, with two random numbers of it.
    let brick = |u: f32, v: f32| {
        let course = (v * COURSES as f32).floor();
        let shift = if course as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let x = u * PAIRS as f32 + shift;
        let pair = (x.floor() as i32).rem_euclid(PAIRS);
        let along = (x - x.floor()) * 0.3375;
        let (length, start, half) = if along < 0.225 { (0.225, 0.0, 0) } else { (0.1125, 0.225, 1) };
        let a = along - start;
        let b = (v * COURSES as f32 - course) * 0.075;
        let edge = a.min(length - a).min(b).min(0.075 - b);
        let id = [pair * 2 + half, course as i32];
        (edge, hash(id[0], id[1], 71), hash(id[0], id[1], 72))
    };
    let body = |u: f32, v: f32| {
        let ragged = (fractal(u, v, [90, 90], 2, 73) - 0.5) * 5.0e-3;
        smooth(0.0035, 0.0065, brick(u, v).0 + ragged)
    };
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (_, tone, kind) = brick(u, v);
        let grain = mix(0.82, 1.18, fractal(u, v, [130, 130], 2, 74));
        let fired = mix3(look.colors[0], look.colors[1], tone);
        let clay = mix3(fired, look.burnt, smooth(0.86, 0.97, kind) * 0.8);
        let shade = grain * mix(0.85, 1.12, hash((tone * 1e6) as i32, 7, 75));
        let mortar = look.mortar.map(|c| c * mix(0.75, 1.1, fractal(u, v, [60, 60], 3, 76)));
        let [r, g, b] = mix3(mortar, clay.map(|c| c * shade), body(u, v));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (_, tone, _) = brick(u, v);
        body(u, v) * (4.0e-3 + tone * 1.5e-3) + fractal(u, v, [110, 110], 2, 77) * 0.5e-3
    });
    Tile { color, height, roughness: Raster::gray(8, 8, |_, _| 1.0) }
}

/// Float-finished plaster, white: its paint comes with the vertices.
pub(super) fn plaster() -> Tile {
    const SIZE: u32 = 256;
    let streak = |u: f32, v: f32| fractal(u, v, [40, 3], 3, 81);
    let color = Raster::gray(SIZE, SIZE, |u, v| {
        let cloud = fractal(u, v, [5, 5], 4, 82);
        0.86 * mix(0.96, 1.03, cloud) * mix(0.985, 1.012, streak(u, v))
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        fractal(u, v, [60, 60], 2, 83) * 0.9e-3 + fractal(u, v, [6, 6], 2, 84) * 2.0e-3
    });
    Tile { color, height, roughness: Raster::gray(8, 8, |_, _| 1.0) }
}

/// Dressed stone, light gray: its hue comes with the vertices.
pub(super) fn stone() -> Raster {
    Raster::gray(128, 128, |u, v| {
        let grain = fractal(u, v, [50, 50], 2, 91);
        0.82 * mix(0.84, 1.12, grain) * mix(0.84, 1.12, fractal(u, v, [4, 4], 4, 92))
    })
}

/// Plain roof tiles: 8 to a row of 1.32 m, 12 rows; their color comes with the vertices.
pub(super) fn roof_tiles() -> Tile {
    const SIZE: u32 = 256;
    const ROWS: i32 = 12;
    const COLUMNS: i32 = 8;
    // Height on the tile from its upper edge, sideways distance from a gap, and two random numbers.
    let tile = |u: f32, v: f32| {
        let row = (v * ROWS as f32).floor();
        let x = u * COLUMNS as f32 + if row as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let column = (x.floor() as i32).rem_euclid(COLUMNS);
        let across = x - x.floor();
        let down = v * ROWS as f32 - row;
        (down, across.min(1.0 - across), hash(column, row as i32, 101), hash(column, row as i32, 102))
    };
    let color = Raster::gray(SIZE, SIZE, |u, v| {
        let (down, side, tone, other) = tile(u, v);
        let lichen = smooth(0.62, 0.85, fractal(u, v, [10, 10], 4, 103)) * 0.3;
        let shade = mix(0.5, 0.92, tone) * mix(0.9, 1.1, other) + lichen;
        let shadow = smooth(0.0, 0.14, down) * smooth(0.01, 0.05, side);
        shade * mix(0.32, 1.0, shadow) * mix(0.88, 1.1, fractal(u, v, [80, 80], 2, 104))
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (down, side, tone, _) = tile(u, v);
        // A tile rises to its lower edge, which is above the next row.
        (down * 0.012 + tone * 3.0e-3) * smooth(0.0, 0.03, side)
    });
    Tile { color, height, roughness: Raster::gray(8, 8, |_, _| 1.0) }
}

/// Grain of planed wood along u; its color comes with the vertices.
pub(super) fn wood() -> Raster {
    Raster::gray(256, 64, |u, v| {
        let rings = fractal(u, v, [3, 24], 4, 111);
        let pores = fractal(u, v, [24, 90], 2, 112);
        0.8 * mix(0.72, 1.2, rings) * mix(0.85, 1.1, pores)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walls_reflect_what_real_ones_do() {
        let [red, _, blue] = brick(&RED).color.mean();
        assert!((0.2..0.35).contains(&red) && blue < 0.5 * red, "{red} {blue}");
        let [red, green, _] = brick(&PALE).color.mean();
        assert!((0.3..0.42).contains(&red) && (0.22..0.36).contains(&green), "{red} {green}");
        assert!((0.75..0.92).contains(&plaster().color.mean()[0]));
    }
}
