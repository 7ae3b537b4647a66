// How much the wind differs about a position from the wind there: bounds for drops that are carried toward it.
// Twin: downpour_wind::field_spread.

struct WindFieldSpreadFrame {
    // The grid, relative to the origin of the position.
    grid: WindFieldGrid,
    // The position, m, and how far about it, m.
    at: vec3f,
    reach: f32,
}

@group(0) @binding(5) var<uniform> wind_field_spread_frame: WindFieldSpreadFrame;
// Bits of the greatest differences between neighbors along x, y and z, 1/s, and from the position, m/s; those of the wind at the position,
// m/s, and 0. Of numbers that are not below 0 the greatest has the greatest bits.
@group(0) @binding(6) var<storage, read_write> wind_field_spread_found: array<atomic<u32>, 8>;

// Wind at a position, trilinear between the centers of the cells.
fn wind_field_spread_wind(grid: WindFieldGrid, at: vec3f) -> vec3f {
    let position = wind_field_locate(grid, at);
    var corners: array<vec3f, 8>;
    for (var k = 0u; k < 8u; k += 1u) {
        corners[k] = wind_field_cells[wind_field_index(grid, wind_field_corner(position, k))].xyz;
    }
    return wind_field_mix(corners, position.fraction);
}

// Differences of the wind in a cell: from its next neighbors along x, y and z up to a last cell, 1/s, and from another wind, m/s.
fn wind_field_spread_cell(grid: WindFieldGrid, cell: vec3u, last: vec3u, there: vec3f) -> vec4f {
    let here = wind_field_cells[wind_field_index(grid, cell)].xyz;
    var rise = vec3f(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        if cell[axis] < last[axis] {
            var next = cell;
            next[axis] += 1u;
            rise[axis] = length(wind_field_cells[wind_field_index(grid, next)].xyz - here) * grid.per_cell[axis];
        }
    }
    return vec4f(rise, length(here - there));
}

@compute @workgroup_size(8, 1, 1)
fn main_wind_field_spread_clear(@builtin(local_invocation_index) index: u32) {
    let frame = wind_field_spread_frame;
    let there = vec4f(wind_field_spread_wind(frame.grid, frame.at), 0.0);
    atomicStore(&wind_field_spread_found[index], select(0u, bitcast<u32>(there[index & 3u]), index > 3u));
}

@compute @workgroup_size(4, 4, 4)
fn main_wind_field_spread(@builtin(global_invocation_id) id: vec3u) {
    let frame = wind_field_spread_frame;
    let first = wind_field_locate(frame.grid, frame.at - vec3f(frame.reach)).cell;
    let last = wind_field_locate(frame.grid, frame.at + vec3f(frame.reach)).next;
    let cell = first + id;
    if any(cell > last) {
        return;
    }
    let there = wind_field_spread_wind(frame.grid, frame.at);
    let found = wind_field_spread_cell(frame.grid, cell, last, there);
    for (var k = 0u; k < 4u; k += 1u) {
        // Most cells raise none of them.
        if bitcast<u32>(found[k]) > atomicLoad(&wind_field_spread_found[k]) {
            atomicMax(&wind_field_spread_found[k], bitcast<u32>(found[k]));
        }
    }
}
