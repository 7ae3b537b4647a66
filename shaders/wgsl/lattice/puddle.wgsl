// One step of a cell of a puddle: the weighted sum over its neighbors, Clenshaw's recurrence of the polynomial that
// approximates omega^2, and the damping of a velocity.
//
// Four cells of a row are a quad. A link is a bit: the neighbor exists and is water. Where a link is missing, the
// neighbor is replaced by the cell itself, or by its image in a straight wall.
// Twin: downpour_lattice::puddle::lattice.

struct PuddleGrid {
    size: vec2u,
    // Number of quads in a row of memory.
    quads: u32,
    // Degree of the polynomial, and its coefficients over the first of them.
    degree: u32,
    coefficients: array<vec4f, 4>,
    // Weights of the cell, of its straight and of its diagonal neighbors.
    weights: vec3f,
    dt: f32,
    // Factors from a weighted sum to 2 x of the polynomial, and to a change of velocity.
    twice: f32,
    kick: f32,
    // Viscosity: fraction of the velocity that is added to the argument of the last sum.
    viscosity: f32,
    // Fraction of a velocity that remains after a time step, far from the border.
    keep: f32,
    // Width of the absorbing border, in cells; drag at its edge times the time step.
    sponge_cells: f32,
    sponge_drag: f32,
    // Number of time steps per sweep, and width of the halo that a tile reads around the cells that it writes.
    steps: u32,
    halo: u32,
    // 1 if the state is stored in 16 bits per number.
    half_storage: u32,
    // Inverse of eight cells, 1/m.
    slope: f32,
    // First texel of the slopes that main_puddle_normal_slopes writes.
    first_texel: u32,
}

// Values of the neighbors, or of the cells themselves where the link is missing. A byte of `links` per cell.
fn puddle_linked(own: vec4f, other: vec4f, links: u32, link: u32) -> vec4f {
    let bits = vec4u(link, link << 8u, link << 16u, link << 24u);
    return select(own, other, (vec4u(links) & bits) != vec4u(0u));
}

// For a diagonal neighbor: the links of the two adjacent straight ones, and its own.
const PUDDLE_LINKS_NORTH_WEST = vec3u(PUDDLE_LINK_NORTH, PUDDLE_LINK_WEST, PUDDLE_LINK_NORTH_WEST);
const PUDDLE_LINKS_NORTH_EAST = vec3u(PUDDLE_LINK_NORTH, PUDDLE_LINK_EAST, PUDDLE_LINK_NORTH_EAST);
const PUDDLE_LINKS_SOUTH_WEST = vec3u(PUDDLE_LINK_SOUTH, PUDDLE_LINK_WEST, PUDDLE_LINK_SOUTH_WEST);
const PUDDLE_LINKS_SOUTH_EAST = vec3u(PUDDLE_LINK_SOUTH, PUDDLE_LINK_EAST, PUDDLE_LINK_SOUTH_EAST);

// Values of the diagonal neighbors. Where the link is missing, it is the mirror image in the wall that the straight
// neighbors `a` and `b` define: `b` if only that is water, `a` if only that is, else the cell itself.
fn puddle_corner(own: vec4f, a: vec4f, b: vec4f, diagonal: vec4f, links: u32, bits: vec3u) -> vec4f {
    let level = puddle_linked(b, puddle_linked(a, own, links, bits.y), links, bits.x);
    return puddle_linked(level, diagonal, links, bits.z);
}

// Weighted sum over the neighbors. Rows are the quads west of, at and east of the quad.
fn puddle_laplacian(north: mat3x4f, here: mat3x4f, south: mat3x4f, links: u32, weights: vec3f) -> vec4f {
    let own = here[1];
    let n = puddle_linked(own, north[1], links, PUDDLE_LINK_NORTH);
    let s = puddle_linked(own, south[1], links, PUDDLE_LINK_SOUTH);
    let w = puddle_linked(own, here[0], links, PUDDLE_LINK_WEST);
    let e = puddle_linked(own, here[2], links, PUDDLE_LINK_EAST);
    let nw = puddle_corner(own, n, w, north[0], links, PUDDLE_LINKS_NORTH_WEST);
    let ne = puddle_corner(own, n, e, north[2], links, PUDDLE_LINKS_NORTH_EAST);
    let sw = puddle_corner(own, s, w, south[0], links, PUDDLE_LINKS_SOUTH_WEST);
    let se = puddle_corner(own, s, e, south[2], links, PUDDLE_LINKS_SOUTH_EAST);
    let straight = (n + s) + (w + e);
    let diagonal = (nw + ne) + (sw + se);
    return weights.x * own - (weights.y * straight + weights.z * diagonal);
}

// Next sum of Clenshaw's recurrence.
fn puddle_recur(wave: vec4f, sum: vec4f, now: vec4f, before: vec4f) -> vec4f {
    return (wave + sum) - (now + before);
}

// Distance of a cell's center from the nearest border along an axis, in cells.
fn puddle_border(cell: u32, size: u32) -> f32 {
    return f32(min(cell, max(max(size, 1u) - 1u, cell) - cell)) + 0.5;
}

// Fraction of a velocity that remains at a distance, in cells, from the border.
fn puddle_keep(distance: f32, keep: f32, sponge_cells: f32, sponge_drag: f32) -> f32 {
    let into = max(sponge_cells - distance, 0.0) / max(sponge_cells, 1.0);
    return keep / (1.0 + sponge_drag * (into * into));
}

// Sets a number to 0 if it is below 1e-20, which would be slow, or not finite.
fn puddle_settle(value: f32) -> f32 {
    return select(0.0, value, ops_is_finite(value) && abs(value) >= PUDDLE_MIN);
}

// True for each finite number of a quad.
fn puddle_is_finite(quad: vec4f) -> vec4<bool> {
    return (bitcast<vec4u>(quad) & vec4u(0x7f800000u)) != vec4u(0x7f800000u);
}
