//! Time steps on the CPU: bands of rows in parallel, several steps per pass over the memory.
//!
//! A tile is loaded with a halo as wide as the support of its steps and passes, is advanced in caches, and its inner
//! part is written to the other copy of the state. Each cell is computed by the same operations in any tile, so the
//! result has the same bits for any number of threads, rows per band and steps per sweep.

mod row;
mod tile;

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use downpour_math::real::{Simd, WithLanes, with_widest_lanes};
use rayon::prelude::*;

use super::lattice::{Links, PuddleGrid, puddle_border, puddle_keep};
use super::storage::State;
use row::{argument_row, first_row, kick_row, recur_row};
use tile::Tile;

/// Number of rows of a band.
const BAND: usize = 64;
/// Number of columns of a tile: five buffers of it fit into a second-level cache.
const TILE: usize = 512;
/// Number of columns of a membrane's tile: some rows of it fit into a first-level cache.
const MEMBRANE_TILE: usize = 256;

/// Makes `grid.steps` time steps, from one copy of the state to the other; returns the number of reset cells.
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
    // Narrower bands for few rows, so that every thread has work.
    let band = BAND.min((ny / (2 * rayon::current_num_threads())).max(16));
    let width = if grid.degree == 1 { MEMBRANE_TILE } else { TILE };
    let bands = to.heights.bands(band * stride).zip(to.velocities.bands(band * stride)).enumerate();
    bands.for_each_init(Tile::default, |tile, (index, (mut heights, mut velocities))| {
        let first = index * band;
        let rows = first..(first + band).min(ny);
        for start in (0..nx).step_by(width) {
            let columns = start..(start + width).min(nx);
            tile.set_range(grid, links, [columns.clone(), rows.clone()]);
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
    if grid.degree == 1 {
        return advance_membrane::<S, DIAGONAL>(simd, tile, grid, links, keep);
    }
    let mut reset = 0;
    let mut left = tile.halo;
    for _ in 0..grid.steps {
        left = argument::<S, DIAGONAL>(simd, tile, grid, links, left) - 1;
        let [columns, rows] = tile.reach(left);
        for y in rows {
            let counted = tile.counted(y);
            reset += kick_row::<S, DIAGONAL>(simd, tile, grid, links, keep, &columns, &counted, y);
        }
    }
    reset
}

/// Advances a tile of degree 1. Each step goes over the tile two rows behind the previous one, so that the data stays
/// in the first-level cache: one row behind, a row would be overwritten while it is still read.
#[inline(always)]
fn advance_membrane<S: Simd, const DIAGONAL: bool>(
    simd: S,
    tile: &mut Tile,
    grid: &PuddleGrid,
    links: &Links,
    keep: &[Vec<f32>; 2],
) -> u64 {
    let steps = grid.steps as usize;
    let mut reset = 0;
    let mut stages: Vec<SweepStage> = (0..steps).map(|step| SweepStage::new(tile, step)).collect();
    let [_, rows] = tile.reach(tile.halo);
    for front in rows.start..rows.end + 2 * steps {
        for (step, stage) in stages.iter_mut().enumerate() {
            let Some(y) = front.checked_sub(2 * step).filter(|y| stage.kicked[1].contains(y)) else {
                continue;
            };
            let argued = stage.argued[1].end.min(y + 2);
            for row in stage.next..argued {
                argument_row(simd, tile, grid, &stage.argued[0], row);
            }
            stage.next = stage.next.max(argued);
            let counted = tile.counted(y);
            reset += kick_row::<S, DIAGONAL>(simd, tile, grid, links, keep, &stage.kicked[0], &counted, y);
        }
    }
    reset
}

/// Input and output of one step of a membrane on a tile: columns and rows.
struct SweepStage {
    argued: [Range<usize>; 2],
    kicked: [Range<usize>; 2],
    /// First row whose argument is not yet computed.
    next: usize,
}

impl SweepStage {
    fn new(tile: &Tile, step: usize) -> Self {
        let argued = tile.reach(tile.halo - step);
        Self { next: argued[1].start, argued, kicked: tile.reach(tile.halo - step - 1) }
    }
}

/// Computes in `now` the argument of the last weighted sum for a degree above 1. Returns the width of the valid halo.
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
    for y in rows {
        first_row(simd, tile, coefficient(grid.degree - 1), &columns, y);
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
        for fraction in [0.1, 0.4, 0.7] {
            let land: Vec<bool> = (0..64 * 64).map(|i| random(i, 0) < fraction).collect();
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
            assert!(value <= largest * (1.0 + 1.0e-9) && scale > 0.0, "{fraction}: {value} of {largest}");
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
