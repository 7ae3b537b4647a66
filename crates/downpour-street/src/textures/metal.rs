//! Zinc of roofs, and iron under old paint.

use super::Tile;
use crate::noise::{fractal, mix, mix3, smooth};
use crate::raster::Raster;

/// Edges of the tiles, meters.
pub(crate) const ZINC_M: f32 = 1.0;
pub(crate) const IRON_M: f32 = 0.7;

/// Weathered zinc in sheets of half a meter with standing seams along v.
pub(super) fn zinc() -> Tile {
    // Sideways distance from the nearest seam, meters.
    let seam = |u: f32| {
        let x = (u * 2.0).fract();
        (x - 0.5).abs() * 0.5
    };
    let patina = |u: f32, v: f32| fractal(u, v, [3, 2], 5, 181);
    let streak = |u: f32, v: f32| fractal(u, v, [34, 2], 3, 182);
    let clean = |u: f32| smooth(0.006, 0.035, seam(u));
    let color = Raster::gray(256, 256, |u, v| {
        mix(0.34, 0.56, patina(u, v)) * mix(0.82, 1.08, streak(u, v)) * mix(0.6, 1.0, clean(u))
    });
    let height = Raster::gray(256, 256, |u, v| {
        smooth(0.016, 0.006, seam(u)) * 0.014 + fractal(u, v, [4, 3], 3, 183) * 5.0e-3
    });
    // A map of a metal: what is rough in green, what is metal in blue.
    let roughness = Raster::new(128, 128, |u, v| {
        let skin = mix(0.36, 0.54, patina(u, v)) + 0.1 * (streak(u, v) - 0.5);
        [1.0, mix(0.72, skin, clean(u)), 1.0, 1.0]
    });
    Tile { color, height, roughness }
}

/// Paint over iron, with rust where it has gone; its color comes with the vertices.
pub(super) fn iron() -> Tile {
    let grain = |u: f32, v: f32| fractal(u, v, [60, 60], 2, 186);
    let rust = |u: f32, v: f32| smooth(0.60, 0.72, fractal(u, v, [9, 9], 5, 187));
    let color = Raster::new(256, 256, |u, v| {
        let shade = mix(0.40, 0.56, grain(u, v));
        let [r, g, b] = mix3([shade; 3], [0.95, 0.58, 0.36].map(|c| c * shade * 2.0), rust(u, v));
        [r, g, b, 1.0]
    });
    let roughness = Raster::gray(128, 128, |u, v| mix(mix(0.42, 0.58, grain(u, v)), 0.92, rust(u, v)));
    Tile::flat(color, roughness)
}
