// The part of the light of lamps that is seen, in fog: a mean of means. Fog is bright before a lamp and even, so that an eye sees what chance has
// left of single rays in the mean of one window (medium_filter.wgsl).
// Twin: downpour_render::rain::medium::smooth.

// For each pixel the part of the light that its window has seen, and 1 if there is light.
@group(0) @binding(4) var<storage, read_write> medium_smooth_parts: array<vec4f>;

// The mean of the parts of the pixels around a pixel whose rays are as long.
fn medium_smooth_part(x: u32, y: u32) -> vec3f {
    let width = render_frame.camera.width;
    let index = y * width + x;
    let reach = SKYLIGHT_RADIUS;
    var sum = vec4f(0.0);
    for (var row = max(y, reach) - reach; row <= min(y + reach, render_frame.camera.height - 1u); row += 1u) {
        for (var column = max(x, reach) - reach; column <= min(x + reach, width - 1u); column += 1u) {
            let other = row * width + column;
            let alike = medium_spread_alike(medium_filter_clean[index].w, medium_filter_clean[other].w);
            let part = medium_smooth_parts[other];
            sum += vec4f(part.rgb, 1.0) * (alike * part.w);
        }
    }
    return sum.rgb / max(sum.w, 1.0e-20);
}

// The light before a pixel, and two halves.
fn medium_smooth_pixel(x: u32, y: u32) -> vec4f {
    let own = medium_filter_own(x, y);
    let packed = medium_filter_packed(own);
    if light_weight(own.whole.rgb) <= 0.0 {
        return vec4f(vec3f(0.0), packed);
    }
    return vec4f(own.whole.rgb * medium_smooth_part(x, y), packed);
}

@compute @workgroup_size(8, 8, 1)
fn main_medium_smooth_parts(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        let own = medium_filter_own(id.x, id.y);
        var part = vec4f(0.0);
        if light_weight(own.whole.rgb) > 0.0 {
            part = vec4f(medium_filter_part(id.x, id.y), 1.0);
        }
        medium_smooth_parts[id.y * render_frame.camera.width + id.x] = part;
    }
}

@compute @workgroup_size(8, 8, 1)
fn main_medium_smooth(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        medium_filter_layer[id.y * render_frame.camera.width + id.x] = medium_smooth_pixel(id.x, id.y);
    }
}
