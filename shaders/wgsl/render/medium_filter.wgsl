// The light of lamps on unresolved drops: what could be seen of it at most, times the part of it that the pixels around a pixel
// have seen. So nothing is blurred but shadows.
// Twin: downpour_render::rain::medium::filter.

@group(0) @binding(1) var<storage, read> medium_filter_found: array<vec4f>;
@group(0) @binding(2) var<storage, read> medium_filter_clean: array<vec4f>;
// Light of lamps, and mean distance and optical depth as halves.
@group(0) @binding(3) var<storage, read_write> medium_filter_layer: array<vec4f>;

// What was found before a pixel (medium_open.wgsl), or sums of it.
struct MediumRows {
    // Light of lamps if nothing hid them, below 0 where others look for it; optical depth, or in a sum the weight.
    whole: vec4f,
    // Light of lamps that one ray has seen, and its mean distance.
    seen: vec4f,
}

// What was found before a pixel.
fn medium_filter_rows(index: u32) -> MediumRows {
    let at = medium_frame.columns * medium_frame.rows * MEDIUM_SLICES + 2u * index;
    return MediumRows(medium_filter_found[at], medium_filter_found[at + 1u]);
}

// What was found before a pixel, or by the pixels around it that have looked for it.
fn medium_filter_own(x: u32, y: u32) -> MediumRows {
    let index = y * render_frame.camera.width + x;
    let own = medium_filter_rows(index);
    if own.whole.x >= 0.0 {
        return own;
    }
    var light = vec4f(0.0);
    var weights = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        let corner = medium_spread_corner(x, y, k);
        let alike = medium_spread_alike(medium_filter_clean[index].w, medium_filter_clean[corner.x].w);
        let weight = f32(corner.y) * alike;
        if weight > 0.0 {
            let rows = medium_filter_rows(corner.x);
            light += vec4f(rows.whole.rgb, rows.seen.w) * weight;
            weights += weight;
        }
    }
    light /= max(weights, 1.0e-20);
    return MediumRows(vec4f(light.rgb, own.whole.w), vec4f(0.0, 0.0, 0.0, light.w));
}

// Of the pixels of a window around a pixel that look for light, or of all: the part of their light that was seen.
fn medium_filter_seen(x: u32, y: u32, all: bool) -> MediumRows {
    let width = render_frame.camera.width;
    let index = y * width + x;
    let apart = select(render_frame.ray_spacing, 1u, all);
    // Where fewer look, they are looked for farther away.
    let reach = SKYLIGHT_RADIUS + 2u * (apart - 1u);
    let left = spacing_first(x, apart, reach, render_frame.ray_column);
    var sum = MediumRows(vec4f(0.0), vec4f(0.0));
    for (var row = spacing_first(y, apart, reach, render_frame.ray_row); row <= min(y + reach, render_frame.camera.height - 1u); row += apart) {
        for (var column = left; column <= min(x + reach, width - 1u); column += apart) {
            let other = row * width + column;
            let weight = medium_spread_alike(medium_filter_clean[index].w, medium_filter_clean[other].w);
            let rows = medium_filter_rows(other);
            if weight > 0.0 && rows.whole.x >= 0.0 {
                sum.whole += vec4f(rows.whole.rgb, 1.0) * weight;
                sum.seen += rows.seen * weight;
            }
        }
    }
    return sum;
}

// The part of the light before a pixel that the pixels around it have seen.
fn medium_filter_part(x: u32, y: u32) -> vec3f {
    var sum = medium_filter_seen(x, y, false);
    if sum.whole.w <= 0.0 {
        sum = medium_filter_seen(x, y, true);
    }
    return sum.seen.rgb / max(sum.whole.rgb, vec3f(1.0e-30));
}

// Mean distance and optical depth of what was found before a pixel, as halves.
fn medium_filter_packed(own: MediumRows) -> f32 {
    return bitcast<f32>(pack2x16float(vec2f(min(own.seen.w, 6.0e4), min(own.whole.w, 6.0e4))));
}

// The light before a pixel, and two halves.
fn medium_filter_pixel(x: u32, y: u32) -> vec4f {
    let own = medium_filter_own(x, y);
    let packed = medium_filter_packed(own);
    if light_weight(own.whole.rgb) <= 0.0 {
        return vec4f(vec3f(0.0), packed);
    }
    return vec4f(own.whole.rgb * medium_filter_part(x, y), packed);
}

@compute @workgroup_size(8, 8, 1)
fn main_medium_filter(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        medium_filter_layer[id.y * render_frame.camera.width + id.x] = medium_filter_pixel(id.x, id.y);
    }
}
