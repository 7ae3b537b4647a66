// Directions of light among those of a streak atlas. The frame of a streak: z toward the viewer, y the drop's axis as
// the picture shows it, x to the right. The half sphere x >= 0 is mapped to the unit disk by (y, z) / (1 + x).
// Twin: downpour_atlas::lookup.

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
    // 1 if all elevations have the same directions, else 0: then patterns are those of the nearest elevation.
    is_shared: u32,
    unused: u32,
    // Gaps between neighboring diameters, up to eight: the lower end, the logarithm to base 2 of meters; then 1 / the width of
    // each gap. 0 where there is no gap.
    diameters: array<vec4f, 4>,
    // Gaps between neighboring elevations, by their sines, in the same form.
    elevations: array<vec4f, 4>,
    // First triangle of each elevation, then the number of all.
    first: array<vec4u, 3>,
}

struct AtlasTriangle {
    // Positions of the corners in the map.
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

struct AtlasSlot {
    // Three layers of the atlas, of the lower diameter and the lower elevation.
    layers: vec3u,
    // -1 if the streak is to be mirrored, else 1.
    side: f32,
    // Weights of the three directions; together 1.
    weights: vec3f,
    // The radiance, in 1/sr for an irradiance of 1, of a disk of the equivalent radius with as much light.
    amount: f32,
    // Weights of the higher diameter and of the higher elevation.
    parts: vec2f,
    unused: vec2f,
}

// Three directions of an elevation and their weights; together 1.
struct AtlasMix {
    directions: vec3u,
    weights: vec3f,
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

// The position of a direction in the map.
fn atlas_map(direction: vec3f) -> vec2f {
    let below = 1.0 / (1.0 + abs(direction.x));
    return direction.yz * below;
}

// Position of a value among up to nine ascending nodes: 0 at the first, 1 at the second, linear in between, constant beyond the
// ends. The lower ends of the gaps between nodes, then 1 / their widths, 0 where there is no gap.
fn atlas_position(low: vec4f, high: vec4f, low_inverse: vec4f, high_inverse: vec4f, value: f32) -> f32 {
    let parts = clamp((vec4f(value) - low) * low_inverse, vec4f(0.0), vec4f(1.0))
        + clamp((vec4f(value) - high) * high_inverse, vec4f(0.0), vec4f(1.0));
    return (parts.x + parts.y) + (parts.z + parts.w);
}

// Position of a viewer among the grids of amounts, by the sine of the elevation.
fn atlas_rise(sine: f32) -> f32 {
    return clamp(0.5 * (sine / ATLAS_RISE_LIMIT) + 0.5, 0.0, 1.0) * f32(ATLAS_RISES - 1u);
}

// Cell of the grid of amounts that a point of the map is in: column and row of its first node, then the point's distance from that
// node in cells.
fn atlas_cell(point: vec2f) -> vec4f {
    let cells = f32(ATLAS_GRID - 1u);
    let at = (0.5 * point + vec2f(0.5)) * cells;
    let node = clamp(floor(at), vec2f(0.0), vec2f(cells - 1.0));
    return vec4f(node, clamp(at - node, vec2f(0.0), vec2f(1.0)));
}

// Weight of one of the four neighbors in diameter and elevation. Bit 0: the higher diameter; bit 1: the higher elevation; the weights
// of these.
fn atlas_corner(size: f32, rise: f32, corner: u32) -> f32 {
    return select(1.0 - size, size, (corner & 1u) == 1u) * select(1.0 - rise, rise, (corner & 2u) == 2u);
}

// Fractions of the corners in a point of the map; together 1, below 0 beyond the opposite edge.
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
