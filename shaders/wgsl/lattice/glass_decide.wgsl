// Decision of each drop: merge into a larger one that it touches, move by a cell, or rest.
// Twin: downpour_lattice::glass::decide.

@group(0) @binding(0) var<uniform> glass_decide_frame: GlassFrame;
@group(0) @binding(1) var<uniform> glass_decide_sizes: GlassTable;
@group(0) @binding(2) var<storage, read> glass_decide_mass: array<u32>;
@group(0) @binding(3) var<storage, read> glass_decide_motion: array<vec2u>;
@group(0) @binding(4) var<storage, read> glass_decide_keys: array<u32>;
@group(0) @binding(5) var<storage, read> glass_decide_wet: array<u32>;
@group(0) @binding(6) var<storage, read> glass_decide_surface: array<u32>;
@group(0) @binding(7) var<storage, read_write> glass_decide_target: array<u32>;
@group(0) @binding(8) var<storage, read_write> glass_decide_next: array<vec2u>;
@group(0) @binding(9) var<storage, read> glass_decide_totals: array<u32>;

// Key of the largest drop that wets a cell; 0 if none does.
fn glass_decide_key(cell: vec2i) -> u32 {
    if !glass_frame_holds(glass_decide_frame, cell) {
        return 0u;
    }
    return glass_decide_keys[glass_frame_index(glass_decide_frame, cell)];
}

// Key of the largest drop that the rim of a drop touches.
fn glass_decide_touch(cell: vec2i, radius: u32) -> u32 {
    var key = glass_decide_key(cell);
    for (var octant = 0u; octant < 8u; octant += 1u) {
        let far = i32((radius * u32(glass_motion_unit(octant)) + 32768u) >> 16u);
        key = max(key, glass_decide_key(cell + glass_motion_offset(octant) * far));
    }
    return key;
}

// Wetness of a cell, 0 to 255.
fn glass_decide_wetness(cell: vec2i) -> u32 {
    if !glass_frame_holds(glass_decide_frame, cell) {
        return 0u;
    }
    let frame = glass_decide_frame;
    let clock = frame.first_clock + glass_decide_totals[GLASS_TOTAL_TICK] * frame.clock_step;
    return glass_motion_wetness(clock, glass_decide_wet[glass_frame_index(frame, cell)], frame.wet_life);
}

// True if water can move to a cell; cells off the pane count.
fn glass_decide_open(cell: vec2i) -> bool {
    if !glass_frame_holds(glass_decide_frame, cell) {
        return true;
    }
    return (glass_decide_surface[glass_frame_index(glass_decide_frame, cell)] & GLASS_OBSTACLE) == 0u;
}

// Weight of the cell along an octant: 0 if it is blocked. Affinity and wetness are read at the front of the drop there.
fn glass_decide_weight(cell: vec2i, own: u32, v: vec2i, octant: u32, reach: i32) -> u32 {
    let step = glass_motion_offset(octant);
    if !glass_decide_open(cell + step) {
        return 0u;
    }
    let front = cell + step * reach;
    var affinity = 128u;
    if glass_frame_holds(glass_decide_frame, front) {
        affinity = glass_decide_surface[glass_frame_index(glass_decide_frame, front)] & 255u;
    }
    let water = glass_decide_key(front);
    let wetness = select(glass_decide_wetness(front), GLASS_WATER_PULL, water != 0u && water != own);
    let pull = vec2u(glass_decide_frame.affinity_pull, glass_decide_frame.wet_pull);
    return max(glass_motion_weight(v, octant, affinity, wetness, pull), 1u);
}

// Octant in which a drop moves; 8 if all cells ahead are blocked.
fn glass_decide_octant(cell: vec2i, own: u32, v: vec2i, reach: i32, word: u32) -> u32 {
    let ahead = glass_motion_octant(v);
    let chosen = glass_motion_choose(
        vec3u(
            glass_decide_weight(cell, own, v, ahead, reach),
            glass_decide_weight(cell, own, v, ahead + 7u, reach),
            glass_decide_weight(cell, own, v, ahead + 1u, reach),
        ),
        word,
    );
    if chosen < 3u {
        return (ahead + select(select(1u, 7u, chosen == 1u), 0u, chosen == 0u)) & 7u;
    }
    // Along an obstacle, to either side.
    let side = select(2u, 6u, (word & 1u) == 1u);
    if glass_decide_open(cell + glass_motion_offset(ahead + side)) {
        return (ahead + side) & 7u;
    }
    if glass_decide_open(cell + glass_motion_offset(ahead + 8u - side)) {
        return (ahead + 8u - side) & 7u;
    }
    return 8u;
}

// Friction of a drop: that of its size, of the glass below it and of the wetness ahead of it.
fn glass_decide_hold(cell: vec2i, hold: u32, drive: vec2i, reach: i32, moves: bool) -> u32 {
    let surface = glass_decide_surface[glass_frame_index(glass_decide_frame, cell)];
    let rough = (hold * ((surface >> 8u) & 255u)) >> 7u;
    let wetness = glass_decide_wetness(cell + glass_motion_offset(glass_motion_octant(drive)) * reach);
    let eased = rough - ((rough * ((wetness * glass_decide_frame.wet_ease) >> 8u)) >> 8u);
    return select(eased, (eased * glass_decide_frame.kinetic) >> 8u, moves);
}

// True if a drop can merge into the drop of a key without exceeding the maximum mass of a cell.
fn glass_decide_fits(key: u32, mass: u32) -> bool {
    // Of a ridge the key does not tell the mass.
    if key >> 24u == GLASS_RIDGE_CLASS {
        return glass_decide_mass[key & GLASS_INDEX] + mass <= GLASS_MAX_MASS;
    }
    return glass_size_floor((key >> 24u) + 1u) + mass <= GLASS_MAX_MASS;
}

// Octant of the next cell of a ridge on one side: the given one or a neighboring one; 8 if it ends there.
fn glass_decide_beside(cell: vec2i, octant: u32) -> u32 {
    for (var k = 0u; k < 3u; k += 1u) {
        let turn = select(k, 7u, k == 2u);
        let to = cell + glass_motion_offset(octant + turn);
        if glass_frame_holds(glass_decide_frame, to) {
            let index = glass_frame_index(glass_decide_frame, to);
            if glass_decide_mass[index] != 0u && glass_ridge_is(glass_decide_motion[index].y) {
                return (octant + turn) & 7u;
            }
        }
    }
    return 8u;
}

// Decides on a cell of a ridge.
fn glass_decide_ridge(cell: vec2i, mass: u32, row: GlassSizeRow, motion: vec2u) {
    let frame = glass_decide_frame;
    let index = glass_frame_index(frame, cell);
    let ahead = glass_motion_unpack(motion.x);
    let fresh = motion.y & 65535u;
    let octant = glass_motion_octant(ahead);
    let left = glass_decide_beside(cell, octant + 6u);
    let right = glass_decide_beside(cell, octant + 2u);
    // The right side is the direction ahead turned from +x toward +y, whose y is the x of the direction.
    let down = ahead.x;
    if fresh == 0u {
        let own = glass_size_key(mass, index);
        let center = glass_ridge_center(cell, ahead, row.ahead);
        let touched = glass_decide_touch(center, row.ridge);
        let into = touched & GLASS_INDEX;
        if touched > own && into != index && !glass_ridge_is(glass_decide_motion[into].y)
            && glass_decide_fits(touched, mass) {
            glass_decide_target[index] = into | GLASS_TAKEN;
            glass_decide_next[index] = vec2u(0u);
            return;
        }
        let lower = select(left, right, down > 0);
        let fall = select(u32(abs(ahead.y)), u32(GLASS_CELL), lower == 8u);
        let sags = mass * (fall >> 6u) > frame.ridge_hold << 8u;
        if sags || row.ridge < GLASS_RIDGE_MIN || (left == 8u && right == 8u) {
            let stands = glass_frame_holds(frame, center) && glass_decide_open(center);
            glass_decide_target[index] = select(index, glass_frame_index(frame, center), stands);
            glass_decide_next[index] = vec2u(0u);
            return;
        }
    }
    var goes = GLASS_STAYS | (left << 16u) | (right << 20u);
    if left != 8u {
        goes |= glass_ridge_flow(mass, -down, frame.ridge_drain);
    }
    if right != 8u {
        goes |= glass_ridge_flow(mass, down, frame.ridge_drain) << 8u;
    }
    glass_decide_target[index] = goes;
    glass_decide_next[index] = vec2u(motion.x, GLASS_RIDGE | (max(fresh, 1u) - 1u));
}

// Target of the drop of a cell, and its motion.
fn glass_decide_drop(cell: vec2i) {
    let frame = glass_decide_frame;
    let index = glass_frame_index(frame, cell);
    let mass = glass_decide_mass[index];
    if mass == 0u {
        return;
    }
    let class_of = glass_size_class(mass);
    let row = glass_size_row(
        glass_decide_sizes.rows[class_of], glass_decide_sizes.rows[class_of + 1u], glass_size_fraction(mass));
    let motion = glass_decide_motion[index];
    if glass_ridge_is(motion.y) {
        glass_decide_ridge(cell, mass, row, motion);
        return;
    }
    let own = glass_size_key(mass, index);
    let touched = glass_decide_touch(cell, row.radius);
    // A drop that could exceed the maximum mass of a cell stays separate.
    if touched > own && glass_decide_fits(touched, mass) {
        glass_decide_target[index] = (touched & GLASS_INDEX) | GLASS_TAKEN;
        glass_decide_next[index] = vec2u(0u);
        return;
    }
    let reach = i32(row.radius >> 8u) + 1;
    let before = glass_motion_unpack(motion.x);
    let drive = frame.gravity + frame.air * i32(row.air) / GLASS_CELL;
    let hold = glass_decide_hold(cell, row.hold, drive, reach, any(before != vec2i(0)));
    var v = glass_motion_slide(before, drive, hold, row.slow);
    var progress = i32(motion.y) + i32(glass_motion_length(v));
    var goes = index;
    if progress >= GLASS_CELL {
        let step = frame.first_step + glass_decide_totals[GLASS_TOTAL_TICK];
        let octant = glass_decide_octant(cell, own, v, reach, rng_draw(frame.seed, index, step, 0u).x);
        if octant == 8u {
            v = vec2i(0);
            progress = 0;
        } else {
            let to = cell + glass_motion_offset(octant);
            goes = select(GLASS_OUT, glass_frame_index(frame, to), glass_frame_holds(frame, to));
            progress -= select(GLASS_CELL, GLASS_DIAGONAL, (octant & 1u) == 1u);
            v = glass_motion_turn(v, octant);
        }
    }
    glass_decide_target[index] = goes;
    glass_decide_next[index] = vec2u(glass_motion_pack(v), u32(progress));
}

@compute @workgroup_size(16, 16)
fn main_glass_decide(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < glass_decide_frame.size) {
        glass_decide_drop(vec2i(id.xy));
    }
}
