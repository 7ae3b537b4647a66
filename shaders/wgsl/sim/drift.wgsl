// Table of the drift of drops by terminal speed.
// Twin: downpour_sim::drift.

// Position of a terminal speed in the table: the entry below, and the fraction of the distance to the next.
fn drift_position(speed: f32) -> vec2f {
    let at = clamp(speed * (f32(FIELD_DRIFT) / FIELD_DRIFT_SPEED), 0.0, f32(FIELD_DRIFT));
    let low = min(floor(at), f32(FIELD_DRIFT - 1u));
    return vec2f(low, at - low);
}
