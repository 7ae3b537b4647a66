//! One row of a pass over a tile: by vectors where all its cells are linked, and cell by cell along coasts. Both do the
//! same operations in the same order.

use std::ops::Range;

use downpour_math::ops::ops_is_finite;
use downpour_math::real::{Lanes, Real, Simd};
use downpour_shaders::lattice::puddle::PUDDLE_MIN;

use super::tile::Tile;
use crate::puddle::lattice::{Links, PuddleGrid, laplacian, laplacian_linked, puddle_recur, puddle_settle};

/// Three by three vectors: a vector and its neighbors.
type Neighborhood<S> = [[Lanes<S>; 3]; 3];

/// Three rows of the argument, from one cell before a run to one after it.
#[derive(Clone, Copy)]
struct Rows<'a>([&'a [f32]; 3]);

/// Whole vectors of a run, and of the runs shifted by one cell to either side.
#[derive(Clone, Copy)]
struct Whole<'a, S: Simd>([[&'a [S::f32s]; 3]; 3]);

impl<'a> Rows<'a> {
    #[inline(always)]
    fn new(now: &'a [f32], at: usize, n: usize, stride: usize) -> Self {
        Self([at - stride, at, at + stride].map(|at| &now[at - 1..at + n + 1]))
    }

    #[inline(always)]
    fn whole<S: Simd>(self, count: usize) -> Whole<'a, S> {
        let [north, here, south] = self.0;
        Whole([beside::<S>(north, count), beside::<S>(here, count), beside::<S>(south, count)])
    }

    /// Values around a part of the run that is shorter than a vector.
    #[inline(always)]
    fn part<S: Simd, const DIAGONAL: bool>(self, simd: S, part: &Range<usize>) -> Neighborhood<S> {
        let zero = Lanes::splat(simd, 0.0);
        let mut around = [[zero; 3]; 3];
        for (row, (lanes, cells)) in around.iter_mut().zip(self.0).enumerate() {
            for (shift, lane) in lanes.iter_mut().enumerate() {
                if DIAGONAL || row == 1 || shift == 1 {
                    *lane = Lanes::load(simd, &cells[part.start + shift..part.end + shift]);
                }
            }
        }
        around
    }

    /// Weighted sum of cell `i` with its links, and its value.
    #[inline(always)]
    fn sum(self, i: usize, links: u8, weights: [f32; 3]) -> [f32; 2] {
        let [north, here, south] = self.0.map(|row| [row[i], row[i + 1], row[i + 2]]);
        [laplacian_linked(north, here, south, u32::from(links), weights), here[1]]
    }
}

/// Number of whole vectors of a run, and the range of its last cells: as many as a vector has, or all. They are
/// computed before the others, from the old row, and written after them: partial loads are slow.
#[inline(always)]
fn ends<S: Simd>(n: usize) -> (usize, Range<usize>) {
    (n / Lanes::<S>::COUNT, n.saturating_sub(Lanes::<S>::COUNT)..n)
}

#[inline(always)]
fn beside<S: Simd>(row: &[f32], count: usize) -> [&[S::f32s]; 3] {
    [
        &Lanes::<S>::vectors(row)[..count],
        &Lanes::<S>::vectors(&row[1..])[..count],
        &Lanes::<S>::vectors(&row[2..])[..count],
    ]
}

impl<S: Simd> Whole<'_, S> {
    /// Values around vector `k`. The weight of the diagonal is 0 for a membrane.
    #[inline(always)]
    fn at<const DIAGONAL: bool>(self, simd: S, k: usize) -> Neighborhood<S> {
        let [[nw, n, ne], [w, own, e], [sw, s, se]] = self.0;
        let zero = Lanes::splat(simd, 0.0);
        let straight = [&n[k], &w[k], &own[k], &e[k], &s[k]];
        let [n, w, own, e, s] = straight.map(|vector| Lanes::of(simd, vector));
        if !DIAGONAL {
            return [[zero, n, zero], [w, own, e], [zero, s, zero]];
        }
        let [nw, ne, sw, se] = [&nw[k], &ne[k], &sw[k], &se[k]].map(|vector| Lanes::of(simd, vector));
        [[nw, n, ne], [w, own, e], [sw, s, se]]
    }
}

/// Constants in all lanes.
#[derive(Clone, Copy)]
struct Recur<S: Simd> {
    weights: [Lanes<S>; 3],
    coefficient: Lanes<S>,
    twice: Lanes<S>,
    fraction: Lanes<S>,
    viscosity: Lanes<S>,
}

impl<S: Simd> Recur<S> {
    #[inline(always)]
    fn value(self, [north, here, south]: Neighborhood<S>, height: Lanes<S>, older: Lanes<S>) -> Lanes<S> {
        let sum = laplacian(north, here, south, self.weights);
        puddle_recur(self.coefficient * height, self.twice * sum, self.fraction * here[1], older)
    }
}

/// Argument of the only weighted sum of a membrane, for a row.
#[inline(always)]
pub(super) fn argument_row<S: Simd>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    columns: &Range<usize>,
    y: usize,
) {
    let n = columns.len();
    let at = tile.row(y) + columns.start - tile.outer[0].start;
    let (h, v) = (&tile.heights[at..at + n], &tile.velocities[at..at + n]);
    let now = &mut tile.now[at..at + n];
    let viscosity = Lanes::splat(simd, grid.viscosity);
    let (count, end) = ends::<S>(n);
    let last = Lanes::load(simd, &h[end.clone()]) + viscosity * Lanes::load(simd, &v[end.clone()]);
    last.store(&mut now[end]);
    let (heights, velocities) = (&Lanes::<S>::vectors(h)[..count], &Lanes::<S>::vectors(v)[..count]);
    let out = &mut Lanes::<S>::vectors_mut(now)[..count];
    for k in 0..count {
        (Lanes::of(simd, &heights[k]) + viscosity * Lanes::of(simd, &velocities[k])).put(&mut out[k]);
    }
}

/// First sum of Clenshaw's recurrence, for a row.
#[inline(always)]
pub(super) fn first_row<S: Simd>(simd: S, tile: &mut Tile, top: f32, columns: &Range<usize>, y: usize) {
    let n = columns.len();
    let at = tile.row(y) + columns.start - tile.outer[0].start;
    let h = &tile.heights[at..at + n];
    let now = &mut tile.now[at..at + n];
    tile.before[at..at + n].fill(0.0);
    let (count, end) = ends::<S>(n);
    let lanes = Lanes::splat(simd, top);
    (lanes * Lanes::load(simd, &h[end.clone()])).store(&mut now[end]);
    let heights = &Lanes::<S>::vectors(h)[..count];
    let out = &mut Lanes::<S>::vectors_mut(now)[..count];
    for k in 0..count {
        (lanes * Lanes::of(simd, &heights[k])).put(&mut out[k]);
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
    // The last sum is multiplied by y = 2 x - 1 alone, the previous ones by 2 y.
    let (twice, fraction) = if last { (grid.twice, 1.0) } else { (2.0 * grid.twice, 2.0) };
    let [a, b, c] = grid.weights;
    let same = Recur {
        weights: [Lanes::splat(simd, a), Lanes::splat(simd, b), Lanes::splat(simd, c)],
        coefficient: Lanes::splat(simd, coefficient),
        twice: Lanes::splat(simd, twice),
        fraction: Lanes::splat(simd, fraction),
        viscosity: Lanes::splat(simd, grid.viscosity),
    };
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
            let (count, end) = ends::<S>(n);
            let around = rows.part::<S, DIAGONAL>(simd, &end);
            let older = Lanes::load(simd, &before[end.clone()]);
            let value = same.value(around, Lanes::load(simd, &h[end.clone()]), older);
            let more = same.viscosity * Lanes::load(simd, &v[end.clone()]);
            let at_end = if last { value + more } else { value };
            let whole = rows.whole::<S>(count);
            let (heights, velocities) = (&Lanes::<S>::vectors(h)[..count], &Lanes::<S>::vectors(v)[..count]);
            let out = &mut Lanes::<S>::vectors_mut(before)[..count];
            for k in 0..count {
                let around = whole.at::<DIAGONAL>(simd, k);
                let value = same.value(around, Lanes::of(simd, &heights[k]), Lanes::of(simd, &out[k]));
                if last {
                    (value + same.viscosity * Lanes::of(simd, &velocities[k])).put(&mut out[k]);
                } else {
                    value.put(&mut out[k]);
                }
            }
            at_end.store(&mut before[end]);
        } else {
            let bytes = &links.bytes[y * links.stride() + start..][..n];
            for i in 0..n {
                let [sum, now] = rows.sum(i, bytes[i], grid.weights);
                let value = puddle_recur(coefficient * h[i], twice * sum, fraction * now, before[i]);
                before[i] = if last { value + grid.viscosity * v[i] } else { value };
            }
        }
        start = end;
    }
}

/// 1 in the lanes of cells that are not finite, 0 in the others.
#[derive(Clone, Copy)]
struct Bad<S: Simd>(Lanes<S>);

impl<S: Simd> Bad<S> {
    #[inline(always)]
    fn any(self) -> bool {
        let zero = self.0.constant(0.0);
        zero.any(zero.less(self.0))
    }

    /// Number of bad cells among the cells from `first` that are in a range.
    #[inline(always)]
    fn count(self, first: usize, counted: &Range<usize>) -> u64 {
        let mut lanes = [0.0; 64];
        self.0.store(&mut lanes[..Lanes::<S>::COUNT.min(64)]);
        let mut count = 0;
        for (i, &lane) in lanes.iter().enumerate() {
            count += u64::from(lane > 0.0 && counted.contains(&(first + i)));
        }
        count
    }
}

/// Constants of a kick in all lanes.
#[derive(Clone, Copy)]
struct Kick<S: Simd> {
    weights: [Lanes<S>; 3],
    kick: Lanes<S>,
    dt: Lanes<S>,
    keep: Lanes<S>,
    zero: Lanes<S>,
    one: Lanes<S>,
    infinite: Lanes<S>,
    below: Lanes<S>,
}

impl<S: Simd> Kick<S> {
    /// Height and velocity, with a mask where one of the two was not finite.
    #[inline(always)]
    fn values(
        self,
        [north, here, south]: Neighborhood<S>,
        height: Lanes<S>,
        velocity: Lanes<S>,
        keep: Lanes<S>,
    ) -> ([Lanes<S>; 2], Bad<S>) {
        let sum = laplacian(north, here, south, self.weights);
        let velocity = (velocity - self.kick * sum) * keep.at_most(self.keep);
        let height = height + self.dt * velocity;
        // A number that is not below infinity is not finite; this includes NaN.
        let finite = self.zero.both(height.abs().less(self.infinite), velocity.abs().less(self.infinite));
        let bad = Bad(Lanes::select(finite, self.zero, self.one));
        ([self.settle(height), self.settle(velocity)], bad)
    }

    /// `puddle_settle` for lanes: comparisons with NaN are false.
    #[inline(always)]
    fn settle(self, value: Lanes<S>) -> Lanes<S> {
        let size = value.abs();
        let kept = size.both(self.below.less(size), size.less(self.infinite));
        Lanes::select(kept, value, self.zero)
    }
}

/// Computes one row of new velocities and heights. Returns the number of reset cells in some columns.
#[expect(clippy::too_many_arguments, reason = "a row of a pass has that many inputs")]
#[inline(always)]
pub(super) fn kick_row<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    keep: &[Vec<f32>; 2],
    columns: &Range<usize>,
    counted: &Range<usize>,
    y: usize,
) -> u64 {
    let (stride, row, keep_y) = (tile.stride(), tile.row(y), keep[1][y]);
    let [a, b, c] = grid.weights;
    let same = Kick {
        weights: [Lanes::splat(simd, a), Lanes::splat(simd, b), Lanes::splat(simd, c)],
        kick: Lanes::splat(simd, grid.kick),
        dt: Lanes::splat(simd, grid.dt),
        keep: Lanes::splat(simd, keep_y),
        zero: Lanes::splat(simd, 0.0),
        one: Lanes::splat(simd, 1.0),
        infinite: Lanes::splat(simd, f32::INFINITY),
        below: Lanes::splat(simd, PUDDLE_MIN.next_down()),
    };
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
            let (count, end) = ends::<S>(n);
            let around = rows.part::<S, DIAGONAL>(simd, &end);
            let (height, velocity) = (Lanes::load(simd, &h[end.clone()]), Lanes::load(simd, &v[end.clone()]));
            let (at_end, bad_at_end) =
                same.values(around, height, velocity, Lanes::load(simd, &keep_x[end.clone()]));
            let whole = rows.whole::<S>(count);
            let keeps = &Lanes::<S>::vectors(keep_x)[..count];
            let heights = &mut Lanes::<S>::vectors_mut(h)[..count];
            let velocities = &mut Lanes::<S>::vectors_mut(v)[..count];
            for k in 0..count {
                let around = whole.at::<DIAGONAL>(simd, k);
                let (height, velocity) = (Lanes::of(simd, &heights[k]), Lanes::of(simd, &velocities[k]));
                let ([height, velocity], bad) =
                    same.values(around, height, velocity, Lanes::of(simd, &keeps[k]));
                height.put(&mut heights[k]);
                velocity.put(&mut velocities[k]);
                if bad.any() {
                    reset += bad.count(start + k * Lanes::<S>::COUNT, counted);
                }
            }
            let [height, velocity] = at_end;
            height.store(&mut h[end.clone()]);
            velocity.store(&mut v[end.clone()]);
            if bad_at_end.any() {
                // Cells of a whole vector have been counted.
                let left = start + (count * Lanes::<S>::COUNT).min(n);
                reset += bad_at_end.count(start + end.start, &(counted.start.max(left)..counted.end));
            }
        } else {
            let bytes = &links.bytes[y * links.stride() + start..][..n];
            for i in 0..n {
                let [sum, _] = rows.sum(i, bytes[i], grid.weights);
                let velocity = (v[i] - grid.kick * sum) * keep_x[i].min(keep_y);
                let height = h[i] + grid.dt * velocity;
                let bad = !(ops_is_finite(height) && ops_is_finite(velocity));
                reset += u64::from(bad && counted.contains(&(start + i)));
                v[i] = puddle_settle(velocity);
                h[i] = puddle_settle(height);
            }
        }
        start = end;
    }
    reset
}
