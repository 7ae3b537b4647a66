// Lookup in the environment map around the eye, interpolated between its texels and its levels.
// Law: octahedral (beyond an edge, the square continues mirrored about the edge's middle) or the papers' wide picture; trilinear.
// Twin: downpour_render::rain::drops_capture.

@group(0) @binding(1) var<storage, read> drops_capture: array<vec4f>;

// A texel of a level of the capture. Beyond an edge, the octahedral map continues mirrored about the edge's middle.
fn drops_capture_texel(level: u32, column: i32, row: i32) -> vec3f {
    let whole = drops_frame.capture_size;
    let size = whole >> level;
    let edge = i32(size);
    var texel = vec2u(vec2i(clamp(column, 0, edge - 1), clamp(row, 0, edge - 1)));
    if drops_frame.form == DROPS_DIRECTION {
        texel = packing_octahedral_texel(size, column, row);
    }
    let first = 4u * (whole * whole - size * size) / 3u;
    return drops_capture[first + texel.y * size + texel.x].rgb;
}

// A level of the capture at a position in [0, 1], bilinear.
fn drops_capture_level(level: u32, position: vec2f) -> vec3f {
    let size = f32(drops_frame.capture_size >> level);
    let x = position.x * size - 0.5;
    let y = position.y * size - 0.5;
    let left = i32(floor(x));
    let top = i32(floor(y));
    let fx = x - floor(x);
    let fy = y - floor(y);
    let upper = drops_capture_texel(level, left, top) * (1.0 - fx)
        + drops_capture_texel(level, left + 1, top) * fx;
    let lower = drops_capture_texel(level, left, top + 1) * (1.0 - fx)
        + drops_capture_texel(level, left + 1, top + 1) * fx;
    return upper * (1.0 - fy) + lower * fy;
}

// The capture at a position of [0, 1], for a footprint of some angle.
fn drops_capture_at(position: vec2f, footprint: f32) -> vec3f {
    let last = f32(drops_frame.capture_last);
    let level = clamp(log2(max(footprint / drops_frame.capture_texel, 1.0e-6)), 0.0, last);
    let low = floor(level);
    let part = level - low;
    var fraction = 1.0 - part;
    var sum = vec3f(0.0);
    for (var k = 0u; k < 2u && fraction > 0.0; k += 1u) {
        sum += drops_capture_level(u32(low) + k, position) * fraction;
        fraction = select(0.0, part, k == 0u);
    }
    return sum;
}

// The position in the papers' capture of a ray that is turned by a drop: the refracted ray, in the frame of the drop's view (right, up,
// toward the viewer), meets the plane of the capture as far from the ray's own position as the tangent of its deviation.
fn drops_capture_shifted(ray: vec3f, direction: vec3f) -> vec2f {
    let depth = max(dot(ray, drops_frame.capture_forward), 1.0e-3);
    let deep = max(-direction.z, 1.0e-3);
    let shift = vec2f(
        direction.x / deep / sqrt(dot(drops_frame.capture_right, drops_frame.capture_right)),
        direction.y / deep / sqrt(dot(drops_frame.capture_up, drops_frame.capture_up)),
    );
    let position = vec2f(
        dot(ray, drops_frame.capture_right) / dot(drops_frame.capture_right, drops_frame.capture_right),
        dot(ray, drops_frame.capture_up) / dot(drops_frame.capture_up, drops_frame.capture_up),
    ) / depth + shift;
    return clamp(vec2f(0.5 + 0.5 * position.x, 0.5 - 0.5 * position.y), vec2f(0.0), vec2f(1.0));
}

// Radiance of the capture in a direction, for a drop that is seen along `towards`, averaged over a width in radians.
fn drops_capture_about(towards: vec3f, direction: vec3f, width: f32) -> vec3f {
    if drops_frame.form == DROPS_SHIFT {
        let right = drop_glint_right(towards);
        let up = cross(right, towards);
        let turned = vec3f(dot(direction, right), dot(direction, up), -dot(direction, towards));
        return drops_capture_at(drops_capture_shifted(towards, turned), width);
    }
    return drops_capture_at(packing_octahedral_encode(direction) * 0.5 + 0.5, width);
}
