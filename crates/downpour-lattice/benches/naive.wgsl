// Naive membrane: one invocation per cell, one step per dispatch.
@group(0) @binding(0) var<storage, read> now: array<f32>;
@group(0) @binding(1) var<storage, read_write> next: array<f32>;
override SIZE: u32 = 256u;

@compute @workgroup_size(16, 16)
fn main_naive(@builtin(global_invocation_id) id: vec3u) {
    let x = id.x;
    let y = id.y;
    if x >= SIZE || y >= SIZE { return; }
    let west = now[y * SIZE + max(x, 1u) - 1u];
    let east = now[y * SIZE + min(x + 1u, SIZE - 1u)];
    let north = now[(max(y, 1u) - 1u) * SIZE + x];
    let south = now[min(y + 1u, SIZE - 1u) * SIZE + x];
    let here = now[y * SIZE + x];
    // The older height is in the buffer that is written.
    let older = next[y * SIZE + x];
    next[y * SIZE + x] = (2.0 * here - older + 0.25 * (north + south + west + east - 4.0 * here)) * 0.999;
}
