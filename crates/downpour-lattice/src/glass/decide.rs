//! Decision of each drop: merge into a larger one that it touches, move by a cell, or rest.
//! Twin of `shaders/wgsl/lattice/glass_decide.wgsl`.

use downpour_math::rng::rng_draw;
use downpour_shaders::lattice::glass::{
    GLASS_CELL, GLASS_DIAGONAL, GLASS_INDEX, GLASS_MAX_MASS, GLASS_OBSTACLE, GLASS_OUT, GLASS_RIDGE,
    GLASS_RIDGE_CLASS, GLASS_RIDGE_MIN, GLASS_STAYS, GLASS_TAKEN, GLASS_WATER_PULL,
};
use glam::{IVec2, UVec2, UVec3};

use super::cells::{Cells, Motion, Tick, load};
use super::frame::{glass_frame_holds, glass_frame_index};
use super::motion::{
    glass_motion_choose, glass_motion_length, glass_motion_octant, glass_motion_offset, glass_motion_pack,
    glass_motion_slide, glass_motion_turn, glass_motion_unit, glass_motion_unpack, glass_motion_weight,
    glass_motion_wetness,
};
use super::ridge::{glass_ridge_center, glass_ridge_flow, glass_ridge_is};
use super::size::{GlassSizeRow, glass_size_floor, glass_size_key};

/// Key of the largest drop that wets a cell; 0 if none does.
fn glass_decide_key(cells: &Cells, tick: &Tick<'_>, cell: IVec2) -> u32 {
    if !glass_frame_holds(tick.frame, cell) {
        return 0;
    }
    load(&cells.keys, glass_frame_index(tick.frame, cell))
}

/// Key of the largest drop that the rim of a drop touches.
fn glass_decide_touch(cells: &Cells, tick: &Tick<'_>, cell: IVec2, radius: u32) -> u32 {
    let mut key = glass_decide_key(cells, tick, cell);
    for octant in 0..8 {
        let far = ((radius * glass_motion_unit(octant) as u32 + 32768) >> 16) as i32;
        key = key.max(glass_decide_key(cells, tick, cell + glass_motion_offset(octant) * far));
    }
    key
}

/// Wetness of a cell, 0 to 255.
fn glass_decide_wetness(cells: &Cells, tick: &Tick<'_>, cell: IVec2) -> u32 {
    if !glass_frame_holds(tick.frame, cell) {
        return 0;
    }
    let stamp = load(&cells.wet, glass_frame_index(tick.frame, cell));
    glass_motion_wetness(tick.clock, stamp, tick.frame.wet_life)
}

/// True if water can move to a cell; cells off the pane count.
fn glass_decide_open(cells: &Cells, tick: &Tick<'_>, cell: IVec2) -> bool {
    !glass_frame_holds(tick.frame, cell)
        || cells.surface[glass_frame_index(tick.frame, cell) as usize] & GLASS_OBSTACLE == 0
}

/// Weight of the cell along an octant: 0 if it is blocked. Affinity and wetness are read at the front of the drop
/// there.
fn glass_decide_weight(
    cells: &Cells,
    tick: &Tick<'_>,
    cell: IVec2,
    own: u32,
    v: IVec2,
    octant: u32,
    reach: i32,
) -> u32 {
    let step = glass_motion_offset(octant);
    if !glass_decide_open(cells, tick, cell + step) {
        return 0;
    }
    let front = cell + step * reach;
    let mut affinity = 128;
    if glass_frame_holds(tick.frame, front) {
        affinity = cells.surface[glass_frame_index(tick.frame, front) as usize] & 255;
    }
    let water = glass_decide_key(cells, tick, front);
    let wetness =
        if water != 0 && water != own { GLASS_WATER_PULL } else { glass_decide_wetness(cells, tick, front) };
    let pull = UVec2::new(tick.frame.affinity_pull, tick.frame.wet_pull);
    glass_motion_weight(v, octant, affinity, wetness, pull).max(1)
}

/// Octant in which a drop moves; 8 if all cells ahead are blocked.
fn glass_decide_octant(
    cells: &Cells,
    tick: &Tick<'_>,
    cell: IVec2,
    own: u32,
    v: IVec2,
    reach: i32,
    word: u32,
) -> u32 {
    let ahead = glass_motion_octant(v);
    let weight = |octant| glass_decide_weight(cells, tick, cell, own, v, octant, reach);
    let weights = UVec3::new(weight(ahead), weight(ahead + 7), weight(ahead + 1));
    match glass_motion_choose(weights, word) {
        0 => return ahead,
        1 => return (ahead + 7) & 7,
        2 => return (ahead + 1) & 7,
        _ => {}
    }
    // Along an obstacle, to either side.
    let side = if word & 1 == 1 { 6 } else { 2 };
    if glass_decide_open(cells, tick, cell + glass_motion_offset(ahead + side)) {
        return (ahead + side) & 7;
    }
    if glass_decide_open(cells, tick, cell + glass_motion_offset(ahead + 8 - side)) {
        return (ahead + 8 - side) & 7;
    }
    8
}

/// Friction of a drop: that of its size, of the glass below it and of the wetness ahead of it.
fn glass_decide_hold(
    cells: &Cells,
    tick: &Tick<'_>,
    cell: IVec2,
    hold: u32,
    drive: IVec2,
    reach: i32,
    moves: bool,
) -> u32 {
    let surface = cells.surface[glass_frame_index(tick.frame, cell) as usize];
    let rough = (hold * ((surface >> 8) & 255)) >> 7;
    let front = cell + glass_motion_offset(glass_motion_octant(drive)) * reach;
    let wetness = glass_decide_wetness(cells, tick, front);
    let eased = rough - ((rough * ((wetness * tick.frame.wet_ease) >> 8)) >> 8);
    if moves { (eased * tick.frame.kinetic) >> 8 } else { eased }
}

/// True if a drop can merge into the drop of a key without exceeding the maximum mass of a cell.
fn glass_decide_fits(cells: &Cells, key: u32, mass: u32) -> bool {
    // Of a ridge the key does not tell the mass.
    if key >> 24 == GLASS_RIDGE_CLASS {
        return cells.mass[(key & GLASS_INDEX) as usize] + mass <= GLASS_MAX_MASS;
    }
    glass_size_floor((key >> 24) + 1) + mass <= GLASS_MAX_MASS
}

/// Octant of the next cell of a ridge on one side: the given one or a neighboring one; 8 if it ends there.
fn glass_decide_beside(cells: &Cells, tick: &Tick<'_>, cell: IVec2, octant: u32) -> u32 {
    for turn in [0, 1, 7] {
        let to = cell + glass_motion_offset(octant + turn);
        if glass_frame_holds(tick.frame, to) {
            let index = glass_frame_index(tick.frame, to) as usize;
            if cells.mass[index] != 0 && glass_ridge_is(cells.motion[index][1]) {
                return (octant + turn) & 7;
            }
        }
    }
    8
}

/// Target of a cell of a ridge, and its motion.
fn glass_decide_ridge(
    cells: &Cells,
    tick: &Tick<'_>,
    cell: IVec2,
    mass: u32,
    row: &GlassSizeRow,
    motion: Motion,
) -> (u32, Motion) {
    let frame = tick.frame;
    let ahead = glass_motion_unpack(motion[0]);
    let fresh = motion[1] & 65535;
    let octant = glass_motion_octant(ahead);
    let (left, right) = (
        glass_decide_beside(cells, tick, cell, octant + 6),
        glass_decide_beside(cells, tick, cell, octant + 2),
    );
    // The right side is the direction ahead turned from +x toward +y, whose y is the x of the direction.
    let down = ahead.x;
    if fresh == 0 {
        let index = glass_frame_index(frame, cell);
        let own = glass_size_key(mass, index);
        let center = glass_ridge_center(cell, ahead, row.ahead);
        let touched = glass_decide_touch(cells, tick, center, row.ridge);
        let into = touched & GLASS_INDEX;
        if touched > own
            && into != index
            && !glass_ridge_is(cells.motion[into as usize][1])
            && glass_decide_fits(cells, touched, mass)
        {
            return (into | GLASS_TAKEN, [0; 2]);
        }
        let lower = if down > 0 { right } else { left };
        let fall = if lower == 8 { GLASS_CELL as u32 } else { ahead.y.unsigned_abs() };
        let sags = mass * (fall >> 6) > frame.ridge_hold << 8;
        if sags || row.ridge < GLASS_RIDGE_MIN || (left == 8 && right == 8) {
            let stands = glass_frame_holds(frame, center) && glass_decide_open(cells, tick, center);
            return (if stands { glass_frame_index(frame, center) } else { index }, [0; 2]);
        }
    }
    let mut goes = GLASS_STAYS | (left << 16) | (right << 20);
    if left != 8 {
        goes |= glass_ridge_flow(mass, -down, frame.ridge_drain);
    }
    if right != 8 {
        goes |= glass_ridge_flow(mass, down, frame.ridge_drain) << 8;
    }
    (goes, [motion[0], GLASS_RIDGE | fresh.saturating_sub(1)])
}

/// Target of the drop of a cell, and its motion.
pub(super) fn glass_decide_drop(cells: &Cells, tick: &Tick<'_>, cell: IVec2) -> (u32, Motion) {
    let frame = tick.frame;
    let index = glass_frame_index(frame, cell);
    let mass = cells.mass[index as usize];
    let row = tick.table.row(mass);
    let [packed, progress] = cells.motion[index as usize];
    if glass_ridge_is(progress) {
        return glass_decide_ridge(cells, tick, cell, mass, &row, [packed, progress]);
    }
    let own = glass_size_key(mass, index);
    let touched = glass_decide_touch(cells, tick, cell, row.radius);
    // A drop that could exceed the maximum mass of a cell stays separate.
    if touched > own && glass_decide_fits(cells, touched, mass) {
        return ((touched & GLASS_INDEX) | GLASS_TAKEN, [0; 2]);
    }
    let reach = (row.radius >> 8) as i32 + 1;
    let before = glass_motion_unpack(packed);
    let drive = IVec2::from(frame.gravity) + IVec2::from(frame.air) * row.air as i32 / GLASS_CELL;
    let hold = glass_decide_hold(cells, tick, cell, row.hold, drive, reach, before != IVec2::ZERO);
    let mut v = glass_motion_slide(before, drive, hold, row.slow);
    let mut progress = progress as i32 + glass_motion_length(v) as i32;
    let mut goes = index;
    if progress >= GLASS_CELL {
        let word = rng_draw(frame.seed, index, tick.step, 0)[0];
        let octant = glass_decide_octant(cells, tick, cell, own, v, reach, word);
        if octant == 8 {
            v = IVec2::ZERO;
            progress = 0;
        } else {
            let to = cell + glass_motion_offset(octant);
            goes = if glass_frame_holds(frame, to) { glass_frame_index(frame, to) } else { GLASS_OUT };
            progress -= if octant & 1 == 1 { GLASS_DIAGONAL } else { GLASS_CELL };
            v = glass_motion_turn(v, octant);
        }
    }
    (goes, [glass_motion_pack(v), progress as u32])
}
