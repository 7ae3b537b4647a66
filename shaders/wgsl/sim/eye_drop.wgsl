// A drop relative to the eye.
// Twin: downpour_sim::field::EyeDrop.

struct EyeDrop {
    // At the time of the picture, or where it would be then, m.
    offset: vec3f,
    // Diameter, m; 0 for an empty place in a list.
    diameter: f32,
    // m/s.
    velocity: vec3f,
    // Both halves of its id, one over the other: 32 bits from which its oscillation is drawn.
    id: u32,
    // When it is there, s from the time of the picture.
    present: vec2f,
    // Terminal speed, m/s; below 0 (FIELD_SPLASH) for a splash, 0 (FIELD_BOUNCED) for a droplet that rebounded.
    speed: f32,
    // Lower half of its id.
    id_low: u32,
}

// A vector turned about an axis by the axis's length, in radians.
fn eye_drop_turned(v: vec3f, axis: vec3f) -> vec3f {
    let angle = sqrt(dot(axis, axis));
    if angle < 1.0e-9 {
        return v;
    }
    let unit = axis / angle;
    return v * cos(angle) + cross(unit, v) * sin(angle) + unit * (dot(unit, v) * (1.0 - cos(angle)));
}

// Position relative to an eye that moves and turns, at a time relative to the picture's, s.
fn eye_drop_position(drop: EyeDrop, velocity: vec3f, turning: vec3f, time: f32) -> vec3f {
    return eye_drop_turned(drop.offset + (drop.velocity - velocity) * time, turning * -time);
}

// Part of the exposure, s from its middle, in which a drop is beyond a pane, from its distances beyond it at the begin and the end, m;
// the first time is above the last if it never is.
fn eye_drop_outside(begin: f32, end: f32, half_time: f32) -> vec2f {
    var part = vec2f(-FIELD_ALWAYS, FIELD_ALWAYS);
    if begin < 0.0 && end < 0.0 {
        return -part;
    }
    let crossing = half_time * ((begin + end) / max(abs(begin - end), 1.0e-30));
    if begin < 0.0 {
        part.x = -crossing;
    }
    if end < 0.0 {
        part.y = crossing;
    }
    return part;
}
