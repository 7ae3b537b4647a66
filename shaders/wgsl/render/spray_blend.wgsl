// Spray behind the rain of a picture: it shows the mean radiance of a drop and the light of lamps, and takes out light of what is behind.
// The part of the lamps' light that is seen is a mean over the pixels around a pixel that look, whose spray is as far away.
// Twin: downpour_render::rain::spray::blend.

@group(0) @binding(2) var<storage, read> spray_blend_found: array<vec4f>;
// The rain: radiance, and the transmittance of the scene behind it.
@group(0) @binding(3) var<storage, read_write> spray_blend_layer: array<vec4f>;

// Optical depth of the spray that was found at a row, and its mean distance.
fn spray_blend_place(row: u32) -> vec2f {
    let pair = unpack2x16float(bitcast<u32>(spray_blend_found[row].w));
    let places = unpack2x16float(bitcast<u32>(spray_blend_found[row + 1u].w));
    return vec2f(pair.x, places.x * pair.y + places.y * (1.0 - pair.y));
}

// Of the pixels of a window around a pixel that look for what hides lamps: their light if nothing did, and what was seen of it. `alike`: of those
// whose spray is as far away.
struct SprayBlendSum {
    all: vec3f,
    seen: vec3f,
}

fn spray_blend_window(x: u32, y: u32, alike: bool) -> SprayBlendSum {
    let width = drops_frame.camera.width;
    let distance = spray_blend_place(2u * (y * width + x)).y;
    let apart = spray_frame.ray_spacing;
    // Where fewer look, they are looked for farther away.
    let reach = SKYLIGHT_RADIUS + 2u * (apart - 1u);
    let left = spacing_first(x, apart, reach, spray_frame.ray_column);
    let bottom = min(y + reach, drops_frame.camera.height - 1u);
    var sum = SprayBlendSum(vec3f(0.0), vec3f(0.0));
    for (var row = spacing_first(y, apart, reach, spray_frame.ray_row); row <= bottom; row += apart) {
        for (var column = left; column <= min(x + reach, width - 1u); column += apart) {
            let other = 2u * (row * width + column);
            let place = spray_blend_place(other);
            var weight = 1.0;
            if alike {
                weight = max(1.0 - abs(distance - place.y) / (SPRAY_ALIKE * max(max(distance, place.y), 1.0e-6)), 0.0);
            }
            if weight > 0.0 && place.x > 0.0 && spray_blend_found[other + 1u].x >= 0.0 {
                sum.all += spray_blend_found[other].rgb * weight;
                sum.seen += spray_blend_found[other + 1u].rgb * weight;
            }
        }
    }
    return sum;
}

// Light of lamps on the spray before a pixel, as far as it is seen.
fn spray_blend_light(x: u32, y: u32) -> vec3f {
    let whole = spray_blend_found[2u * (y * drops_frame.camera.width + x)].rgb;
    if light_weight(whole) <= 0.0 {
        return vec3f(0.0);
    }
    var sum = spray_blend_window(x, y, true);
    if light_weight(sum.all) <= 0.0 {
        sum = spray_blend_window(x, y, false);
    }
    return whole * sum.seen / max(sum.all, vec3f(1.0e-30));
}

// The rain of a pixel with the spray behind it.
fn spray_blend_pixel(x: u32, y: u32, rain: vec4f) -> vec4f {
    let depth = spray_blend_place(2u * (y * drops_frame.camera.width + x)).x;
    if depth <= 0.0 {
        return rain;
    }
    let left = exp(-depth);
    let shown = (drops_medium(x, y) + spray_blend_light(x, y)) * (1.0 - left);
    return vec4f(rain.rgb + shown * rain.w, rain.w * left);
}

@compute @workgroup_size(8, 8, 1)
fn main_spray_blend(@builtin(global_invocation_id) id: vec3u) {
    if id.x < drops_frame.camera.width && id.y < drops_frame.camera.height {
        let index = id.y * drops_frame.camera.width + id.x;
        spray_blend_layer[index] = spray_blend_pixel(id.x, id.y, spray_blend_layer[index]);
    }
}
