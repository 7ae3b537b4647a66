//! Bricks in a bond, plaster, stone, roof tiles and wood.
//!
//! Albedos: red brick 0.2 to 0.3, buff brick 0.3 to 0.4, mortar 0.4, light plaster 0.6 to 0.8 before its paint (Oke 1987, table
//! 1.1; CIBSE code for lighting).

use super::Tile;
use crate::noise::{cellular, fractal, hash, mix, mix3, smooth};
use crate::raster::Raster;

/// Edges of the tiles, meters.
pub(crate) const BRICK_M: f32 = 1.35;
pub(crate) const PLASTER_M: f32 = 3.0;
pub(crate) const ROOF_M: f32 = 1.32;
pub(crate) const ASHLAR_M: f32 = 2.4;
pub(crate) const JOINERY_M: f32 = 0.8;
pub(crate) const CLOTH_M: f32 = 0.25;

/// Colors of bricks: two ends of their range, that of overburnt ones, and the mortar's.
pub(crate) struct Bricks {
    colors: [[f32; 3]; 2],
    burnt: [f32; 3],
    mortar: [f32; 3],
}

/// Red bricks.
pub(crate) const RED: Bricks = Bricks {
    colors: [[0.33, 0.135, 0.085], [0.25, 0.095, 0.062]],
    burnt: [0.12, 0.06, 0.05],
    mortar: [0.33, 0.305, 0.265],
};
/// Buff stock bricks.
pub(crate) const PALE: Bricks = Bricks {
    colors: [[0.42, 0.325, 0.205], [0.33, 0.245, 0.155]],
    burnt: [0.19, 0.135, 0.095],
    mortar: [0.36, 0.335, 0.29],
};

/// Flemish bond: stretchers of 215 mm and headers of 102.5 mm take turns, joints of 10 mm, courses of 75 mm.
pub(crate) fn brick(look: &Bricks) -> Tile {
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
    // Overburnt bricks have a skin of glass.
    let roughness = Raster::gray(SIZE / 2, SIZE / 2, |u, v| {
        let (_, _, kind) = brick(u, v);
        let clay = mix(0.84, 0.95, fractal(u, v, [20, 20], 3, 78)) - 0.25 * smooth(0.86, 0.97, kind);
        mix(0.97, clay, body(u, v))
    });
    Tile { color, height, roughness }
}

/// Float-finished plaster, white: its paint comes with the vertices. Rain has streaked it, and hair cracks go through it.
pub(super) fn plaster() -> Tile {
    const SIZE: u32 = 512;
    let streak = |u: f32, v: f32| fractal(u, v, [46, 3], 3, 81);
    let crack = |u: f32, v: f32| {
        let bend = (fractal(u, v, [9, 9], 3, 86) - 0.5) * 0.12;
        let cell = cellular((u + bend).rem_euclid(1.0), (v - bend).rem_euclid(1.0), [4, 3], 85);
        smooth(0.016, 0.004, cell.second - cell.nearest) * smooth(0.50, 0.62, fractal(u, v, [3, 3], 2, 87))
    };
    let damp = |u: f32, v: f32| smooth(0.54, 0.78, fractal(u, v, [3, 5], 4, 88));
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let cloud = fractal(u, v, [4, 4], 5, 82);
        let tone =
            0.87 * mix(0.90, 1.05, cloud) * mix(0.955, 1.02, streak(u, v)) * mix(1.0, 0.68, crack(u, v));
        let [r, g, b] = mix3([1.0; 3], [0.86, 0.85, 0.80], damp(u, v)).map(|c| (c * tone).min(1.0));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        fractal(u, v, [120, 120], 2, 83) * 0.8e-3 + fractal(u, v, [7, 7], 3, 84) * 3.5e-3
            - crack(u, v) * 1.2e-3
    });
    // Paint holds on longest where it stays dry; elsewhere it has chalked.
    let roughness = Raster::gray(128, 128, |u, v| {
        mix(0.86, 0.94, fractal(u, v, [24, 24], 3, 89)) + 0.05 * damp(u, v).max(crack(u, v))
    });
    Tile { color, height, roughness }
}

/// Blocks of limestone: courses of 40 cm, blocks of 80 cm in half bond, joints of 7 mm; the hue comes with the vertices.
pub(super) fn ashlar() -> Tile {
    const SIZE: u32 = 512;
    const COURSES: f32 = 6.0;
    const BLOCKS: f32 = 3.0;
    let block = |u: f32, v: f32| {
        let course = (v * COURSES).floor();
        let x = u * BLOCKS + if course as i32 % 2 == 0 { 0.0 } else { 0.5 };
        let number = (x.floor() as i32).rem_euclid(BLOCKS as i32);
        let (a, b) = ((x - x.floor()) * 0.8, (v * COURSES - course) * 0.4);
        let edge = a.min(0.8 - a).min(b).min(0.4 - b);
        (edge, hash(number, course as i32, 95), hash(number, course as i32, 96))
    };
    let body = |u: f32, v: f32| {
        let ragged = (fractal(u, v, [70, 70], 2, 97) - 0.5) * 4.0e-3;
        smooth(0.0025, 0.0075, block(u, v).0 + ragged)
    };
    let pits = |u: f32, v: f32| smooth(0.66, 0.80, fractal(u, v, [64, 40], 3, 98));
    let color = Raster::new(SIZE, SIZE, |u, v| {
        let (edge, tone, hue) = block(u, v);
        let grain = mix(0.90, 1.08, fractal(u, v, [100, 100], 2, 99));
        let bed = mix(0.92, 1.06, fractal(u, v, [3, 26], 3, 100));
        let soot = mix(0.84, 1.0, smooth(0.0, 0.04, edge));
        let warm = mix3([0.96, 1.0, 1.0], [1.0, 0.97, 0.90], hue);
        let shade = 0.84 * mix(0.86, 1.08, tone) * grain * bed * soot * mix(1.0, 0.78, pits(u, v));
        let [r, g, b] = mix3([0.42, 0.40, 0.37], warm.map(|c| c * shade), body(u, v)).map(|c| c.min(1.0));
        [r, g, b, 1.0]
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (_, tone, _) = block(u, v);
        body(u, v) * (6.0e-3 + tone * 1.5e-3) + fractal(u, v, [40, 40], 3, 89) * 1.6e-3 - pits(u, v) * 1.5e-3
    });
    // Sawn faces, some rubbed smooth, between joints and pits.
    let roughness = Raster::gray(SIZE / 2, SIZE / 2, |u, v| {
        let (_, tone, hue) = block(u, v);
        let face = 0.74 + 0.1 * tone + 0.06 * hue + 0.12 * (fractal(u, v, [20, 20], 3, 90) - 0.5);
        mix(0.96, face, body(u, v) * (1.0 - pits(u, v)))
    });
    Tile { color, height, roughness }
}

/// Dressed stone, light gray: its hue comes with the vertices.
pub(super) fn stone() -> Tile {
    let color = Raster::gray(256, 256, |u, v| {
        let grain = fractal(u, v, [70, 70], 2, 91);
        0.82 * mix(0.88, 1.10, grain) * mix(0.82, 1.12, fractal(u, v, [4, 4], 5, 92))
    });
    let height = Raster::gray(256, 256, |u, v| {
        fractal(u, v, [50, 50], 2, 93) * 0.7e-3 + fractal(u, v, [8, 8], 3, 94) * 1.4e-3
    });
    let roughness = Raster::gray(128, 128, |u, v| {
        mix(0.70, 0.90, fractal(u, v, [4, 4], 5, 92)) + 0.1 * (fractal(u, v, [20, 20], 2, 95) - 0.5)
    });
    Tile { color, height, roughness }
}

/// Paint on wood, brushed along v, with fine cracks and dirt; its color comes with the vertices.
pub(super) fn joinery() -> Tile {
    let worn = |u: f32, v: f32| smooth(0.60, 0.74, fractal(u, v, [40, 5], 4, 115));
    let dirt = |u: f32, v: f32| fractal(u, v, [4, 4], 4, 114);
    let color = Raster::gray(256, 256, |u, v| {
        let brushed = mix(0.90, 1.02, fractal(u, v, [90, 4], 2, 113));
        0.94 * brushed * mix(0.84, 1.03, dirt(u, v)) * mix(1.0, 0.74, worn(u, v))
    });
    let height = Raster::gray(256, 256, |u, v| fractal(u, v, [80, 4], 2, 116) * 0.5e-3 - worn(u, v) * 0.4e-3);
    // Gloss paint under dirt, dull where it is worn.
    let roughness = Raster::gray(128, 128, |u, v| mix(mix(0.60, 0.34, dirt(u, v)), 0.82, worn(u, v)));
    Tile { color, height, roughness }
}

/// Canvas, white: its color comes with the vertices.
pub(super) fn cloth() -> Tile {
    let weave = |u: f32, v: f32| {
        let (x, y) = (u * 64.0, v * 64.0);
        let over = (x.floor() as i32 + y.floor() as i32) % 2 == 0;
        let t = if over { x.fract() } else { y.fract() };
        4.0 * t * (1.0 - t)
    };
    let color = Raster::gray(128, 128, |u, v| {
        0.92 * mix(0.86, 1.0, weave(u, v)) * mix(0.92, 1.05, fractal(u, v, [4, 4], 3, 118))
    });
    let height = Raster::gray(128, 128, |u, v| weave(u, v) * 0.3e-3 + fractal(u, v, [3, 3], 2, 119) * 2.0e-3);
    Tile::plain(color, height)
}

/// Plain roof tiles: 8 to a row of 1.32 m, 12 rows; their color comes with the vertices.
pub(crate) fn roof_tiles() -> Tile {
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
    let lichen = |u: f32, v: f32| smooth(0.62, 0.85, fractal(u, v, [10, 10], 4, 103));
    let color = Raster::gray(SIZE, SIZE, |u, v| {
        let (down, side, tone, other) = tile(u, v);
        let shade = mix(0.5, 0.92, tone) * mix(0.9, 1.1, other) + lichen(u, v) * 0.3;
        let shadow = smooth(0.0, 0.14, down) * smooth(0.01, 0.05, side);
        shade * mix(0.32, 1.0, shadow) * mix(0.88, 1.1, fractal(u, v, [80, 80], 2, 104))
    });
    let height = Raster::gray(SIZE, SIZE, |u, v| {
        let (down, side, tone, _) = tile(u, v);
        // A tile rises to its lower edge, which is above the next row.
        (down * 0.012 + tone * 3.0e-3) * smooth(0.0, 0.03, side)
    });
    let roughness = Raster::gray(SIZE / 2, SIZE / 2, |u, v| {
        let (_, _, tone, other) = tile(u, v);
        mix(0.62 + 0.12 * tone + 0.10 * other, 0.97, lichen(u, v))
    });
    Tile { color, height, roughness }
}

/// Grain of planed wood along u; its color comes with the vertices.
pub(super) fn wood() -> Tile {
    let rings = |u: f32, v: f32| fractal(u, v, [3, 24], 4, 111);
    let pores = |u: f32, v: f32| fractal(u, v, [24, 90], 2, 112);
    let color = Raster::gray(256, 64, |u, v| 0.8 * mix(0.72, 1.2, rings(u, v)) * mix(0.85, 1.1, pores(u, v)));
    // Late wood is dense and takes a polish; pores are open.
    let roughness = Raster::gray(256, 64, |u, v| mix(0.50, 0.78, rings(u, v)) + 0.12 * (0.5 - pores(u, v)));
    Tile::flat(color, roughness)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::metal::{iron, zinc};

    /// Roughness is that of what it is in the mean, varies, and is none that a surface cannot have.
    #[test]
    fn materials_are_as_rough_as_real_ones() {
        for (name, tile, mean, least_spread) in [
            ("brick", brick(&RED), 0.91, 0.02),
            ("plaster", plaster(), 0.92, 0.01),
            ("ashlar", ashlar(), 0.84, 0.03),
            ("stone", stone(), 0.80, 0.02),
            ("roof", roof_tiles(), 0.75, 0.04),
            ("joinery", joinery(), 0.51, 0.04),
            ("wood", wood(), 0.64, 0.02),
            ("zinc", zinc(), 0.49, 0.02),
            ("iron", iron(), 0.56, 0.05),
        ] {
            let found = tile.roughness.mean()[1];
            let [least, most, spread] = tile.roughness.spread();
            assert!((found - mean).abs() < 0.03, "{name}: {found}");
            assert!(spread > least_spread && spread < 0.2, "{name}: {spread}");
            assert!(least >= 0.25 && most <= 1.0, "{name}: {least} to {most}");
        }
    }

    #[test]
    fn walls_reflect_what_real_ones_do() {
        let [red, _, blue] = brick(&RED).color.mean();
        assert!((0.2..0.35).contains(&red) && blue < 0.5 * red, "{red} {blue}");
        let [red, green, _] = brick(&PALE).color.mean();
        assert!((0.3..0.42).contains(&red) && (0.22..0.36).contains(&green), "{red} {green}");
        assert!((0.75..0.92).contains(&plaster().color.mean()[0]));
    }
}
