// Normals of the water by Sobel sums. Missing neighbors are replaced as for the ripples: by the cell itself, or by its
// image in the wall.
//
// x runs along the rows, z along the columns, y is up. Two components are stored in 16 bits each; y completes the
// length 1. Or slopes are stored as they are, for the levels of a picture. Twin: downpour_lattice::puddle::normal.

// A normal per cell, packed.
@group(0) @binding(3) var<storage, read_write> puddle_normal_words: array<vec4u>;
// A texel of slopes per cell, in rows without padding, from grid.first_texel on.
@group(0) @binding(4) var<storage, read_write> puddle_normal_texels: array<vec4f>;

// Heights of a quad; 0 beyond the lattice, to which there are no links.
fn puddle_normal_quad(x: u32, y: u32) -> vec4f {
    if x < puddle_grid.quads && y < puddle_grid.size.y {
        return puddle_state_load(y * puddle_grid.quads + x).height;
    }
    return vec4f(0.0);
}

// A row: the quads west of, at and east of a position.
fn puddle_normal_row(x: u32, y: u32) -> mat3x4f {
    let quad = puddle_normal_quad(x, y);
    let west = puddle_normal_quad(x - 1u, y).w;
    let east = puddle_normal_quad(x + 1u, y).x;
    return mat3x4f(vec4f(west, quad.xyz), quad, vec4f(quad.yzw, east));
}

// Slopes along x and z of a quad.
fn puddle_normal_slopes(north: mat3x4f, here: mat3x4f, south: mat3x4f, links: u32, scale: f32) -> mat2x4f {
    let own = here[1];
    let n = puddle_linked(own, north[1], links, PUDDLE_LINK_NORTH);
    let s = puddle_linked(own, south[1], links, PUDDLE_LINK_SOUTH);
    let w = puddle_linked(own, here[0], links, PUDDLE_LINK_WEST);
    let e = puddle_linked(own, here[2], links, PUDDLE_LINK_EAST);
    let nw = puddle_corner(own, n, w, north[0], links, PUDDLE_LINKS_NORTH_WEST);
    let ne = puddle_corner(own, n, e, north[2], links, PUDDLE_LINKS_NORTH_EAST);
    let sw = puddle_corner(own, s, w, south[0], links, PUDDLE_LINKS_SOUTH_WEST);
    let se = puddle_corner(own, s, e, south[2], links, PUDDLE_LINKS_SOUTH_EAST);
    let x = ((ne - nw) + (se - sw)) + 2.0 * (e - w);
    let z = ((sw - nw) + (se - ne)) + 2.0 * (s - n);
    return mat2x4f(x * scale, z * scale);
}

// x and z components of the normal of a surface with these slopes.
fn puddle_normal_lean(slope: vec2f) -> vec2f {
    return -slope / sqrt(1.0 + slope.x * slope.x + slope.y * slope.y);
}

// Texel of a surface with these slopes: the slopes of its normal, at most 1000, and the square of the slope.
fn puddle_normal_texel(slope: vec2f) -> vec4f {
    let lean = puddle_normal_lean(slope);
    let up = sqrt(max(1.0 - lean.x * lean.x - lean.y * lean.y, 0.0));
    let kept = -lean / max(up, 1.0e-3);
    return vec4f(kept, kept.x * kept.x + kept.y * kept.y, 0.0);
}

// Slopes along x and z of the quad at a position.
fn puddle_normal_found(x: u32, y: u32) -> mat2x4f {
    return puddle_normal_slopes(
        puddle_normal_row(x, y - 1u),
        puddle_normal_row(x, y),
        puddle_normal_row(x, y + 1u),
        puddle_links[y * puddle_grid.quads + x],
        puddle_grid.slope,
    );
}

@compute @workgroup_size(16, 16)
fn main_puddle_normal(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= puddle_grid.quads || id.y >= puddle_grid.size.y {
        return;
    }
    let at = id.y * puddle_grid.quads + id.x;
    let slopes = puddle_normal_found(id.x, id.y);
    puddle_normal_words[at] = vec4u(
        pack2x16snorm(puddle_normal_lean(vec2f(slopes[0].x, slopes[1].x))),
        pack2x16snorm(puddle_normal_lean(vec2f(slopes[0].y, slopes[1].y))),
        pack2x16snorm(puddle_normal_lean(vec2f(slopes[0].z, slopes[1].z))),
        pack2x16snorm(puddle_normal_lean(vec2f(slopes[0].w, slopes[1].w))),
    );
}

@compute @workgroup_size(16, 16)
fn main_puddle_normal_slopes(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= puddle_grid.quads || id.y >= puddle_grid.size.y {
        return;
    }
    let slopes = puddle_normal_found(id.x, id.y);
    let row = puddle_grid.first_texel + id.y * puddle_grid.size.x;
    for (var k = 0u; k < 4u; k += 1u) {
        let x = id.x * 4u + k;
        if x < puddle_grid.size.x {
            puddle_normal_texels[row + x] = puddle_normal_texel(vec2f(slopes[0][k], slopes[1][k]));
        }
    }
}
