// From scene-referred radiance to a picture to look at: the tone curves, the sRGB transfer function, and a pixel of 8 bits a channel.
// Colors up to 0.8 less the toe stay as they are in both curves, brighter ones are compressed. Edges of things brighter than white are
// filtered behind the curve, as downpour_render::tone::edge says.
// Twin: downpour_render::tone.

@group(0) @binding(0) var<uniform> tone_frame: ToneFrame;
@group(0) @binding(1) var<storage, read> tone_plate: array<vec4f>;
@group(0) @binding(2) var<storage, read> tone_rain: array<vec4f>;
@group(0) @binding(3) var<storage, read> tone_glow: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> tone_target: array<u32>;

struct ToneFrame {
    width: u32,
    height: u32,
    // TONE_KHRONOS or TONE_KEEPS_HUE.
    curve: u32,
    // Factor from radiance to display.
    exposure: f32,
    // 1: tone_glow holds what glow adds.
    has_glow: u32,
    // 1: edges of things brighter than white are filtered.
    has_edges: u32,
    pad_a: u32,
    pad_b: u32,
}

// Linear BT.709 to the cone responses of Oklab, cube roots of these to lightness and colors, and both ways back.
const TONE_CONES = mat3x3f(
    0.41222146, 0.2119035, 0.08830246,
    0.53633255, 0.6806995, 0.28171885,
    0.051445995, 0.10739696, 0.6299787,
);
const TONE_OPPONENT = mat3x3f(
    0.21045426, 1.9779985, 0.025904037,
    0.7936178, -2.4285922, 0.78277177,
    -0.004072047, 0.4505937, -0.80867577,
);
const TONE_CONE_ROOTS = mat3x3f(
    1.0, 1.0, 1.0,
    0.39633778, -0.105561346, -0.08948418,
    0.21580376, -0.06385417, -1.2914855,
);
const TONE_PRIMARIES = mat3x3f(
    4.0767417, -1.268438, -0.0041960863,
    -3.3077116, 2.6097574, -0.7034186,
    0.23096993, -0.3413194, 1.7076147,
);

// A color of no channel below 0, less what a surface of gloss reflects of white surroundings.
fn tone_lifted(color: vec3f) -> vec3f {
    let least = min(min(color.x, color.y), color.z);
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    return color - vec3f(offset);
}

// Value of a largest channel from TONE_START on, below 1.
fn tone_compressed(peak: f32) -> f32 {
    let d = 1.0 - TONE_START;
    return 1.0 - d * d / (peak + d - TONE_START);
}

// The neutral tone curve of Khronos; the result is in [0, 1].
fn tone_neutral(color: vec3f) -> vec3f {
    let lifted = tone_lifted(max(color, vec3f(0.0)));
    let peak = max(max(lifted.x, lifted.y), lifted.z);
    if peak < TONE_START {
        return lifted;
    }
    let new_peak = tone_compressed(peak);
    let scaled = lifted * (new_peak / peak);
    let g = 1.0 - 1.0 / (TONE_DESATURATION * (peak - new_peak) + 1.0);
    return mix(scaled, vec3f(new_peak), g);
}

// Oklab of a linear color of no channel below 0: lightness, green-red, blue-yellow.
fn tone_oklab(color: vec3f) -> vec3f {
    return TONE_OPPONENT * pow(max(TONE_CONES * color, vec3f(0.0)), vec3f(1.0 / 3.0));
}

// Linear color of an Oklab color.
fn tone_linear(lab: vec3f) -> vec3f {
    let roots = TONE_CONE_ROOTS * lab;
    return TONE_PRIMARIES * (roots * roots * roots);
}

// A color within the display: one that is not is mixed with gray of its luminance, as little as that takes.
fn tone_within(color: vec3f) -> vec3f {
    let gray = clamp(color_luminance(color), 0.0, 1.0);
    let low = min(min(color.x, color.y), color.z);
    let high = max(max(color.x, color.y), color.z);
    var below = 1.0;
    if low < 0.0 {
        below = gray / (gray - low);
    }
    var above = 1.0;
    if high > 1.0 {
        above = (1.0 - gray) / (high - gray);
    }
    return clamp(mix(vec3f(gray), color, min(below, above)), vec3f(0.0), vec3f(1.0));
}

// Fraction of white in a color whose largest channel is `peak`.
fn tone_whiteness(peak: f32) -> f32 {
    let stops = log2(peak / TONE_START) / TONE_HALF_WHITE_STOPS;
    let cube = stops * stops * stops;
    return cube / (cube + 1.0);
}

// A color of the lightness and chroma of `color` and the hue of `hued`, both linear; paler where the display has none so strong.
fn tone_with_hue(color: vec3f, hued: vec3f) -> vec3f {
    let lab = tone_oklab(color);
    let wanted = tone_oklab(hued);
    let chroma = sqrt(lab.y * lab.y + lab.z * lab.z);
    let strength = sqrt(wanted.y * wanted.y + wanted.z * wanted.z);
    if strength < 1.0e-5 {
        return color;
    }
    return tone_within(tone_linear(vec3f(lab.x, wanted.yz * (chroma / strength))));
}

// The tone curve that keeps hues in Oklab; the result is in [0, 1].
fn tone_hue(radiance: vec3f) -> vec3f {
    let color = max(radiance, vec3f(0.0));
    if max(max(color.x, color.y), color.z) <= min(min(color.x, color.y), color.z) {
        return tone_neutral(color);
    }
    let lifted = tone_lifted(min(color, vec3f(TONE_MAX_CHANNEL)));
    let peak = max(max(lifted.x, lifted.y), lifted.z);
    if peak < TONE_START {
        return lifted;
    }
    let most = tone_compressed(peak);
    let scaled = lifted * (most / peak);
    return tone_with_hue(mix(scaled, vec3f(most), tone_whiteness(peak)), scaled);
}

// The sRGB transfer function, to 8 bits.
fn tone_srgb(linear: f32) -> u32 {
    let v = clamp(linear, 0.0, 1.0);
    var encoded = v * 12.92;
    if v > 0.0031308 {
        encoded = 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    }
    return u32(encoded * 255.0 + 0.5);
}

// A curve applied to an exposed color; the result is in [0, 1].
fn tone_color(color: vec3f, curve: u32) -> vec3f {
    if curve == TONE_KEEPS_HUE {
        return tone_hue(color);
    }
    return tone_neutral(color);
}

// A color of the display as 8 bits each of red, green, blue and an alpha of 255, red lowest.
fn tone_pack(toned: vec3f) -> u32 {
    return tone_srgb(toned.x) | tone_srgb(toned.y) << 8u | tone_srgb(toned.z) << 16u | 255u << 24u;
}

// Smooth rise from 0 at `low` to 1 at `high`.
fn tone_rise(low: f32, high: f32, value: f32) -> f32 {
    let t = clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Sum of the channels.
fn tone_sum(color: vec3f) -> f32 {
    return color.x + color.y + color.z;
}

// Weight from 0 to 1 with which a pixel is the edge of something brighter than white: of its color, its dark neighbor and the pixel behind
// that one, its bright neighbor, and the coverage that follows from them.
fn tone_edge_weight(color: vec3f, dark: vec3f, behind: vec3f, bright: vec3f, coverage: f32) -> f32 {
    let sum = tone_sum(dark);
    let above = tone_rise(TONE_EDGE_WHITE, TONE_EDGE_BRIGHT, max(max(bright.x, bright.y), bright.z));
    let contrast = (tone_sum(color) - sum) / (sum + TONE_EDGE_FLOOR);
    let differs = tone_rise(0.25 * TONE_EDGE_CONTRAST, TONE_EDGE_CONTRAST, contrast);
    let covered = tone_rise(0.25 * TONE_EDGE_COVERAGE, TONE_EDGE_COVERAGE, coverage);
    let clips = tone_rise(TONE_START, TONE_EDGE_CLIPPED, max(max(color.x, color.y), color.z));
    // A dark side that rises toward the edge is the slope of something soft.
    let slope = (sum - tone_sum(behind)) / (tone_sum(behind) + TONE_EDGE_SLOPE_FLOOR);
    let is_even = 1.0 - tone_rise(0.25 * TONE_EDGE_SLOPE, TONE_EDGE_SLOPE, slope);
    return above * differs * is_even * max(covered, clips);
}

// What a pair of neighbors takes from a pixel, times the pair's weight among pairs, and that weight. `toned` is the pixel's color through
// the curve; the others are exposed colors from 0 to TONE_MAX_CHANNEL: of the pixel, its dark neighbor and the pixel behind that one, its
// bright neighbor and the pixel beyond that one.
fn tone_edge(
    toned: vec3f,
    color: vec3f,
    dark: vec3f,
    behind: vec3f,
    bright: vec3f,
    beyond: vec3f,
    curve: u32,
) -> vec4f {
    let sum = tone_sum(dark);
    let covered = tone_sum(color) - sum;
    let whole = min(tone_sum(bright), tone_sum(beyond)) - sum;
    if !(covered > 0.0 && covered < whole) {
        return vec4f(0.0);
    }
    let coverage = covered / whole;
    let weight = tone_edge_weight(color, dark, behind, bright, coverage);
    if weight <= 0.0 {
        return vec4f(0.0);
    }
    let through = tone_color(dark, curve);
    // The bright side in the pixel's own color.
    let side = tone_color(dark + (color - dark) / coverage, curve);
    let taken = (toned - (through + (side - through) * coverage)) * weight;
    let strength = max(color_luminance(taken), 0.0);
    let square = strength * strength;
    return vec4f(taken * (square * square), square * square);
}

// Index of a pixel; beyond the borders that of the nearest one.
fn tone_index(at: vec2i) -> u32 {
    let size = vec2i(i32(tone_frame.width), i32(tone_frame.height));
    let inside = clamp(at, vec2i(0), size - 1);
    return u32(inside.y * size.x + inside.x);
}

// Exposed color of a pixel from 0 to TONE_MAX_CHANNEL; beyond the borders that of the nearest pixel.
fn tone_seen(at: vec2i) -> vec3f {
    let i = tone_index(at);
    var seen = compose_pixel(tone_plate[i], tone_rain[i]).rgb;
    if tone_frame.has_glow > 0u {
        seen += tone_glow[i].rgb;
    }
    return clamp(seen * tone_frame.exposure, vec3f(0.0), vec3f(TONE_MAX_CHANNEL));
}

// Exposed glow of a pixel; beyond the borders that of the nearest pixel.
fn tone_glowing(at: vec2i) -> vec3f {
    if tone_frame.has_glow == 0u {
        return vec3f(0.0);
    }
    return tone_glow[tone_index(at)].rgb * tone_frame.exposure;
}

// Step to one neighbor of a pair; the other is opposite. Pairs 0 to 3 are a row, a column and two diagonals.
fn tone_step(pair: u32) -> vec2i {
    return vec2i(select(1, 0, pair == 1u), select(select(1, -1, pair == 3u), 0, pair == 0u));
}

// Largest glow of the 3 x 3 pixels around a pixel, channel by channel. A bright pixel gives more than it gets; those beside it show what
// comes.
fn tone_glow_around(at: vec2i) -> vec3f {
    var glow = tone_glowing(at);
    for (var pair = 0u; pair < 4u; pair += 1u) {
        let step = tone_step(pair);
        glow = max(glow, max(tone_glowing(at + step), tone_glowing(at - step)));
    }
    return glow;
}

// A pixel's color through the curve, `toned`, less what clips at the edges of bright things.
fn tone_edges(at: vec2i, toned: vec3f) -> vec3f {
    let color = tone_seen(at);
    let sum = tone_sum(color);
    var taken = vec4f(0.0);
    for (var pair = 0u; pair < 4u; pair += 1u) {
        let step = tone_step(pair);
        let ahead = tone_seen(at + step);
        let behind = tone_seen(at - step);
        let is_ahead = tone_sum(ahead) > tone_sum(behind);
        let bright = select(behind, ahead, is_ahead);
        let plain = select(ahead, behind, is_ahead);
        let least = tone_sum(plain) + 0.25 * TONE_EDGE_CONTRAST * (tone_sum(plain) + TONE_EDGE_FLOOR);
        // Most pixels, whose pairs have no weight.
        if max(max(bright.x, bright.y), bright.z) <= TONE_EDGE_WHITE || sum >= tone_sum(bright) || sum <= least {
            continue;
        }
        let way = select(-step, step, is_ahead);
        // Glow is no coverage: the dark side has as much of it as there is around the pixel.
        let glow = tone_glow_around(at);
        let dark = plain + (glow - tone_glowing(at - way));
        let behind_it = at - way * 2;
        let deep = tone_seen(behind_it) + (glow - tone_glowing(behind_it));
        let most = vec3f(TONE_MAX_CHANNEL);
        let beyond = tone_seen(at + way * 2);
        let pair_takes = tone_edge(
            toned,
            color,
            min(dark, most),
            clamp(deep, vec3f(0.0), most),
            bright,
            beyond,
            tone_frame.curve,
        );
        taken += pair_takes;
    }
    // The constant is far below a step of the display.
    return toned - taken.xyz / (taken.w + 1.0e-12);
}

@compute @workgroup_size(8, 8, 1)
fn main_tone(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= tone_frame.width || id.y >= tone_frame.height {
        return;
    }
    let i = id.y * tone_frame.width + id.x;
    var seen = compose_pixel(tone_plate[i], tone_rain[i]).rgb;
    if tone_frame.has_glow > 0u {
        seen += tone_glow[i].rgb;
    }
    var toned = tone_color(seen * tone_frame.exposure, tone_frame.curve);
    if tone_frame.has_edges > 0u {
        toned = tone_edges(vec2i(id.xy), toned);
    }
    tone_target[i] = tone_pack(toned);
}
