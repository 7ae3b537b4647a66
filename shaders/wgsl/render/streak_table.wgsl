// Makes the means of the streak radiance table: what a drop of a class of sizes shows, over its disk and over all phases of its
// oscillation.
// Law: points of a rank-1 lattice over the disk, the phases of both modes and the azimuth of the lobe; those that meet the drop
// as it is then are traced. Rays are parallel: such drops are below two pixels.
// Twin: downpour_render::rain::streak_table.

@group(0) @binding(2) var<storage, read> streak_classes: array<StreakPath>;
@group(0) @binding(3) var<storage, read_write> streak_made: array<vec4f>;

var<workgroup> streak_table_parts: array<vec4f, STREAK_MEAN_GROUP>;

// One of the points of a class's mean: radiance, and 1 if it meets the drop, else 0.
fn streak_table_point(kind: u32, towards: vec3f, point: u32) -> vec4f {
    var path = streak_classes[kind];
    let number = f32(point) + 0.5;
    let phases = fract(number * vec3f(STREAK_MEAN_SECOND, STREAK_MEAN_THIRD, STREAK_MEAN_FOURTH));
    let azimuth = STREAK_TURN * phases.z;
    path.lobe = vec2f(cos(azimuth), sin(azimuth));
    let displacement =
        path.amplitudes * vec2f(drop_oscillation_sine(phases.x), drop_oscillation_sine(phases.y));
    let body = streak_path_body(path, displacement);
    // Evenly over a disk that holds the drop.
    let reach = STREAK_MEAN_REACH / sqrt(min(body.inverse_wide, body.inverse_tall));
    let away = sqrt(number / f32(STREAK_MEAN_POINTS));
    let angle = STREAK_TURN * fract(number * STREAK_MEAN_FIRST);
    let right = drop_glint_right(towards);
    let up = cross(right, towards);
    let offset = right * (away * cos(angle)) + up * (away * sin(angle));
    let origin = streak_path_turned(path, offset * reach);
    let direction = streak_path_turned(path, towards);
    let guess = mask_wobble_nearest(body, origin, direction, 0.0);
    let along = mask_wobble_nearest(body, origin, direction, guess);
    if mask_wobble_surface(body.shape, body.state, origin + direction * along).excess >= 0.0 {
        return vec4f(0.0);
    }
    let light = mask_wobble_light(body, origin, direction);
    // A sphere's deviations and their derivatives, for the footprints.
    let bend = 2.0 / sqrt(max(1.0 - away * away, STREAK_MEAN_RIM));
    let width = STREAK_MEAN_WIDTH * reach;
    var exits = array<vec3f, 4>(light.outer, light.first, light.second, light.third);
    let bends = vec4f(
        bend,
        bend - DROPS_STRAIGHT,
        max(abs(bend - 2.0 * DROPS_STRAIGHT), 1.0),
        max(abs(bend - 3.0 * DROPS_STRAIGHT), 1.0),
    );
    let shifts = drops_frame.form == DROPS_SHIFT;
    var sum = vec3f(0.0);
    var rest = 1.0;
    for (var k = 0u; k <= STREAK_EXITS; k += 1u) {
        if light.interfaces[k] > 0.0 {
            let shown = select(light.fractions[k], select(0.0, 1.0, k == 1u), shifts);
            let seen = streak_path_back(path, exits[k]);
            sum += drops_capture_about(towards, seen, width * bends[k]) * shown;
            rest -= light.fractions[k];
        }
    }
    sum += drops_capture_texel(drops_frame.capture_last, 0, 0) * select(max(rest, 0.0), 0.0, shifts);
    return vec4f(sum, 1.0);
}

@compute @workgroup_size(64, 1, 1)
fn main_streak_table(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) index: u32) {
    let ray = group.x;
    let kind = group.y;
    let last = f32(STREAK_RAYS - 1u);
    let column = f32(ray % STREAK_RAYS) / last;
    let line = f32(ray / STREAK_RAYS) / last;
    let towards =
        normalize(camera_ray(drops_frame.camera, column * f32(drops_frame.camera.width), line * f32(drops_frame.camera.height)));
    let entry = kind * STREAK_RAYS * STREAK_RAYS + ray;
    let known = f32(drops_frame.known);
    let is_known = known > 0.0 && streak_made[entry].w == known;
    // A class without rows is one that no drop has.
    let is_wanted = (streak_classes[kind].rows > 0u || kind < drops_frame.made_classes) && !is_known;
    var sum = vec4f(0.0);
    let points = select(0u, STREAK_MEAN_POINTS, is_wanted);
    for (var point = index; point < points; point += STREAK_MEAN_GROUP) {
        sum += streak_table_point(kind, towards, point);
    }
    streak_table_parts[index] = sum;
    workgroupBarrier();
    if index == 0u && !is_known {
        for (var part = 1u; part < STREAK_MEAN_GROUP; part += 1u) {
            sum += streak_table_parts[part];
        }
        streak_made[entry] = vec4f(sum.rgb / max(sum.w, 1.0), select(0.0, known, is_wanted));
    }
}
