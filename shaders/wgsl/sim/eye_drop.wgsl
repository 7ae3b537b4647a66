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
    // Terminal speed, m/s; 0 (FIELD_BOUNCED) for a droplet that rebounded, FIELD_DRIPPED for a drop that drips; of a splash the normal of its
    // surface (eye_drop_standing), which is FIELD_SPLASH or below.
    speed: f32,
    // Lower half of its id.
    id_low: u32,
}

// The normal of a surface that does not look down, as a whole number of FIELD_SPLASH or below: two numbers of the upper half of an
// octahedron, unfolded.
fn eye_drop_standing(normal: vec3f) -> f32 {
    let steps = f32(FIELD_NORMAL_STEPS);
    let size = max(abs(normal.x) + abs(normal.y) + abs(normal.z), 1.0e-20);
    let first = clamp((normal.x + normal.z) / size, -1.0, 1.0);
    let second = clamp((normal.x - normal.z) / size, -1.0, 1.0);
    return FIELD_SPLASH - ((floor(first * steps + 0.5) + steps) * (2.0 * steps + 1.0) + floor(second * steps + 0.5) + steps);
}

// The normal of the surface on which a splash stands.
fn eye_drop_normal(speed: f32) -> vec3f {
    let width = 2u * FIELD_NORMAL_STEPS + 1u;
    let code = u32(max(FIELD_SPLASH - speed, 0.0));
    let first = (f32(code / width) - f32(FIELD_NORMAL_STEPS)) / f32(FIELD_NORMAL_STEPS);
    let second = (f32(code % width) - f32(FIELD_NORMAL_STEPS)) / f32(FIELD_NORMAL_STEPS);
    let x = 0.5 * (first + second);
    let z = 0.5 * (first - second);
    let normal = vec3f(x, max(1.0 - abs(x) - abs(z), 0.0), z);
    return normal / sqrt(dot(normal, normal));
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
