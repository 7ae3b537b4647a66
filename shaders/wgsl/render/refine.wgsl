// The mean of pictures of one scene with other rays, taken one by one: radiance, and the distance of what stands nearest in any.
// Twin: downpour_render::refine.

@group(0) @binding(0) var<uniform> refine_frame: vec4u;
@group(0) @binding(1) var<storage, read> refine_next: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> refine_mean: array<vec4f>;

// The mean of `count` pictures with one more, the `count`-th from 1 on.
fn refine_pixel(mean: vec4f, next: vec4f, count: u32) -> vec4f {
    if count <= 1u {
        return next;
    }
    let part = 1.0 / f32(count);
    return vec4f(mean.rgb + (next.rgb - mean.rgb) * part, min(mean.w, next.w));
}

// Width, height and count of the pictures are in refine_frame.
@compute @workgroup_size(8, 8, 1)
fn main_refine(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= refine_frame.x || id.y >= refine_frame.y {
        return;
    }
    let i = id.y * refine_frame.x + id.x;
    refine_mean[i] = refine_pixel(refine_mean[i], refine_next[i], refine_frame.z);
}
