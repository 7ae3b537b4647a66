// Several time steps of a tile of 64 x 64 cells in one workgroup. The tile is read with a halo as wide as the support
// of its passes, and its inner part is written: the same operations per cell as one step at a time.
//
// An invocation has a block of 4 x 4 cells: four quads above each other, as the columns of a matrix. Twelve passes over
// the neighbors at most.
// Twin: downpour_lattice::puddle::sweep.

// The state after the sweep.
@group(0) @binding(3) var<storage, read_write> puddle_step_next: array<vec4u>;
// Number of cells that were reset because they were not finite.
@group(0) @binding(4) var<storage, read_write> puddle_step_reset: array<atomic<u32>>;

var<workgroup> puddle_step_tile: array<vec4f, 1024>;

// A quad of the tile; beyond the tile, the nearest one, which no written cell depends on.
fn puddle_step_at(column: i32, row: i32) -> vec4f {
    return puddle_step_tile[u32(clamp(row, 0, 63) * 16 + clamp(column, 0, 15))];
}

// A row around a block: the quads west of, at and east of it.
fn puddle_step_row(column: i32, row: i32) -> mat3x4f {
    return puddle_step_shift(
        puddle_step_at(column - 1, row).w,
        puddle_step_at(column, row),
        puddle_step_at(column + 1, row).x,
    );
}

// A quad shifted one cell to the east, unshifted, and shifted one cell to the west.
fn puddle_step_shift(before: f32, quad: vec4f, after: f32) -> mat3x4f {
    return mat3x4f(vec4f(before, quad.xyz), quad, vec4f(quad.yzw, after));
}

// Weighted sums of a block, whose argument is in the tile.
fn puddle_step_sums(block: mat4x4f, column: i32, row: i32, links: vec4u, weights: vec3f) -> mat4x4f {
    let a = puddle_step_row(column, row - 1);
    let b = puddle_step_shift(
        puddle_step_at(column - 1, row).w, block[0], puddle_step_at(column + 1, row).x);
    let c = puddle_step_shift(
        puddle_step_at(column - 1, row + 1).w, block[1], puddle_step_at(column + 1, row + 1).x);
    let d = puddle_step_shift(
        puddle_step_at(column - 1, row + 2).w, block[2], puddle_step_at(column + 1, row + 2).x);
    let e = puddle_step_shift(
        puddle_step_at(column - 1, row + 3).w, block[3], puddle_step_at(column + 1, row + 3).x);
    let f = puddle_step_row(column, row + 4);
    return mat4x4f(
        puddle_laplacian(a, b, c, links.x, weights),
        puddle_laplacian(b, c, d, links.y, weights),
        puddle_laplacian(c, d, e, links.z, weights),
        puddle_laplacian(d, e, f, links.w, weights),
    );
}

// Writes a block into the tile, after all have read the old contents.
fn puddle_step_fraction(block: mat4x4f, column: i32, row: i32) {
    workgroupBarrier();
    let at = u32(row * 16 + column);
    puddle_step_tile[at] = block[0];
    puddle_step_tile[at + 16u] = block[1];
    puddle_step_tile[at + 32u] = block[2];
    puddle_step_tile[at + 48u] = block[3];
    workgroupBarrier();
}

// Coefficient of the polynomial.
fn puddle_step_coefficient(grid: PuddleGrid, j: u32) -> f32 {
    return grid.coefficients[j >> 2u][j & 3u];
}

// Sets numbers of a quad to 0 if they are below 1e-20 or not finite.
fn puddle_step_settle(quad: vec4f) -> vec4f {
    return vec4f(puddle_settle(quad.x), puddle_settle(quad.y), puddle_settle(quad.z), puddle_settle(quad.w));
}

// Fractions of the velocities of a quad that remain.
fn puddle_step_keep(grid: PuddleGrid, x: u32, y: u32) -> vec4f {
    let along = vec4f(
        puddle_border(x, grid.size.x),
        puddle_border(x + 1u, grid.size.x),
        puddle_border(x + 2u, grid.size.x),
        puddle_border(x + 3u, grid.size.x),
    );
    let distance = min(along, vec4f(puddle_border(y, grid.size.y)));
    return vec4f(
        puddle_keep(distance.x, grid.keep, grid.sponge_cells, grid.sponge_drag),
        puddle_keep(distance.y, grid.keep, grid.sponge_cells, grid.sponge_drag),
        puddle_keep(distance.z, grid.keep, grid.sponge_cells, grid.sponge_drag),
        puddle_keep(distance.w, grid.keep, grid.sponge_cells, grid.sponge_drag),
    );
}

@compute @workgroup_size(16, 16)
fn main_puddle_step(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    // Tiles overlap by whole quads and blocks.
    let border = (puddle_grid.halo + 3u) / 4u;
    let inner = 16u - 2u * border;
    let column = i32(local.x);
    let row = i32(local.y) * 4;
    // Wraps below 0, which is beyond the lattice as well.
    let quad_x = group.x * inner + local.x - border;
    let y0 = (group.y * inner + local.y - border) * 4u;
    var heights = mat4x4f();
    var velocities = mat4x4f();
    var keep = mat4x4f();
    var links = vec4u(0u);
    for (var r = 0u; r < 4u; r += 1u) {
        let y = y0 + r;
        if quad_x < puddle_grid.quads && y < puddle_grid.size.y {
            let at = y * puddle_grid.quads + quad_x;
            let quad = puddle_state_load(at);
            heights[r] = quad.height;
            velocities[r] = quad.velocity;
            links[r] = puddle_links[at];
            keep[r] = puddle_step_keep(puddle_grid, quad_x * 4u, y);
        }
    }
    let weights = puddle_grid.weights;
    var bad = 0u;
    for (var step = 0u; step < puddle_grid.steps; step += 1u) {
        var now = heights;
        if puddle_grid.degree == 1u {
            now = heights + velocities * puddle_grid.viscosity;
        } else {
            now = heights * puddle_step_coefficient(puddle_grid, puddle_grid.degree - 1u);
        }
        puddle_step_fraction(now, column, row);
        var before = mat4x4f();
        for (var j = puddle_grid.degree - 1u; j > 0u; j -= 1u) {
            let last = j == 1u;
            let wave = puddle_step_coefficient(puddle_grid, j - 1u);
            let twice = select(2.0 * puddle_grid.twice, puddle_grid.twice, last);
            let fraction = select(2.0, 1.0, last);
            let sums = puddle_step_sums(now, column, row, links, weights);
            var next = mat4x4f(
                puddle_recur(heights[0] * wave, sums[0] * twice, now[0] * fraction, before[0]),
                puddle_recur(heights[1] * wave, sums[1] * twice, now[1] * fraction, before[1]),
                puddle_recur(heights[2] * wave, sums[2] * twice, now[2] * fraction, before[2]),
                puddle_recur(heights[3] * wave, sums[3] * twice, now[3] * fraction, before[3]),
            );
            if last {
                next = next + velocities * puddle_grid.viscosity;
            }
            before = now;
            now = next;
            puddle_step_fraction(now, column, row);
        }
        let sums = puddle_step_sums(now, column, row, links, weights);
        velocities = velocities - sums * puddle_grid.kick;
        velocities = mat4x4f(
            velocities[0] * keep[0], velocities[1] * keep[1], velocities[2] * keep[2], velocities[3] * keep[3]);
        heights = heights + velocities * puddle_grid.dt;
        for (var r = 0u; r < 4u; r += 1u) {
            let good = puddle_is_finite(heights[r]) & puddle_is_finite(velocities[r]);
            let counts = select(vec4u(1u), vec4u(0u), good);
            bad += counts.x + counts.y + counts.z + counts.w;
            heights[r] = puddle_step_settle(heights[r]);
            velocities[r] = puddle_step_settle(velocities[r]);
        }
    }
    if local.x < border || local.x >= 16u - border || local.y < border || local.y >= 16u - border {
        return;
    }
    if quad_x >= puddle_grid.quads {
        return;
    }
    for (var r = 0u; r < 4u; r += 1u) {
        if y0 + r < puddle_grid.size.y {
            let at = (y0 + r) * puddle_grid.quads + quad_x;
            if puddle_grid.half_storage != 0u {
                puddle_step_next[at] = puddle_state_words(heights[r], velocities[r]);
            } else {
                puddle_step_next[2u * at] = bitcast<vec4u>(heights[r]);
                puddle_step_next[2u * at + 1u] = bitcast<vec4u>(velocities[r]);
            }
        }
    }
    if bad > 0u {
        atomicAdd(&puddle_step_reset[0], bad);
    }
}

// Argument of the weighted sum for degree 1; beyond the lattice, that of the nearest quad, to which there are no links.
fn puddle_step_direct(column: i32, row: i32) -> vec4f {
    let x = u32(clamp(column, 0, i32(puddle_grid.quads) - 1));
    let y = u32(clamp(row, 0, i32(puddle_grid.size.y) - 1));
    let quad = puddle_state_load(y * puddle_grid.quads + x);
    return quad.height + quad.velocity * puddle_grid.viscosity;
}

// A row around a quad, as puddle_step_row.
fn puddle_step_direct_row(column: i32, row: i32) -> mat3x4f {
    return puddle_step_shift(
        puddle_step_direct(column - 1, row).w,
        puddle_step_direct(column, row),
        puddle_step_direct(column + 1, row).x,
    );
}

// Number of a quad that is nearest to its eastern neighbor, or to its western one, as puddle_step_direct; for 32-bit
// storage.
fn puddle_step_direct_side(column: i32, row: i32, east: bool) -> f32 {
    let x = u32(clamp(column, 0, i32(puddle_grid.quads) - 1));
    let at = 2u * (u32(row) * puddle_grid.quads + x);
    if east {
        return bitcast<f32>(puddle_state[at].w) + bitcast<f32>(puddle_state[at + 1u].w) * puddle_grid.viscosity;
    }
    return bitcast<f32>(puddle_state[at].x) + bitcast<f32>(puddle_state[at + 1u].x) * puddle_grid.viscosity;
}

// Weighted sums of a quad with zero weight of the diagonal neighbors: a third of the reads.
fn puddle_step_direct_straight(quad: PuddleStateQuad, column: i32, row: i32, links: u32) -> vec4f {
    let own = quad.height + quad.velocity * puddle_grid.viscosity;
    let here = puddle_step_shift(
        puddle_step_direct_side(column - 1, row, true), own, puddle_step_direct_side(column + 1, row, false));
    let n = puddle_linked(own, puddle_step_direct(column, row - 1), links, PUDDLE_LINK_NORTH);
    let s = puddle_linked(own, puddle_step_direct(column, row + 1), links, PUDDLE_LINK_SOUTH);
    let w = puddle_linked(own, here[0], links, PUDDLE_LINK_WEST);
    let e = puddle_linked(own, here[2], links, PUDDLE_LINK_EAST);
    return puddle_grid.weights.x * own - puddle_grid.weights.y * ((n + s) + (w + e));
}

// One time step of degree 1: a quad per invocation, from memory to memory. Neighbors share data through the caches.
@compute @workgroup_size(32, 8)
fn main_lattice_puddle_step_direct(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= puddle_grid.quads || id.y >= puddle_grid.size.y {
        return;
    }
    let column = i32(id.x);
    let row = i32(id.y);
    let at = id.y * puddle_grid.quads + id.x;
    let quad = puddle_state_load(at);
    let links = puddle_links[at];
    var sums = vec4f(0.0);
    if puddle_grid.weights.z == 0.0 && puddle_grid.half_storage == 0u {
        sums = puddle_step_direct_straight(quad, column, row, links);
    } else {
        sums = puddle_laplacian(
            puddle_step_direct_row(column, row - 1),
            puddle_step_direct_row(column, row),
            puddle_step_direct_row(column, row + 1),
            links,
            puddle_grid.weights,
        );
    }
    let keep = puddle_step_keep(puddle_grid, id.x * 4u, id.y);
    let velocity = (quad.velocity - sums * puddle_grid.kick) * keep;
    let height = quad.height + velocity * puddle_grid.dt;
    let good = puddle_is_finite(height) & puddle_is_finite(velocity);
    let counts = select(vec4u(1u), vec4u(0u), good);
    let bad = counts.x + counts.y + counts.z + counts.w;
    let settled_height = puddle_step_settle(height);
    let settled_velocity = puddle_step_settle(velocity);
    if puddle_grid.half_storage != 0u {
        puddle_step_next[at] = puddle_state_words(settled_height, settled_velocity);
    } else {
        puddle_step_next[2u * at] = bitcast<vec4u>(settled_height);
        puddle_step_next[2u * at + 1u] = bitcast<vec4u>(settled_velocity);
    }
    if bad > 0u {
        atomicAdd(&puddle_step_reset[0], bad);
    }
}
