// Craters of impacts and footprints of moving objects, added to the heights of the water.
//
// A crater is a damped sine of the distance, -a (2 / sqrt 3) exp(-q) sin(sqrt(3) q + pi / 3) with q the distance over a
// length: smooth in the middle, and its rim holds exactly the water of its hollow. A bump is (1 - q^2)^2.
// Twin: downpour_lattice::puddle::seed.

struct PuddleSeed {
    // Center, in cells from the corner of the first.
    center: vec2f,
    // Inverse of the length, 1/cells.
    per_length: f32,
    // Amplitude, m, upwards.
    amplitude: f32,
    // Fraction of exp(-q) that compensates the volume lost to the cells, the border and the land.
    lift: f32,
    // Radius in cells beyond which the seed is 0; below 0 for a bump.
    reach: f32,
}

@group(0) @binding(3) var<storage, read> puddle_seed_list: array<PuddleSeed>;
// Index of the first entry of each square of 64 x 64 cells, and the end.
@group(0) @binding(4) var<storage, read> puddle_seed_first: array<u32>;
@group(0) @binding(5) var<storage, read> puddle_seed_entries: array<u32>;
@group(0) @binding(6) var<storage, read_write> puddle_seed_next: array<vec4u>;

// Height of a seed of amplitude 1 without lift, at a distance in lengths.
fn puddle_seed_shape(shape: u32, q: f32) -> f32 {
    let crater = PUDDLE_SEED_HEIGHT * exp(-q) * sin(PUDDLE_SEED_TURN * (q + PUDDLE_SEED_SHIFT));
    let hill = max(1.0 - q * q, 0.0);
    return select(crater, hill * hill, shape == PUDDLE_SEED_BUMP);
}

// Height that a seed adds to a cell.
fn puddle_seed_height(seed: PuddleSeed, cell: vec2f) -> f32 {
    let away = cell + 0.5 - seed.center;
    let distance = sqrt(away.x * away.x + away.y * away.y);
    let q = distance * seed.per_length;
    let shape = select(PUDDLE_SEED_CRATER, PUDDLE_SEED_BUMP, seed.reach < 0.0);
    let height = seed.amplitude * (puddle_seed_shape(shape, q) + seed.lift * exp(-q));
    return select(0.0, height, distance < abs(seed.reach));
}

@compute @workgroup_size(16, 16)
fn main_puddle_seed(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= puddle_grid.quads || id.y >= puddle_grid.size.y {
        return;
    }
    let at = id.y * puddle_grid.quads + id.x;
    let across = (puddle_grid.quads * 4u + PUDDLE_SEED_SQUARE - 1u) / PUDDLE_SEED_SQUARE;
    let square = id.y / PUDDLE_SEED_SQUARE * across + id.x * 4u / PUDDLE_SEED_SQUARE;
    var quad = puddle_state_load(at);
    let links = vec4u(puddle_links[at]) & vec4u(0xffu, 0xff00u, 0xff0000u, 0xff000000u);
    let water = links != vec4u(0u);
    let cell = vec2f(f32(id.x * 4u), f32(id.y));
    // At most 4096 entries in a dispatch.
    for (var k = puddle_seed_first[square]; k < puddle_seed_first[square + 1u]; k += 1u) {
        let seed = puddle_seed_list[puddle_seed_entries[k]];
        let added = vec4f(
            puddle_seed_height(seed, cell),
            puddle_seed_height(seed, cell + vec2f(1.0, 0.0)),
            puddle_seed_height(seed, cell + vec2f(2.0, 0.0)),
            puddle_seed_height(seed, cell + vec2f(3.0, 0.0)),
        );
        quad.height += select(vec4f(0.0), added, water);
    }
    if puddle_grid.half_storage != 0u {
        puddle_seed_next[at] = puddle_state_words(quad.height, quad.velocity);
    } else {
        puddle_seed_next[2u * at] = bitcast<vec4u>(quad.height);
        puddle_seed_next[2u * at + 1u] = bitcast<vec4u>(quad.velocity);
    }
}
