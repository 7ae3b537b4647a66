// Makes the streak radiance table of a frame (streak_lookup.wgsl says what is in it).
// Law: midpoints along each chord, by parts, each the work of one invocation; the same samples as a streak that is averaged by a loop, at the lattice's rays.
// Twin: downpour_render::rain::streak_table.

// Drops of about one size.
struct StreakShape {
    // Mean velocity relative to the picture, m/s.
    velocity: vec3f,
    // Row of their diameter in the masks.
    row: f32,
    // Half the width of their mask, in equivalent radii.
    half_extent: f32,
    // What is wanted of them: nothing, their mean (STREAK_MEAN), or chords, too (STREAK_CHORDS).
    wanted: u32,
    unused: vec2u,
    // For each elevation: half the width and half the height of the oval, and how far its middle is up.
    ovals: array<vec4f, DROPS_ELEVATIONS>,
}

@group(0) @binding(3) var<storage, read> streak_shapes: array<StreakShape>;
@group(0) @binding(4) var<storage, read_write> streak_made: array<vec2u>;

// The row of elevations of a ray of length 1.
fn streak_table_elevation(row: f32, towards: vec3f) -> f32 {
    let half = f32(DROPS_ELEVATIONS - 1u) * 0.5;
    // A sphere is the same from everywhere.
    let turned = clamp((asin(clamp(-towards.y, -1.0, 1.0)) * STREAK_PER_QUARTER + 1.0) * half, 0.0, 2.0 * half);
    return select(turned, half, row == 0.0);
}

// The oval between elevations.
fn streak_table_oval(shape: u32, elevation: f32) -> vec3f {
    let low = min(u32(elevation), DROPS_ELEVATIONS - 2u);
    let part = elevation - f32(low);
    return (streak_shapes[shape].ovals[low] * (1.0 - part) + streak_shapes[shape].ovals[low + 1u] * part).xyz;
}

// The direction of the motion on the oval.
fn streak_table_direction(right: vec3f, up: vec3f, velocity: vec3f, oval: vec3f) -> vec2f {
    let moved = vec2f(dot(velocity, right), dot(velocity, up)) / oval.xy;
    let length = sqrt(dot(moved, moved));
    return select(vec2f(0.0, -1.0), moved / max(length, 1.0e-20), length > 1.0e-6);
}

// Writes an entry.
fn streak_table_write(shape: u32, across: u32, ray: u32, sums: u32, value: vec4f) {
    let at = ((shape * (STREAK_ACROSS + 1u) + across) * STREAK_RAYS * STREAK_RAYS + ray) * STREAK_SUMS + sums;
    let kept = min(value, vec4f(STREAK_BRIGHTEST));
    streak_made[at] = vec2u(pack2x16float(kept.xy), pack2x16float(kept.zw));
}

// The light of one part of a chord, or of a drop: the sum over its taps.
fn streak_table_part(shape: u32, across_index: u32, ray_index: u32, part: u32) -> vec4f {
    let mean = across_index == STREAK_ACROSS;
    let last = f32(STREAK_RAYS - 1u);
    let column = f32(ray_index % STREAK_RAYS) / last;
    let line = f32(ray_index / STREAK_RAYS) / last;
    let ray = drops_frame_ray(column * f32(drops_frame.width), line * f32(drops_frame.height));
    let towards = drops_mask_unit(ray);
    let right = drops_mask_right(towards);
    let up = cross(right, towards);
    let row = streak_shapes[shape].row;
    let elevation = streak_table_elevation(row, towards);
    let oval = streak_table_oval(shape, elevation);
    let extent = streak_shapes[shape].half_extent;
    let direction = streak_table_direction(right, up, streak_shapes[shape].velocity, oval);
    let taps = select(STREAK_TAPS, STREAK_MEAN_GRID * STREAK_MEAN_GRID, mean) / STREAK_SUMS;
    let across = (f32(across_index) + 0.5) * (2.0 / f32(STREAK_ACROSS)) - 1.0;
    let half = sqrt(max(1.0 - across * across, 0.0));
    let spacing = select(2.0 * oval.x / f32(STREAK_FINE), 2.0 * oval.x / f32(STREAK_MEAN_GRID), mean);
    let drop = DropsShade(towards, extent, vec3f(0.0), spacing, vec2f(row, elevation));
    var sum = vec4f(0.0);
    for (var tap = part * taps; tap < (part + 1u) * taps; tap += 1u) {
        let v = (f32(tap) + 0.5) * (2.0 / f32(STREAK_TAPS)) - 1.0;
        var at = vec2f(direction.y, -direction.x) * across + direction * (v * half);
        if mean {
            let cell = vec2f(f32(tap % STREAK_MEAN_GRID), f32(tap / STREAK_MEAN_GRID));
            at = (cell + 0.5) * (2.0 / f32(STREAK_MEAN_GRID)) - 1.0;
        }
        let place = (at * oval.xy + vec2f(0.0, oval.z)) / extent;
        if abs(place.x) < 1.0 && abs(place.y) < 1.0 {
            sum += drops_shade_ray(drop, place.x, place.y);
        }
    }
    return sum;
}

// The parts of the rays of a workgroup, STREAK_SUMS for each.
var<workgroup> streak_table_parts: array<vec4f, 64>;

// One invocation per part of a chord, place across the motion, and shape: the parts of a ray are neighbours.
@compute @workgroup_size(64, 1, 1)
fn main_streak_table(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let part = id.x % STREAK_SUMS;
    let ray = id.x / STREAK_SUMS;
    let mean = id.y == STREAK_ACROSS;
    let wanted = streak_shapes[id.z].wanted >= select(STREAK_CHORDS, STREAK_MEAN, mean);
    let made = wanted && ray < STREAK_RAYS * STREAK_RAYS && id.y <= STREAK_ACROSS;
    if made {
        streak_table_parts[local] = streak_table_part(id.z, id.y, ray, part);
    }
    workgroupBarrier();
    let whole = part + 1u == STREAK_SUMS;
    if !made || (mean && !whole) {
        return;
    }
    var sum = streak_table_parts[local - part];
    for (var k = 1u; k <= part; k += 1u) {
        sum += streak_table_parts[local - part + k];
    }
    let colour = sum.rgb / max(sum.w, 1.0e-20);
    if mean {
        streak_table_write(id.z, id.y, ray, 0u, vec4f(colour, sum.w / max(sum.w, 1.0e-20)));
    } else {
        let share = f32(part + 1u) / f32(STREAK_SUMS);
        streak_table_write(id.z, id.y, ray, part, vec4f(colour, 1.0) * share);
    }
}
