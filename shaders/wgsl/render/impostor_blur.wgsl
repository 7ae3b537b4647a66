// One pass of the vertical blur of the reflection buffer, after Kawase: the mean of four texels, farther apart from pass to pass.
// Twin: downpour_trace::impostor::blur.

@group(0) @binding(1) var<storage, read> impostor_blur_before: array<vec2u>;
@group(0) @binding(2) var<storage, read_write> impostor_blur_after: array<vec2u>;

// A texel of a column; beyond its ends, the last one.
fn impostor_blur_texel(column: u32, row: i32, size: vec2u) -> vec3f {
    return impostor_unpack(impostor_blur_before[u32(clamp(row, 0, i32(size.y) - 1)) * size.x + column]);
}

// The mean of pass `turn` at a texel.
fn impostor_blur_mean(column: u32, row: u32, size: vec2u, turn: u32) -> vec3f {
    let near = i32(turn);
    let at = i32(row);
    let above = impostor_blur_texel(column, at - near - 1, size) + impostor_blur_texel(column, at - near, size);
    let below = impostor_blur_texel(column, at + near, size) + impostor_blur_texel(column, at + near + 1, size);
    return (above + below) * 0.25;
}

@compute @workgroup_size(8, 8, 1)
fn main_impostor_blur(@builtin(global_invocation_id) id: vec3u) {
    let size = impostor_size();
    if id.x >= size.x || id.y >= size.y {
        return;
    }
    let mean = impostor_blur_mean(id.x, id.y, size, render_frame.turn);
    impostor_blur_after[id.y * size.x + id.x] = impostor_pack(mean);
}
