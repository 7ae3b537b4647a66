//! Transfer of water as the drops have decided: with the drop, into beads, by evaporation, ahead of a blade, or off
//! the pane. Rain lands as well. All sums are of integers, so their order does not matter.
//! Twin of `shaders/wgsl/lattice/glass_transfer.wgsl`.

use std::sync::atomic::{AtomicU64, Ordering};

use downpour_math::rng::rng_draw;
use downpour_shaders::lattice::glass::{
    GLASS_CELL, GLASS_INDEX, GLASS_OBSTACLE, GLASS_OUT, GLASS_RIDGE_CLASS, GLASS_STAYS, GLASS_TAKEN,
};
use glam::IVec2;

use super::blade::{GlassBlade, glass_blade_ahead, glass_blade_moved, glass_blade_push, glass_blade_sweeps};
use super::cells::{Cells, Tick, load};
use super::frame::{glass_frame_cell, glass_frame_holds, glass_frame_index, glass_frame_landing};
use super::motion::glass_motion_offset;
use super::ridge::glass_ridge_key;
use super::size::{glass_size_class, glass_size_key};
use super::totals::Counters;

/// Adds to a total.
fn glass_transfer_count(total: &AtomicU64, mass: u32) {
    total.fetch_add(mass.into(), Ordering::Relaxed);
}

/// Adds water to a cell. The first addition records the cell in `come`.
fn glass_transfer_put(cells: &Cells, tick: &Tick<'_>, cell: IVec2, mass: u32, come: &mut Vec<u32>) {
    let index = glass_frame_index(tick.frame, cell);
    if mass != 0 && cells.next[index as usize].fetch_add(mass, Ordering::Relaxed) == 0 {
        come.push(index);
    }
}

/// True if a cell can hold water.
fn glass_transfer_open(cells: &Cells, tick: &Tick<'_>, cell: IVec2) -> bool {
    glass_frame_holds(tick.frame, cell)
        && cells.surface[glass_frame_index(tick.frame, cell) as usize] & GLASS_OBSTACLE == 0
}

/// Lands the drops of the block of cells with this corner.
pub(super) fn glass_transfer_land(
    cells: &Cells,
    tick: &Tick<'_>,
    counters: &Counters,
    corner: IVec2,
    come: &mut Vec<u32>,
) {
    let frame = tick.frame;
    let block = glass_frame_index(frame, corner);
    let drops = glass_frame_landing(frame, rng_draw(frame.seed, block, tick.step, 1)[0]);
    for k in 0..drops {
        let [x, y, z, _] = rng_draw(frame.seed, block, tick.step, 2 + k);
        let cell = corner + IVec2::new((x >> 28) as i32, (y >> 28) as i32);
        if !glass_transfer_open(cells, tick, cell) {
            continue;
        }
        let mass = tick.table.landing[(z >> 22) as usize][(z >> 20) as usize & 3];
        glass_transfer_put(cells, tick, cell, mass, come);
        glass_transfer_count(&counters.landed, mass);
    }
}

/// Mass that evaporates from a drop in one tick.
fn glass_transfer_dry(mass: u32, loss: u32, word: u32) -> u32 {
    mass.min((loss >> 16) + u32::from(word & 0xffff < loss & 0xffff))
}

/// Mass that a drop leaves behind in a bead.
fn glass_transfer_bead(tick: &Tick<'_>, mass: u32, words: [u32; 4]) -> u32 {
    if words[1] >= tick.frame.trail_chance {
        return 0;
    }
    // From half to one and a half times the mean.
    let mean = tick.frame.trail_mass;
    (mean / 2 + ((mean * (words[2] >> 20)) >> 12)).min(mass / 4)
}

/// Index of the blade part that passes over a cell; `GLASS_OUT` if none does.
fn glass_transfer_blade(tick: &Tick<'_>, cell: IVec2) -> u32 {
    let found = tick.blades.iter().position(|blade| glass_blade_sweeps(blade, cell));
    found.map_or(GLASS_OUT, |k| k as u32)
}

/// Leaves a film of the water that a blade pushes, as droplets behind it. Returns its mass.
fn glass_transfer_film(
    cells: &Cells,
    tick: &Tick<'_>,
    blade: &GlassBlade,
    cell: IVec2,
    mass: u32,
    come: &mut Vec<u32>,
) -> u32 {
    let index = glass_frame_index(tick.frame, cell);
    let words = rng_draw(tick.frame.seed, index, tick.step, 17);
    // The ridge is as wide as a cell or as what the blade sweeps in a tick: this cell stands for so many.
    let count = glass_blade_moved(blade, cell) as u32;
    let film = glass_transfer_dry(mass, blade.film * count, words[0]);
    let off = ((words[1] >> 16) * count) >> 16;
    let spot = cell - ((glass_blade_ahead(blade) * off as i32 + GLASS_CELL / 2) >> 14);
    let to = if glass_transfer_open(cells, tick, spot) { spot } else { cell };
    glass_transfer_put(cells, tick, to, film, come);
    film
}

/// Moves water to a cell, or to where a blade pushes it: into the ridge ahead of it, which evens out along the blade. Returns
/// true if no blade diverts it. `films`: a film stays behind.
fn glass_transfer_bring(
    cells: &Cells,
    tick: &Tick<'_>,
    counters: &Counters,
    cell: IVec2,
    mass: u32,
    films: bool,
    come: &mut Vec<u32>,
) -> bool {
    let which = glass_transfer_blade(tick, cell);
    if which == GLASS_OUT {
        glass_transfer_put(cells, tick, cell, mass, come);
        return true;
    }
    let blade = &tick.blades[which as usize];
    let left = (mass * blade.leaves) >> 8;
    glass_transfer_put(cells, tick, cell, left, come);
    let film = if films { glass_transfer_film(cells, tick, blade, cell, mass - left, come) } else { 0 };
    let rest = mass - left - film;
    for outward in [-2, 0, 2] {
        let part = if outward == 0 { rest - rest / 4 * 2 } else { rest / 4 };
        let to = glass_blade_push(blade, cell, outward);
        if part == 0 {
            continue;
        }
        if !glass_frame_holds(tick.frame, to) {
            glass_transfer_count(&counters.wiped, part);
        } else if glass_transfer_open(cells, tick, to) {
            glass_transfer_put(cells, tick, to, part, come);
            let key = glass_ridge_key(glass_blade_ahead(blade));
            cells.arrival[glass_frame_index(tick.frame, to) as usize].fetch_max(key, Ordering::Relaxed);
        } else {
            glass_transfer_put(cells, tick, cell, part, come);
        }
    }
    false
}

/// Target of the drop of a cell, followed through the larger drop that takes it.
fn glass_transfer_goal(cells: &Cells, index: u32) -> u32 {
    let goal = load(&cells.target, index);
    if goal == GLASS_OUT {
        return goal;
    }
    if goal & GLASS_STAYS != 0 {
        return index;
    }
    if goal & GLASS_TAKEN == 0 {
        return goal;
    }
    let after = load(&cells.target, goal & GLASS_INDEX);
    if after == GLASS_OUT {
        return GLASS_OUT;
    }
    if after & GLASS_STAYS != 0 { goal & GLASS_INDEX } else { after & GLASS_INDEX }
}

/// Leaves a bead where the drop and the bead do not touch.
fn glass_transfer_trail(
    cells: &Cells,
    tick: &Tick<'_>,
    cell: IVec2,
    step: IVec2,
    drop_radius: u32,
    bead: u32,
    come: &mut Vec<u32>,
) -> bool {
    let bead_radius = tick.table.rows.as_flattened()[glass_size_class(bead) as usize + 1].radius;
    let behind = cell - step * ((drop_radius + bead_radius + 512) >> 8) as i32;
    // Water of a ridge that becomes a drop moves by more than a cell.
    if bead == 0
        || step.abs().max_element() > 1
        || !glass_transfer_open(cells, tick, behind)
        || glass_transfer_blade(tick, behind) != GLASS_OUT
    {
        return false;
    }
    glass_transfer_put(cells, tick, behind, bead, come);
    true
}

/// Moves water along a ridge to the next cells. Returns its mass.
fn glass_transfer_flow(
    cells: &Cells,
    tick: &Tick<'_>,
    counters: &Counters,
    cell: IVec2,
    mass: u32,
    decided: u32,
    come: &mut Vec<u32>,
) -> u32 {
    let mut sum = 0;
    for side in 0..2 {
        let part = (mass * ((decided >> (8 * side)) & 255)) >> 8;
        if part != 0 {
            let to = cell + glass_motion_offset((decided >> (16 + 4 * side)) & 15);
            glass_transfer_bring(cells, tick, counters, to, part, false, come);
            sum += part;
        }
    }
    sum
}

/// Moves the water of a cell.
pub(super) fn glass_transfer_drop(
    cells: &Cells,
    tick: &Tick<'_>,
    counters: &Counters,
    cell: IVec2,
    come: &mut Vec<u32>,
) {
    let frame = tick.frame;
    let index = glass_frame_index(frame, cell);
    let mut mass = cells.mass[index as usize];
    if mass == 0 {
        return;
    }
    let mut key = glass_size_key(mass, index);
    let row = tick.table.row(mass);
    let decided = load(&cells.target, index);
    let free = decided == GLASS_OUT || decided & GLASS_TAKEN == 0;
    let goal = glass_transfer_goal(cells, index);
    let moves = free && goal != index;
    if moves || row.loss != 0 {
        let words = rng_draw(frame.seed, index, tick.step, 16);
        let dried = glass_transfer_dry(mass, row.loss, words[0]);
        glass_transfer_count(&counters.evaporated, dried);
        mass -= dried;
        let bead = if moves && goal != GLASS_OUT { glass_transfer_bead(tick, mass, words) } else { 0 };
        let to = if goal == GLASS_OUT { index } else { goal };
        let step = glass_frame_cell(frame, to) - cell;
        if glass_transfer_trail(cells, tick, cell, step, row.radius, bead, come) {
            mass -= bead;
        }
    }
    if decided & GLASS_STAYS != 0 && decided != GLASS_OUT {
        key = (GLASS_RIDGE_CLASS << 24) | index;
        mass -= glass_transfer_flow(cells, tick, counters, cell, mass, decided, come);
    }
    if goal == GLASS_OUT {
        glass_transfer_count(&counters.over_edge, mass);
    } else if glass_transfer_bring(cells, tick, counters, glass_frame_cell(frame, goal), mass, free, come)
        && free
        && mass != 0
    {
        cells.arrival[goal as usize].fetch_max(key, Ordering::Relaxed);
    }
}
