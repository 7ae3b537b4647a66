// The streak radiance table: what moving drops show, averaged beforehand.
// Law: the light that a passing drop shows a pixel is a mean over a curve of directions: over the chord of its outline that the
// pixel's ray passes. For a streak that is sampled in its pixels it stands in the streak's own profile (streak_rays.wgsl,
// streak_light.wgsl), as a running sum along the chord, of which an interior pixel needs the last and a streak's end the
// difference of two. Of drops that are not sampled one mean for each class of sizes is kept, for a lattice of rays.
// Layout: the means, by class, row and column of the ray; then the profiles.
// Twin: downpour_render::rain::streak_lookup.

@group(0) @binding(7) var<storage, read> streak_table: array<vec4f>;

// Position in the profile of a drop at which a ray passes it.
struct StreakPassage {
    // First entry of the profile, and its sizes: rows and columns of chords, rows of the profile and fine columns of each.
    first: u32,
    rows: u32,
    columns: u32,
    profile_rows: u32,
    fine: u32,
    // Fraction of the rows before the time at which the drop is nearest.
    row: f32,
    // Position across the outline in fractions of its columns, 0 to 1.
    across: f32,
    // The part of the chord that passes during the exposure, -1 to 1; none if `high` is not above `low`.
    low: f32,
    high: f32,
    // Fraction of the exposure in which the whole chord would pass, by the weight in the middle of the part that does.
    fraction: f32,
}

// The chords between columns of a row: middle and half of the outline's width, middle and half of the chord.
fn streak_lookup_chord(first: u32, columns: u32, row: u32, at: f32) -> vec4f {
    let low = min(u32(at), columns - 2u);
    let part = at - f32(low);
    let entry = first + 1u + row * columns + low;
    return streak_table[entry] * (1.0 - part) + streak_table[entry + 1u] * part;
}

// Returns the position in a drop's profile for a point of the plane.
fn streak_lookup_passage(drop: ScreenDrop, at: vec2f) -> StreakPassage {
    let first = drop.profile;
    let sizes = vec4u(streak_table[first]);
    let span = streak_span(drop);
    let moves = max(sqrt(dot(drop.along, drop.along)), 1.0e-20);
    let nearest = dot(at - drop.start, drop.along) / (moves * moves);
    let way = clamp(nearest, -span.before, 1.0 + span.after);
    let time = streak_time(drop.depth_ratio, way);
    let scale = drop.slope / streak_depth(drop.depth_ratio, time);
    let path = drop.along / moves;
    let offset = (at - drop.start - drop.along * way) / scale;
    let aside = offset.x * path.y - offset.y * path.x;
    let ahead = dot(offset, path);
    let fraction = clamp((time - span.first) / (span.last - span.first), 0.0, 1.0);
    let row_at = fraction * f32(sizes.x - 1u);
    let row = min(u32(row_at), sizes.x - 2u);
    let row_part = row_at - f32(row);
    let width = streak_table[first + 1u + row * sizes.y].xy * (1.0 - row_part)
        + streak_table[first + 1u + (row + 1u) * sizes.y].xy * row_part;
    let position = (aside - width.x) / max(width.y, 1.0e-6);
    let across = streak_cell_index(position, 1u);
    let column_at = clamp(across * f32(sizes.y) - 0.5, 0.0, f32(sizes.y - 1u));
    let chord = streak_lookup_chord(first, sizes.y, row, column_at) * (1.0 - row_part)
        + streak_lookup_chord(first, sizes.y, row + 1u, column_at) * row_part;
    let half = chord.w * sqrt(max(1.0 - position * position, 0.0));
    let per_half = 1.0 / max(half, 1.0e-6);
    let faster = way + (1.0 - way) * drop.depth_ratio;
    // Time in which it moves by an equivalent radius.
    let pace = drop.depth_ratio / max(faster * faster, 1.0e-12) * scale / moves;
    let low = max(((ahead - chord.z) - (1.0 - time) / pace) * per_half, -1.0);
    let high = select(min(((ahead - chord.z) + time / pace) * per_half, 1.0), -2.0, half <= 1.0e-6);
    let middle = time + ((ahead - chord.z) - 0.5 * half * (low + high)) * pace;
    let weight = streak_weight(drop.weights, middle);
    return StreakPassage(
        first,
        sizes.x,
        sizes.y,
        sizes.z,
        sizes.w,
        fraction,
        across,
        low,
        high,
        2.0 * half * pace * drop.fraction * weight,
    );
}

// A running sum of a row of a profile, between its fine columns; sum 0 is nothing.
fn streak_lookup_column(passage: StreakPassage, row: u32, sums: u32) -> vec3f {
    if sums == 0u {
        return vec3f(0.0);
    }
    let columns = passage.columns * passage.fine;
    let at = clamp(passage.across * f32(columns) - 0.5, 0.0, f32(columns - 1u));
    let low = min(u32(at), columns - 2u);
    let part = at - f32(low);
    let chords = passage.first + 1u + passage.rows * passage.columns;
    let entry = chords + (row * columns + low) * STREAK_SUMS + sums - 1u;
    return streak_table[entry].rgb * (1.0 - part) + streak_table[entry + STREAK_SUMS].rgb * part;
}

// The same between rows.
fn streak_lookup_sum(passage: StreakPassage, sums: u32) -> vec3f {
    let at = passage.row * f32(passage.profile_rows - 1u);
    let low = min(u32(at), passage.profile_rows - 2u);
    let part = at - f32(low);
    return streak_lookup_column(passage, low, sums) * (1.0 - part)
        + streak_lookup_column(passage, low + 1u, sums) * part;
}

// The running sum up to a position on the chord, -1 to 1.
fn streak_lookup_until(passage: StreakPassage, position: f32) -> vec3f {
    let at = streak_cell_index(position, STREAK_SUMS);
    let low = min(u32(at), STREAK_SUMS - 1u);
    // By length: in a uniform environment light is proportional to coverage.
    let first = streak_cell_position(f32(low), STREAK_SUMS);
    let length = streak_cell_position(f32(low + 1u), STREAK_SUMS) - first;
    let part = clamp((position - first) / length, 0.0, 1.0);
    return streak_lookup_sum(passage, low) * (1.0 - part) + streak_lookup_sum(passage, low + 1u) * part;
}

// A streak at a position of the plane: radiance times the fraction of the exposure in which it is covered, and this fraction.
fn streak_lookup_shown(drop: ScreenDrop, at: vec2f) -> vec4f {
    let passage = streak_lookup_passage(drop, at);
    if passage.high <= passage.low {
        return vec4f(0.0);
    }
    var light = vec3f(0.0);
    if passage.low <= -1.0 && passage.high >= 1.0 {
        light = streak_lookup_sum(passage, STREAK_SUMS);
    } else {
        light = streak_lookup_until(passage, passage.high) - streak_lookup_until(passage, passage.low);
    }
    return vec4f(light, (passage.high - passage.low) * 0.5) * passage.fraction;
}

// The mean radiance of a whole drop of a class. `position` is in [0, 1] from the top left of the picture.
fn streak_lookup_mean(shape: u32, position: vec2f) -> vec3f {
    let at = clamp(position, vec2f(0.0), vec2f(1.0)) * f32(STREAK_RAYS - 1u);
    let low = min(vec2u(at), vec2u(STREAK_RAYS - 2u));
    let part = at - vec2f(low);
    let entry = (shape * STREAK_RAYS + low.y) * STREAK_RAYS + low.x;
    let upper = streak_table[entry].rgb * (1.0 - part.x) + streak_table[entry + 1u].rgb * part.x;
    let lower = streak_table[entry + STREAK_RAYS].rgb * (1.0 - part.x)
        + streak_table[entry + STREAK_RAYS + 1u].rgb * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}
