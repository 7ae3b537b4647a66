// Mip pyramid: the coarser levels of a map, each of about half the size of the one before. A texel is the mean of the four
// below it; where an odd size leaves a row or column over, the last one counts twice. All levels lie in one buffer, the
// finest first.
// Twin: downpour_math::pyramid.

struct PyramidLevel {
    // Columns and rows of the level that is made.
    size: vec2u,
    // Columns and rows of the level that it is made of.
    source_size: vec2u,
    // First texel of the level that is read, and of the one that is made.
    source: u32,
    target_texel: u32,
    unused: vec2u,
}

@group(0) @binding(0) var<uniform> pyramid_level: PyramidLevel;
@group(0) @binding(1) var<storage, read_write> pyramid_texels: array<vec4f>;

// Mean of the four texels below a texel.
fn pyramid_texel(x: u32, y: u32) -> vec4f {
    let edge = pyramid_level.source_size.x;
    let left = 2u * x;
    let right = min(2u * x + 1u, edge - 1u);
    let upper = pyramid_level.source + 2u * y * edge;
    let lower = pyramid_level.source + min(2u * y + 1u, pyramid_level.source_size.y - 1u) * edge;
    let first_row = pyramid_texels[upper + left] + pyramid_texels[upper + right];
    return (first_row + pyramid_texels[lower + left] + pyramid_texels[lower + right]) * 0.25;
}

@compute @workgroup_size(8, 8, 1)
fn main_pyramid(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= pyramid_level.size.x || id.y >= pyramid_level.size.y {
        return;
    }
    let texel = pyramid_texel(id.x, id.y);
    pyramid_texels[pyramid_level.target_texel + id.y * pyramid_level.size.x + id.x] = texel;
}
