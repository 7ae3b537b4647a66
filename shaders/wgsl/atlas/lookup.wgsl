// Radiances of streaks, by the directions of light and viewer.
// Twin: downpour_atlas::lookup.

// The three directions of an elevation about a point of the map, and their weights. The walk goes over the edge that the point is
// farthest beyond, until it is in a triangle or at the rim.
fn atlas_lookup_mix(elevation: u32, point: vec2f) -> AtlasMix {
    let first = atlas_data_frame.first[elevation >> 2u][elevation & 3u];
    var triangle = atlas_data_triangles[first];
    var weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    for (var step = 0u; step < ATLAS_STEPS; step += 1u) {
        let least = min(weights.x, min(weights.y, weights.z));
        let last = select(triangle.next.z, triangle.next.y, weights.y == least);
        let over = select(last, triangle.next.x, weights.x == least);
        if least >= 0.0 || over == ATLAS_NONE {
            break;
        }
        triangle = atlas_data_triangles[first + over];
        weights = atlas_weights(triangle.a, triangle.b, triangle.c, point);
    }
    return AtlasMix(triangle.directions, atlas_clamp(weights));
}

// The amount of one grid in a cell: bilinear.
fn atlas_lookup_amount(grid: u32, cell: vec4f) -> f32 {
    let first = (grid * ATLAS_GRID + u32(cell.y)) * ATLAS_GRID + u32(cell.x);
    let next = first + ATLAS_GRID;
    let below = atlas_data_amounts[first] * (1.0 - cell.z) + atlas_data_amounts[first + 1u] * cell.z;
    let above = atlas_data_amounts[next] * (1.0 - cell.z) + atlas_data_amounts[next + 1u] * cell.z;
    return below * (1.0 - cell.w) + above * cell.w;
}

// The streak of a drop's id, diameter in meters and axis, and the unit vectors to its light and viewer.
fn atlas_lookup_slot(id: u32, diameter: f32, axis: vec3f, light: vec3f, view: vec3f) -> AtlasSlot {
    let counts = atlas_data_frame.counts;
    let within = atlas_light(light, view, axis);
    let side = select(1.0, -1.0, within.x < 0.0);
    if atlas_data_frame.pick == ATLAS_RANDOM {
        let sets = counts.x * counts.y;
        let layer = atlas_draw(atlas_data_frame.seed, id, 1u, sets * counts.z * counts.w);
        let amount = atlas_data_amounts[sets * ATLAS_RISES * ATLAS_GRID * ATLAS_GRID + layer];
        return AtlasSlot(vec3u(layer), side, vec3f(1.0, 0.0, 0.0), amount, vec2f(0.0), vec2f(0.0));
    }
    let sizes = atlas_data_frame.diameters;
    let rises = atlas_data_frame.elevations;
    let size = atlas_position(sizes[0], sizes[1], sizes[2], sizes[3], log2(max(diameter, ATLAS_MIN_DIAMETER)));
    let sine = dot(view, axis);
    let rise = atlas_rise(sine);
    let lower = vec2u(vec2f(size, rise));
    let parts = vec2f(size, rise) - vec2f(lower);
    let group = lower.x * counts.y + atlas_draw(atlas_data_frame.seed, id, 0u, counts.y);
    let point = atlas_map(within);
    let cell = atlas_cell(point);
    var amount = 0.0;
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let weight = atlas_corner(parts.x, parts.y, corner);
        if weight > 0.0 {
            let grid = (group + (corner & 1u) * counts.y) * ATLAS_RISES + lower.y + (corner >> 1u);
            amount += weight * atlas_lookup_amount(grid, cell);
        }
    }
    let level = atlas_position(rises[0], rises[1], rises[2], rises[3], sine);
    let nearest = atlas_data_frame.is_shared == 0u;
    let elevation = u32(select(level, level + 0.5, nearest));
    let higher = select(level - floor(level), 0.0, nearest);
    let corners = atlas_lookup_mix(elevation, point);
    let base = (group * counts.z + elevation) * counts.w;
    return AtlasSlot(vec3u(base) + corners.directions, side, corners.weights, amount, vec2f(parts.x, higher), vec2f(0.0));
}

// A texel. Columns outside are 0, rows wrap around.
fn atlas_lookup_texel(layer: u32, column: i32, row: i32) -> f32 {
    let size = atlas_data_frame.size;
    if column < 0 || column >= i32(size.x) {
        return 0.0;
    }
    let rows = i32(size.y);
    let down = u32(((row % rows) + rows) % rows);
    let index = (layer * size.y + down) * size.x + u32(column);
    let pair = unpack2x16float(atlas_data_texels[index >> 1u]);
    return select(pair.x, pair.y, (index & 1u) == 1u);
}

// A layer at so many columns and rows from its corner: bilinear.
fn atlas_lookup_layer(layer: u32, across: f32, down: f32) -> f32 {
    let u = across - 0.5;
    let v = down - 0.5;
    let left = floor(u);
    let top = floor(v);
    let x = u - left;
    let y = v - top;
    let column = i32(left);
    let row = i32(top);
    let above = atlas_lookup_texel(layer, column, row) * (1.0 - x)
        + atlas_lookup_texel(layer, column + 1, row) * x;
    let below = atlas_lookup_texel(layer, column, row + 1) * (1.0 - x)
        + atlas_lookup_texel(layer, column + 1, row + 1) * x;
    return above * (1.0 - y) + below * y;
}

// The radiance at a slot, `across` equivalent radii to the right of the middle, after `turns` turns of the mode (2,0).
fn atlas_lookup_radiance(slot: AtlasSlot, across: f32, turns: f32) -> f32 {
    let counts = atlas_data_frame.counts;
    let half = 0.5 * f32(atlas_data_frame.size.x);
    let column = half + half * clamp(across * slot.side / atlas_data_frame.half_extent, -2.0, 2.0);
    let row = (turns - floor(turns)) * f32(atlas_data_frame.size.y);
    var pattern = 0.0;
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let weight = atlas_corner(slot.parts.x, slot.parts.y, corner);
        if weight > 0.0 {
            let layers = slot.layers + vec3u(((corner & 1u) * counts.y * counts.z + (corner >> 1u)) * counts.w);
            pattern += weight * (slot.weights.x * atlas_lookup_layer(layers.x, column, row)
                + slot.weights.y * atlas_lookup_layer(layers.y, column, row)
                + slot.weights.z * atlas_lookup_layer(layers.z, column, row));
        }
    }
    return slot.amount * pattern;
}
