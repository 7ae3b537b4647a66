// Normals of the water surface by a Sobel filter (Tatarchuk & Isidoro 2006, section 5).
// Twin: downpour_lattice::glass::normal.

@group(0) @binding(0) var<uniform> glass_normal_frame: GlassFrame;
@group(0) @binding(1) var<storage, read> glass_normal_heights: array<u32>;
// x and y of the unit normal; z completes the length 1.
@group(0) @binding(2) var<storage, read_write> glass_normal_cells: array<vec2f>;

// Height at a cell; cells outside the pane are clamped to its edge.
fn glass_normal_at(cell: vec2i) -> i32 {
    let inside = clamp(cell, vec2i(0), vec2i(glass_normal_frame.size) - 1);
    return i32(glass_normal_heights[glass_frame_index(glass_normal_frame, inside)]);
}

// Sobel sums along x and y: 2048 is a slope of 1.
fn glass_normal_sobel(cell: vec2i) -> vec2i {
    var sum = vec2i(0);
    for (var k = -1; k <= 1; k += 1) {
        let weight = 2 - abs(k);
        sum.x += weight * (glass_normal_at(cell + vec2i(1, k)) - glass_normal_at(cell + vec2i(-1, k)));
        sum.y += weight * (glass_normal_at(cell + vec2i(k, 1)) - glass_normal_at(cell + vec2i(k, -1)));
    }
    return sum;
}

// x and y of the unit normal of a surface from its slopes times 2048.
fn glass_normal_unit(sobel: vec2i) -> vec2f {
    let slope = vec2f(sobel) / 2048.0;
    return -slope / sqrt(1.0 + slope.x * slope.x + slope.y * slope.y);
}

@compute @workgroup_size(16, 16)
fn main_glass_normal(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < glass_normal_frame.size) {
        let index = glass_frame_index(glass_normal_frame, vec2i(id.xy));
        glass_normal_cells[index] = glass_normal_unit(glass_normal_sobel(vec2i(id.xy)));
    }
}
