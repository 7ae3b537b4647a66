// The light of lamps on unresolved drops: what could be seen of it at most, times the part of it that the pixels around a pixel
// have seen. So nothing is blurred but shadows.
// Twin: downpour_render::rain::medium::filter.

@group(0) @binding(1) var<storage, read> medium_filter_found: array<vec4f>;
@group(0) @binding(2) var<storage, read> medium_filter_clean: array<vec4f>;
// Light of lamps, and mean distance and optical depth as halves.
@group(0) @binding(3) var<storage, read_write> medium_filter_layer: array<vec4f>;

// Weight of a neighbor, 0 to 1: 1 if its ray is as long, 0 from a relative difference of 20 %.
fn medium_filter_weight(own: f32, other: f32) -> f32 {
    let reach = min(own, MEDIUM_LAMP_REACH);
    let far = min(other, MEDIUM_LAMP_REACH);
    return max(1.0 - abs(reach - far) / (0.2 * max(reach, far)), 0.0);
}

// The light before a pixel, and two halves.
fn medium_filter_pixel(x: u32, y: u32) -> vec4f {
    let width = render_frame.camera.width;
    let first = medium_frame.columns * medium_frame.rows * MEDIUM_SLICES;
    let index = y * width + x;
    let own = medium_filter_found[first + 2u * index];
    let mean = medium_filter_found[first + 2u * index + 1u].w;
    let packed = bitcast<f32>(pack2x16float(vec2f(min(mean, 6.0e4), min(own.w, 6.0e4))));
    if light_weight(own.rgb) <= 0.0 {
        return vec4f(vec3f(0.0), packed);
    }
    var whole = vec3f(0.0);
    var seen = vec3f(0.0);
    let left = max(x, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    let top = max(y, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    for (var row = top; row <= min(y + SKYLIGHT_RADIUS, render_frame.camera.height - 1u); row += 1u) {
        for (var column = left; column <= min(x + SKYLIGHT_RADIUS, width - 1u); column += 1u) {
            let other = row * width + column;
            let weight = medium_filter_weight(medium_filter_clean[index].w, medium_filter_clean[other].w);
            if weight > 0.0 {
                whole += medium_filter_found[first + 2u * other].rgb * weight;
                seen += medium_filter_found[first + 2u * other + 1u].rgb * weight;
            }
        }
    }
    return vec4f(own.rgb * seen / max(whole, vec3f(1.0e-30)), packed);
}

@compute @workgroup_size(8, 8, 1)
fn main_medium_filter(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        medium_filter_layer[id.y * render_frame.camera.width + id.x] = medium_filter_pixel(id.x, id.y);
    }
}
