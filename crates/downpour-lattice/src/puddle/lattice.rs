//! Cells, their links, and one step of a cell. Twin of `shaders/wgsl/lattice/puddle.wgsl`.
//!
//! Four cells of a row are a quad, the unit of memory and of the shaders' arithmetic. A link is a bit: the neighbor
//! exists and is water. Where a link is missing, the neighbor is replaced by the cell itself, or by its image in a
//! straight wall: that reflects ripples without loss, and the operator stays symmetric. For every square of four cells
//! its quadratic form is at most that of open water, so no coast has a larger eigenvalue, and the time step that is
//! stable on open water is stable everywhere.

use downpour_math::ops::ops_is_finite;
use downpour_math::real::Real;
use downpour_shaders::lattice::puddle::{
    PUDDLE_HALF_SCALE, PUDDLE_LINK_EAST, PUDDLE_LINK_NORTH, PUDDLE_LINK_NORTH_EAST, PUDDLE_LINK_NORTH_WEST,
    PUDDLE_LINK_SOUTH, PUDDLE_LINK_SOUTH_EAST, PUDDLE_LINK_SOUTH_WEST, PUDDLE_LINK_WEST, PUDDLE_MIN,
};

/// Four cells of a row.
pub type PuddleQuad = [f32; 4];

/// A lattice and one time step of it, in the layout of `PuddleGrid` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PuddleGrid {
    /// Number of cells along each edge.
    pub size: [u32; 2],
    /// Number of quads in a row of memory.
    pub quads: u32,
    /// Degree of the polynomial.
    pub degree: u32,
    /// Coefficients of the polynomial over the first of them.
    pub coefficients: [[f32; 4]; 4],
    /// Weights of the cell, of its straight and of its diagonal neighbors.
    pub weights: [f32; 3],
    /// Time step, s.
    pub dt: f32,
    /// Factor from a weighted sum to 2 x of the polynomial.
    pub twice: f32,
    /// Factor from the last weighted sum to a change of velocity.
    pub kick: f32,
    /// Viscosity: fraction of the velocity that is added to the argument of the last sum.
    pub viscosity: f32,
    /// Fraction of a velocity that remains after a time step, far from the border.
    pub keep: f32,
    /// Width of the absorbing border, in cells; 0: the border reflects.
    pub sponge_cells: f32,
    /// Drag at the edge times the time step.
    pub sponge_drag: f32,
    /// Number of time steps per sweep.
    pub steps: u32,
    /// Width of the halo that a tile reads around the cells that it writes.
    pub halo: u32,
    /// 1 if the state is stored in 16 bits per number.
    pub half_storage: u32,
    /// Inverse of eight cells, 1/m: factor of the Sobel sums.
    pub slope: f32,
    /// First texel of the slopes that `main_puddle_normal_slopes` writes.
    pub first_texel: u32,
    /// Padding of the WGSL layout.
    pub padding: u32,
}

/// Value of the neighbor, or of the cell itself where the link is missing.
#[inline(always)]
#[must_use]
pub fn puddle_linked(own: f32, other: f32, links: u32, link: u32) -> f32 {
    if links & link != 0 { other } else { own }
}

/// Value of a diagonal neighbor. Where its link is missing, it is the mirror image in the wall that the two adjacent
/// straight neighbors `a` and `b` define: `b` if only that is water, `a` if only that is, else the cell itself.
#[inline(always)]
#[must_use]
pub fn puddle_corner(own: f32, straight: [f32; 2], diagonal: f32, links: u32, bits: [u32; 3]) -> f32 {
    let [a, b] = straight;
    let level = puddle_linked(b, puddle_linked(a, own, links, bits[1]), links, bits[0]);
    puddle_linked(level, diagonal, links, bits[2])
}

/// Three by three cells whose middle one has these links, with land replaced.
#[inline(always)]
pub(crate) fn linked(north: [f32; 3], here: [f32; 3], south: [f32; 3], links: u32) -> [[f32; 3]; 3] {
    let own = here[1];
    let n = puddle_linked(own, north[1], links, PUDDLE_LINK_NORTH);
    let s = puddle_linked(own, south[1], links, PUDDLE_LINK_SOUTH);
    let w = puddle_linked(own, here[0], links, PUDDLE_LINK_WEST);
    let e = puddle_linked(own, here[2], links, PUDDLE_LINK_EAST);
    let corner = |a, b, value, bits| puddle_corner(own, [a, b], value, links, bits);
    [
        [
            corner(n, w, north[0], [PUDDLE_LINK_NORTH, PUDDLE_LINK_WEST, PUDDLE_LINK_NORTH_WEST]),
            n,
            corner(n, e, north[2], [PUDDLE_LINK_NORTH, PUDDLE_LINK_EAST, PUDDLE_LINK_NORTH_EAST]),
        ],
        [w, own, e],
        [
            corner(s, w, south[0], [PUDDLE_LINK_SOUTH, PUDDLE_LINK_WEST, PUDDLE_LINK_SOUTH_WEST]),
            s,
            corner(s, e, south[2], [PUDDLE_LINK_SOUTH, PUDDLE_LINK_EAST, PUDDLE_LINK_SOUTH_EAST]),
        ],
    ]
}

/// Weighted sum over the neighbors of one cell. `north`, `here` and `south` are three values each, west to east.
#[inline(always)]
pub(crate) fn laplacian<R: Real>(north: [R; 3], here: [R; 3], south: [R; 3], weights: [R; 3]) -> R {
    let straight = (north[1] + south[1]) + (here[0] + here[2]);
    let diagonal = (north[0] + north[2]) + (south[0] + south[2]);
    weights[0] * here[1] - (weights[1] * straight + weights[2] * diagonal)
}

/// Weighted sum with the links of the cell.
#[inline(always)]
pub(crate) fn laplacian_linked(
    north: [f32; 3],
    here: [f32; 3],
    south: [f32; 3],
    links: u32,
    weights: [f32; 3],
) -> f32 {
    let [north, here, south] = linked(north, here, south, links);
    laplacian(north, here, south, weights)
}

/// Weighted sum over the neighbors, for a quad. Rows are the quads west of, at and east of the quad; `links` has a
/// byte per cell, the first in the lowest bits.
#[must_use]
pub fn puddle_laplacian(
    north: [PuddleQuad; 3],
    here: [PuddleQuad; 3],
    south: [PuddleQuad; 3],
    links: u32,
    weights: [f32; 3],
) -> PuddleQuad {
    std::array::from_fn(|i| {
        let pick = |row: [PuddleQuad; 3]| row.map(|quad| quad[i]);
        laplacian_linked(pick(north), pick(here), pick(south), links >> (8 * i), weights)
    })
}

/// Next sum of Clenshaw's recurrence.
#[inline(always)]
#[must_use]
pub fn puddle_recur<R: Real>(wave: R, sum: R, now: R, before: R) -> R {
    (wave + sum) - (now + before)
}

/// Fraction of a velocity that remains at a distance, in cells, from the border: the drag grows as the square of the
/// depth into the border.
#[inline(always)]
#[must_use]
pub fn puddle_keep(distance: f32, keep: f32, sponge_cells: f32, sponge_drag: f32) -> f32 {
    let into = (sponge_cells - distance).max(0.0) / sponge_cells.max(1.0);
    keep / (1.0 + sponge_drag * (into * into))
}

/// Distance of a cell's center from the nearest border along an axis of `size` cells, in cells.
#[inline(always)]
#[must_use]
pub fn puddle_border(cell: u32, size: u32) -> f32 {
    cell.min((size.max(1) - 1).saturating_sub(cell)) as f32 + 0.5
}

/// Sets a number to 0 if it is below 1e-20, which would be slow, or not finite.
#[inline(always)]
#[must_use]
pub fn puddle_settle(value: f32) -> f32 {
    if ops_is_finite(value) && value.abs() >= PUDDLE_MIN { value } else { 0.0 }
}

/// Converts a finite number to a half, to nearest, ties to even; clamped to the range of a half.
#[inline(always)]
#[must_use]
pub fn puddle_state_half(value: f32) -> u32 {
    let limited = value.clamp(-65504.0, 65504.0);
    let bits = limited.to_bits();
    let magnitude = bits & 0x7fff_ffff;
    let small = (limited.abs().min(1.0) * 16_777_216.0).round_ties_even() as u32;
    let rounded = magnitude.wrapping_add(0xfff + ((magnitude >> 13) & 1));
    let normal = rounded.wrapping_sub(0x3800_0000) >> 13;
    ((bits >> 16) & 0x8000) | if magnitude < 0x3880_0000 { small } else { normal }
}

/// Converts a finite half to a float.
#[inline(always)]
#[must_use]
pub fn puddle_state_float(half: u32) -> f32 {
    let magnitude = half & 0x7fff;
    let normal = f32::from_bits((magnitude << 13) + 0x3800_0000);
    let small = magnitude as f32 * 5.960_464_5e-8;
    let value = if magnitude < 0x400 { small } else { normal };
    if half & 0x8000 != 0 { -value } else { value }
}

/// Packs height and velocity into 16 bits each.
#[inline(always)]
#[must_use]
pub fn puddle_state_pack(height: f32, velocity: f32) -> u32 {
    puddle_state_half(height * PUDDLE_HALF_SCALE) | puddle_state_half(velocity * PUDDLE_HALF_SCALE) << 16
}

/// Unpacks height and velocity of [`puddle_state_pack`].
#[inline(always)]
#[must_use]
pub fn puddle_state_unpack(word: u32) -> [f32; 2] {
    [word & 0xffff, word >> 16].map(|half| puddle_state_float(half) * (1.0 / PUDDLE_HALF_SCALE))
}

/// Cells of water and the links to their neighbors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Links {
    pub(crate) size: [usize; 2],
    /// A byte per cell, in rows of whole quads.
    pub(crate) bytes: Vec<u8>,
    /// Runs of cells of a row that are either all fully linked or not: (end, fully linked), per row.
    pub(crate) runs: Vec<Vec<(usize, bool)>>,
}

impl Links {
    /// Creates the links of the cells for which `is_land` is false.
    pub(crate) fn new(size: [usize; 2], is_land: impl Fn(usize, usize) -> bool) -> Self {
        let [nx, ny] = size;
        let stride = nx.next_multiple_of(4);
        let water: Vec<bool> = (0..nx * ny).map(|i| !is_land(i % nx, i / nx)).collect();
        let at = |x: isize, y: isize| {
            let inside = x >= 0 && y >= 0 && x < nx as isize && y < ny as isize;
            inside && water[y as usize * nx + x as usize]
        };
        let steps: [(u32, isize, isize); 8] = [
            (PUDDLE_LINK_WEST, -1, 0),
            (PUDDLE_LINK_EAST, 1, 0),
            (PUDDLE_LINK_NORTH, 0, -1),
            (PUDDLE_LINK_SOUTH, 0, 1),
            (PUDDLE_LINK_NORTH_WEST, -1, -1),
            (PUDDLE_LINK_NORTH_EAST, 1, -1),
            (PUDDLE_LINK_SOUTH_WEST, -1, 1),
            (PUDDLE_LINK_SOUTH_EAST, 1, 1),
        ];
        let mut bytes = vec![0; stride * ny];
        let mut runs = Vec::with_capacity(ny);
        for (y, row) in bytes.chunks_exact_mut(stride).enumerate() {
            for (x, byte) in row.iter_mut().enumerate().take(nx) {
                if !at(x as isize, y as isize) {
                    continue;
                }
                for (bit, dx, dy) in steps {
                    if at(x as isize + dx, y as isize + dy) {
                        *byte |= bit as u8;
                    }
                }
            }
            runs.push(runs_of(&row[..nx]));
        }
        Self { size, bytes, runs }
    }

    pub(crate) fn stride(&self) -> usize {
        self.size[0].next_multiple_of(4)
    }

    /// True if a cell is water with at least one neighbor.
    pub(crate) fn is_water(&self, x: usize, y: usize) -> bool {
        self.bytes.get(y * self.stride() + x).is_some_and(|&byte| byte != 0)
    }
}

/// Runs of at least 16 fully linked cells, and the runs between them.
fn runs_of(row: &[u8]) -> Vec<(usize, bool)> {
    let mut runs: Vec<(usize, bool)> = Vec::new();
    let mut start = 0;
    while start < row.len() {
        let open = row[start] == u8::MAX;
        let length = row[start..].iter().take_while(|&&byte| (byte == u8::MAX) == open).count();
        let open = open && length >= 16;
        start += length;
        match runs.last_mut() {
            Some((end, false)) if !open => *end = start,
            _ => runs.push((start, open)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use half::f16;

    #[test]
    fn halves_are_those_of_the_library() {
        for bits in (0..=u32::MAX - 40_009).step_by(40_009) {
            let value = f32::from_bits(bits);
            if value.is_finite() && value.abs() < 65504.0 {
                assert_eq!(puddle_state_half(value), u32::from(f16::from_f32(value).to_bits()), "{value:e}");
            }
        }
        for half in (0..0x7c00).chain(0x8000..0xfc00) {
            assert_eq!(puddle_state_float(half).to_bits(), f16::from_bits(half as u16).to_f32().to_bits());
        }
    }
}
