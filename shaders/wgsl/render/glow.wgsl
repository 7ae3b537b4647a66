// Glow around bright light: a part of the light of each pixel goes over the pixels around it.
// Method: the spread is a sum of kernels of growing width, one for each level of a pyramid. Going down, [1 2 1] / 4 and a mean by
// area; going up, the same transposed. Both keep the sum of all texels and a picture of one color, at borders (which mirror) and for
// odd sizes too. Or Kawase's passes: four taps beside each texel, farther out in each pass.
// Twin: downpour_render::glow.

struct GlowLevel {
    // Columns and rows of the level, and of the coarser one.
    size: vec2u,
    coarse: vec2u,
    // First texel of both.
    first: u32,
    coarse_first: u32,
    // Factors of both.
    weight: f32,
    coarse_weight: f32,
    // Fraction of light that is taken, and extinction by which light is diffracted, 1/m.
    fraction: f32,
    extinction: f32,
    // 1: adds to the glow that is there.
    is_added: u32,
    // Offset of Kawase's taps, in texels; 1 in a step of GlowCoarse that goes up.
    offset: u32,
}

// Steps between coarse levels, which one workgroup takes: as many dispatches would take longer to begin than to end.
struct GlowCoarse {
    count: u32,
    unused_1: u32,
    unused_2: u32,
    unused_3: u32,
    levels: array<GlowLevel, GLOW_COARSE_STEPS>,
}

@group(0) @binding(0) var<uniform> glow_given: GlowLevel;
@group(0) @binding(1) var<storage, read_write> glow_texels: array<vec4f>;
@group(0) @binding(2) var<storage, read> glow_plate: array<vec4f>;
@group(0) @binding(3) var<storage, read> glow_rain: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> glow_target: array<vec4f>;
@group(0) @binding(5) var<uniform> glow_coarse: GlowCoarse;

// The level that is made.
var<private> glow_level: GlowLevel;

// Fraction of the light of a pixel that is taken, whose scene is at a distance, m.
fn glow_fraction(level: GlowLevel, distance: f32) -> f32 {
    let reach = select(distance, MEDIUM_SKY_REACH, distance >= MEDIUM_SKY);
    return level.fraction + 1.0 - exp(-level.extinction * reach);
}

// Light that is taken from a pixel.
fn glow_taken(level: GlowLevel, plate: vec4f, rain: vec4f, glow: vec4f) -> vec4f {
    let seen = compose_pixel(plate, rain).rgb + select(vec3f(0.0), glow.rgb, level.is_added == 1u);
    return vec4f(clamp(seen, vec3f(0.0), vec3f(GLOW_BRIGHTEST)) * glow_fraction(level, plate.w), 0.0);
}

// Length that two cells of two lattices over one line share: cell `a` of edge `a_edge`, cell `b` of edge `b_edge`.
fn glow_overlap(a: u32, a_edge: u32, b: u32, b_edge: u32) -> u32 {
    let low = max(a * a_edge, b * b_edge);
    return max(min((a + 1u) * a_edge, (b + 1u) * b_edge), low) - low;
}

// Weights of five texels of a line of `fine`, from the one before the first below texel `i` of `coarse` on.
fn glow_down_weights(i: u32, fine: u32, coarse: u32) -> array<f32, 5> {
    let first = i * fine / coarse;
    let a = f32(glow_overlap(i, fine, first, coarse)) / f32(fine);
    let b = f32(glow_overlap(i, fine, first + 1u, coarse)) / f32(fine);
    let c = f32(glow_overlap(i, fine, first + 2u, coarse)) / f32(fine);
    return array<f32, 5>(0.25 * a, 0.5 * a + 0.25 * b, 0.25 * a + 0.5 * b + 0.25 * c, 0.25 * b + 0.5 * c, 0.25 * c);
}

// First texel of a line of `coarse` over texel `i` of `fine` and its neighbors.
fn glow_up_first(i: u32, fine: u32, coarse: u32) -> u32 {
    return (max(i, 1u) - 1u) * coarse / fine;
}

// Weight of texel `k` of a line of `coarse` for texel `i` of `fine`.
fn glow_up_weight(k: u32, i: u32, fine: u32, coarse: u32) -> f32 {
    let before = f32(glow_overlap(k, fine, max(i, 1u) - 1u, coarse));
    let here = f32(glow_overlap(k, fine, i, coarse));
    let after = f32(glow_overlap(k, fine, min(i + 1u, fine - 1u), coarse));
    return (0.25 * before + 0.5 * here + 0.25 * after) / f32(coarse);
}

// A texel of the coarser level.
fn glow_down(x: u32, y: u32) -> vec4f {
    var across = glow_down_weights(x, glow_level.size.x, glow_level.coarse.x);
    var along = glow_down_weights(y, glow_level.size.y, glow_level.coarse.y);
    let left = x * glow_level.size.x / glow_level.coarse.x;
    let top = y * glow_level.size.y / glow_level.coarse.y;
    var sum = vec4f(0.0);
    for (var j = 0u; j < 5u; j += 1u) {
        let row = min(max(top + j, 1u) - 1u, glow_level.size.y - 1u);
        var line = vec4f(0.0);
        for (var i = 0u; i < 5u; i += 1u) {
            let column = min(max(left + i, 1u) - 1u, glow_level.size.x - 1u);
            line += across[i] * glow_texels[glow_level.first + row * glow_level.size.x + column];
        }
        sum += along[j] * line;
    }
    return sum;
}

// The coarser level at a texel of the level.
fn glow_up(x: u32, y: u32) -> vec4f {
    let left = glow_up_first(x, glow_level.size.x, glow_level.coarse.x);
    let top = glow_up_first(y, glow_level.size.y, glow_level.coarse.y);
    var sum = vec4f(0.0);
    for (var j = 0u; j < 3u; j += 1u) {
        let row = min(top + j, glow_level.coarse.y - 1u);
        var line = vec4f(0.0);
        for (var i = 0u; i < 3u; i += 1u) {
            let column = min(left + i, glow_level.coarse.x - 1u);
            let texel = glow_texels[glow_level.coarse_first + row * glow_level.coarse.x + column];
            line += glow_up_weight(left + i, x, glow_level.size.x, glow_level.coarse.x) * texel;
        }
        sum += glow_up_weight(top + j, y, glow_level.size.y, glow_level.coarse.y) * line;
    }
    return sum;
}

// Index of a texel at a signed position of a line, mirrored at its ends.
fn glow_mirrored(position: i32, size: u32) -> u32 {
    let period = 2 * i32(size);
    let wrapped = (position % period + period) % period;
    return u32(min(wrapped, period - 1 - wrapped));
}

// A texel of a pass of Kawase's filter: the mean of four taps between four texels each, and its own as far as the pass is a part of one.
fn glow_kawase(x: u32, y: u32) -> vec4f {
    var sum = vec4f(0.0);
    for (var k = 0u; k < 16u; k += 1u) {
        // The nearer and the farther texel to the left and right, of a tap at offset + 1/2.
        let reach = i32(glow_level.offset) + vec2i(vec2u(k, k >> 1u) & vec2u(1u));
        let away = select(-reach, reach, (vec2u(k >> 2u, k >> 3u) & vec2u(1u)) == vec2u(1u));
        let column = glow_mirrored(i32(x) + away.x, glow_level.size.x);
        let row = glow_mirrored(i32(y) + away.y, glow_level.size.y);
        sum += glow_texels[glow_level.first + row * glow_level.size.x + column];
    }
    let own = glow_texels[glow_level.first + y * glow_level.size.x + x];
    return sum * (0.0625 * glow_level.weight) + own * (1.0 - glow_level.weight);
}

@compute @workgroup_size(8, 8, 1)
fn main_glow_take(@builtin(global_invocation_id) id: vec3u) {
    glow_level = glow_given;
    if id.x < glow_level.size.x && id.y < glow_level.size.y {
        let i = id.y * glow_level.size.x + id.x;
        glow_texels[i] = glow_taken(glow_level, glow_plate[i], glow_rain[i], glow_target[i]);
    }
}

@compute @workgroup_size(8, 8, 1)
fn main_glow_down(@builtin(global_invocation_id) id: vec3u) {
    glow_level = glow_given;
    if id.x < glow_level.coarse.x && id.y < glow_level.coarse.y {
        glow_texels[glow_level.coarse_first + id.y * glow_level.coarse.x + id.x] = glow_down(id.x, id.y);
    }
}

@compute @workgroup_size(8, 8, 1)
fn main_glow_up(@builtin(global_invocation_id) id: vec3u) {
    glow_level = glow_given;
    if id.x < glow_level.size.x && id.y < glow_level.size.y {
        let i = glow_level.first + id.y * glow_level.size.x + id.x;
        glow_texels[i] = glow_level.weight * glow_texels[i] + glow_level.coarse_weight * glow_up(id.x, id.y);
    }
}

@compute @workgroup_size(256, 1, 1)
fn main_glow_coarse(@builtin(local_invocation_index) local: u32) {
    for (var k = 0u; k < glow_coarse.count; k += 1u) {
        glow_level = glow_coarse.levels[k];
        let goes_up = glow_level.offset == 1u;
        let size = select(glow_level.coarse, glow_level.size, goes_up);
        for (var i = local; i < size.x * size.y; i += 256u) {
            if goes_up {
                let own = glow_level.weight * glow_texels[glow_level.first + i];
                glow_texels[glow_level.first + i] = own + glow_level.coarse_weight * glow_up(i % size.x, i / size.x);
            } else {
                glow_texels[glow_level.coarse_first + i] = glow_down(i % size.x, i / size.x);
            }
        }
        storageBarrier();
        workgroupBarrier();
    }
}

@compute @workgroup_size(8, 8, 1)
fn main_glow_kawase(@builtin(global_invocation_id) id: vec3u) {
    glow_level = glow_given;
    if id.x < glow_level.size.x && id.y < glow_level.size.y {
        glow_texels[glow_level.coarse_first + id.y * glow_level.size.x + id.x] = glow_kawase(id.x, id.y);
    }
}

// Adds what comes to a pixel, less what was taken from it.
@compute @workgroup_size(8, 8, 1)
fn main_glow_add(@builtin(global_invocation_id) id: vec3u) {
    glow_level = glow_given;
    if id.x < glow_level.size.x && id.y < glow_level.size.y {
        let i = id.y * glow_level.size.x + id.x;
        let before = select(vec4f(0.0), glow_target[i], glow_level.is_added == 1u);
        let come = glow_level.coarse_weight * glow_up(id.x, id.y);
        glow_target[i] = before + come - glow_level.weight * glow_texels[glow_level.first + i];
    }
}
