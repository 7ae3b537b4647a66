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
    let color = Raster::gray(256, 256, |u, v| {
        let patina = mix(0.34, 0.56, fractal(u, v, [3, 2], 5, 181));
        let streak = mix(0.82, 1.08, fractal(u, v, [34, 2], 3, 182));
        let dirt = mix(0.6, 1.0, smooth(0.006, 0.035, seam(u)));
        patina * streak * dirt
    });
    let height = Raster::gray(256, 256, |u, v| {
        smooth(0.016, 0.006, seam(u)) * 0.014 + fractal(u, v, [4, 3], 3, 183) * 5.0e-3
    });
    Tile::plain(color, height)
}

/// Paint over iron, with rust where it has gone; its color comes with the vertices.
pub(super) fn iron() -> Raster {
    Raster::new(256, 256, |u, v| {
        let grain = mix(0.40, 0.56, fractal(u, v, [60, 60], 2, 186));
        let patch = fractal(u, v, [9, 9], 5, 187);
        let rust = smooth(0.60, 0.72, patch);
        let [r, g, b] = mix3([grain; 3], [0.95, 0.58, 0.36].map(|c| c * grain * 2.0), rust);
        [r, g, b, 1.0]
    })
}
