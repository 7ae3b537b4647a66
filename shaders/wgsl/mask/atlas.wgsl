// Directions of light among those of a streak atlas. The frame of a streak: z towards the viewer, y the drop's axis as
// the picture shows it, x to the right. The half sphere x >= 0 is mapped to the unit disc by (y, z) / (1 + x).
// Twin: downpour_mask::atlas::lookup.

struct AtlasFrame {
    // Columns and rows of a layer.
    size: vec2u,
    // Half of the width of a streak, in equivalent radii.
    half_extent: f32,
    // ATLAS_BY_ANGLE or ATLAS_RANDOM.
    pick: u32,
    // Numbers of diameters, oscillations, elevations and directions.
    counts: vec4u,
    seed: vec2u,
    unused: vec2u,
    // Thresholds between neighbouring diameters in metres.
    diameters: array<vec4f, 2>,
    // Sines of the angles midway between neighbouring elevations.
    elevations: array<vec4f, 2>,
    // First triangle of each elevation, then the number of all.
    first: array<vec4u, 3>,
    unused_1: vec4u,
}

struct AtlasTriangle {
    // Places of the corners in the map.
    a: vec2f,
    b: vec2f,
    c: vec2f,
    unused: vec2f,
    // Directions of the corners.
    directions: vec3u,
    unused_1: u32,
    // Triangles across from each corner; ATLAS_NONE at the rim.
    next: vec3u,
    unused_2: u32,
}

struct AtlasPlace {
    // Three layers of the atlas.
    layers: vec3u,
    // -1 if the streak is to be mirrored, else 1.
    side: f32,
    // Their weights; together 1.
    weights: vec3f,
    unused: f32,
}

// A light in the frame of the streak of a drop with this axis.
fn atlas_light(light: vec3f, view: vec3f, axis: vec3f) -> vec3f {
    let along = dot(axis, view);
    let up = axis - along * view;
    let square = dot(up, up);
    let spare = cross(view, select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(view.x) < 0.5));
    let chosen = select(up, spare, square < ATLAS_TINY);
    let y = chosen * (1.0 / sqrt(dot(chosen, chosen)));
    let x = cross(y, view);
    return vec3f(dot(light, x), dot(light, y), dot(light, view));
}

// The place of a direction in the map.
fn atlas_map(direction: vec3f) -> vec2f {
    let below = 1.0 / (1.0 + abs(direction.x));
    return direction.yz * below;
}

// How many of eight ascending thresholds a value is above.
fn atlas_rank(low: vec4f, high: vec4f, value: f32) -> u32 {
    let above = select(vec4u(0u), vec4u(1u), vec4f(value) > low)
        + select(vec4u(0u), vec4u(1u), vec4f(value) > high);
    return above.x + above.y + above.z + above.w;
}

// Shares of the corners in a point of the map; together 1, below 0 beyond the opposite edge.
fn atlas_weights(a: vec2f, b: vec2f, c: vec2f, point: vec2f) -> vec3f {
    let ab = b - a;
    let ac = c - a;
    let ap = point - a;
    let area = ab.x * ac.y - ab.y * ac.x;
    let second = (ap.x * ac.y - ap.y * ac.x) / area;
    let third = (ab.x * ap.y - ab.y * ap.x) / area;
    return vec3f(1.0 - second - third, second, third);
}

// The weights with those below 0 taken as 0; together 1.
fn atlas_clamp(weights: vec3f) -> vec3f {
    let above = max(weights, vec3f(0.0));
    return above * (1.0 / (above.x + above.y + above.z));
}

// One of `count` by chance, by the id of a particle.
fn atlas_draw(seed: vec2u, id: u32, which: u32, count: u32) -> u32 {
    let word = rng_draw(seed, id, which, ATLAS_DIMENSION).x;
    return min(u32(rng_unit(word) * f32(count)), count - 1u);
}
