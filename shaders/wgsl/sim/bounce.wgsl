// Droplets that rebound from impacts, as a picture shows them.
// Method: three kernels. The first looks at the drops whose droplets the picture may show (main_bounce_find): a drop is given by its
// position at the end of the exposure, as if nothing had stopped it, and its path is divided at whole sixteenths of a second. Each part
// of a path whose droplet may get into the picture is listed. The second follows each part until it hits something, and the droplet
// from there (main_bounce_hit). The third adds the droplets to the list of the picture.
// Twin: downpour_sim::impacts::bounced, which computes in f64.

struct BounceFrame {
    // Outward normals of the pyramid of the picture.
    sides: array<vec4f, FIELD_SIDES>,
    // A pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pane: vec4f,
    // Air in which droplets fall.
    air: FallSpeedAir,
    // Position of the eye relative to the obstacles, m.
    eye: vec3f,
    // Half the exposure time, s.
    half_shutter: f32,
    // Velocity of the eye, m/s.
    velocity: vec3f,
    // Least distance of a droplet, m.
    nearest: f32,
    // Axis of the camera's rotation, with its angular speed as length, rad/s.
    turning: vec3f,
    // Largest distance of a droplet, m.
    farthest: f32,
    // Distance up to which a droplet is listed, by its diameter.
    per_diameter: f32,
    // Lowest and highest obstacles, relative to the eye, m.
    lowest: f32,
    highest: f32,
    // Time of the first row of the motion by the wind, s from the time of the picture.
    first_time: f32,
    // Parts of a path: one less than the rows.
    slices: u32,
    // Maximum time of a droplet, s.
    longest: f32,
    // Part of the impacts that throw a droplet.
    chance: f32,
    // Part of the speed toward the surface that is left, and part of that along it that is lost.
    restitution: f32,
    grip: f32,
    // Diameter of a droplet relative to that of its drop.
    size: f32,
    // Number of the model of terminal speed.
    model: u32,
    // Distance of a path from the line between its ends, at most, m.
    slack: f32,
    // Room for parts of paths.
    parts: u32,
    // Places of the list before the first that is searched for, and room after it.
    first: u32,
    room: u32,
    unused: u32,
}

// Parts of paths whose droplets the picture may show: how many were found, and those that have room. The second kernel puts the droplet
// in the place of its part, of diameter 0 if there is none.
struct BounceParts {
    count: atomic<u32>,
    drops: array<EyeDrop>,
}

struct BounceMotion {
    // Displacement or position, m.
    moved: vec3f,
    // m/s.
    velocity: vec3f,
}

struct BounceDroplet {
    // Where it starts, relative to the eye, m, and when, s from the time of the picture.
    start: vec3f,
    begin: f32,
    // Velocity with which it starts, m/s.
    leaves: vec3f,
    // Terminal speed, m/s.
    speed: f32,
    // Motion at its start of a droplet that has always followed the wind, without its fall.
    follows: BounceMotion,
    // m.
    diameter: f32,
}

@group(0) @binding(9) var<uniform> bounce_frame: BounceFrame;
// Row by row, by terminal speed: displacement by the wind, relative to the last row, m, and velocity due to it, m/s.
@group(0) @binding(10) var<storage, read> bounce_rows: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> bounce_parts: BounceParts;
// The list of the picture, and how many have been found.
@group(0) @binding(12) var<storage, read_write> bounce_list: array<EyeDrop>;
@group(0) @binding(13) var<storage, read_write> bounce_found: array<atomic<u32>, 2>;

// Motion by the wind of drops of a terminal speed up to the time of a row.
fn bounce_row(row: u32, speed: f32) -> BounceMotion {
    let position = drift_position(speed);
    let part = position.y;
    let at = 2u * (row * (FIELD_DRIFT + 1u) + u32(position.x));
    return BounceMotion(
        bounce_rows[at].xyz * (1.0 - part) + bounce_rows[at + 2u].xyz * part,
        bounce_rows[at + 1u].xyz * (1.0 - part) + bounce_rows[at + 3u].xyz * part,
    );
}

// Motion between the times of two rows: the cubic with their positions and velocities.
fn bounce_between(before: BounceMotion, after: BounceMotion, part: f32) -> BounceMotion {
    let square = part * part;
    let cube = square * part;
    let way = after.moved - before.moved;
    let bent = before.velocity * (part - 2.0 * square + cube) + after.velocity * (cube - square);
    return BounceMotion(
        before.moved + way * (3.0 * square - 2.0 * cube) + bent * BOUNCE_SLICE,
        way * (6.0 * (part - square) / BOUNCE_SLICE) + before.velocity * (1.0 - 4.0 * part + 3.0 * square)
            + after.velocity * (3.0 * square - 2.0 * part),
    );
}

// Motion by the wind of drops of a terminal speed up to a time, s from that of the picture.
fn bounce_carried(time: f32, speed: f32) -> BounceMotion {
    let position = clamp((time - bounce_frame.first_time) / BOUNCE_SLICE, 0.0, f32(bounce_frame.slices));
    let row = min(u32(position), bounce_frame.slices - 1u);
    return bounce_between(bounce_row(row, speed), bounce_row(row + 1u, speed), position - f32(row));
}

// What is left of the slip between a droplet of a terminal speed and the air after a time, and how far that has displaced it.
fn bounce_slip(slip: vec3f, speed: f32, age: f32) -> BounceMotion {
    // Along the fall it relaxes twice as fast as across it.
    let times = max(fall_speed_relaxation(speed).yxy, vec3f(BOUNCE_MIN_RELAXATION));
    let left = exp(-age / times);
    return BounceMotion(slip * times * (1.0 - left), slip * left);
}

// Position relative to the eye, and velocity, of a droplet at an age.
fn bounce_at(droplet: BounceDroplet, age: f32) -> BounceMotion {
    let fall = vec3f(0.0, droplet.speed, 0.0);
    let carried = bounce_carried(droplet.begin + age, droplet.speed);
    let slip = bounce_slip(droplet.leaves - (droplet.follows.velocity - fall), droplet.speed, age);
    let followed = carried.moved - droplet.follows.moved - fall * age;
    return BounceMotion(droplet.start + followed + slip.moved, carried.velocity - fall + slip.velocity);
}

// Ball in which the droplet of a drop is at the time of the picture, wherever the drop hits something in a part of its path, and during
// the exposure: middle relative to the eye, and radius, m.
fn bounce_ball(slice: u32, begin: vec3f, end: vec3f, speed: f32, drop: EyeDrop) -> vec4f {
    let now = bounce_carried(0.0, speed).moved;
    let oldest = bounce_row(slice, speed);
    let youngest = bounce_row(slice + 1u, speed);
    let first = bounce_row(slice, drop.speed).velocity;
    let last = bounce_row(slice + 1u, drop.speed).velocity;
    let wind = sqrt(max(dot(first, first), dot(last, last)));
    let left = max(bounce_frame.restitution, 1.0 - bounce_frame.grip);
    let leaves = left * sqrt(drop.speed * drop.speed + wind * wind);
    let starts = bounce_frame.first_time + f32(slice) * BOUNCE_SLICE;
    let ages = max(vec2f(-starts, -starts - BOUNCE_SLICE), vec2f(0.0));
    let across = max(fall_speed_relaxation(speed).y, BOUNCE_MIN_RELAXATION);
    // Seconds for which the slip counts.
    let lasts = across * (1.0 - exp(-ages / across));
    // The slip that it has from the wind and its fall, as if it left the surface at rest; the path of the drop is a line.
    let fall = vec3f(0.0, speed, 0.0);
    let old_slip = fall - oldest.velocity;
    let young_slip = fall - youngest.velocity;
    let old = begin + now - oldest.moved - fall * ages.x + bounce_slip(old_slip, speed, ages.x).moved;
    let young = end + now - youngest.moved - fall * ages.y + bounce_slip(young_slip, speed, ages.y).moved;
    let apart = old - young;
    let slip = sqrt(max(dot(old_slip, old_slip), dot(young_slip, young_slip)));
    let eye = sqrt(dot(bounce_frame.velocity, bounce_frame.velocity));
    // An exponential is as far from its chord.
    let bent = slip * (lasts.x - lasts.y) * min(0.125 * (ages.x - ages.y) / across, 1.0);
    let exposed = bounce_frame.half_shutter * (leaves + wind + eye);
    let radius = 0.5 * sqrt(dot(apart, apart)) + bent + leaves * lasts.x + exposed;
    return vec4f(0.5 * (old + young), radius + bounce_frame.slack + drop.diameter);
}

// True if a droplet that is somewhere in a ball may be in the picture.
fn bounce_may_show(ball: vec4f, diameter: f32) -> bool {
    let range = min(diameter * bounce_frame.per_diameter, bounce_frame.farthest);
    let distance = sqrt(dot(ball.xyz, ball.xyz));
    if distance - ball.w > range {
        return false;
    }
    let turns = sqrt(dot(bounce_frame.turning, bounce_frame.turning)) * bounce_frame.half_shutter;
    let radius = ball.w + turns * distance;
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        if dot(bounce_frame.sides[k].xyz, ball.xyz) > radius {
            return false;
        }
    }
    return true;
}

// True if a droplet touches the picture in a part of the exposure, and is between the least distance and that up to which it is listed.
fn bounce_shows(drop: EyeDrop) -> bool {
    let distance = sqrt(dot(drop.offset, drop.offset));
    let range = min(drop.diameter * bounce_frame.per_diameter, bounce_frame.farthest);
    if distance < bounce_frame.nearest || distance > range {
        return false;
    }
    let half_time = bounce_frame.half_shutter;
    let times = clamp(drop.present, vec2f(-half_time), vec2f(half_time));
    let begin = eye_drop_position(drop, bounce_frame.velocity, bounce_frame.turning, times.x);
    let end = eye_drop_position(drop, bounce_frame.velocity, bounce_frame.turning, times.y);
    let radius = FIELD_RADIUS * drop.diameter;
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        let side = bounce_frame.sides[k].xyz;
        if min(dot(side, begin), dot(side, end)) > radius {
            return false;
        }
    }
    return true;
}

// A droplet until its longest time, as the picture shows it; of diameter 0 if it does not.
fn bounce_listed(droplet: BounceDroplet, drop: EyeDrop) -> EyeDrop {
    let age = -droplet.begin;
    let half_time = bounce_frame.half_shutter;
    // A droplet that starts later in the exposure is listed as if it had always moved.
    var at = BounceMotion(droplet.start + droplet.leaves * age, droplet.leaves);
    if age > 0.0 {
        at = bounce_at(droplet, age);
    }
    let until = bounce_frame.longest - age;
    var listed = EyeDrop(
        at.moved,
        droplet.diameter,
        at.velocity,
        drop.id ^ BOUNCE_HIGH ^ BOUNCE_LOW,
        vec2f(-age, until),
        FIELD_BOUNCED,
        drop.id_low ^ BOUNCE_LOW,
    );
    if age < -half_time || until < -half_time || !bounce_shows(listed) {
        listed.diameter = 0.0;
    }
    return listed;
}

// A droplet that is on the outer side of a pane while it is there, with the part of the exposure in which it is; of diameter 0 if it
// never is.
fn bounce_outside(drop: EyeDrop) -> EyeDrop {
    let half_time = bounce_frame.half_shutter;
    let begin = eye_drop_position(drop, bounce_frame.velocity, bounce_frame.turning, -half_time);
    let end = eye_drop_position(drop, bounce_frame.velocity, bounce_frame.turning, half_time);
    let pane = bounce_frame.pane;
    let part = eye_drop_outside(dot(pane.xyz, begin) - pane.w, dot(pane.xyz, end) - pane.w, half_time);
    var outside = drop;
    outside.present = vec2f(max(drop.present.x, part.x), min(drop.present.y, part.y));
    if outside.present.x > outside.present.y {
        outside.diameter = 0.0;
    }
    return outside;
}

@compute @workgroup_size(1, 1, 1)
fn main_bounce_clear() {
    atomicStore(&bounce_parts.count, 0u);
}

@compute @workgroup_size(64, 1, 1)
fn main_bounce_list(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    let count = atomicLoad(&bounce_parts.count);
    if index == 0u && count > bounce_frame.parts {
        // Parts without room are told as such of the list.
        atomicMax(&bounce_found[0], bounce_frame.room + count - bounce_frame.parts);
    }
    if index >= min(count, bounce_frame.parts) || bounce_parts.drops[index].diameter <= 0.0 {
        return;
    }
    let slot = atomicAdd(&bounce_found[0], 1u);
    if slot < bounce_frame.room {
        bounce_list[bounce_frame.first + slot] = bounce_parts.drops[index];
    }
}
