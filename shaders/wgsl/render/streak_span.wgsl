// The part of a streak's path on which its profile stands.
// Geometry: the ray of a pixel stands still while the drop passes it, so it meets the drop along a line of parallel rays. Of each
// pixel the profile has the row at whose time the drop is nearest to the ray: so its path is longer than that of the exposure, by as
// much as the drop has ahead and behind. A drop that comes nearer or goes away grows or shrinks meanwhile, and in its frame the
// pixels' lines come together like a funnel.
// Limits: where the drop moves along the line of sight, the path would begin or end at infinity. Its length is limited there, and
// the rays are the less parallel, the shorter it is: at last they are those of the eye at one instant.
// Twin: downpour_render::rain::streak_span.

// Path of a streak's profile, and how rays go through its drop.
struct StreakSpan {
    // Fractions of the path by which it is longer at either end.
    before: f32,
    after: f32,
    // Times of its ends: at most 0, and 1 or more.
    first: f32,
    last: f32,
    // 1: the rays of a chord are those of one pixel, which are parallel; 0: those of one instant.
    parallel: f32,
    // Growth of a ray's distance from the path per equivalent radius that the drop has ahead of the ray.
    funnel: f32,
}

// The span of a streak.
fn streak_span(drop: ScreenDrop) -> StreakSpan {
    let ratio = max(drop.depth_ratio, 1.0e-6);
    let moves = max(sqrt(dot(drop.along, drop.along)), 1.0e-20);
    // An equivalent radius when the exposure begins.
    let radius = drop.slope * (1.0 + ratio) * 0.5 / moves;
    let wanted = max(drop.half_extent * radius, 1.0e-6);
    let least = min(STREAK_SPAN_ROOM * ratio / max(1.0 - ratio, 1.0e-6), STREAK_SPAN_MAX);
    let most = min(STREAK_SPAN_ROOM / max(ratio - 1.0, 1.0e-6), STREAK_SPAN_MAX);
    let parallel = min(min(least / wanted, most / (wanted / ratio)), 1.0);
    let before = wanted * parallel;
    let after = wanted / ratio * parallel;
    return StreakSpan(
        before,
        after,
        streak_time(ratio, -before),
        streak_time(ratio, 1.0 + after),
        parallel,
        parallel * radius * (1.0 - ratio) / ratio,
    );
}

// Time of a row of a profile, by the fraction of the rows before it.
fn streak_span_time(span: StreakSpan, row: f32) -> f32 {
    return span.first + (span.last - span.first) * row;
}
