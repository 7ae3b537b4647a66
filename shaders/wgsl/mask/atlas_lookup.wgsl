// Radiances of streaks, by the directions of light and viewer.
// Twin: downpour_mask::atlas::lookup.

// The three layers for a drop's id, diameter in metres and axis, and the unit vectors to its light and viewer. The walk
// goes over the edge that the point is farthest beyond, until it is in a triangle or at the rim.
fn atlas_lookup_place(id: u32, diameter: f32, axis: vec3f, light: vec3f, view: vec3f) -> AtlasPlace {
    let counts = atlas_data_frame.counts;
    let within = atlas_light(light, view, axis);
    let side = select(1.0, -1.0, within.x < 0.0);
    if atlas_data_frame.pick == ATLAS_RANDOM {
        let layer = atlas_draw(atlas_data_frame.seed, id, 1u, counts.x * counts.y * counts.z * counts.w);
        return AtlasPlace(vec3u(layer), side, vec3f(1.0, 0.0, 0.0), 0.0);
    }
    let size = atlas_rank(atlas_data_frame.diameters[0], atlas_data_frame.diameters[1], diameter);
    let elevation =
        atlas_rank(atlas_data_frame.elevations[0], atlas_data_frame.elevations[1], dot(view, axis));
    let oscillation = atlas_draw(atlas_data_frame.seed, id, 0u, counts.y);
    let base = ((size * counts.y + oscillation) * counts.z + elevation) * counts.w;
    let first = atlas_data_frame.first[elevation >> 2u][elevation & 3u];
    let point = atlas_map(within);
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
    return AtlasPlace(vec3u(base) + triangle.directions, side, atlas_clamp(weights), 0.0);
}

// A texel. Columns outside are 0, rows go round.
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

// The texel of a place, so many equivalent radii to the right of the middle, so many turns of the mode (2,0) along.
fn atlas_lookup_radiance(place: AtlasPlace, across: f32, turns: f32) -> f32 {
    let half = 0.5 * f32(atlas_data_frame.size.x);
    let column = half + half * clamp(across * place.side / atlas_data_frame.half_extent, -2.0, 2.0);
    let row = (turns - floor(turns)) * f32(atlas_data_frame.size.y);
    return place.weights.x * atlas_lookup_layer(place.layers.x, column, row)
        + place.weights.y * atlas_lookup_layer(place.layers.y, column, row)
        + place.weights.z * atlas_lookup_layer(place.layers.z, column, row);
}
