//! Normals of the water by Sobel sums. Twin of `shaders/wgsl/lattice/puddle_normal.wgsl`.
//!
//! x runs along the rows of the lattice, z along its columns, y is up. Missing neighbors are replaced as for the
//! ripples: by the cell itself, or by its image in the wall.

use downpour_math::pyramid::{PyramidLevel, PyramidRounding, pyramid_levels};
use rayon::prelude::*;

use super::lattice::{Links, PuddleQuad, linked};

/// Slopes along x and z of a cell. Rows are three heights each, west to east; `scale` is the inverse of eight cells.
#[inline(always)]
fn slope(north: [f32; 3], here: [f32; 3], south: [f32; 3], links: u32, scale: f32) -> [f32; 2] {
    let [[nw, n, ne], [w, _, e], [sw, s, se]] = linked(north, here, south, links);
    let x = ((ne - nw) + (se - sw)) + 2.0 * (e - w);
    let z = ((sw - nw) + (se - ne)) + 2.0 * (s - n);
    [x * scale, z * scale]
}

/// Slopes along x and z of a quad. Rows are the quads west of, at and east of the quad.
#[must_use]
pub fn puddle_normal_slopes(
    north: [PuddleQuad; 3],
    here: [PuddleQuad; 3],
    south: [PuddleQuad; 3],
    links: u32,
    scale: f32,
) -> [PuddleQuad; 2] {
    let slopes: [[f32; 2]; 4] = std::array::from_fn(|i| {
        let pick = |row: [PuddleQuad; 3]| row.map(|quad| quad[i]);
        slope(pick(north), pick(here), pick(south), links >> (8 * i), scale)
    });
    [0, 1].map(|axis| slopes.map(|s| s[axis]))
}

/// x and z components of the normal of a surface with these slopes.
#[inline(always)]
#[must_use]
pub fn puddle_normal_lean(slope: [f32; 2]) -> [f32; 2] {
    let length = (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
    slope.map(|s| -s / length)
}

/// Full normal: the y component completes the length 1.
#[inline(always)]
pub(crate) fn whole([x, z]: [f32; 2]) -> [f32; 3] {
    [x, (1.0 - x * x - z * z).max(0.0).sqrt(), z]
}

/// Texel of a surface with these slopes: the slopes of its normal, at most 1000, the square of the slope, and 0.
#[must_use]
pub fn puddle_normal_texel(slope: [f32; 2]) -> [f32; 4] {
    let [x, up, z] = whole(puddle_normal_lean(slope));
    let up = up.max(1.0e-3);
    let [x, z] = [-x / up, -z / up];
    [x, z, x * x + z * z, 0.0]
}

/// Normals of all cells, from heights row by row.
pub(crate) fn normals(links: &Links, heights: &[f32], scale: f32) -> Vec<[f32; 3]> {
    each_slope(links, heights, scale, |slope| whole(puddle_normal_lean(slope)))
}

/// Texels of all cells, from heights row by row.
pub(crate) fn texels(links: &Links, heights: &[f32], scale: f32) -> Vec<[f32; 4]> {
    each_slope(links, heights, scale, puddle_normal_texel)
}

/// Levels of the slopes of a lattice below the finest: means of four of the one before, down to two cells along an edge.
#[must_use]
pub fn slope_levels(size: [u32; 2]) -> Vec<PyramidLevel> {
    let levels = pyramid_levels(size, PyramidRounding::Down);
    levels.into_iter().filter(|level| level.size[0] > 1).collect()
}

/// A value for the slopes of each cell.
fn each_slope<T: Send>(
    links: &Links,
    heights: &[f32],
    scale: f32,
    of: impl Fn([f32; 2]) -> T + Sync,
) -> Vec<T> {
    let [nx, ny] = links.size;
    let at = |x: isize, y: isize| {
        let inside = x >= 0 && y >= 0 && x < nx as isize && y < ny as isize;
        if inside { heights[y as usize * nx + x as usize] } else { 0.0 }
    };
    (0..nx * ny)
        .into_par_iter()
        .map(|i| {
            let (x, y) = ((i % nx) as isize, (i / nx) as isize);
            let row = |y: isize| [at(x - 1, y), at(x, y), at(x + 1, y)];
            let bits = u32::from(links.bytes[y as usize * links.stride() + x as usize]);
            of(slope(row(y - 1), row(y), row(y + 1), bits, scale))
        })
        .collect()
}
