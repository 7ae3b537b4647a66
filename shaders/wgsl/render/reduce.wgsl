// Coarser levels of a square map whose edge is a power of two: each texel is the mean of four. Levels follow each other
// in one buffer, the finest first.
// Twin: downpour_render::rain::reduce.

struct ReduceLevel {
    // Texels along an edge of the level that is made.
    size: u32,
    // First texel of the level that is read, and of the one that is made.
    source: u32,
    target_texel: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> reduce_level: ReduceLevel;
@group(0) @binding(1) var<storage, read_write> reduce_texels: array<vec4f>;

// The mean of the four texels below a texel.
fn reduce_texel(x: u32, y: u32) -> vec4f {
    let edge = reduce_level.size * 2u;
    let first = reduce_level.source + 2u * y * edge + 2u * x;
    let upper = reduce_texels[first] + reduce_texels[first + 1u];
    let lower = reduce_texels[first + edge] + reduce_texels[first + edge + 1u];
    return (upper + lower) * 0.25;
}

@compute @workgroup_size(8, 8, 1)
fn main_reduce(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= reduce_level.size || id.y >= reduce_level.size {
        return;
    }
    reduce_texels[reduce_level.target_texel + id.y * reduce_level.size + id.x] = reduce_texel(id.x, id.y);
}
