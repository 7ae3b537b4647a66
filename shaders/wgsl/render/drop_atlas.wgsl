// Choice of the streaks of an atlas that a drop shows under a lamp: that of atlas/lookup.wgsl, out of a table of numbers that
// stands behind the scattering of drops.
// Law: an amount is the radiance, in 1/sr for an irradiance of 1, of a disk of the equivalent radius that sends as much
// light to the viewer as the drop of the streak does.
// Twin: downpour_render::rain::light::atlas, where the rows are laid out.

// Three directions: positions in the map, what is across from each corner (below 0: the rim), and their numbers.
struct DropAtlasTriangle {
    a: vec2f,
    b: vec2f,
    c: vec2f,
    next: vec3f,
    directions: vec3f,
}

// A row of the atlas' numbers.
fn drop_atlas_row(k: u32) -> vec4f {
    return drop_light_table[DROP_LIGHT_ENTRIES * (1u + DROP_LIGHT_PATHS) + k];
}

// The seed of all choices by chance.
fn drop_atlas_seed() -> vec2u {
    let halves = vec4u(drop_atlas_row(DROP_ATLAS_SEED));
    return vec2u(halves.x | (halves.y << 16u), halves.z | (halves.w << 16u));
}

// A triangle of the map.
fn drop_atlas_triangle(k: u32) -> DropAtlasTriangle {
    let row = DROP_ATLAS_TRIANGLES + 3u * k;
    let corners = drop_atlas_row(row);
    let more = drop_atlas_row(row + 1u);
    let last = drop_atlas_row(row + 2u);
    return DropAtlasTriangle(corners.xy, corners.zw, more.xy, vec3f(more.zw, last.x), last.yzw);
}

// An amount by its number.
fn drop_atlas_number(k: u32) -> f32 {
    let first = u32(drop_atlas_row(DROP_ATLAS_PICK).y);
    return drop_atlas_row(first + (k >> 2u))[k & 3u];
}

// The amount of one grid in a cell: bilinear.
fn drop_atlas_amount(grid: u32, cell: vec4f) -> f32 {
    let first = (grid * ATLAS_GRID + u32(cell.y)) * ATLAS_GRID + u32(cell.x);
    let next = first + ATLAS_GRID;
    let below = drop_atlas_number(first) * (1.0 - cell.z) + drop_atlas_number(first + 1u) * cell.z;
    let above = drop_atlas_number(next) * (1.0 - cell.z) + drop_atlas_number(next + 1u) * cell.z;
    return below * (1.0 - cell.w) + above * cell.w;
}

// Position of a value among the nodes whose gaps are the four rows from `first` on.
fn drop_atlas_position(first: u32, value: f32) -> f32 {
    return atlas_position(
        drop_atlas_row(first),
        drop_atlas_row(first + 1u),
        drop_atlas_row(first + 2u),
        drop_atlas_row(first + 3u),
        value,
    );
}

// The streak of a drop's id, diameter in meters and axis, and the unit vectors to its light and viewer.
fn drop_atlas_slot(id: u32, diameter: f32, axis: vec3f, light: vec3f, view: vec3f) -> AtlasSlot {
    let counts = vec4u(drop_atlas_row(DROP_ATLAS_COUNTS));
    let head = drop_atlas_row(DROP_ATLAS_PICK);
    let seed = drop_atlas_seed();
    let within = atlas_light(light, view, axis);
    let side = select(1.0, -1.0, within.x < 0.0);
    if u32(head.x) == ATLAS_RANDOM {
        let sets = counts.x * counts.y;
        let layer = atlas_draw(seed, id, 1u, sets * counts.z * counts.w);
        let amount = drop_atlas_number(sets * ATLAS_RISES * ATLAS_GRID * ATLAS_GRID + layer);
        return AtlasSlot(vec3u(layer), side, vec3f(1.0, 0.0, 0.0), amount, vec2f(0.0), vec2f(0.0));
    }
    let size = drop_atlas_position(DROP_ATLAS_SIZES, log2(max(diameter, ATLAS_MIN_DIAMETER)));
    let sine = dot(view, axis);
    let rise = atlas_rise(sine);
    let lower = vec2u(vec2f(size, rise));
    let parts = vec2f(size, rise) - vec2f(lower);
    let group = lower.x * counts.y + atlas_draw(seed, id, 0u, counts.y);
    let point = atlas_map(within);
    let cell = atlas_cell(point);
    var amount = 0.0;
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let weight = atlas_corner(parts.x, parts.y, corner);
        if weight > 0.0 {
            let grid = (group + (corner & 1u) * counts.y) * ATLAS_RISES + lower.y + (corner >> 1u);
            amount += weight * drop_atlas_amount(grid, cell);
        }
    }
    let level = drop_atlas_position(DROP_ATLAS_RISES, sine);
    let nearest = u32(head.z) == 0u;
    let elevation = u32(select(level, level + 0.5, nearest));
    let higher = select(level - floor(level), 0.0, nearest);
    let base = (group * counts.z + elevation) * counts.w;
    let first = u32(drop_atlas_row(DROP_ATLAS_FIRST + (elevation >> 2u))[elevation & 3u]);
    var triangle = drop_atlas_triangle(first);
    var weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    for (var step = 0u; step < ATLAS_STEPS; step += 1u) {
        let least = min(weights.x, min(weights.y, weights.z));
        let last = select(triangle.next.z, triangle.next.y, weights.y == least);
        let over = select(last, triangle.next.x, weights.x == least);
        if least >= 0.0 || over < 0.0 {
            break;
        }
        triangle = drop_atlas_triangle(first + u32(over));
        weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    }
    let layers = vec3u(base) + vec3u(triangle.directions);
    return AtlasSlot(layers, side, atlas_clamp(weights), amount, vec2f(parts.x, higher), vec2f(0.0));
}
