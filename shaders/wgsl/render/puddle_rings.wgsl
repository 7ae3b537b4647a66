// Rings of single drops on the water near the eye: the closed form of each from a table of slopes, and their sum, in whole numbers, so
// that it does not depend on their order.
// Rows behind that of the ripples' lattice: cells along x and z, first row of the cells and of the rings; first row of the slopes, part
// and reach; corner and middle. A cell has the number of its first ring, in half a
// word; the last of them is that of the cell behind it. A ring has two words: its
// place in the cell, and its age and its size.
// Twin: downpour_trace::scene::puddle_rings.

struct PuddleRings {
    // Cells along x and z; 0: there are no rings.
    cells: vec2u,
    // First rows of the cells, of the rings and of the slopes.
    first_cell: u32,
    first_ring: u32,
    first_slope: u32,
    // Part of the mean square of the slope that rings have where they are whole.
    part: f32,
    // Distance from the middle within which there are all rings, m.
    reach: f32,
    // Corner of the cells, and middle of the rings, along x and z, m.
    corner: vec2f,
    middle: vec2f,
}

// Reads where the rings are.
fn puddle_rings_load() -> PuddleRings {
    let row = render_frame.puddles + render_frame.puddle_count * PUDDLE_WATER_ROWS + 1u;
    let head = render_table[row];
    let look = render_table[row + 1u];
    let place = bitcast<vec4f>(render_table[row + 2u]);
    return PuddleRings(
        head.xy, head.z, head.w, look.x, bitcast<f32>(look.y), bitcast<f32>(look.z), place.xy, place.zw,
    );
}

// A word of rows.
fn puddle_rings_word(first: u32, index: u32) -> u32 {
    return render_table[first + index / 4u][index % 4u];
}

// Number of the first ring of a cell.
fn puddle_rings_first(rings: PuddleRings, cell: u32) -> u32 {
    return (puddle_rings_word(rings.first_cell, cell / 2u) >> (16u * (cell & 1u))) & 0xffffu;
}

// A slope of the table: of a node of sizes, at a step of time and a step of distance.
fn puddle_rings_node(first: u32, node: u32, time: u32, step: u32) -> f32 {
    let index = (node * PUDDLE_RINGS_TIMES + time) * PUDDLE_RINGS_DISTANCES + step;
    let pair = unpack2x16float(puddle_rings_word(first, index / 2u));
    return select(pair.x, pair.y, (index & 1u) == 1u);
}

// Slope of a ring of a size, in nodes, of an age, in steps, away from its middle at a distance, in steps: linear between all.
fn puddle_rings_slope(first: u32, size: f32, age: f32, distance: f32) -> f32 {
    let node = min(u32(size), PUDDLE_RINGS_SIZES - 2u);
    let time = min(u32(age), PUDDLE_RINGS_TIMES - 2u);
    let step = min(u32(distance), PUDDLE_RINGS_DISTANCES - 2u);
    let along = distance - f32(step);
    var slopes = vec4f(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        let a = puddle_rings_node(first, node + k / 2u, time + k % 2u, step);
        let b = puddle_rings_node(first, node + k / 2u, time + k % 2u, step + 1u);
        slopes[k] = a * (1.0 - along) + b * along;
    }
    let later = age - f32(time);
    let larger = size - f32(node);
    return (slopes.x * (1.0 - later) + slopes.y * later) * (1.0 - larger) + (slopes.z * (1.0 - later) + slopes.w * later) * larger;
}

// Slopes of a ring at a place relative to the corner of its cell, in units of 1 / PUDDLE_RINGS_UNITS.
fn puddle_rings_one(rings: PuddleRings, number: u32, place: vec2f) -> vec2i {
    let words = vec2u(puddle_rings_word(rings.first_ring, 2u * number), puddle_rings_word(rings.first_ring, 2u * number + 1u));
    let middle = vec2f(f32(words.x & 0xffffu), f32(words.x >> 16u)) * (PUDDLE_RINGS_CELL / 65536.0);
    let away = place - middle;
    let distance = sqrt(dot(away, away));
    let age = f32(words.y & 0xffffu) * (PUDDLE_RINGS_LIFE / 65536.0);
    // Waves are no faster than this.
    if distance >= min(PUDDLE_RINGS_CRATER + age * PUDDLE_RINGS_SPEED, PUDDLE_RINGS_CELL) {
        return vec2i(0);
    }
    let size = f32(words.y >> 16u) * (f32(PUDDLE_RINGS_SIZES - 1u) / 65536.0);
    let slope = puddle_rings_slope(rings.first_slope, size, age / PUDDLE_RINGS_TIME, distance / PUDDLE_RINGS_DISTANCE);
    return vec2i(away * (slope * PUDDLE_RINGS_UNITS / max(distance, 1.0e-6)));
}

// Slopes along x and z of all rings over a position.
fn puddle_rings_sum(rings: PuddleRings, position: vec2f) -> vec2f {
    let place = (position - rings.corner) / PUDDLE_RINGS_CELL;
    let own = vec2i(floor(place));
    var sum = vec2i(0);
    for (var near = 0; near < 9; near += 1) {
        let cell = own + vec2i(near % 3 - 1, near / 3 - 1);
        if cell.x < 0 || cell.y < 0 || cell.x >= i32(rings.cells.x) || cell.y >= i32(rings.cells.y) {
            continue;
        }
        let index = u32(cell.y) * rings.cells.x + u32(cell.x);
        let end = puddle_rings_first(rings, index + 1u);
        let in_cell = (place - vec2f(cell)) * PUDDLE_RINGS_CELL;
        for (var ring = puddle_rings_first(rings, index); ring < end; ring += 1u) {
            sum += puddle_rings_one(rings, ring, in_cell);
        }
    }
    return vec2f(sum) / PUDDLE_RINGS_UNITS;
}

// How much of rings is shown so far from their middle with a footprint, m: none where waves are smaller than the footprint, and far
// away.
fn puddle_rings_shown(away: vec2f, reach: f32, footprint: f32) -> f32 {
    let near = 1.0 - smoothstep(0.8 * reach, reach, sqrt(dot(away, away)));
    return near * (1.0 - smoothstep(PUDDLE_RINGS_FINE, PUDDLE_RINGS_COARSE, footprint));
}
