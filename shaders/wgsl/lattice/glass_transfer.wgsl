// Transfer of water as the drops have decided: with the drop, into beads, by evaporation, ahead of a blade, or off the
// pane. Rain lands as well. All sums are of integers, so their order does not matter.
// Twin: downpour_lattice::glass::transfer.

@group(0) @binding(0) var<uniform> glass_transfer_frame: GlassFrame;
@group(0) @binding(1) var<uniform> glass_transfer_sizes: GlassTable;
@group(0) @binding(2) var<storage, read> glass_transfer_mass: array<u32>;
@group(0) @binding(3) var<storage, read> glass_transfer_target: array<u32>;
@group(0) @binding(4) var<storage, read> glass_transfer_surface: array<u32>;
@group(0) @binding(5) var<storage, read> glass_transfer_blades: array<GlassBlade>;
@group(0) @binding(6) var<storage, read_write> glass_transfer_next: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> glass_transfer_arrival: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> glass_transfer_totals: array<atomic<u32>>;

// Adds to a total of two words.
fn glass_transfer_count(total: u32, mass: u32) {
    let before = atomicAdd(&glass_transfer_totals[total], mass);
    if before + mass < before {
        atomicAdd(&glass_transfer_totals[total + 1u], 1u);
    }
}

// Adds water to a cell.
fn glass_transfer_put(cell: vec2i, mass: u32) {
    atomicAdd(&glass_transfer_next[glass_frame_index(glass_transfer_frame, cell)], mass);
}

// True if a cell can hold water.
fn glass_transfer_open(cell: vec2i) -> bool {
    if !glass_frame_holds(glass_transfer_frame, cell) {
        return false;
    }
    return (glass_transfer_surface[glass_frame_index(glass_transfer_frame, cell)] & GLASS_OBSTACLE) == 0u;
}

// Lands the drops of the block of cells with this corner.
fn glass_transfer_land(corner: vec2i, tick: u32) {
    let frame = glass_transfer_frame;
    let block = glass_frame_index(frame, corner);
    let drops = glass_frame_landing(frame, rng_draw(frame.seed, block, tick, 1u).x);
    for (var k = 0u; k < drops; k += 1u) {
        let words = rng_draw(frame.seed, block, tick, 2u + k);
        let cell = corner + vec2i(vec2u(words.xy >> vec2u(28u)));
        if !glass_transfer_open(cell) {
            continue;
        }
        let mass = glass_transfer_sizes.landing[words.z >> 22u][(words.z >> 20u) & 3u];
        glass_transfer_put(cell, mass);
        glass_transfer_count(GLASS_TOTAL_LANDED, mass);
    }
}

// Mass that evaporates from a drop in one tick.
fn glass_transfer_dry(mass: u32, loss: u32, word: u32) -> u32 {
    return min(mass, (loss >> 16u) + select(0u, 1u, (word & 0xffffu) < (loss & 0xffffu)));
}

// Mass that a drop leaves behind in a bead.
fn glass_transfer_bead(mass: u32, words: vec4u) -> u32 {
    if words.y >= glass_transfer_frame.trail_chance {
        return 0u;
    }
    // From half to one and a half times the mean.
    let mean = glass_transfer_frame.trail_mass;
    return min(mean / 2u + ((mean * (words.z >> 20u)) >> 12u), mass / 4u);
}

// Index of the blade part that passes over a cell; the number of parts if none does.
fn glass_transfer_blade(cell: vec2i) -> u32 {
    let count = glass_transfer_frame.blades;
    let first = atomicLoad(&glass_transfer_totals[GLASS_TOTAL_TICK]) * count;
    for (var k = 0u; k < count; k += 1u) {
        if glass_blade_sweeps(glass_transfer_blades[first + k], cell) {
            return first + k;
        }
    }
    return GLASS_OUT;
}

// Leaves a film of the water that a blade pushes, as droplets behind it. Returns its mass.
fn glass_transfer_film(blade: GlassBlade, cell: vec2i, mass: u32, tick: u32) -> u32 {
    let index = glass_frame_index(glass_transfer_frame, cell);
    let words = rng_draw(glass_transfer_frame.seed, index, tick, 17u);
    // The ridge is as wide as a cell or as what the blade sweeps in a tick: this cell stands for so many.
    let count = u32(glass_blade_moved(blade, cell));
    let film = glass_transfer_dry(mass, blade.film * count, words.x);
    let off = ((words.y >> 16u) * count) >> 16u;
    let spot = cell - ((glass_blade_ahead(blade) * i32(off) + GLASS_CELL / 2) >> vec2u(14u));
    if glass_transfer_open(spot) {
        glass_transfer_put(spot, film);
    } else {
        glass_transfer_put(cell, film);
    }
    return film;
}

// Moves water to a cell, or to where a blade pushes it: into the ridge ahead of it, which evens out along the blade. Returns
// true if no blade diverts it. `films`: a film stays behind.
fn glass_transfer_bring(cell: vec2i, mass: u32, films: bool, tick: u32) -> bool {
    let which = glass_transfer_blade(cell);
    if which == GLASS_OUT {
        glass_transfer_put(cell, mass);
        return true;
    }
    let blade = glass_transfer_blades[which];
    let left = (mass * blade.leaves) >> 8u;
    glass_transfer_put(cell, left);
    var film = 0u;
    if films {
        film = glass_transfer_film(blade, cell, mass - left, tick);
    }
    let rest = mass - left - film;
    for (var outward = -2; outward <= 2; outward += 2) {
        let part = select(rest / 4u, rest - rest / 4u * 2u, outward == 0);
        let to = glass_blade_push(blade, cell, outward);
        if part == 0u {
            continue;
        }
        if !glass_frame_holds(glass_transfer_frame, to) {
            glass_transfer_count(GLASS_TOTAL_WIPED, part);
        } else if glass_transfer_open(to) {
            glass_transfer_put(to, part);
            let key = glass_ridge_key(glass_blade_ahead(blade));
            atomicMax(&glass_transfer_arrival[glass_frame_index(glass_transfer_frame, to)], key);
        } else {
            glass_transfer_put(cell, part);
        }
    }
    return false;
}

// Target of the drop of a cell, followed through the larger drop that takes it.
fn glass_transfer_goal(index: u32) -> u32 {
    let goal = glass_transfer_target[index];
    if goal == GLASS_OUT {
        return goal;
    }
    if (goal & GLASS_STAYS) != 0u {
        return index;
    }
    if (goal & GLASS_TAKEN) == 0u {
        return goal;
    }
    let after = glass_transfer_target[goal & GLASS_INDEX];
    if after == GLASS_OUT {
        return GLASS_OUT;
    }
    return select(after, goal, (after & GLASS_STAYS) != 0u) & GLASS_INDEX;
}

// Leaves a bead where the drop and the bead do not touch.
fn glass_transfer_trail(cell: vec2i, step: vec2i, drop_radius: u32, bead: u32) -> bool {
    let bead_radius = glass_transfer_sizes.rows[glass_size_class(bead) + 1u].radius;
    let behind = cell - step * i32((drop_radius + bead_radius + 512u) >> 8u);
    // Water of a ridge that becomes a drop moves by more than a cell.
    if bead == 0u || any(abs(step) > vec2i(1)) || !glass_transfer_open(behind) || glass_transfer_blade(behind) != GLASS_OUT {
        return false;
    }
    glass_transfer_put(behind, bead);
    return true;
}

// Moves water along a ridge to the next cells. Returns its mass.
fn glass_transfer_flow(cell: vec2i, mass: u32, decided: u32, tick: u32) -> u32 {
    var sum = 0u;
    for (var side = 0u; side < 2u; side += 1u) {
        let part = (mass * ((decided >> (8u * side)) & 255u)) >> 8u;
        if part != 0u {
            let to = cell + glass_motion_offset((decided >> (16u + 4u * side)) & 15u);
            glass_transfer_bring(to, part, false, tick);
            sum += part;
        }
    }
    return sum;
}

// Moves the water of a cell.
fn glass_transfer_drop(cell: vec2i, tick: u32) {
    let frame = glass_transfer_frame;
    let index = glass_frame_index(frame, cell);
    var mass = glass_transfer_mass[index];
    if mass == 0u {
        return;
    }
    var key = glass_size_key(mass, index);
    let class_of = glass_size_class(mass);
    let row = glass_size_row(
        glass_transfer_sizes.rows[class_of], glass_transfer_sizes.rows[class_of + 1u], glass_size_fraction(mass));
    let decided = glass_transfer_target[index];
    let free = decided == GLASS_OUT || (decided & GLASS_TAKEN) == 0u;
    let goal = glass_transfer_goal(index);
    let moves = free && goal != index;
    if moves || row.loss != 0u {
        let words = rng_draw(frame.seed, index, tick, 16u);
        let dried = glass_transfer_dry(mass, row.loss, words.x);
        glass_transfer_count(GLASS_TOTAL_EVAPORATED, dried);
        mass -= dried;
        let bead = select(0u, glass_transfer_bead(mass, words), moves && goal != GLASS_OUT);
        let step = glass_frame_cell(frame, select(goal, index, goal == GLASS_OUT)) - cell;
        if glass_transfer_trail(cell, step, row.radius, bead) {
            mass -= bead;
        }
    }
    if (decided & GLASS_STAYS) != 0u && decided != GLASS_OUT {
        key = (GLASS_RIDGE_CLASS << 24u) | index;
        mass -= glass_transfer_flow(cell, mass, decided, tick);
    }
    if goal == GLASS_OUT {
        glass_transfer_count(GLASS_TOTAL_EDGE, mass);
    } else if glass_transfer_bring(glass_frame_cell(frame, goal), mass, free, tick) && free && mass != 0u {
        atomicMax(&glass_transfer_arrival[goal], key);
    }
}

@compute @workgroup_size(16, 16)
fn main_glass_transfer(@builtin(global_invocation_id) id: vec3u) {
    let frame = glass_transfer_frame;
    if any(id.xy >= frame.size) {
        return;
    }
    let tick = frame.first_step + atomicLoad(&glass_transfer_totals[GLASS_TOTAL_TICK]);
    if all((id.xy & vec2u(15u)) == vec2u(0u)) {
        glass_transfer_land(vec2i(id.xy), tick);
    }
    glass_transfer_drop(vec2i(id.xy), tick);
}
