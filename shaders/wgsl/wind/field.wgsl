// Wind in the cells of a box: the sum of the primitives and of the waves of turbulence at their centers, reduced inside
// objects; and its interpolation between them.
//
// Rousseau 2008, 3.2 and 5.1.2. Cells are ordered x, y, z, with x the fastest in memory. Between the centers of cells
// the wind is trilinear; beyond the outermost centers it is that of the nearest point between them.
// Twin: downpour_wind::field.

struct WindFieldGrid {
    // Edges of a cell, m.
    cell: vec3f,
    // Number of turbulence modes.
    modes: u32,
    // Lower corner of the box, m.
    low: vec3f,
    // Number of primitives.
    primitives: u32,
    // Inverses of the edges, 1/m.
    per_cell: vec3f,
    // Number of cells along each edge.
    size: vec3u,
}

// The eight cells whose centers surround a position, from `cell` to `next`, and the fraction between them.
struct WindFieldPosition {
    cell: vec3u,
    next: vec3u,
    fraction: vec3f,
}

@group(0) @binding(0) var<uniform> wind_field_grid: WindFieldGrid;
@group(0) @binding(1) var<storage, read> wind_field_primitives: array<mat3x3f>;
// Openness of each cell to the wind: 0 inside an object, 1 away from all.
@group(0) @binding(2) var<storage, read> wind_field_openness: array<f32>;
// Velocity, m/s, and openness.
@group(0) @binding(3) var<storage, read_write> wind_field_cells: array<vec4f>;
@group(0) @binding(4) var<storage, read> wind_field_modes: array<WindTurbulenceMode>;

// Center of a cell.
fn wind_field_center(grid: WindFieldGrid, cell: vec3u) -> vec3f {
    return grid.low + (vec3f(cell) + 0.5) * grid.cell;
}

// Index of a cell in memory.
fn wind_field_index(grid: WindFieldGrid, cell: vec3u) -> u32 {
    return (cell.z * grid.size.y + cell.y) * grid.size.x + cell.x;
}

// Finds the cells around a position.
fn wind_field_locate(grid: WindFieldGrid, at: vec3f) -> WindFieldPosition {
    let last = grid.size - 1u;
    let x = min(max((at - grid.low) * grid.per_cell - 0.5, vec3f(0.0)), vec3f(last));
    let lower = floor(x);
    let cell = min(vec3u(lower), last);
    return WindFieldPosition(cell, min(cell + 1u, last), x - lower);
}

// One of the eight cells: bits 0, 1 and 2 of `corner` select along x, y and z.
fn wind_field_corner(position: WindFieldPosition, corner: u32) -> vec3u {
    return select(position.cell, position.next, (vec3u(corner) & vec3u(1u, 2u, 4u)) != vec3u(0u));
}

// Trilinear interpolation of the values of the eight cells, in the order of their corners.
fn wind_field_mix(corners: array<vec3f, 8>, fraction: vec3f) -> vec3f {
    let c00 = corners[0] + (corners[1] - corners[0]) * fraction.x;
    let c10 = corners[2] + (corners[3] - corners[2]) * fraction.x;
    let c01 = corners[4] + (corners[5] - corners[4]) * fraction.x;
    let c11 = corners[6] + (corners[7] - corners[6]) * fraction.x;
    let c0 = c00 + (c10 - c00) * fraction.y;
    let c1 = c01 + (c11 - c01) * fraction.y;
    return c0 + (c1 - c0) * fraction.z;
}

// Wind in a cell, and its openness.
fn wind_field_cell(cell: vec3u) -> vec4f {
    let openness = wind_field_openness[wind_field_index(wind_field_grid, cell)];
    if openness <= 0.0 {
        return vec4f(0.0);
    }
    let at = wind_field_center(wind_field_grid, cell);
    var sum = vec3f(0.0);
    for (var k = 0u; k < wind_field_grid.primitives; k += 1u) {
        sum += wind_primitive_velocity(wind_field_primitives[k], at);
    }
    let offset = at - wind_field_grid.low;
    for (var k = 0u; k < wind_field_grid.modes; k += 1u) {
        sum += wind_turbulence_velocity(wind_field_modes[k], offset);
    }
    return vec4f(sum * openness, openness);
}

@compute @workgroup_size(4, 4, 4)
fn main_wind_field(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= wind_field_grid.size) {
        return;
    }
    wind_field_cells[wind_field_index(wind_field_grid, id)] = wind_field_cell(id);
}
