//! Time steps on the CPU: bands of rows in parallel, several steps per visit of the memory.
//!
//! A tile is loaded with a halo of as many cells as its steps and passes reach, is advanced in caches, and its inner
//! part is written to the other copy of the state. Each cell is computed by the same operations whatever tile it is in,
//! so the result has the same bits for any number of threads, rows per band and steps per sweep.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use downpour_math::ops::ops_is_finite;
use downpour_math::real::{Lanes, Real, Simd, WithLanes, with_widest_lanes};
use downpour_shaders::lattice::puddle::PUDDLE_SMALLEST;
use rayon::prelude::*;

use super::lattice::{
    Links, PuddleGrid, laplacian, laplacian_linked, puddle_border, puddle_keep, puddle_recur, puddle_settle,
};
use super::storage::{Plane, State};

/// Rows of a band.
const BAND: usize = 64;
/// Columns of a tile: five buffers of it stay in a second-level cache.
const TILE: usize = 512;

/// Makes `grid.steps` time steps, from one copy of the state to the other; gives how many cells had to be reset.
pub(crate) fn sweep(grid: &PuddleGrid, links: &Links, from: &State, to: &mut State) -> u64 {
    let [nx, ny] = links.size;
    let along = |n: usize| -> Vec<f32> {
        (0..n)
            .map(|i| {
                let distance = puddle_border(i as u32, n as u32);
                puddle_keep(distance, grid.keep, grid.sponge_cells, grid.sponge_drag)
            })
            .collect()
    };
    let keep = [along(nx), along(ny)];
    let reset = AtomicU64::new(0);
    let stride = links.stride();
    // Narrower bands when there are few rows, so that every thread has some.
    let band = BAND.min((ny / (2 * rayon::current_num_threads())).max(16));
    let bands = to.heights.bands(band * stride).zip(to.velocities.bands(band * stride)).enumerate();
    bands.for_each_init(Tile::default, |tile, (index, (mut heights, mut velocities))| {
        let first = index * band;
        let rows = first..(first + band).min(ny);
        for start in (0..nx).step_by(TILE) {
            let columns = start..(start + TILE).min(nx);
            tile.place(grid, links, [columns.clone(), rows.clone()]);
            tile.load(from, stride);
            let count = with_widest_lanes(Advance { tile, grid, links, keep: &keep });
            if count > 0 {
                // A sum of integers: the order does not matter.
                reset.fetch_add(count, Ordering::Relaxed);
            }
            tile.store(&mut heights, &mut velocities, stride);
        }
    });
    reset.into_inner()
}

/// A part of the lattice with its halo, in buffers that are one cell wider on each side.
#[derive(Debug, Default)]
struct Tile {
    /// Cells that are written, as columns and rows.
    inner: [Range<usize>; 2],
    /// Cells that are read.
    outer: [Range<usize>; 2],
    /// Cells of the lattice.
    size: [usize; 2],
    halo: usize,
    heights: Vec<f32>,
    velocities: Vec<f32>,
    now: Vec<f32>,
    before: Vec<f32>,
}

impl Tile {
    fn place(&mut self, grid: &PuddleGrid, links: &Links, inner: [Range<usize>; 2]) {
        self.halo = (grid.degree * grid.steps) as usize;
        self.size = links.size;
        self.inner = inner;
        self.outer = self.reach(self.halo);
        let cells = self.stride() * (self.outer[1].len() + 2);
        for buffer in [&mut self.heights, &mut self.velocities, &mut self.now, &mut self.before] {
            buffer.clear();
            buffer.resize(cells, 0.0);
        }
    }

    /// The inner cells and those within `cells` of them.
    fn reach(&self, cells: usize) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let range: &Range<usize> = &self.inner[axis];
            range.start.saturating_sub(cells)..(range.end + cells).min(self.size[axis])
        })
    }

    fn stride(&self) -> usize {
        self.outer[0].len() + 2
    }

    /// Where the first outer cell of a row stands in the buffers.
    fn row(&self, y: usize) -> usize {
        (y - self.outer[1].start + 1) * self.stride() + 1
    }

    fn load(&mut self, from: &State, stride: usize) {
        let n = self.outer[0].len();
        for y in self.outer[1].clone() {
            let (there, here) = (y * stride + self.outer[0].start, self.row(y));
            from.heights.read(there, &mut self.heights[here..here + n]);
            from.velocities.read(there, &mut self.velocities[here..here + n]);
        }
    }

    fn store(&self, heights: &mut Plane<'_>, velocities: &mut Plane<'_>, stride: usize) {
        let n = self.inner[0].len();
        let skip = self.inner[0].start - self.outer[0].start;
        for (row, y) in self.inner[1].clone().enumerate() {
            let (here, there) = (self.row(y) + skip, row * stride + self.inner[0].start);
            heights.write(there, &self.heights[here..here + n]);
            velocities.write(there, &self.velocities[here..here + n]);
        }
    }
}

struct Advance<'a> {
    tile: &'a mut Tile,
    grid: &'a PuddleGrid,
    links: &'a Links,
    keep: &'a [Vec<f32>; 2],
}

impl WithLanes for Advance<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> u64 {
        let Self { tile, grid, links, keep } = self;
        if grid.weights[2] == 0.0 {
            advance::<S, false>(simd, tile, grid, links, keep)
        } else {
            advance::<S, true>(simd, tile, grid, links, keep)
        }
    }
}

#[inline(always)]
fn advance<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    keep: &[Vec<f32>; 2],
) -> u64 {
    let mut reset = 0;
    let mut left = tile.halo;
    for _ in 0..grid.steps {
        left = argument::<S, DIAGONAL>(simd, tile, grid, links, left) - 1;
        let [columns, rows] = tile.reach(left);
        // Cells of the halo are reset as well, but each is counted where it is written.
        let [inner, inner_rows] = tile.inner.clone();
        for y in rows {
            for part in [columns.start..inner.start, inner.clone(), inner.end..columns.end] {
                let count = kick_row::<S, DIAGONAL>(simd, tile, grid, links, keep, &part, y);
                if inner_rows.contains(&y) && part == inner {
                    reset += count;
                }
            }
        }
    }
    reset
}

/// Leaves in `now` the argument of the last weighted sum. Gives how many cells of the halo are still good.
#[inline(always)]
fn argument<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    halo: usize,
) -> usize {
    let coefficient = |j: u32| grid.coefficients[(j / 4) as usize % 4][(j % 4) as usize];
    let mut left = halo;
    let [columns, rows] = tile.reach(left);
    let top = Lanes::splat(simd, coefficient(grid.degree - 1));
    let viscosity = Lanes::splat(simd, grid.viscosity);
    let zero = Lanes::splat(simd, 0.0);
    let n = columns.len();
    for y in rows {
        let at = tile.row(y) + columns.start - tile.outer[0].start;
        let (h, v) = (&tile.heights[at..at + n], &tile.velocities[at..at + n]);
        let (now, before) = (&mut tile.now[at..at + n], &mut tile.before[at..at + n]);
        for part in parts::<S>(n) {
            let height = Lanes::load(simd, &h[part.clone()]);
            if grid.degree == 1 {
                (height + viscosity * Lanes::load(simd, &v[part.clone()])).store(&mut now[part]);
            } else {
                (top * height).store(&mut now[part.clone()]);
                zero.store(&mut before[part]);
            }
        }
    }
    for j in (0..grid.degree.saturating_sub(1)).rev() {
        left -= 1;
        let [columns, rows] = tile.reach(left);
        for y in rows {
            recur_row::<S, DIAGONAL>(simd, tile, grid, links, &columns, y, coefficient(j), j == 0);
        }
        std::mem::swap(&mut tile.now, &mut tile.before);
    }
    left
}

/// A row in parts as wide as the machine's vectors.
#[inline(always)]
fn parts<S: Simd>(n: usize) -> impl Iterator<Item = Range<usize>> {
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
fn recur_row<S: Simd, const DIAGONAL: bool>(
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
fn kick_row<S: Simd, const DIAGONAL: bool>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puddle::model::Model;
    use crate::puddle::reference::apply;
    use crate::puddle::{PuddleDamping, PuddleForm, PuddleOptions, PuddleStorage};
    use downpour_math::rng::{rng_draw, rng_unit};

    /// One step of rough water among islands, against the operator in f64.
    fn one_step(options: &PuddleOptions) {
        let [nx, ny] = options.size.map(|n| n as usize);
        let random = |i: usize, dimension| rng_unit(rng_draw([1, 2], i as u32, 0, dimension)[0]);
        let land: Vec<bool> = (0..nx * ny).map(|i| random(i, 0) < 0.1).collect();
        let mut model = Model::new(options, Some(&land)).expect("a puddle");
        let dt = 0.9 * model.limit();
        let grid = model.grid(dt, 1);
        let stride = model.links.stride();
        let mut from = State::new(PuddleStorage::Full, stride * ny);
        let (mut heights, mut velocities) = (vec![0.0; nx * ny], vec![0.0; nx * ny]);
        for i in 0..nx * ny {
            if model.links.is_water(i % nx, i / nx) {
                (heights[i], velocities[i]) = (random(i, 1) - 0.5, 20.0 * (random(i, 2) - 0.5));
                from.heights.set(i / nx * stride + i % nx, heights[i]);
                from.velocities.set(i / nx * stride + i % nx, velocities[i]);
            }
        }
        let mut to = from.clone();
        assert_eq!(sweep(&grid, &model.links, &from, &mut to), 0);
        let wide = |v: &[f32]| v.iter().copied().map(f64::from).collect::<Vec<_>>();
        let force = apply(&model.links, model.fitted().0, &wide(&heights));
        let scale = force.iter().fold(0.0, |a: f64, f| a.max(f.abs())) * dt;
        let mut worst: f64 = 0.0;
        for i in 0..nx * ny {
            let expected = f64::from(velocities[i]) - dt * force[i];
            let found = f64::from(to.velocities.get(i / nx * stride + i % nx));
            worst = worst.max((found - expected).abs());
        }
        assert!(worst < 3.0e-6 * scale, "{worst} of {scale}: {options:?}");
    }

    /// The operator is symmetric and positive, and no coast has a larger eigenvalue than open water.
    #[test]
    fn coasts_keep_the_operator_symmetric_and_small() {
        let options = PuddleOptions { size: [64, 64], degree: Some(4), ..PuddleOptions::default() };
        let random = |i: usize, dimension| rng_unit(rng_draw([3, 4], i as u32, 0, dimension)[0]);
        for share in [0.1, 0.4, 0.7] {
            let land: Vec<bool> = (0..64 * 64).map(|i| random(i, 0) < share).collect();
            let model = Model::new(&options, Some(&land)).expect("a puddle");
            let symbol = model.fitted().0;
            let field = |dimension| -> Vec<f64> {
                let water = |i: usize| model.links.is_water(i % 64, i / 64);
                (0..64 * 64)
                    .map(|i| if water(i) { f64::from(random(i, dimension)) - 0.5 } else { 0.0 })
                    .collect()
            };
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let (a, b) = (field(1), field(2));
            let crossed =
                [dot(&a, &apply(&model.links, symbol, &b)), dot(&b, &apply(&model.links, symbol, &a))];
            let scale = dot(&a, &apply(&model.links, symbol, &a));
            assert!((crossed[0] - crossed[1]).abs() < 1.0e-12 * scale, "{crossed:?}");
            // The largest eigenvalue, by iteration.
            let mut vector = a;
            let mut value = 0.0;
            for _ in 0..60 {
                let next = apply(&model.links, symbol, &vector);
                value = dot(&next, &next).sqrt() / dot(&vector, &vector).sqrt();
                let length = dot(&next, &next).sqrt();
                vector = next.iter().map(|v| v / length).collect();
            }
            let largest = (0..=1000).map(|i| symbol.at(f64::from(i) / 1000.0)).fold(0.0, f64::max);
            assert!(value <= largest * (1.0 + 1.0e-9) && scale > 0.0, "{share}: {value} of {largest}");
        }
    }

    #[test]
    fn a_step_is_that_of_the_operator_in_f64() {
        let plain =
            PuddleOptions { size: [103, 71], damping: PuddleDamping::None, ..PuddleOptions::default() };
        for degree in [1, 2, 3, 4, 7, 12] {
            one_step(&PuddleOptions { degree: Some(degree), ..plain.clone() });
        }
        one_step(&PuddleOptions { form: PuddleForm::Membrane { speed_m_s: 0.3 }, ..plain });
    }
}
