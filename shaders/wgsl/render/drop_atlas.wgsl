// Which streaks of an atlas a drop shows under a lamp: the choice of mask/atlas_lookup.wgsl, out of a table of numbers that
// stands behind the scattering of drops.
// Law: a layer's mean is the radiance, in 1/sr for an irradiance of 1, of a disc of the equivalent radius that sends as much
// light to the viewer as the drop of the streak does.
// Twin: downpour_render::rain::light::atlas, where the rows are laid out.

// Three directions: places in the map, what is across from each corner (below 0: the rim), and their numbers.
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

// The mean of a layer.
fn drop_atlas_mean(layer: u32) -> f32 {
    let first = u32(drop_atlas_row(DROP_ATLAS_PICK).y);
    return drop_atlas_row(first + (layer >> 2u))[layer & 3u];
}

// The three layers for a drop's id, diameter in metres and axis, and the unit vectors to its light and viewer.
fn drop_atlas_place(id: u32, diameter: f32, axis: vec3f, light: vec3f, view: vec3f) -> AtlasPlace {
    let counts = vec4u(drop_atlas_row(DROP_ATLAS_COUNTS));
    let seed = drop_atlas_seed();
    let within = atlas_light(light, view, axis);
    let side = select(1.0, -1.0, within.x < 0.0);
    if u32(drop_atlas_row(DROP_ATLAS_PICK).x) == ATLAS_RANDOM {
        let layer = atlas_draw(seed, id, 1u, counts.x * counts.y * counts.z * counts.w);
        return AtlasPlace(vec3u(layer), side, vec3f(1.0, 0.0, 0.0), 0.0);
    }
    let size = atlas_rank(drop_atlas_row(DROP_ATLAS_SIZES), drop_atlas_row(DROP_ATLAS_SIZES + 1u), diameter);
    let rise = dot(view, axis);
    let elevation = atlas_rank(drop_atlas_row(DROP_ATLAS_RISES), drop_atlas_row(DROP_ATLAS_RISES + 1u), rise);
    let oscillation = atlas_draw(seed, id, 0u, counts.y);
    let base = ((size * counts.y + oscillation) * counts.z + elevation) * counts.w;
    let first = u32(drop_atlas_row(DROP_ATLAS_FIRST + (elevation >> 2u))[elevation & 3u]);
    let point = atlas_map(within);
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
    return AtlasPlace(vec3u(base) + vec3u(triangle.directions), side, atlas_clamp(weights), 0.0);
}

// The parts of three layers in the mean of their mixture, and this mean.
fn drop_atlas_shares(place: AtlasPlace) -> vec4f {
    let layers = place.layers;
    let means = vec3f(drop_atlas_mean(layers.x), drop_atlas_mean(layers.y), drop_atlas_mean(layers.z));
    let parts = place.weights * means;
    let whole = parts.x + parts.y + parts.z;
    return vec4f(parts / max(whole, DROP_GLINT_TINY), whole);
}
