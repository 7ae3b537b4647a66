// Traces the rays of the profiles of streaks: for an instant of the exposure the drop's outline, chords along the motion across it,
// and rays along each chord to where their light leaves the drop.
// Layout: a streak has a head in the table (rows, columns, rows of the profile, fine columns), then for each row and column the
// middle and half of the outline's width and the middle and half of the chord, the latter over sqrt(1 - a^2) at the position a
// across; rays are in a separate buffer, row by row, column by column, along the chord.
// Twin: downpour_render::rain::streak_rays.

@group(0) @binding(0) var<storage, read> streak_rays_drops: array<ScreenDrop>;
@group(0) @binding(1) var<storage, read> streak_rays_paths: array<StreakPath>;
// First the number of jobs; then for each the indices of the path and of the row.
@group(0) @binding(2) var<storage, read> streak_rays_jobs: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> streak_rays_table: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> streak_rays_made: array<StreakRay>;

var<workgroup> streak_rays_points: array<vec2f, STREAK_OUTLINE>;

// Of the pixel that sees a point at a radius and an angle from the motion: the distance from the path, and how far ahead it is.
fn streak_rays_beside(instant: StreakInstant, radius: f32, c: f32, s: f32) -> vec2f {
    return vec2f(radius * s / (1.0 + instant.funnel * radius * c), radius * c);
}

// A point of the outline at an angle from the motion.
fn streak_rays_outline(path: StreakPath, drop: ScreenDrop, instant: StreakInstant, angle: f32) -> vec2f {
    let axes = streak_path_axes(drop);
    let c = cos(angle);
    let s = sin(angle);
    let way = axes.xy * c + axes.zw * s;
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let radial = streak_path_turned(path, right * way.x + up * way.y);
    var radius = 1.0;
    var along = 0.0;
    for (var step = 0u; step < STREAK_OUTLINE_STEPS; step += 1u) {
        let time = instant.time - radius * c * instant.pace;
        let body = streak_path_body(path, streak_path_displacement(path, drop, time));
        let line = streak_path_line(path, drop, instant, streak_rays_beside(instant, radius, c, s));
        along = mask_wobble_nearest(body, line.origin, line.direction, along);
        let surface = mask_wobble_surface(body.shape, body.state, line.origin + line.direction * along);
        let gauge = sqrt(max(surface.excess + 1.0, 0.0));
        let slope = max(dot(surface.half_gradient, radial), STREAK_OUTLINE_SLOPE);
        let next = radius - surface.excess / (gauge + 1.0) * gauge / slope;
        radius = clamp(next, STREAK_OUTLINE_MIN, STREAK_OUTLINE_MAX);
    }
    return streak_rays_beside(instant, radius, c, s);
}

// Middle and half of the outline's width.
fn streak_rays_width() -> vec2f {
    var low = streak_rays_points[0].x;
    var high = low;
    for (var k = 1u; k < STREAK_OUTLINE; k += 1u) {
        low = min(low, streak_rays_points[k].x);
        high = max(high, streak_rays_points[k].x);
    }
    return vec2f(0.5 * (high + low), 0.5 * (high - low));
}

// Middle and half of the chord at a position across the motion.
fn streak_rays_chord(across: f32) -> vec2f {
    var low = STREAK_OUTLINE_MAX;
    var high = -STREAK_OUTLINE_MAX;
    for (var k = 0u; k < STREAK_OUTLINE; k += 1u) {
        let p = streak_rays_points[k];
        let q = streak_rays_points[(k + 1u) % STREAK_OUTLINE];
        if (p.x - across) * (q.x - across) <= 0.0 && p.x != q.x {
            let along = p.y + (q.y - p.y) * (across - p.x) / (q.x - p.x);
            low = min(low, along);
            high = max(high, along);
        }
    }
    return vec2f(0.5 * (high + low), max(0.5 * (high - low), 0.0));
}

// The ray through a point across and along the motion.
fn streak_rays_ray(path: StreakPath, drop: ScreenDrop, instant: StreakInstant, point: vec2f) -> StreakRay {
    let line = streak_path_line(path, drop, instant, point);
    let time = instant.time - point.y * instant.pace;
    let body = streak_path_body(path, streak_path_displacement(path, drop, time));
    let light = mask_wobble_light(body, line.origin, line.direction);
    let passed = vec4u(light.interfaces);
    return StreakRay(
        vec4u(
            pack2x16snorm(packing_octahedral_encode(streak_path_back(path, light.outer))),
            pack2x16snorm(packing_octahedral_encode(streak_path_back(path, light.first))),
            pack2x16snorm(packing_octahedral_encode(streak_path_back(path, light.second))),
            pack2x16snorm(packing_octahedral_encode(streak_path_back(path, light.third))),
        ),
        vec2u(pack2x16unorm(light.fractions.xy), pack2x16unorm(light.fractions.zw)),
        passed.x | (passed.y << 8u) | (passed.z << 16u) | (passed.w << 24u),
        0u,
    );
}

@compute @workgroup_size(64, 1, 1)
fn main_streak_rays(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let number = group.y * groups.x + group.x;
    if number >= streak_rays_jobs[0].x {
        return;
    }
    let job = streak_rays_jobs[1u + number];
    let path = streak_rays_paths[job.x];
    let drop = streak_rays_drops[path.drop];
    let row = job.y;
    let instant = streak_path_instant(drop, f32(row) / f32(path.rows - 1u));
    let step = STREAK_TURN / f32(STREAK_OUTLINE);
    for (var k = index; k < STREAK_OUTLINE; k += 64u) {
        streak_rays_points[k] = streak_rays_outline(path, drop, instant, step * f32(k));
    }
    workgroupBarrier();
    let columns = path.columns;
    let width = streak_rays_width();
    if row == 0u && index == 0u {
        let sizes = vec4u(path.rows, columns, path.profile_rows, path.fine);
        streak_rays_table[path.first_entry] = vec4f(sizes);
    }
    for (var k = index; k < columns * columns; k += 64u) {
        let column = k / columns;
        let position = streak_cell_position(f32(column) + 0.5, columns);
        let across = width.x + width.y * position;
        let chord = streak_rays_chord(across);
        let along = chord.x + chord.y * streak_cell_position(f32(k % columns) + 0.5, columns);
        streak_rays_made[path.first_ray + row * columns * columns + k] =
            streak_rays_ray(path, drop, instant, vec2f(across, along));
        if k % columns == 0u {
            let round = chord.y / sqrt(max(1.0 - position * position, 1.0e-6));
            streak_rays_table[path.first_entry + 1u + row * columns + column] = vec4f(width, chord.x, round);
        }
    }
}
