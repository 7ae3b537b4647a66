// A drop that moves while the shutter is open: which part of the exposure a ray passes it, and where.
// Geometry: on the plane through the drop's middle at mid-exposure, at distance 1 across the direction to it, straight
// paths are straight lines; a drop that comes nearer grows and is faster. A drop's outline lies within an oval, which the
// oscillation stretches: left and right each by the mode's radius there, up and down by that of the poles. While a drop
// passes a ray, which takes some tenths of a millisecond, its shape stands still.
// Law: a ray that meets the oval's chord of half length h at the speed s is covered for 2 h / s of the exposure, so the
// light that a drop takes out does not depend on how it is sampled. Where light of earlier moments weighs less, the fraction is
// multiplied by the weight in the middle of the time in which the ray is covered: exact for a drop that keeps its depth, since weights
// are straight lines.
// Source: Rousseau 2006, section 5; Rousseau 2008, section 2.2.3 (oscillation, left and right with phi + pi).
// Twin: downpour_render::rain::streak.

// A drop on the picture.
struct ScreenDrop {
    // From the eye to the drop's middle, of length 1.
    towards: vec3f,
    // Meters from the eye.
    distance: f32,
    // Position of the middle on the picture, pixels from the top left.
    position: vec2f,
    // Equivalent radius over distance.
    slope: f32,
    // Half the width of its mask, in equivalent radii.
    half_extent: f32,
    // Index of its mask, fractional: diameter, elevation.
    mask_index: vec2f,
    // Area on the picture, pixels.
    area: f32,
    // Samples along an edge of a pixel; of a streak: samples of a pixel. 0: below a pixel, or out of focus.
    grid: u32,
    // Position when the exposure begins, and displacement until it ends: on the plane at distance 1, along the right and up of the
    // drop's view.
    start: vec2f,
    along: vec2f,
    // The same on the picture, pixels.
    first: vec2f,
    screen_delta: vec2f,
    // Half the width and half the height of the oval, and how far its middle is up, in equivalent radii.
    oval: vec3f,
    // Depth at the end over that at the beginning.
    depth_ratio: f32,
    // Amplitudes of the modes (2,0) and (3,1), the latter times the cosine of its azimuth, and phases at the beginning, in
    // turns.
    mode_phase: vec4f,
    // Turns of both modes until the end; of a splash its own turn on the picture (project_turn).
    cycles: vec2f,
    // Fraction of the exposure in which it is before the eye.
    fraction: f32,
    // Width over which a drop that is not sampled is spread, pixels.
    spread: f32,
    // No part of it is nearer, m.
    nearest: f32,
    // DROPS_STILL, DROPS_TABLE or DROPS_LOOP.
    kind: u32,
    // Index of its mean in the streak radiance table.
    shape: u32,
    // First entry of its profile in the table.
    profile: u32,
    // Weight of the light at the beginning and at the end of its way; over the whole exposure the mean weight is 1.
    weights: vec2f,
    // Largest distance from its path that it covers, pixels.
    reach: f32,
    // Its id in 32 bits.
    id: u32,
}

// True for a streak that covers so little of each pixel, and is so narrow, that it is summed up (drops_sum.wgsl).
fn streak_is_summed(drop: ScreenDrop) -> bool {
    let across = 2.0 * drop.slope * max(drop.weights.x, drop.weights.y);
    let most = select(STREAK_SUM_COVER, STREAK_SUM_THIN, drop.grid == 0u);
    let covers = across * across <= most * most * dot(drop.along, drop.along);
    return drop.kind != DROPS_STILL && drop.reach > 0.0 && drop.reach <= STREAK_SUM_REACH && covers;
}

// First and last column (or row) of those within a range of pixels, from 0; (1, 0): there is none.
fn streak_pixels(low: f32, high: f32, count: u32) -> vec2u {
    let first = floor(low);
    let last = ceil(high) - 1.0;
    let limit = f32(count);
    if last >= 0.0 && first < limit && first <= last {
        return vec2u(u32(clamp(first, 0.0, limit - 1.0)), u32(clamp(last, 0.0, limit - 1.0)));
    }
    return vec2u(1u, 0u);
}

// Chord along which a ray passes a moving drop.
struct StreakChord {
    // Unit direction of the motion on the oval, which is a circle of radius 1 here.
    direction: vec2f,
    // Position of the chord across the motion, -1 to 1.
    across: f32,
    // Half its length.
    half: f32,
    // The part of it that passes during the exposure, in units of `half`; none if `high` is not above `low`.
    low: f32,
    high: f32,
    // Fraction of the exposure in which the whole chord would pass, by weight.
    fraction: f32,
    // Fraction of the exposure in which it moves by an equivalent radius, by weight.
    pace: f32,
    // Weights of the light at `low` and at `high`.
    weights: vec2f,
    // Position of the ray across the path, in equivalent radii.
    aside: f32,
    // Unit direction of the motion.
    path: vec2f,
}

// The time, as a fraction of the exposure, at which the drop is at a fraction of its way on the picture.
fn streak_time(depth_ratio: f32, way: f32) -> f32 {
    return way / max(way + (1.0 - way) * depth_ratio, 1.0e-20);
}

// Weight of the light at a time, 0 to 1, by the weights at the beginning and at the end of the way.
fn streak_weight(weights: vec2f, time: f32) -> f32 {
    return weights.x + (weights.y - weights.x) * clamp(time, 0.0, 1.0);
}

// The fraction of the way that is nearest to a position on the plane.
fn streak_nearest(drop: ScreenDrop, at: vec2f) -> f32 {
    return clamp(dot(at - drop.start, drop.along) / max(dot(drop.along, drop.along), 1.0e-20), 0.0, 1.0);
}

// The depth at a time, over that in the middle of the exposure.
fn streak_depth(depth_ratio: f32, time: f32) -> f32 {
    return (1.0 + (depth_ratio - 1.0) * time) * 2.0 / (1.0 + depth_ratio);
}

// Scales of the oval at a time: width on the right and on the left, and height.
fn streak_stretch(mode_phase: vec4f, turns: vec2f, time: f32) -> vec3f {
    let s2 = mode_phase.x * drop_oscillation_sine(mode_phase.z + turns.x * time);
    let s3 = mode_phase.y * drop_oscillation_sine(mode_phase.w + turns.y * time);
    let state = drop_oscillation_state(vec2f(s2, s3));
    return vec3f(drop_oscillation_outline(state, 1.0), drop_oscillation_radius(state, 1.0, 0.0));
}

// Returns the chord along which a ray through a point of the plane passes the drop.
fn streak_chord(drop: ScreenDrop, at: vec2f) -> StreakChord {
    let way = streak_nearest(drop, at);
    let time = streak_time(drop.depth_ratio, way);
    let scale = drop.slope / streak_depth(drop.depth_ratio, time);
    let stretch = streak_stretch(drop.mode_phase, drop.cycles, time);
    let offset = (at - drop.start - drop.along * way) / scale;
    let side = select(stretch.x, stretch.y, offset.x < 0.0);
    let oval = vec2f(drop.oval.x * side, drop.oval.y * stretch.z);
    let on_oval = (offset - vec2f(0.0, drop.oval.z * stretch.z)) / oval;
    let moved = drop.along / (scale * oval);
    let length = max(sqrt(dot(moved, moved)), 1.0e-12);
    let direction = moved / length;
    let across = on_oval.x * direction.y - on_oval.y * direction.x;
    let along = dot(on_oval, direction);
    let half = sqrt(max(1.0 - across * across, 0.0));
    let per_half = 1.0 / max(half, 1.0e-6);
    let faster = way + (1.0 - way) * drop.depth_ratio;
    let rate = drop.fraction * drop.depth_ratio / max(faster * faster, 1.0e-12);
    let moves = max(sqrt(dot(drop.along, drop.along)), 1.0e-20);
    let path = drop.along / moves;
    let low = max((along - length * (1.0 - way)) * per_half, -1.0);
    let high = select(min((along + length * way) * per_half, 1.0), -2.0, half <= 1.0e-6);
    // Points ahead on the chord have passed earlier.
    let begin = streak_time(drop.depth_ratio, clamp(way + (along - half * high) / length, 0.0, 1.0));
    let end = streak_time(drop.depth_ratio, clamp(way + (along - half * low) / length, 0.0, 1.0));
    let weights = vec2f(streak_weight(drop.weights, end), streak_weight(drop.weights, begin));
    let weight = 0.5 * (weights.x + weights.y);
    return StreakChord(
        direction,
        across,
        half,
        low,
        high,
        2.0 * half / length * rate * weight,
        rate * scale / moves * weight,
        weights,
        offset.x * path.y - offset.y * path.x,
        path,
    );
}

// Position in the mask, in units of half its width, of a position on a chord, in units of half its length.
fn streak_mask_position(drop: ScreenDrop, chord: StreakChord, v: f32) -> vec2f {
    let away = vec2f(chord.direction.y, -chord.direction.x);
    let at = (away * chord.across + chord.direction * (v * chord.half)) * drop.oval.xy;
    return (at + vec2f(0.0, drop.oval.z)) / drop.half_extent;
}

// The fraction of a pixel's width that a box of some width (1 or more), `off` pixels from the pixel's middle, covers, over that
// width: over all pixels it is 1.
fn streak_box(width: f32, off: f32) -> f32 {
    return clamp((width + 1.0) * 0.5 - abs(off), 0.0, 1.0) / width;
}

// Both edges, as fractions of the way, of where a path is less than `reach` from 0.
fn streak_within(begin: f32, way: f32, reach: f32) -> vec2f {
    if abs(way) < 1.0e-6 {
        return select(vec2f(2.0, -1.0), vec2f(0.0, 1.0), abs(begin) < reach);
    }
    let a = (-reach - begin) / way;
    let b = (reach - begin) / way;
    return vec2f(min(a, b), max(a, b));
}

// The mean of the box over a path, by the weights of its light: exact, by pieces in which both edges are straight.
fn streak_mean(begin: vec2f, way: vec2f, width: f32, weights: vec2f) -> f32 {
    let outer_x = streak_within(begin.x, way.x, (width + 1.0) * 0.5);
    let outer_y = streak_within(begin.y, way.y, (width + 1.0) * 0.5);
    let low = max(max(outer_x.x, outer_y.x), 0.0);
    let high = min(min(outer_x.y, outer_y.y), 1.0);
    if high <= low {
        return 0.0;
    }
    let inner_x = streak_within(begin.x, way.x, (width - 1.0) * 0.5);
    let inner_y = streak_within(begin.y, way.y, (width - 1.0) * 0.5);
    // Edges of pieces, in order: two pairs, each in order, merged.
    let x = clamp(inner_x, vec2f(low), vec2f(high));
    let y = clamp(inner_y, vec2f(low), vec2f(high));
    let first = min(min(x.x, x.y), min(y.x, y.y));
    let last = max(max(x.x, x.y), max(y.x, y.y));
    let starts = max(min(x.x, x.y), min(y.x, y.y));
    let ends = min(max(x.x, x.y), max(y.x, y.y));
    var edges = array<f32, 6>(low, first, min(starts, ends), max(starts, ends), last, high);
    var sum = 0.0;
    for (var k = 0u; k < 5u; k += 1u) {
        let middle = (edges[k] + edges[k + 1u]) * 0.5;
        let reach = (edges[k + 1u] - edges[k]) * 0.5;
        // Gauss's two points are exact for cubics.
        for (var side = -1.0; side < 2.0; side += 2.0) {
            let time = middle + side * reach * STREAK_GAUSS;
            let at = begin + way * time;
            sum += streak_box(width, at.x) * streak_box(width, at.y) * reach * streak_weight(weights, time);
        }
    }
    return sum;
}

// The fraction of a pixel that a drop which is not sampled covers, by weight.
fn streak_cover(drop: ScreenDrop, x: u32, y: u32) -> f32 {
    let begin = drop.first - vec2f(f32(x) + 0.5, f32(y) + 0.5);
    return min(drop.area * drop.fraction * streak_mean(begin, drop.screen_delta, drop.spread, drop.weights), 1.0);
}
