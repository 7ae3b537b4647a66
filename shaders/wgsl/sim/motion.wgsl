// Motion of a drop in the wind during a step, and its bounce.
//
// The slip between drop and air relaxes: across the fall with v / g, along it with v / 2g, where v is the terminal
// speed. In a constant wind a step of any length is exact. Rousseau 2008 instead averages the velocity with the wind,
// once per step. Twin: downpour_sim::motion.

struct MotionStep {
    // Velocity after the step, m/s.
    velocity: vec3f,
    // Displacement of the drop, m.
    displacement: vec3f,
}

// Diameter from its 16 bits, m.
fn motion_diameter(bits: u32) -> f32 {
    return f32(bits) * MOTION_DIAMETER_STEP;
}

// Index of a diameter in the table of terminal speeds: between this entry and the next.
fn motion_table_entry(diameter: f32) -> u32 {
    let position = clamp(diameter * MOTION_TABLE_PER_METER, 0.0, f32(MOTION_TABLE_LAST));
    return min(u32(position), MOTION_TABLE_LAST - 1u);
}

// Terminal speed between two entries of the table, m/s.
fn motion_table_speed(lower: f32, upper: f32, diameter: f32) -> f32 {
    let position = clamp(diameter * MOTION_TABLE_PER_METER, 0.0, f32(MOTION_TABLE_LAST));
    let fraction = position - f32(motion_table_entry(diameter));
    return lower + (upper - lower) * fraction;
}

// Velocity of a drop that is at rest in the surrounding air.
fn motion_settled(wind: vec3f, speed: f32) -> vec3f {
    return vec3f(wind.x, wind.y - speed, wind.z);
}

// A step of `time` seconds by relaxation of the slip.
fn motion_relax(velocity: vec3f, wind: vec3f, speed: f32, time: f32) -> MotionStep {
    let settled = motion_settled(wind, speed);
    let slip = velocity - settled;
    let relaxation = max(fall_speed_relaxation(speed), vec2f(MOTION_MIN_RELAXATION));
    // Along the fall the slip relaxes twice as fast.
    let left = exp(-time / relaxation.y);
    let stay = vec3f(left, left * left, left);
    let reach = relaxation.yxy * (1.0 - stay);
    return MotionStep(settled + slip * stay, settled * time + slip * reach);
}

// A step as Rousseau 2008, 5.1.2: the mean of the velocity and its equilibrium with air and gravity.
fn motion_average(velocity: vec3f, wind: vec3f, speed: f32, time: f32) -> MotionStep {
    let mean = 0.5 * (velocity + motion_settled(wind, speed));
    return MotionStep(mean, mean * time);
}

// Velocity after a bounce off a surface with normal `normal`: the fraction `restitution` of the normal component is
// reflected, the fraction `grip` of the tangential component is lost.
fn motion_bounce(velocity: vec3f, normal: vec3f, restitution: f32, grip: f32) -> vec3f {
    let into = dot(velocity, normal);
    let past = velocity - normal * into;
    return past * (1.0 - grip) - normal * (into * restitution);
}
