// The streak radiance table: what a moving drop shows along a chord, averaged beforehand.
// Law: for a pixel's ray and a place across the motion, the light that a passing drop shows is a mean over a fixed curve of
// directions, whatever the drop's distance and speed. So it is averaged once per frame for a lattice of rays and places, as
// a running sum along the chord, of which an interior pixel needs the last and a streak's end the difference of two.
// Layout: shape, place across the motion (and, last, the mean over the drop), row and column of the ray, running sum; two
// halves in each word: radiance times coverage, and coverage.
// Twin: downpour_render::rain::streak_lookup.

@group(0) @binding(7) var<storage, read> streak_table: array<vec2u>;

// One entry; running sum 0 is nothing.
fn streak_lookup_entry(shape: u32, across: u32, column: u32, row: u32, sums: u32) -> vec4f {
    if sums == 0u {
        return vec4f(0.0);
    }
    let layer = shape * (STREAK_ACROSS + 1u) + across;
    let entry = streak_table[((layer * STREAK_RAYS + row) * STREAK_RAYS + column) * STREAK_SUMS + sums - 1u];
    return vec4f(unpack2x16float(entry.x), unpack2x16float(entry.y));
}

// Between rays. `place` is in [0, 1] from the top left of the picture.
fn streak_lookup_rays(shape: u32, across: u32, place: vec2f, sums: u32) -> vec4f {
    let at = clamp(place, vec2f(0.0), vec2f(1.0)) * f32(STREAK_RAYS - 1u);
    let low = min(vec2u(at), vec2u(STREAK_RAYS - 2u));
    let part = at - vec2f(low);
    let upper = streak_lookup_entry(shape, across, low.x, low.y, sums) * (1.0 - part.x)
        + streak_lookup_entry(shape, across, low.x + 1u, low.y, sums) * part.x;
    let lower = streak_lookup_entry(shape, across, low.x, low.y + 1u, sums) * (1.0 - part.x)
        + streak_lookup_entry(shape, across, low.x + 1u, low.y + 1u, sums) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// Between places across the motion, -1 to 1.
fn streak_lookup_sum(shape: u32, across: f32, place: vec2f, sums: u32) -> vec4f {
    let at = clamp((across * 0.5 + 0.5) * f32(STREAK_ACROSS) - 0.5, 0.0, f32(STREAK_ACROSS - 1u));
    let low = min(u32(at), STREAK_ACROSS - 2u);
    let part = at - f32(low);
    return streak_lookup_rays(shape, low, place, sums) * (1.0 - part)
        + streak_lookup_rays(shape, low + 1u, place, sums) * part;
}

// The running sum up to a place on the chord, -1 to 1.
fn streak_lookup_until(shape: u32, across: f32, place: vec2f, v: f32) -> vec4f {
    let at = clamp((v * 0.5 + 0.5) * f32(STREAK_SUMS), 0.0, f32(STREAK_SUMS));
    let low = u32(at);
    let part = at - f32(low);
    var sum = streak_lookup_sum(shape, across, place, low) * (1.0 - part);
    if part > 0.0 {
        sum += streak_lookup_sum(shape, across, place, low + 1u) * part;
    }
    return sum;
}

// The part of a chord from `low` to `high`, as a share of what the whole shows.
fn streak_lookup_part(shape: u32, across: f32, place: vec2f, low: f32, high: f32) -> vec4f {
    if low <= -1.0 && high >= 1.0 {
        return streak_lookup_sum(shape, across, place, STREAK_SUMS);
    }
    return streak_lookup_until(shape, across, place, high) - streak_lookup_until(shape, across, place, low);
}

// The mean radiance of a whole drop.
fn streak_lookup_mean(shape: u32, place: vec2f) -> vec3f {
    return streak_lookup_rays(shape, STREAK_ACROSS, place, 1u).rgb;
}
