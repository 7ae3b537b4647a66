//! One row of a pass over a tile, in vectors where all its cells are linked and cell by cell along coasts. Both ways do
//! the same operations in the same order.

use std::ops::Range;

use downpour_math::ops::ops_is_finite;
use downpour_math::real::{Lanes, Real, Simd};
use downpour_shaders::lattice::puddle::PUDDLE_SMALLEST;

use super::tile::Tile;
use crate::puddle::lattice::{Links, PuddleGrid, laplacian, laplacian_linked, puddle_recur, puddle_settle};

/// A row in parts as wide as the machine's vectors.
#[inline(always)]
pub(super) fn parts<S: Simd>(n: usize) -> impl Iterator<Item = Range<usize>> {
    (0..n).step_by(Lanes::<S>::COUNT).map(move |i| i..n.min(i + Lanes::<S>::COUNT))
}

/// Three rows of the argument, from one cell before a run to one behind it.
#[derive(Clone, Copy)]
struct Rows<'a>([&'a [f32]; 3]);

impl<'a> Rows<'a> {
    #[inline(always)]
    fn new(now: &'a [f32], at: usize, n: usize, stride: usize) -> Self {
        Self([at - stride, at, at + stride].map(|at| &now[at - 1..at + n + 1]))
    }

    /// The weighted sums of a part of the run, all of whose cells are linked.
    #[inline(always)]
    fn sums<S: Simd, const DIAGONAL: bool>(
        self,
        simd: S,
        part: &Range<usize>,
        weights: [f32; 3],
    ) -> [Lanes<S>; 2] {
        let zero = Lanes::splat(simd, 0.0);
        let load =
            |row: usize, shift: usize| Lanes::load(simd, &self.0[row][part.start + shift..part.end + shift]);
        // The weight of the diagonal is 0 for a membrane.
        let corner = |row, shift| if DIAGONAL { load(row, shift) } else { zero };
        let here = [load(1, 0), load(1, 1), load(1, 2)];
        let north = [corner(0, 0), load(0, 1), corner(0, 2)];
        let south = [corner(2, 0), load(2, 1), corner(2, 2)];
        [laplacian(north, here, south, weights.map(|w| Lanes::splat(simd, w))), here[1]]
    }

    /// The weighted sum of cell `i` with its links, and its value.
    #[inline(always)]
    fn sum(self, i: usize, links: u8, weights: [f32; 3]) -> [f32; 2] {
        let [north, here, south] = self.0.map(|row| [row[i], row[i + 1], row[i + 2]]);
        [laplacian_linked(north, here, south, u32::from(links), weights), here[1]]
    }
}

/// One row of Clenshaw's recurrence, into `before`.
#[expect(clippy::too_many_arguments, reason = "a row of a pass has that many inputs")]
#[inline(always)]
pub(super) fn recur_row<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    columns: &Range<usize>,
    y: usize,
    coefficient: f32,
    last: bool,
) {
    // The last sum is multiplied by y = 2 x - 1 alone, those before by 2 y.
    let (twice, share) = if last { (grid.twice, 1.0) } else { (2.0 * grid.twice, 2.0) };
    let splat = |value| Lanes::splat(simd, value);
    let (stride, row) = (tile.stride(), tile.row(y));
    let mut start = columns.start;
    for &(end, open) in &links.runs[y] {
        let end = end.min(columns.end);
        if end <= start {
            continue;
        }
        let n = end - start;
        let at = row + start - tile.outer[0].start;
        let rows = Rows::new(&tile.now, at, n, stride);
        let (before, h) = (&mut tile.before[at..at + n], &tile.heights[at..at + n]);
        let v = &tile.velocities[at..at + n];
        if open {
            for part in parts::<S>(n) {
                let [sum, now] = rows.sums::<S, DIAGONAL>(simd, &part, grid.weights);
                let wave = splat(coefficient) * Lanes::load(simd, &h[part.clone()]);
                let older = Lanes::load(simd, &before[part.clone()]);
                let mut value = puddle_recur(wave, splat(twice) * sum, splat(share) * now, older);
                if last {
                    value = value + splat(grid.viscosity) * Lanes::load(simd, &v[part.clone()]);
                }
                value.store(&mut before[part]);
            }
        } else {
            let bytes = &links.bytes[y * links.stride() + start..][..n];
            for i in 0..n {
                let [sum, now] = rows.sum(i, bytes[i], grid.weights);
                let value = puddle_recur(coefficient * h[i], twice * sum, share * now, before[i]);
                before[i] = if last { value + grid.viscosity * v[i] } else { value };
            }
        }
        start = end;
    }
}

/// One row of new velocities and heights. Gives how many cells had to be reset.
#[inline(always)]
pub(super) fn kick_row<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    keep: &[Vec<f32>; 2],
    columns: &Range<usize>,
    y: usize,
) -> u64 {
    let splat = |value| Lanes::splat(simd, value);
    let (stride, row, keep_y) = (tile.stride(), tile.row(y), keep[1][y]);
    let (mut start, mut reset) = (columns.start, 0);
    for &(end, open) in &links.runs[y] {
        let end = end.min(columns.end);
        if end <= start {
            continue;
        }
        let n = end - start;
        let at = row + start - tile.outer[0].start;
        let rows = Rows::new(&tile.now, at, n, stride);
        let (h, v) = (&mut tile.heights[at..at + n], &mut tile.velocities[at..at + n]);
        let keep_x = &keep[0][start..end];
        if open {
            let mut bad = splat(0.0);
            for part in parts::<S>(n) {
                let [sum, _] = rows.sums::<S, DIAGONAL>(simd, &part, grid.weights);
                let left = Lanes::load(simd, &keep_x[part.clone()]).at_most(splat(keep_y));
                let velocity = (Lanes::load(simd, &v[part.clone()]) - splat(grid.kick) * sum) * left;
                let height = Lanes::load(simd, &h[part.clone()]) + splat(grid.dt) * velocity;
                let infinite = splat(f32::INFINITY);
                let finite = bad.both(height.abs().less(infinite), velocity.abs().less(infinite));
                bad = bad + Lanes::select(finite, splat(0.0), splat(1.0));
                settle(velocity).store(&mut v[part.clone()]);
                settle(height).store(&mut h[part]);
            }
            // Fewer than 2^24 per lane: exact. What lies beyond the end of the run is 0, which is finite.
            let mut counts = [0.0; 64];
            bad.store(&mut counts[..Lanes::<S>::COUNT.min(64)]);
            reset += counts.iter().sum::<f32>() as u64;
        } else {
            let bytes = &links.bytes[y * links.stride() + start..][..n];
            for i in 0..n {
                let [sum, _] = rows.sum(i, bytes[i], grid.weights);
                let velocity = (v[i] - grid.kick * sum) * keep_x[i].min(keep_y);
                let height = h[i] + grid.dt * velocity;
                reset += u64::from(!(ops_is_finite(height) && ops_is_finite(velocity)));
                v[i] = puddle_settle(velocity);
                h[i] = puddle_settle(height);
            }
        }
        start = end;
    }
    reset
}

/// `puddle_settle` for lanes: comparisons with NaN are false.
#[inline(always)]
fn settle<S: Simd>(value: Lanes<S>) -> Lanes<S> {
    let size = value.abs();
    let below = size.constant(f64::from(PUDDLE_SMALLEST.next_down()));
    let kept = size.both(below.less(size), size.less(size.constant(f64::INFINITY)));
    Lanes::select(kept, value, size.constant(0.0))
}
