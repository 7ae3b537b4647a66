// Lights the profiles of streaks: what a drop shows along each chord, at each instant of the profile, as a running sum of four
// parts.
// Law: the light that a ray brings is that of the directions in which it leaves the drop, weighted by what Fresnel's equations
// give each. Between the rays that were traced, directions go as a polynomial of degree two across, along and in time, from ray to
// ray that pass as many interfaces. So the ray's own patch of the drop is known: how wide the environment is averaged, and where
// in the patch a lamp shines, whose disk (or, where the patch's points are farther apart, a spot that some of them meet) is sampled.
// Light that leaves after the exits that are followed has the mean radiance of environment and lamps over all directions: it travels
// around the rim and comes out there.
// Layout: behind the chords of streak_rays.wgsl, for each row of the profile and each fine column the light of the chord's first
// part, of the first two, three and of all four, each over the length of the whole chord.
// Twin: downpour_render::rain::streak_light.

@group(0) @binding(2) var<storage, read> streak_light_drops: array<ScreenDrop>;
@group(0) @binding(3) var<storage, read> streak_light_paths: array<StreakPath>;
// First the number of jobs; then for each the index of the path, and the first of 64 columns of all rows of its profile.
@group(0) @binding(4) var<storage, read> streak_light_jobs: array<vec2u>;
@group(0) @binding(5) var<storage, read> streak_light_rays: array<StreakRay>;
// For each path the mean of what is not resolved by lamp, then two rows for each lamp: its irradiance and the chord from the
// middle to the edge of its disk (below 0: its irradiance over pi, in the form of Rousseau 2006); its direction.
@group(0) @binding(6) var<storage, read> streak_light_lamps: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> streak_light_table: array<vec4f>;

// One exit of a ray.
struct StreakExit {
    direction: vec3f,
    fraction: f32,
    // Interfaces passed; 0: there is none.
    passed: u32,
}

// Change of an exit along an axis: first and second difference per ray of its direction and of its fraction.
struct StreakChange {
    first: vec3f,
    fraction: f32,
    second: vec3f,
    fraction_second: f32,
}

// Cell of a ray in the grid of its row: columns of rays across the motion, each of several fine columns, and rays along a chord.
struct StreakCell {
    column: u32,
    tap: u32,
    columns: u32,
    fine: u32,
}

// A ray's patch: its exit and how that goes across, along and in time.
struct StreakPatch {
    middle: StreakExit,
    across: StreakChange,
    along: StreakChange,
    later: StreakChange,
    across_along: vec3f,
    across_later: vec3f,
    along_later: vec3f,
}

// An exit of a ray; none outside of the streak's rays.
fn streak_light_exit(path: StreakPath, row: i32, column: i32, tap: i32, number: u32) -> StreakExit {
    let columns = i32(path.columns);
    if row < 0 || row >= i32(path.rows) || column < 0 || column >= columns || tap < 0 || tap >= columns {
        return StreakExit(vec3f(0.0), 0.0, 0u);
    }
    let at = path.first_ray + u32((row * columns + column) * columns + tap);
    let passed = (streak_light_rays[at].interfaces >> (8u * number)) & 0xffu;
    if passed == 0u {
        return StreakExit(vec3f(0.0), 0.0, 0u);
    }
    let fractions = unpack2x16unorm(streak_light_rays[at].fractions[number >> 1u]);
    return StreakExit(
        packing_octahedral_decode(unpack2x16snorm(streak_light_rays[at].exits[number])),
        select(fractions.x, fractions.y, (number & 1u) == 1u),
        passed,
    );
}

// The change between an exit's neighbors, as far as their light went the same way.
fn streak_light_change(before: StreakExit, here: StreakExit, after: StreakExit) -> StreakChange {
    let has_before = before.passed == here.passed;
    let has_after = after.passed == here.passed;
    if has_before && has_after {
        return StreakChange(
            (after.direction - before.direction) * 0.5,
            (after.fraction - before.fraction) * 0.5,
            after.direction + before.direction - here.direction * 2.0,
            after.fraction + before.fraction - here.fraction * 2.0,
        );
    }
    if has_after {
        return StreakChange(after.direction - here.direction, after.fraction - here.fraction, vec3f(0.0), 0.0);
    }
    if has_before {
        return StreakChange(here.direction - before.direction, here.fraction - before.fraction, vec3f(0.0), 0.0);
    }
    return StreakChange(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
}

// The mixed second difference, from the two neighbors on a diagonal.
fn streak_light_mixed(
    before: StreakExit,
    here: StreakExit,
    after: StreakExit,
    a: StreakChange,
    b: StreakChange,
) -> vec3f {
    if before.passed != here.passed || after.passed != here.passed {
        return vec3f(0.0);
    }
    return (before.direction + after.direction - here.direction * 2.0 - a.second - b.second) * 0.5;
}

// The patch around the exit `here` of a ray.
fn streak_light_patch(path: StreakPath, row: i32, column: i32, tap: i32, number: u32, here: StreakExit) -> StreakPatch {
    let across = streak_light_change(
        streak_light_exit(path, row, column - 1, tap, number),
        here,
        streak_light_exit(path, row, column + 1, tap, number),
    );
    let along = streak_light_change(
        streak_light_exit(path, row, column, tap - 1, number),
        here,
        streak_light_exit(path, row, column, tap + 1, number),
    );
    let later = streak_light_change(
        streak_light_exit(path, row - 1, column, tap, number),
        here,
        streak_light_exit(path, row + 1, column, tap, number),
    );
    let across_along = streak_light_mixed(
        streak_light_exit(path, row, column - 1, tap - 1, number),
        here,
        streak_light_exit(path, row, column + 1, tap + 1, number),
        across,
        along,
    );
    let across_later = streak_light_mixed(
        streak_light_exit(path, row - 1, column - 1, tap, number),
        here,
        streak_light_exit(path, row + 1, column + 1, tap, number),
        across,
        later,
    );
    let along_later = streak_light_mixed(
        streak_light_exit(path, row - 1, column, tap - 1, number),
        here,
        streak_light_exit(path, row + 1, column, tap + 1, number),
        along,
        later,
    );
    return StreakPatch(here, across, along, later, across_along, across_later, along_later);
}

// The direction at a position of a patch: rays across, along and later, from its middle.
fn streak_light_direction(ray: StreakPatch, position: vec3f) -> vec3f {
    let linear = ray.middle.direction
        + ray.across.first * position.x
        + ray.along.first * position.y
        + ray.later.first * position.z;
    let squares = ray.across.second * (0.5 * position.x * position.x)
        + ray.along.second * (0.5 * position.y * position.y)
        + ray.later.second * (0.5 * position.z * position.z);
    let mixed = ray.across_along * (position.x * position.y)
        + ray.across_later * (position.x * position.z)
        + ray.along_later * (position.y * position.z);
    return normalize(linear + squares + mixed);
}

// The fraction of the light at a position of a patch.
fn streak_light_fraction(ray: StreakPatch, position: vec3f) -> f32 {
    let linear = ray.middle.fraction
        + ray.across.fraction * position.x
        + ray.along.fraction * position.y
        + ray.later.fraction * position.z;
    let squares = ray.across.fraction_second * (0.5 * position.x * position.x)
        + ray.along.fraction_second * (0.5 * position.y * position.y)
        + ray.later.fraction_second * (0.5 * position.z * position.z);
    return clamp(linear + squares, 0.0, 1.0);
}

// Width of a patch across and along, at a time.
fn streak_light_size(ray: StreakPatch, later: f32) -> vec2f {
    let across = ray.across.first + ray.across_later * later;
    let along = ray.along.first + ray.along_later * later;
    return sqrt(vec2f(dot(across, across), dot(along, along)));
}

// Radius of a spot that some of the points of a patch meet, by the patch's width across and along.
fn streak_light_radius(size: vec2f) -> f32 {
    let least = STREAK_SPOT_NARROW;
    let area = max(size.x, least * size.y) * max(size.y, least * size.x);
    return STREAK_SPOT_WIDTH * sqrt(area / f32(STREAK_SPOTS));
}

// How far directions of a patch go along an axis beside its lines across and along: in time, and by second differences; and how far away a
// lamp is looked for.
fn streak_light_bound(ray: StreakPatch, axis: vec3f, moved: vec3f, span: f32, reach: f32) -> f32 {
    let squares = abs(dot(ray.across.second, axis))
        + abs(dot(ray.along.second, axis))
        + abs(dot(ray.later.second, axis)) * (span * span);
    let mixed = abs(dot(ray.across_along, axis))
        + (abs(dot(ray.across_later, axis)) + abs(dot(ray.along_later, axis))) * span;
    return reach + STREAK_SPOT_SLACK * (0.5 * abs(dot(moved, axis)) + 0.125 * squares + 0.25 * mixed);
}

// The axis of length 1 beside a way from a direction.
fn streak_light_beside(center: vec3f, way: vec3f) -> vec3f {
    let axis = cross(center, way);
    return axis / max(sqrt(dot(axis, axis)), STREAK_SPOT_EDGE);
}

// The points of a patch of which some may be nearer than `reach` to the direction of a lamp: the first, and how many follow it, from the
// last on again from 0.
// Beside the patch's lines along the chord the direction goes as far across as its first differences say, and else no farther than all
// others together; that bounds where across a point may be. The like along tells whether there is any.
fn streak_light_points(ray: StreakPatch, later: f32, span: f32, lamp: vec3f, reach: f32, shift: f32) -> vec2u {
    let center = streak_light_direction(ray, vec3f(0.0, 0.0, later));
    let across = ray.across.first + ray.across_later * later;
    let along = ray.along.first + ray.along_later * later;
    let moved = (ray.later.first + ray.later.second * later) * span;
    let aside = streak_light_beside(center, across);
    let wide = streak_light_bound(ray, aside, moved, span, reach) + 0.5 * STREAK_SPOT_SLACK * abs(dot(along, aside));
    if abs(dot(lamp - center, aside)) > wide {
        return vec2u(0u);
    }
    let axis = streak_light_beside(center, along);
    let per_ray = dot(across, axis);
    let off = dot(lamp - center, axis);
    let half = streak_light_bound(ray, axis, moved, span, reach) + 0.5 * (STREAK_SPOT_SLACK - 1.0) * abs(per_ray);
    if abs(off) > half + 0.5 * abs(per_ray) {
        return vec2u(0u);
    }
    let firm = select(per_ray, STREAK_SPOT_EDGE, abs(per_ray) < STREAK_SPOT_EDGE);
    let ends = clamp(vec2f(off - half, off + half) / firm, vec2f(-0.5), vec2f(0.5)) + 0.5 - shift;
    let count = f32(STREAK_SPOTS);
    let first = i32(floor(count * min(ends.x, ends.y) - 0.5));
    let last = i32(ceil(count * max(ends.x, ends.y) - 0.5));
    let number = clamp(last + 1 - first, 0, i32(STREAK_SPOTS));
    return vec2u(u32(first + 2 * i32(STREAK_SPOTS)) % STREAK_SPOTS, u32(number));
}

// Light of a lamp with an irradiance of 1 in the fine columns of a ray's cell, as parts of the light of a chord: the mean over the
// points of its patch, of which those that see the lamp's disk show its radiance. `width`: of the patch, across, along and in time; `spot`:
// radius of a spot that some of its points meet; `reach`: the chord from the middle to the edge of the disk; `span`: rays between two
// rows of the profile; `shift` tells the points of a patch from its neighbors'. A point stands for the part of the outline's area
// around it; what is looked up between fine columns then has the light of the points.
fn streak_light_spot(
    ray: StreakPatch,
    later: f32,
    span: f32,
    width: f32,
    spot: f32,
    lamp: vec3f,
    reach: f32,
    cell: StreakCell,
    shift: vec3f,
) -> vec4f {
    var spots = vec4f(0.0);
    let wide = max(reach, spot);
    // The edge of a disk is as soft as points are apart.
    let edge = select(0.5 * spot, 0.0, spot > reach);
    let whole = 2.0 * STREAK_QUARTER * (wide * wide + edge * edge / 3.0);
    let radiance = f32(cell.fine) / (f32(STREAK_SPOTS) * whole);
    var points = vec2u(0u, STREAK_SPOTS);
    if width < STREAK_SPOT_FLAT {
        points = streak_light_points(ray, later, span, lamp, wide + edge, shift.x);
    }
    // In the order of all points: those past the last one come first.
    let past = max(points.x + points.y, STREAK_SPOTS) - STREAK_SPOTS;
    for (var turn = 0u; turn < points.y; turn += 1u) {
        let k = select(points.x + turn - past, turn, turn < past);
        let number = f32(k) + 0.5;
        let steps = vec3f(1.0 / f32(STREAK_SPOTS), STREAK_SPOT_ALONG, STREAK_SPOT_LATER);
        let point = fract(number * steps + shift);
        let position = vec3f(point.xy - 0.5, later + (point.z - 0.5) * span);
        let apart = streak_light_direction(ray, position) - lamp;
        let off = sqrt(dot(apart, apart));
        if off < wide + edge {
            // A disk, or a spot that fades toward its edge.
            let soft = clamp(0.5 + 0.5 * (wide - off) / max(edge, STREAK_SPOT_EDGE), 0.0, 1.0);
            let faded = select(soft, 2.0 * (1.0 - off * off / (wide * wide)), spot > reach);
            let part = min(u32(point.x * f32(cell.fine)), cell.fine - 1u);
            let along = streak_cell_slope(f32(cell.tap) + point.y, cell.columns);
            let across = streak_cell_slope(f32(cell.column) + point.x, cell.columns);
            // Chords are the shorter the farther out, and columns stand the closer.
            let density = along * across * across;
            spots[part] += radiance * faded * density * streak_light_fraction(ray, position);
        }
    }
    let count = cell.columns * cell.fine;
    // Half the length of a chord is 1.
    let length = STREAK_QUARTER / f32(cell.columns);
    for (var part = 0u; part < cell.fine; part += 1u) {
        spots[part] *= length / streak_cell_weight(cell.column * cell.fine + part, count);
    }
    return spots;
}

// From the eye to a drop's middle at a time, of length 1.
fn streak_light_view(drop: ScreenDrop, row: f32) -> vec3f {
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let middle = streak_path_instant(drop, row).middle;
    return normalize(drop.towards + right * middle.x + up * middle.y);
}

// Which of its lamps light a streak: a bit for each.
fn streak_light_lit(first_lamp: u32) -> u32 {
    var lit = 0u;
    for (var k = 0u; k < STREAK_LAMPS; k += 1u) {
        lit |= select(0u, 1u << k, streak_light_lamps[first_lamp + 1u + 2u * k].w != 0.0);
    }
    return lit;
}

// Mean radiance of the lamps over all directions.
fn streak_light_even(first_lamp: u32, lit: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var rest = lit; rest > 0u; rest &= rest - 1u) {
        let lamp = streak_light_lamps[first_lamp + 1u + 2u * firstTrailingBit(rest)];
        if lamp.w > 0.0 {
            sum += lamp.rgb;
        }
    }
    return sum * (0.125 / STREAK_QUARTER);
}

// Light of the lamps in the form of Rousseau 2006 where a ray meets the drop: by the normal there, which halves the angle between
// the eye and what is mirrored.
fn streak_light_facing(path: StreakPath, first_lamp: u32, lit: u32, view: vec3f, row: i32, column: i32, tap: i32) -> vec3f {
    var sum = vec3f(0.0);
    for (var rest = lit; rest > 0u; rest &= rest - 1u) {
        let k = firstTrailingBit(rest);
        let lamp = streak_light_lamps[first_lamp + 1u + 2u * k];
        if lamp.w >= 0.0 {
            continue;
        }
        let mirrored = streak_light_exit(path, row, column, tap, 0u).direction - view;
        let normal = mirrored / sqrt(max(dot(mirrored, mirrored), DROP_GLINT_TINY));
        let towards = streak_light_lamps[first_lamp + 2u + 2u * k].xyz;
        sum += lamp.rgb * max(drop_glint_rousseau(normal, -view, towards, drops_frame.light_terms), 0.0);
    }
    return sum;
}

// The light of one column of a row of the profile, written part by part.
fn streak_light_column(path_index: u32, row: u32, column: u32) {
    let path = streak_light_paths[path_index];
    let drop = streak_light_drops[path.drop];
    let rays_per_row = f32(path.rows - 1u) / f32(path.profile_rows - 1u);
    let at = f32(row) * rays_per_row;
    let nearest = min(u32(at + 0.5), path.rows - 1u);
    let later = at - f32(nearest);
    let first_lamp = path_index * (1u + 2u * STREAK_LAMPS);
    let fine = path.fine;
    let none = streak_light_lamps[first_lamp].rgb;
    let lit = streak_light_lit(first_lamp);
    let lost = drops_capture_texel(drops_frame.capture_last, 0, 0) + streak_light_even(first_lamp, lit);
    let view = streak_light_view(drop, f32(row) / f32(path.profile_rows - 1u));
    var sums = array<vec3f, 4>(vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0));
    let per_part = path.columns / STREAK_SUMS;
    let first_light = path.first_entry + 1u + path.rows * path.columns;
    for (var tap = 0u; tap < path.columns; tap += 1u) {
        let low = streak_cell_position(f32(tap), path.columns);
        let high = streak_cell_position(f32(tap + 1u), path.columns);
        let weight = 0.5 * (high - low);
        let number = f32((row * path.columns + column) * path.columns + tap);
        let shift = fract(number * vec3f(STREAK_SPOT_FIRST, STREAK_SPOT_SECOND, STREAK_SPOT_THIRD));
        let cell = StreakCell(column, tap, path.columns, fine);
        var even = none + streak_light_facing(path, first_lamp, lit, view, i32(nearest), i32(column), i32(tap));
        var seen = vec3f(0.0);
        var rest = 1.0;
        for (var exit = 0u; exit <= STREAK_EXITS; exit += 1u) {
            let here = streak_light_exit(path, i32(nearest), i32(column), i32(tap), exit);
            if here.passed == 0u {
                continue;
            }
            let ray = streak_light_patch(path, i32(nearest), i32(column), i32(tap), exit, here);
            let fraction = clamp(ray.middle.fraction + ray.later.fraction * later, 0.0, 1.0);
            rest -= fraction;
            // The papers' form has what comes through, undimmed, and nothing else.
            let shown = select(fraction, select(0.0, 1.0, exit == 1u), drops_frame.form == DROPS_SHIFT);
            let size = streak_light_size(ray, later);
            let width = max(sqrt(size.x * size.y), STREAK_NARROWEST * max(size.x, size.y));
            let direction = streak_light_direction(ray, vec3f(0.0, 0.0, later));
            let all = size.x + size.y + sqrt(dot(ray.later.first, ray.later.first)) * rays_per_row;
            let spot = streak_light_radius(size);
            seen += drops_capture_about(drop.towards, direction, width) * shown;
            for (var left = lit; left > 0u; left &= left - 1u) {
                let k = firstTrailingBit(left);
                let lamp = streak_light_lamps[first_lamp + 1u + 2u * k];
                if lamp.w <= 0.0 {
                    continue;
                }
                let towards = streak_light_lamps[first_lamp + 2u + 2u * k].xyz;
                let near = max(lamp.w + 0.5 * spot, spot) + STREAK_SPOT_REACH * all;
                let apart = direction - towards;
                if dot(apart, apart) > near * near {
                    continue;
                }
                let spots = streak_light_spot(ray, later, rays_per_row, all, spot, towards, lamp.w, cell, shift);
                for (var part = 0u; part < fine; part += 1u) {
                    sums[part] += lamp.rgb * spots[part];
                }
            }
        }
        // Between rows fractions may sum to a little more than all.
        let whole = select(max(1.0 - rest, 1.0), 1.0, drops_frame.form == DROPS_SHIFT);
        even += seen / whole + lost * select(max(rest, 0.0), 0.0, drops_frame.form == DROPS_SHIFT);
        for (var part = 0u; part < fine; part += 1u) {
            sums[part] += even * weight;
        }
        if (tap + 1u) % per_part == 0u {
            let sum = (tap + 1u) / per_part - 1u;
            for (var part = 0u; part < fine; part += 1u) {
                let cell = (row * path.columns + column) * fine + part;
                streak_light_table[first_light + cell * STREAK_SUMS + sum] = vec4f(sums[part], 0.0);
            }
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_streak_light(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    let job = group.y * groups.x + group.x;
    if job >= streak_light_jobs[0].x {
        return;
    }
    let path = streak_light_jobs[1u + job].x;
    let unit = streak_light_jobs[1u + job].y + index;
    let columns = streak_light_paths[path].columns;
    if unit < columns * streak_light_paths[path].profile_rows {
        streak_light_column(path, unit / columns, unit % columns);
    }
}
