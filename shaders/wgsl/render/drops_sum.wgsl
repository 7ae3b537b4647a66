// Streaks that cover little of each pixel, summed up: from drop to drop over the pixels of its path, in place of from pixel to pixel over
// the drops of its tile.
// Law: the light that passes streaks of coverages w is exp(-sum t) with t = -ln(1 - w), in any order; what they show together is the mean
// of their radiances by t, over 1 - exp(-sum t), as far away as they are on the mean by t. That is exact for one streak, and for several
// of one radiance. Streaks of other radiances are mixed where they would hide one another, by some percent of some percent of their light
// (STREAK_SUM_COVER).
// Method: sums are integers, so they do not depend on the order in which the device works. Their unit is a fraction of the power of two
// above the largest of the mean radiances of the lamps' light on the drops and of the environment. What is larger than a bound is
// summed in larger units, which together hold 44 bits.
// Layout of the sums: for each pixel red, green, blue in small units, and t; then the scale. Beside them for each pixel red, green, blue in
// large units, and t times the distance. In the end the former become what drops.wgsl reads.
// Twin: downpour_render::rain::drops_sum.

// The picture without rain: its distances.
@group(0) @binding(10) var<storage, read> drops_sum_clean: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> drops_sum_small: array<atomic<u32>>;
@group(0) @binding(12) var<storage, read_write> drops_sum_large: array<atomic<u32>>;

var<workgroup> drops_sum_brightest: atomic<u32>;
// Drops with profiles that a workgroup has found, and their number.
var<workgroup> drops_sum_wide: array<u32, DROPS_SUM_LOOKED>;
var<workgroup> drops_sum_found: atomic<u32>;

// The optical depth of a coverage.
fn drops_sum_depth(cover: f32) -> f32 {
    if cover < DROPS_SUM_FEW {
        return cover * (1.0 + cover * (0.5 + cover * (1.0 / 3.0 + cover * 0.25)));
    }
    return -log(max(1.0 - cover, DROPS_OPAQUE));
}

// The coverage of an optical depth, over that depth.
fn drops_sum_share(depth: f32) -> f32 {
    if depth < DROPS_SUM_FEW {
        return 1.0 - depth * (0.5 - depth * (1.0 / 6.0 - depth * (1.0 / 24.0)));
    }
    return (1.0 - exp(-depth)) / depth;
}

// The bits of the power of two that is not below a number, within the range of scales; 1 of 0.
fn drops_sum_scale(bits: u32) -> u32 {
    if bits == 0u {
        return 0x3f800000u;
    }
    return clamp((bits + 0x7fffffu) & 0x7f800000u, DROPS_SUM_FAINTEST, DROPS_SUM_BRIGHTEST);
}

// The first and last pixel across a path, on a line of pixels: a row where the path is `plumb`, else a column; (1, 0): there is none.
fn drops_sum_across(drop: ScreenDrop, plumb: bool, line: u32, count: u32) -> vec2u {
    let first = select(drop.first.yx, drop.first, plumb);
    let way = select(drop.screen_delta.yx, drop.screen_delta, plumb);
    // The part of the path that is as high as this line.
    let faces = (vec2f(f32(line) - drop.reach, f32(line) + 1.0 + drop.reach) - first.y)
        / select(max(way.y, 1.0e-6), min(way.y, -1.0e-6), way.y < 0.0);
    let low = clamp(min(faces.x, faces.y), 0.0, 1.0);
    let high = clamp(max(faces.x, faces.y), 0.0, 1.0);
    let a = first.x + way.x * low;
    let b = first.x + way.x * high;
    return streak_pixels(min(a, b) - drop.reach, max(a, b) + drop.reach, count);
}

// The first and last line of pixels that a path may touch; (1, 0): there is none.
fn drops_sum_lines(drop: ScreenDrop, plumb: bool, count: u32) -> vec2u {
    let first = select(drop.first.x, drop.first.y, plumb);
    let last = first + select(drop.screen_delta.x, drop.screen_delta.y, plumb);
    return streak_pixels(min(first, last) - drop.reach, max(first, last) + drop.reach, count);
}

// No fewer pixels than drops_sum_across has on any line.
fn drops_sum_width(drop: ScreenDrop, plumb: bool) -> u32 {
    let way = select(drop.screen_delta.yx, drop.screen_delta, plumb);
    let slanted = min(abs(way.x), (1.0 + 2.0 * drop.reach) * abs(way.x) / max(abs(way.y), 1.0e-6));
    return u32(slanted + 2.0 * drop.reach) + 3u;
}

// True if a path is longer from row to row than from column to column.
fn drops_sum_is_plumb(drop: ScreenDrop) -> bool {
    return abs(drop.screen_delta.y) >= abs(drop.screen_delta.x);
}

// What streaks show together, of a scene at a distance: the distance, and radiance times coverage, coverage and mean distance in 96 bits.
// 21 bits of each color are its exponent and 13 digits.
fn drops_sum_pack(shown: vec4f, distance: f32, scene: f32) -> vec4u {
    let color = (bitcast<vec3u>(max(shown.rgb, vec3f(0.0))) + 0x200u) >> vec3u(10u);
    let cover = u32(clamp(shown.w, 0.0, 1.0) * 65535.0 + 0.5);
    return vec4u(
        bitcast<u32>(scene),
        color.r | (color.g << 21u),
        (color.g >> 11u) | (color.b << 10u),
        cover | (bitcast<u32>(distance) & 0xffff0000u),
    );
}

// Adds what a streak shows of a pixel: radiance times coverage, and coverage.
fn drops_sum_add(drop: ScreenDrop, streak: vec4f, x: u32, y: u32, scale: f32) {
    let pixel = y * drops_frame.camera.width + x;
    let scene = drops_sum_clean[pixel].w;
    if drop.nearest >= scene {
        return;
    }
    let shown = drops_shown(drop, streak, x, y, scene);
    if max(max(shown.r, shown.g), max(shown.b, shown.w)) <= 0.0 {
        return;
    }
    let depth = drops_sum_depth(shown.w);
    // Light of lamps may be where there is no coverage.
    let per_cover = select(1.0, depth / max(shown.w, 1.0e-20), shown.w > 0.0);
    let light = max(shown.rgb, vec3f(0.0)) * (per_cover * (DROPS_SUM_UNITS / scale));
    for (var k = 0u; k < 3u; k += 1u) {
        if light[k] < DROPS_SUM_SMALL {
            atomicAdd(&drops_sum_small[4u * pixel + k], u32(light[k] + 0.5));
        } else {
            let large = min(light[k] / DROPS_SUM_LARGE, DROPS_SUM_MAX);
            atomicAdd(&drops_sum_large[4u * pixel + k], u32(large + 0.5));
        }
    }
    atomicAdd(&drops_sum_small[4u * pixel + 3u], u32(depth * DROPS_SUM_DEPTHS + 0.5));
    let distance = min(drop.distance, DROPS_FAR);
    atomicAdd(&drops_sum_large[4u * pixel + 3u], u32(depth * distance * DROPS_SUM_WAYS + 0.5));
}

@compute @workgroup_size(64, 1, 1)
fn main_drops_sum_clear(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index < arrayLength(&drops_sum_small) {
        atomicStore(&drops_sum_small[index], 0u);
    }
    if index < arrayLength(&drops_sum_large) {
        atomicStore(&drops_sum_large[index], 0u);
    }
    if index < 4u {
        atomicStore(&drops_groups[index], select(0u, 1u, index == 2u));
    }
    if index == 0u {
        atomicStore(&drops_blocks[arrayLength(&drops_blocks) - 1u], 0u);
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_drops_sum_scale(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation_index(id, groups);
    if index < drops_frame.count && streak_is_summed(drops_list[index]) {
        let light = drops_light[drops_glint_row(index)].rgb;
        let most = max(max(light.r, light.g), max(light.b, 0.0));
        atomicMax(&drops_sum_brightest, bitcast<u32>(most));
    }
    workgroupBarrier();
    if local == 0u {
        let mean = drops_capture_texel(drops_frame.capture_last, 0, 0);
        let most = max(max(mean.r, mean.g), max(mean.b, 0.0));
        let brightest = max(atomicLoad(&drops_sum_brightest), bitcast<u32>(most));
        let pixels = drops_frame.camera.width * drops_frame.camera.height;
        atomicMax(&drops_sum_small[4u * pixels], brightest);
    }
}

// True for a drop of the list that is summed up, with a profile or without.
fn drops_sum_is_of(index: u32, has_profile: bool) -> bool {
    return index < drops_frame.count
        && streak_is_summed(drops_list[index])
        && (drops_list[index].grid > 0u) == has_profile;
}

// Streaks without profiles: few invocations for each share the lines of its path.
@compute @workgroup_size(64, 1, 1)
fn main_drops_sum_thin(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let invocation = invocation_index(id, groups);
    let index = invocation / DROPS_SUM_SHARED;
    if !drops_sum_is_of(index, false) {
        return;
    }
    let drop = drops_list[index];
    let size = vec2u(drops_frame.camera.width, drops_frame.camera.height);
    let scale = bitcast<f32>(drops_sum_scale(atomicLoad(&drops_sum_small[4u * size.x * size.y])));
    let plumb = drops_sum_is_plumb(drop);
    let turned = select(size.yx, size, plumb);
    let lines = drops_sum_lines(drop, plumb, turned.y);
    for (var line = lines.x + invocation % DROPS_SUM_SHARED; line <= lines.y; line += DROPS_SUM_SHARED) {
        let across = drops_sum_across(drop, plumb, line, turned.x);
        for (var k = across.x; k <= across.y; k += 1u) {
            let at = select(vec2u(line, k), vec2u(k, line), plumb);
            drops_sum_add(drop, drops_thin(index, drop, at.x, at.y), at.x, at.y, scale);
        }
    }
}

// Streaks with profiles: a workgroup looks for them among some drops of the list, then shares the pixels of the path of each.
@compute @workgroup_size(256, 1, 1)
fn main_drops_sum_wide(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let candidate = (group.y * groups.x + group.x) * DROPS_SUM_LOOKED + local;
    if local < DROPS_SUM_LOOKED && drops_sum_is_of(candidate, true) {
        drops_sum_wide[atomicAdd(&drops_sum_found, 1u)] = candidate;
    }
    workgroupBarrier();
    let size = vec2u(drops_frame.camera.width, drops_frame.camera.height);
    let scale = bitcast<f32>(drops_sum_scale(atomicLoad(&drops_sum_small[4u * size.x * size.y])));
    let found = atomicLoad(&drops_sum_found);
    for (var n = 0u; n < found; n += 1u) {
        let index = drops_sum_wide[n];
        let drop = drops_list[index];
        let plumb = drops_sum_is_plumb(drop);
        let turned = select(size.yx, size, plumb);
        let lines = drops_sum_lines(drop, plumb, turned.y);
        let width = drops_sum_width(drop, plumb);
        let places = select(0u, (lines.y + 1u - lines.x) * width, lines.y >= lines.x);
        for (var place = local; place < places; place += DROPS_SUM_WIDE) {
            let line = lines.x + place / width;
            let across = drops_sum_across(drop, plumb, line, turned.x);
            let k = across.x + place % width;
            if k <= across.y {
                let at = select(vec2u(line, k), vec2u(k, line), plumb);
                drops_sum_add(drop, drops_wide(index, drop, at.x, at.y), at.x, at.y, scale);
            }
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_drops_sum_finish(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let pixel = invocation_index(id, groups);
    let pixels = drops_frame.camera.width * drops_frame.camera.height;
    if pixel >= pixels {
        return;
    }
    let scene = drops_sum_clean[pixel].w;
    let depth = f32(atomicLoad(&drops_sum_small[4u * pixel + 3u])) / DROPS_SUM_DEPTHS;
    let unit = bitcast<f32>(drops_sum_scale(atomicLoad(&drops_sum_small[4u * pixels]))) / DROPS_SUM_UNITS;
    var light = vec3f(0.0);
    for (var k = 0u; k < 3u; k += 1u) {
        let large = f32(atomicLoad(&drops_sum_large[4u * pixel + k])) * DROPS_SUM_LARGE;
        light[k] = (f32(atomicLoad(&drops_sum_small[4u * pixel + k])) + large) * unit;
    }
    let way = f32(atomicLoad(&drops_sum_large[4u * pixel + 3u])) / DROPS_SUM_WAYS;
    let distance = way / max(depth, 1.0 / DROPS_SUM_DEPTHS);
    let packed = drops_sum_pack(vec4f(light, depth) * drops_sum_share(depth), distance, scene);
    for (var k = 0u; k < 4u; k += 1u) {
        atomicStore(&drops_sum_small[4u * pixel + k], packed[k]);
    }
}
