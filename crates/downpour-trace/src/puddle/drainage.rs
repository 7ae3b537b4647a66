//! Ways of the water over some ground, and the heights that it reaches before it runs out.
//!
//! The heights of all ways out are found from the border inwards, lowest first (R. Barnes et al., Priority-Flood, Computers &
//! Geosciences 62, 2014). Cells of the border and cells without ground let water out. The cell from which a cell was found is the way
//! its water takes.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::fill::Hollows;

/// Ways of the water over some ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Drainage {
    /// Height that water reaches over each cell before it runs out: the ground itself where it runs off at once.
    pub(super) spill: Vec<f32>,
    /// Cells in the order in which they were found, from the border inwards.
    pub(super) order: Vec<usize>,
    /// Cell to which the water of each runs.
    pub(super) next: Vec<Option<usize>>,
}

impl Drainage {
    /// The ways of the water over some ground.
    #[must_use]
    pub fn new(hollows: &Hollows<'_>) -> Self {
        let [columns, rows] = hollows.size;
        let ground = |cell: usize| hollows.ground.get(cell).copied().filter(|h| h.is_finite());
        let mut levels = vec![f32::INFINITY; columns * rows];
        let mut next_of = vec![None; columns * rows];
        let mut order = Vec::with_capacity(columns * rows);
        let mut open = BinaryHeap::new();
        let mut let_out = |cell: usize, level: f32, levels: &mut Vec<f32>| {
            levels[cell] = level;
            // Ties by number: the same order everywhere.
            open.push(Reverse((ordered(level), cell)));
        };
        for cell in 0..columns * rows {
            let (x, y) = (cell % columns, cell / columns);
            let border = x == 0 || y == 0 || x + 1 == columns || y + 1 == rows;
            match ground(cell) {
                None => let_out(cell, f32::NEG_INFINITY, &mut levels),
                Some(height) if border => let_out(cell, height, &mut levels),
                Some(_) => {}
            }
        }
        while let Some(Reverse((_, cell))) = open.pop() {
            order.push(cell);
            for next in neighbors(hollows.size, cell) {
                if levels[next] == f32::INFINITY {
                    let own = ground(next).unwrap_or(f32::NEG_INFINITY);
                    levels[next] = own.max(levels[cell]);
                    next_of[next] = Some(cell);
                    open.push(Reverse((ordered(levels[next]), next)));
                }
            }
        }
        Self { spill: levels, order, next: next_of }
    }
}

/// A whole number that is in the same order as the numbers.
fn ordered(level: f32) -> u32 {
    let bits = level.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The four cells beside a cell.
pub(super) fn neighbors([columns, rows]: [usize; 2], cell: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (cell % columns, cell / columns);
    let beside = [
        (x > 0).then(|| cell - 1),
        (x + 1 < columns).then_some(cell + 1),
        (y > 0).then(|| cell - columns),
        (y + 1 < rows).then_some(cell + columns),
    ];
    beside.into_iter().flatten()
}
