// Drops as refractive particles that face the camera: still ones, and the streaks of those that move while the shutter is
// open.
// Law: a drop below a pixel, or out of focus, covers the pixels around its path by its area and its fraction of the exposure, so
// its light does not depend on where it falls; a larger one is sampled in each pixel. What lamps add is the mean over the
// drop.
// Streaks that cover little of each pixel are summed up before (drops_sum.wgsl) and count as one drop.
// Unresolved drops are a medium between them (medium.wgsl): it shows the mean radiance of a drop, and the light of lamps.
// Twin: downpour_render::rain::drops.

@group(0) @binding(3) var<storage, read> drops_list: array<ScreenDrop>;
// The lists of the tiles (tiles.wgsl). At its end the number of blocks of 8 by 8 pixels in which drops are listed, and before that, from the
// last one backward, these blocks.
@group(0) @binding(4) var<storage, read> drops_tiles: array<u32>;
// Of each pixel the distance of the scene, and what streaks show that were summed up (drops_sum.wgsl).
@group(0) @binding(5) var<storage, read> drops_summed: array<vec4u>;
// At first the medium (medium_filter.wgsl): light of lamps, and mean distance and optical depth as halves. Then the rain.
@group(0) @binding(6) var<storage, read_write> drops_layer: array<vec4f>;
// The lists while these blocks are found, and workgroups for them: along a row, rows, 1, number of blocks.
@group(0) @binding(13) var<storage, read_write> drops_blocks: array<atomic<u32>>;
@group(0) @binding(14) var<storage, read_write> drops_groups: array<atomic<u32>>;

// First and end of the list of a workgroup's block.
var<workgroup> drops_listed: vec2u;

// The position of a ray on the plane at distance 1 through a drop's middle, along the right and up of its view.
fn drops_on_plane(towards: vec3f, ray: vec3f) -> vec3f {
    return ray / max(dot(ray, towards), 1.0e-6) - towards;
}

// Light of lamps in the form of Rousseau 2006 at a position of a drop's mask, by the normal there, which halves the angle between the
// eye and what is mirrored: what it is more than the mean over the drop.
fn drops_facing(index: u32, drop: ScreenDrop, x: f32, y: f32) -> vec3f {
    let row = drops_glint_row(index);
    var light = vec3f(0.0);
    // An atlas has streaks, other forms have glints.
    if drops_frame.atlas > 0u || drops_frame.glints < 2u || drops_light[row + 1u].w >= 0.0 {
        return light;
    }
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let turned = drops_mask_unit(drops_mask_at(drop.mask_index, x, y).reflected + vec3f(0.0, 0.0, 1.0));
    let normal = right * turned.x + up * turned.y - drop.towards * turned.z;
    for (var k = 1u; k < drops_frame.glints; k += 2u) {
        let lamp = drops_light[row + k];
        if lamp.w < 0.0 {
            let way = drops_light[row + k + 1u].xyz;
            let shown = drop_glint_rousseau(normal, -drop.towards, way, drops_frame.light_terms);
            light += lamp.rgb * (max(shown, 0.0) + 1.0 + lamp.w);
        }
    }
    return light;
}

// The phase of the mode (2,0), in turns, where a passing drop is at a fraction of its way.
fn drops_turns(drop: ScreenDrop, way: f32) -> f32 {
    return drop.mode_phase.z + drop.cycles.x * streak_time(drop.depth_ratio, way);
}

// Light of lamps on a passing drop by the streaks of an atlas, for as long as it passes a position on the plane.
fn drops_streaks(index: u32, drop: ScreenDrop, chord: StreakChord, at: vec2f) -> vec3f {
    let row = drops_glint_row(index);
    let part = (chord.high - chord.low) * 0.5;
    let turns = drops_turns(drop, streak_nearest(drop, at));
    var light = drops_light[row].rgb * chord.fraction;
    for (var k = DROP_ATLAS_ROWS; k <= drops_frame.glints; k += DROP_ATLAS_ROWS) {
        let first = drops_light[row + k - 2u];
        if first.w != 0.0 {
            let streak = drops_atlas_streak(first, drops_light[row + k - 1u], drops_light[row + k]);
            let shown = drops_atlas_across(streak, -chord.aside, turns);
            light += first.rgb * (shown * 2.0 * chord.pace - chord.fraction);
        }
    }
    return max(light, vec3f(0.0)) * part;
}

// Light of lamps on a drop that is not sampled, as a radiance over all of it: with an atlas bright and dark along its path.
fn drops_beads(index: u32, drop: ScreenDrop, x: u32, y: u32) -> vec3f {
    let row = drops_glint_row(index);
    var light = drops_light[row].rgb;
    if drops_frame.atlas == 0u || drop.spread > 1.0 {
        return light;
    }
    let square = max(dot(drop.screen_delta, drop.screen_delta), 1.0);
    let at = dot(vec2f(f32(x), f32(y)) + 0.5 - drop.first, drop.screen_delta) / square;
    let pixel = 1.0 / sqrt(square);
    for (var k = DROP_ATLAS_ROWS; k <= drops_frame.glints; k += DROP_ATLAS_ROWS) {
        let first = drops_light[row + k - 2u];
        if first.w != 0.0 {
            let streak = drops_atlas_streak(first, drops_light[row + k - 1u], drops_light[row + k]);
            var mean = 0.0;
            for (var n = 0u; n < DROPS_ATLAS_TAPS; n += 1u) {
                let off = (f32(n) + 0.5) / f32(DROPS_ATLAS_TAPS) - 0.5;
                mean += drops_atlas_along(streak, drops_turns(drop, clamp(at + off * pixel, 0.0, 1.0)));
            }
            light += first.rgb * (mean / f32(DROPS_ATLAS_TAPS) - 1.0);
        }
    }
    return max(light, vec3f(0.0));
}

// True for a splash, whose masks are behind those of the diameters.
fn drops_is_splash(drop: ScreenDrop) -> bool {
    return drop.mask_index.x >= f32(PROJECT_DIAMETERS);
}

// The light of lamps on a part of a splash, over that of a sphere: what is bent as little as by a sheet of water stays where it is.
fn drops_bent(direction: vec3f) -> f32 {
    return min(dot(direction.xy, direction.xy) * DROPS_BENT, DROPS_MAX_BENT);
}

// A still drop over a pixel: radiance times coverage, and coverage. Below a pixel it is its mean radiance.
fn drops_still(index: u32, drop: ScreenDrop, x: u32, y: u32) -> vec4f {
    let small = drop.grid == 0u;
    let spread = streak_cover(drop, x, y);
    if small && spread <= 0.0 {
        return vec4f(0.0);
    }
    var right = drop_glint_right(drop.towards);
    if drops_is_splash(drop) {
        right = right * drop.cycles.x - cross(right, drop.towards) * drop.cycles.y;
    }
    let up = cross(right, drop.towards);
    let n = select(drop.grid, DROPS_SMALL_GRID, small);
    let extent = drop.half_extent * drop.slope;
    let of_mask = 2.0 * drop.half_extent / f32(n);
    let spacing = select(drops_frame.camera.pixel_angle / (drop.slope * f32(n)), of_mask, small);
    var sum = vec4f(0.0);
    for (var k = 0u; k < n * n; k += 1u) {
        let dx = (f32(k % n) + 0.5) / f32(n);
        let dy = (f32(k / n) + 0.5) / f32(n);
        var sx = 2.0 * dx - 1.0;
        var sy = 2.0 * dy - 1.0;
        var lean = vec3f(0.0);
        if !small {
            lean = drops_on_plane(drop.towards, camera_ray(drops_frame.camera, f32(x) + dx, f32(y) + dy));
            sx = dot(lean, right) / extent;
            sy = dot(lean, up) / extent;
        }
        if abs(sx) < 1.0 && abs(sy) < 1.0 {
            let texel = drops_mask_at(drop.mask_index, sx, sy);
            let shade = DropsShade(drop.towards, drop.half_extent, right, lean, spacing, drop.mask_index);
            var shown = drops_shade_texel(shade, texel, sx, sy);
            if !small {
                var light: vec3f;
                if drops_is_splash(drop) {
                    // Lamps shine on its rims as on so many small drops: no glint has its place on it.
                    let bends = drops_bent(texel.direction);
                    light = drops_light[drops_glint_row(index)].rgb * bends;
                } else {
                    light = drops_glint_rest(index) + drops_facing(index, drop, sx, sy);
                }
                shown += vec4f(light * shown.w, 0.0);
            }
            sum += shown;
        }
    }
    if small {
        let mean = sum.rgb / max(sum.w, 1.0e-20) + drops_light[drops_glint_row(index)].rgb;
        return vec4f(mean, 1.0) * spread;
    }
    sum /= f32(n * n);
    if !drops_is_splash(drop) {
        sum += vec4f(drops_glint_light(index, drop, x, y), 0.0);
    }
    return sum;
}

// The part of a chord that passes during the exposure, by the weighted mean over its middle points: what a table keeps
// beforehand, without weights.
fn drops_chord(index: u32, drop: ScreenDrop, chord: StreakChord, ray: vec3f) -> vec4f {
    let towards = drops_mask_unit(ray);
    let spacing = 2.0 * drop.oval.x / f32(STREAK_FINE);
    let shade = DropsShade(towards, drop.half_extent, drop_glint_right(towards), vec3f(0.0), spacing, drop.mask_index);
    var sum = vec4f(0.0);
    for (var k = 0u; k < drops_frame.streak_samples; k += 1u) {
        let part = (f32(k) + 0.5) / f32(drops_frame.streak_samples);
        let at = streak_mask_position(drop, chord, chord.low + (chord.high - chord.low) * part);
        if abs(at.x) < 1.0 && abs(at.y) < 1.0 {
            let shown = drops_shade_ray(shade, at.x, at.y);
            let light = shown + vec4f(drops_facing(index, drop, at.x, at.y) * shown.w, 0.0);
            sum += light * streak_weight(chord.weights, part);
        }
    }
    return vec4f(sum.rgb / max(sum.w, 1.0e-20), 1.0) * ((chord.high - chord.low) * 0.5);
}

// The fraction of a step by which the samples of a line of pixels are shifted: unshifted, all lines of a plumb streak would meet the thin
// image of a lamp in it, or miss it, alike.
fn drops_shift(line: u32) -> f32 {
    return f32((line * STREAK_GOLDEN) & 0xffffu) / 65536.0;
}

// The streak of a drop that is not sampled over a pixel: radiance times coverage, and coverage.
fn drops_thin(index: u32, drop: ScreenDrop, x: u32, y: u32) -> vec4f {
    let cover = streak_cover(drop, x, y);
    if cover <= 0.0 {
        return vec4f(0.0);
    }
    let size = vec2f(f32(drops_frame.camera.width), f32(drops_frame.camera.height));
    let position = vec2f(f32(x) + 0.5, f32(y) + 0.5) / size;
    let mean = streak_lookup_mean(drop.shape, position) + drops_beads(index, drop, x, y);
    return vec4f(mean, 1.0) * cover;
}

// The streak of a drop that is sampled over a pixel.
fn drops_wide(index: u32, drop: ScreenDrop, x: u32, y: u32) -> vec4f {
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let shift = vec2f(drops_shift(y), drops_shift(x));
    var sum = vec4f(0.0);
    for (var k = 0u; k < drop.grid; k += 1u) {
        // A lattice whose points differ in every direction.
        let turned = (k * STREAK_LATTICE) % drop.grid;
        let at = vec2f(f32(x), f32(y)) + (vec2f(f32(k), f32(turned)) + shift) / f32(drop.grid);
        let ray = camera_ray(drops_frame.camera, at.x, at.y);
        let lean = drops_on_plane(drop.towards, ray);
        let position = vec2f(dot(lean, right), dot(lean, up));
        let by_profile = drop.kind == DROPS_TABLE;
        if by_profile {
            sum += streak_lookup_shown(drop, position);
        }
        if by_profile && drops_frame.atlas == 0u {
            continue;
        }
        let chord = streak_chord(drop, position);
        if chord.high <= chord.low {
            continue;
        }
        if !by_profile && drops_frame.streak_color == STREAK_WHITE {
            sum.w += 0.5 * (chord.high - chord.low) * chord.fraction;
        } else if !by_profile {
            sum += drops_chord(index, drop, chord, ray) * chord.fraction;
        }
        if drops_frame.atlas > 0u {
            sum += vec4f(drops_streaks(index, drop, chord, position), 0.0);
        } else {
            sum += vec4f(drops_glint_rest(index) * (chord.fraction * (chord.high - chord.low) * 0.5), 0.0);
        }
    }
    sum /= f32(drop.grid);
    sum /= max(sum.w, 1.0);
    if drop.kind == DROPS_LOOP {
        sum += vec4f(drops_glint_light(index, drop, x, y), 0.0);
    }
    return sum;
}

// Position on the plane at distance 1 through a drop's center, along the right and up of its view, of a place on the picture.
fn drops_position(drop: ScreenDrop, x: f32, y: f32) -> vec2f {
    let right = drop_glint_right(drop.towards);
    let lean = drops_on_plane(drop.towards, camera_ray(drops_frame.camera, x, y));
    return vec2f(dot(lean, right), dot(lean, cross(right, drop.towards)));
}

// The part of a drop at a depth that is before a scene, 0 to 1: one that meets a surface goes into it over its own size; a splash
// stands on one, which hides it only from behind.
fn drops_before(drop: ScreenDrop, scene: f32, depth: f32) -> f32 {
    let sunk = (scene - depth) / (2.0 * drop.slope * drop.distance);
    return clamp(sunk + select(0.5, 1.5, drops_is_splash(drop)), 0.0, 1.0);
}

// The depth of a drop before a pixel, m.
fn drops_depth(drop: ScreenDrop, x: u32, y: u32) -> f32 {
    let way = streak_nearest(drop, drops_position(drop, f32(x) + 0.5, f32(y) + 0.5));
    return drop.distance * streak_depth(drop.depth_ratio, streak_time(drop.depth_ratio, way));
}

// The light of a drop over a pixel with another visibility: it takes out that multiple of the light behind it, at most all of it, and
// gives the same multiple of its own.
fn drops_visible(shown: vec4f, visibility: f32) -> vec4f {
    return shown * min(visibility, 1.0 / max(shown.w, 1.0e-6));
}

// What a drop over a pixel shows before a scene that is `scene` meters away.
fn drops_shown(drop: ScreenDrop, light: vec4f, x: u32, y: u32, scene: f32) -> vec4f {
    var shown = light;
    if max(max(shown.r, shown.g), max(shown.b, shown.w)) <= 0.0 {
        return vec4f(0.0);
    }
    if drops_frame.streak_color == STREAK_WHITE {
        shown = vec4f(drops_capture_texel(drops_frame.capture_last, 0, 0) * shown.w, shown.w);
    }
    let seen = shown * drops_before(drop, scene, drops_depth(drop, x, y));
    return drops_visible(seen, drops_frame.visibility);
}

// A drop over a pixel whose scene is `scene` meters away: radiance times coverage, and coverage.
fn drops_pixel(index: u32, x: u32, y: u32, scene: f32) -> vec4f {
    let drop = drops_list[index];
    var shown = vec4f(0.0);
    if drop.kind == DROPS_STILL {
        shown = drops_still(index, drop, x, y);
    } else if drop.grid == 0u {
        shown = drops_thin(index, drop, x, y);
    } else {
        shown = drops_wide(index, drop, x, y);
    }
    return drops_shown(drop, shown, x, y, scene);
}

// Mean radiance that fog scatters into a ray: the capture about the ray, over the solid angle of an even cone whose mean cosine is
// the asymmetry of the phase function.
fn drops_fog(direction: vec3f) -> vec3f {
    return drops_capture_about(direction, direction, medium_frame.fog_phase.x) * medium_frame.fog.w;
}

// What streaks show together that were summed up: radiance times coverage, and coverage.
fn drops_sums_shown(sums: vec4u) -> vec4f {
    let green = (sums.y >> 21u) | ((sums.z & 0x3ffu) << 11u);
    let color = bitcast<vec3f>(vec3u(sums.y & 0x1fffffu, green, sums.z >> 10u) << vec3u(10u));
    return vec4f(color, f32(sums.w & 0xffffu) / 65535.0);
}

// How far away they are on the mean, m.
fn drops_sums_distance(sums: vec4u) -> f32 {
    return bitcast<f32>(sums.w & 0xffff0000u);
}

// What is before a pixel besides drops of its list.
struct DropsAir {
    // The pixel's ray.
    direction: vec3f,
    // The part of it in which drops are drawn (medium_span).
    span: vec3f,
    // Distance of the scene, and where the medium ends before it, m.
    scene: f32,
    end: f32,
    // Optical depth of the medium, and its factor.
    depth: f32,
    thinned: f32,
    // What drops of the medium show, and what fog does.
    medium: vec3f,
    fog: vec3f,
    // Light of lamps on the medium, and its mean distance, m.
    lamps: vec3f,
    lamps_at: f32,
    // Streaks that were summed up: radiance times coverage, coverage; and their mean distance, m.
    streaks: vec4f,
    streaks_at: f32,
}

// What is seen of a pixel from the eye to some distance.
struct DropsSeen {
    radiance: vec3f,
    // What drops let through, the medium, and fog.
    transmittance: f32,
    left: f32,
    clear: f32,
    // True if the light of lamps on the medium is in it, and the streaks that were summed up.
    has_lamps: bool,
    has_streaks: bool,
}

// What is before a pixel besides drops of its list.
fn drops_air(x: u32, y: u32) -> DropsAir {
    let index = y * drops_frame.camera.width + x;
    let sums = drops_summed[index];
    let scene = bitcast<f32>(sums.x);
    let mean = drops_layer[index];
    // Mean distance of the medium's light of lamps, and its optical depth.
    let pair = unpack2x16float(bitcast<u32>(mean.w));
    let direction = drops_mask_unit(camera_ray(drops_frame.camera, f32(x) + 0.5, f32(y) + 0.5));
    let span = medium_span(direction);
    let end = select(scene, MEDIUM_SKY_REACH, scene >= MEDIUM_SKY);
    // More or fewer drops than are to be expected.
    var depth = pair.y;
    var lamps = mean.rgb;
    if depth > 0.0 {
        let drops = medium_streaks_at(direction, span, end, pair.x, drops_frame.camera.pixel_angle);
        var rainy = 1.0;
        if medium_frame.fog.x > 0.0 {
            rainy = depth / (depth + medium_fog_depth(medium_frame.fog, direction.y, pair.x));
        }
        lamps *= 1.0 + (drops.y - 1.0) * rainy;
        depth *= drops.x;
    }
    // Air that rain does not reach thins the medium; evenly, as far as drops between it go.
    let thinned = depth / max(medium_depth(end, span, 1.0), 1.0e-12);
    var shown_medium = vec3f(0.0);
    if depth > 0.0 {
        shown_medium = drops_medium(x, y);
    }
    var shown_fog = vec3f(0.0);
    if medium_frame.fog.x > 0.0 {
        shown_fog = drops_fog(direction);
    }
    return DropsAir(
        direction,
        span,
        scene,
        end,
        depth,
        thinned,
        shown_medium,
        shown_fog,
        lamps,
        pair.x,
        drops_sums_shown(sums),
        drops_sums_distance(sums),
    );
}

// Goes on to a drop at a distance, with the medium and the fog before it.
fn drops_behind(before: DropsSeen, air: DropsAir, shown: vec4f, distance: f32) -> DropsSeen {
    var seen = before;
    let at = min(distance, air.end);
    if !seen.has_lamps && at > air.lamps_at {
        seen.radiance += air.lamps * seen.transmittance;
        seen.has_lamps = true;
    }
    let here = min(exp(-medium_depth(at, air.span, 1.0) * air.thinned), seen.left);
    let through = medium_fog(air.direction, at);
    // What a part of the way takes out, left * clear - here * through, is shared by medium and fog.
    let between = air.medium * ((seen.left - here) * (0.5 * (seen.clear + through)));
    let fog = air.fog * ((seen.clear - through) * (0.5 * (seen.left + here)));
    seen.radiance += seen.transmittance * (between + fog + shown.rgb * (here * through));
    seen.clear = through;
    seen.transmittance *= 1.0 - shown.w;
    seen.left = here;
    return seen;
}

// Goes on to the streaks that were summed up, if they are nearer than a distance.
fn drops_behind_streaks(before: DropsSeen, air: DropsAir, distance: f32) -> DropsSeen {
    let shown = max(max(air.streaks.r, air.streaks.g), max(air.streaks.b, air.streaks.w)) > 0.0;
    if before.has_streaks || !shown || air.streaks_at >= distance {
        return before;
    }
    var seen = drops_behind(before, air, air.streaks, air.streaks_at);
    seen.has_streaks = true;
    return seen;
}

// The rain over a pixel: radiance, and the transmittance of the scene behind it, by what is seen up to the last drop.
fn drops_whole(before: DropsSeen, air: DropsAir) -> vec4f {
    let seen = drops_behind_streaks(before, air, DROPS_FAR);
    var radiance = seen.radiance;
    if !seen.has_lamps {
        radiance += air.lamps * seen.transmittance;
    }
    let last = min(exp(-air.depth), seen.left);
    let whole = medium_fog(air.direction, air.scene);
    radiance += air.medium * (seen.transmittance * (seen.left - last) * (0.5 * (seen.clear + whole)));
    radiance += air.fog * (seen.transmittance * (seen.clear - whole) * (0.5 * (seen.left + last)));
    return vec4f(radiance, seen.transmittance * last * whole);
}

// The rain over a pixel whose list is between two places. Drops are in order of their nearest points, with the medium and the fog between
// them.
fn drops_over(x: u32, y: u32, first: u32, end: u32) -> vec4f {
    let air = drops_air(x, y);
    var seen = DropsSeen(vec3f(0.0), 1.0, 1.0, 1.0, false, false);
    for (var k = first; k < end; k += 1u) {
        let drop = drops_tiles[k];
        if drops_list[drop].nearest >= air.scene || seen.transmittance < DROPS_OPAQUE {
            break;
        }
        let shown = drops_pixel(drop, x, y, air.scene);
        if max(max(shown.r, shown.g), max(shown.b, shown.w)) <= 0.0 {
            continue;
        }
        seen = drops_behind_streaks(seen, air, drops_list[drop].distance);
        seen = drops_behind(seen, air, shown, drops_list[drop].distance);
    }
    return drops_whole(seen, air);
}

// The tile of the lists that has a block of 8 by 8 pixels of a picture so wide, where tiles are so wide.
fn drops_tile(block: vec2u, edge: u32, width: u32) -> u32 {
    let tile = block * DROPS_TILE / edge;
    return tile.y * ((width + edge - 1u) / edge) + tile.x;
}

// The rain where no drops are listed; elsewhere notes the blocks. Apart from those, which take so much more: all that a kernel can do costs
// those of its pixels that do not.
@compute @workgroup_size(8, 8, 1)
fn main_drops_unlisted(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0u {
        let tile = drops_tile(group.xy, atomicLoad(&drops_blocks[0]), drops_frame.camera.width);
        drops_listed = vec2u(atomicLoad(&drops_blocks[1u + tile]), atomicLoad(&drops_blocks[2u + tile]));
        if drops_listed.x < drops_listed.y {
            let place = atomicAdd(&drops_groups[3], 1u);
            atomicMax(&drops_groups[0], min(place + 1u, DROPS_ALONG));
            atomicMax(&drops_groups[1], place / DROPS_ALONG + 1u);
            let last = arrayLength(&drops_blocks) - 1u;
            atomicMax(&drops_blocks[last], place + 1u);
            atomicStore(&drops_blocks[last - 1u - place], group.y * groups.x + group.x);
        }
    }
    let listed = workgroupUniformLoad(&drops_listed);
    if listed.x < listed.y || id.x >= drops_frame.camera.width || id.y >= drops_frame.camera.height {
        return;
    }
    let nothing = DropsSeen(vec3f(0.0), 1.0, 1.0, 1.0, false, false);
    drops_layer[id.y * drops_frame.camera.width + id.x] = drops_whole(nothing, drops_air(id.x, id.y));
}

// The rain where drops are listed: a workgroup for each of these blocks.
@compute @workgroup_size(8, 8, 1)
fn main_drops(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let place = group.y * groups.x + group.x;
    let last = arrayLength(&drops_tiles) - 1u;
    if place >= drops_tiles[last] {
        return;
    }
    let number = drops_tiles[last - 1u - place];
    let across = (drops_frame.camera.width + DROPS_TILE - 1u) / DROPS_TILE;
    let block = vec2u(number % across, number / across);
    let pixel = block * DROPS_TILE + local.xy;
    if pixel.x >= drops_frame.camera.width || pixel.y >= drops_frame.camera.height {
        return;
    }
    let tile = drops_tile(block, drops_tiles[0], drops_frame.camera.width);
    let shown = drops_over(pixel.x, pixel.y, drops_tiles[1u + tile], drops_tiles[2u + tile]);
    drops_layer[pixel.y * drops_frame.camera.width + pixel.x] = shown;
}
