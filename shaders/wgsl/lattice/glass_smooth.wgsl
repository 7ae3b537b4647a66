// Smoothing of heights, so that touching drops form one surface.
// Twin: downpour_lattice::glass::smooth.

@group(0) @binding(0) var<uniform> glass_smooth_frame: GlassFrame;
@group(0) @binding(1) var<storage, read> glass_smooth_from: array<u32>;
@group(0) @binding(2) var<storage, read_write> glass_smooth_to: array<u32>;

// Height at a cell; cells outside the pane are clamped to its edge.
fn glass_smooth_at(cell: vec2i) -> u32 {
    let inside = clamp(cell, vec2i(0), vec2i(glass_smooth_frame.size) - 1);
    return glass_smooth_from[glass_frame_index(glass_smooth_frame, inside)];
}

// Binomial mean of three by three cells.
fn glass_smooth_mean(cell: vec2i) -> u32 {
    var sum = 8u;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            sum += glass_smooth_at(cell + vec2i(x, y)) * u32((2 - abs(x)) * (2 - abs(y)));
        }
    }
    return sum >> 4u;
}

@compute @workgroup_size(16, 16)
fn main_glass_smooth(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < glass_smooth_frame.size) {
        glass_smooth_to[glass_frame_index(glass_smooth_frame, vec2i(id.xy))] = glass_smooth_mean(vec2i(id.xy));
    }
}
