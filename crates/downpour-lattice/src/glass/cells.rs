//! State of the cells, and the order of work in a tick.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use rayon::prelude::*;

use super::blade::GlassBlade;
use super::claim::glass_claim_drop;
use super::decide::glass_decide_drop;
use super::frame::{GlassFrame, glass_frame_cell};
use super::settle::settle_cell;
use super::size::GlassTable;
use super::totals::Counters;
use super::transfer::{glass_transfer_drop, glass_transfer_land};

/// Minimum number of drops per task of a thread.
const CHUNK: usize = 256;

/// Number of ticks after which the drops are sorted by their index in memory. It changes no result.
const SORTED: u32 = 32;

/// Velocity and progress of a drop: a packed velocity, and the progress toward the next cell (an i32).
pub(super) type Motion = [u32; 2];

/// State per cell. Fields that threads write are atomic; sums and maxima do not depend on their order.
#[derive(Debug)]
pub(super) struct Cells {
    /// Affinity, friction and obstacles.
    pub(super) surface: Vec<u32>,
    /// Mass, nl.
    pub(super) mass: Vec<u32>,
    /// Motion of the drop of the cell.
    pub(super) motion: Vec<Motion>,
    /// Key of the largest drop that wets the cell.
    pub(super) keys: Vec<AtomicU32>,
    /// Time when water last moved over the cell.
    pub(super) wet: Vec<AtomicU32>,
    /// Target cell of the drop of the cell.
    pub(super) target: Vec<AtomicU32>,
    /// Motion after the tick: the words of a [`Motion`], low and high.
    pub(super) decided: Vec<AtomicU64>,
    /// Mass after the tick.
    pub(super) next: Vec<AtomicU32>,
    /// Key of the largest drop that moves to the cell by itself, not pushed by a blade.
    pub(super) arrival: Vec<AtomicU32>,
    /// Indices of the cells with drops, in any order: most cells are empty and are skipped.
    pub(super) drops: Vec<u32>,
}

/// Data that all cells read in a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tick<'a> {
    pub(super) frame: &'a GlassFrame,
    pub(super) table: &'a GlassTable,
    pub(super) blades: &'a [GlassBlade],
    /// Number of the tick.
    pub(super) step: u32,
    /// Time of the tick.
    pub(super) clock: u32,
}

fn zeros(cells: usize) -> Vec<AtomicU32> {
    (0..cells).map(|_| AtomicU32::new(0)).collect()
}

/// Loads a word whose concurrent changes do not matter.
#[inline]
pub(super) fn load(words: &[AtomicU32], index: u32) -> u32 {
    words[index as usize].load(Ordering::Relaxed)
}

fn joined(mut a: Vec<u32>, b: Vec<u32>) -> Vec<u32> {
    if a.is_empty() {
        return b;
    }
    a.extend(b);
    a
}

impl Cells {
    pub(super) fn new(surface: Vec<u32>) -> Self {
        let cells = surface.len();
        Self {
            surface,
            mass: vec![0; cells],
            motion: vec![[0; 2]; cells],
            keys: zeros(cells),
            wet: zeros(cells),
            target: zeros(cells),
            decided: (0..cells).map(|_| AtomicU64::new(0)).collect(),
            next: zeros(cells),
            arrival: zeros(cells),
            drops: Vec::new(),
        }
    }

    /// Runs one tick: claim, decide, transfer, settle.
    pub(super) fn tick(&mut self, tick: &Tick<'_>, counters: &Counters) {
        let cells = &*self;
        let each = || cells.drops.par_iter().with_min_len(CHUNK);
        let cell = |index: u32| glass_frame_cell(tick.frame, index);
        each().for_each(|&index| glass_claim_drop(cells, tick, cell(index)));
        each().for_each(|&index| {
            let (target, [velocity, progress]) = glass_decide_drop(cells, tick, cell(index));
            let motion = u64::from(velocity) | (u64::from(progress) << 32);
            cells.target[index as usize].store(target, Ordering::Relaxed);
            cells.decided[index as usize].store(motion, Ordering::Relaxed);
        });
        let mut come = each()
            .fold(Vec::new, |mut come, &index| {
                glass_transfer_drop(cells, tick, counters, cell(index), &mut come);
                come
            })
            .reduce(Vec::new, joined);
        come.extend(self.land(tick, counters));
        if tick.step.is_multiple_of(SORTED) {
            // Neighboring cells are then processed together, which helps the caches.
            come.sort_unstable();
        }
        self.settle(come, tick.frame.ridge_fresh, counters);
    }

    fn land(&self, tick: &Tick<'_>, counters: &Counters) -> Vec<u32> {
        if tick.frame.rain_few[0] == 0 {
            return Vec::new();
        }
        let [columns, rows] = tick.frame.size.map(|n| n.div_ceil(16));
        let blocks = (0..columns * rows).into_par_iter().with_min_len(1024);
        let land = |mut come, block| {
            let corner = glam::UVec2::new(block % columns, block / columns).as_ivec2() * 16;
            glass_transfer_land(self, tick, counters, corner, &mut come);
            come
        };
        blocks.fold(Vec::new, land).reduce(Vec::new, joined)
    }

    fn settle(&mut self, come: Vec<u32>, fresh: u32, counters: &Counters) {
        for &index in &self.drops {
            self.mass[index as usize] = 0;
            self.motion[index as usize] = [0; 2];
        }
        for &index in &come {
            let k = index as usize;
            let (winner, mass) =
                (std::mem::take(self.arrival[k].get_mut()), std::mem::take(self.next[k].get_mut()));
            (self.mass[k], self.motion[k]) = settle_cell(mass, winner, fresh, &self.decided, counters);
        }
        self.drops = come;
        self.keys.par_chunks_mut(1 << 16).for_each(|keys| {
            for key in keys {
                *key.get_mut() = 0;
            }
        });
    }
}
