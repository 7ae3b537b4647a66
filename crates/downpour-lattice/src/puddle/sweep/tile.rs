//! Tile: cells of a band and the halo that their new values depend on, copied into buffers that fit into caches.

use std::ops::Range;

use crate::puddle::lattice::{Links, PuddleGrid};
use crate::puddle::storage::{Plane, State};

/// A part of the lattice with its halo, in buffers that are one cell wider on each side.
#[derive(Debug, Default)]
pub(super) struct Tile {
    /// Columns and rows of the cells that are written.
    pub(super) inner: [Range<usize>; 2],
    /// Columns and rows of the cells that are read.
    pub(super) outer: [Range<usize>; 2],
    /// Number of cells of the lattice.
    size: [usize; 2],
    pub(super) halo: usize,
    pub(super) heights: Vec<f32>,
    pub(super) velocities: Vec<f32>,
    pub(super) now: Vec<f32>,
    pub(super) before: Vec<f32>,
}

impl Tile {
    pub(super) fn set_range(&mut self, grid: &PuddleGrid, links: &Links, inner: [Range<usize>; 2]) {
        self.halo = (grid.degree * grid.steps) as usize;
        self.size = links.size;
        self.inner = inner;
        self.outer = self.reach(self.halo);
        let cells = self.stride() * (self.outer[1].len() + 2);
        // Old contents are overwritten, or belong to cells without links.
        for buffer in [&mut self.heights, &mut self.velocities, &mut self.now, &mut self.before] {
            if buffer.len() < cells {
                buffer.resize(cells, 0.0);
            }
        }
    }

    /// The inner cells and those within `cells` of them.
    pub(super) fn reach(&self, cells: usize) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let range: &Range<usize> = &self.inner[axis];
            range.start.saturating_sub(cells)..(range.end + cells).min(self.size[axis])
        })
    }

    /// Columns of a row whose cells this tile writes.
    pub(super) fn counted(&self, y: usize) -> Range<usize> {
        let [columns, rows] = &self.inner;
        if rows.contains(&y) { columns.clone() } else { 0..0 }
    }

    pub(super) fn stride(&self) -> usize {
        self.outer[0].len() + 2
    }

    /// Index of the first outer cell of a row in the buffers.
    pub(super) fn row(&self, y: usize) -> usize {
        (y - self.outer[1].start + 1) * self.stride() + 1
    }

    pub(super) fn load(&mut self, from: &State, stride: usize) {
        let n = self.outer[0].len();
        for y in self.outer[1].clone() {
            let (there, here) = (y * stride + self.outer[0].start, self.row(y));
            from.heights.read(there, &mut self.heights[here..here + n]);
            from.velocities.read(there, &mut self.velocities[here..here + n]);
        }
    }

    pub(super) fn store(&self, heights: &mut Plane<'_>, velocities: &mut Plane<'_>, stride: usize) {
        let n = self.inner[0].len();
        let skip = self.inner[0].start - self.outer[0].start;
        for (row, y) in self.inner[1].clone().enumerate() {
            let (here, there) = (self.row(y) + skip, row * stride + self.inner[0].start);
            heights.write(there, &self.heights[here..here + n]);
            velocities.write(there, &self.velocities[here..here + n]);
        }
    }
}
