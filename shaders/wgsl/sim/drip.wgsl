// Drops of points that drip, before an eye: those that hang there and those that fall, in a steady wind.
// Method: DRIP_LANES invocations share the drops of a point. How many have left it is counted in integers, the same on every device, at
// any time: whole drops, and a fraction of 32 bits. Only from there on, relative to the time of the picture and to the eye, are times
// and positions f32. After the rain a point runs dry: its number of drops nears that of its store by exponential decay.
// Twin: downpour_sim::drips.

struct DripRow {
    // Position relative to the origin of the points, m.
    position: vec3f,
    // Terminal speed of its drops, m/s.
    terminal: f32,
    // Where the longest fall ends, relative to the same origin, m.
    end: vec3f,
    // Time of that fall, s.
    longest: f32,
    // Drops that are yet to leave at time 0: whole ones in two words, the high one first, and a fraction in units of 2^-32.
    due: vec3u,
    // Drops per second, in units of 2^-shift.
    units: u32,
    // Drops that will ever have left, as `due`, where the rain ends.
    left: vec3u,
    shift: u32,
    // Key of its random numbers.
    key: vec2u,
    // Diameter of the drops that fall, m.
    diameter: f32,
    // Distance of a drop's center from the point when it begins to fall, m.
    below: f32,
    // Time after which a fall ends on a surface, s; FIELD_ALWAYS: nowhere.
    until: f32,
    // Cube of the diameter of the water that hangs there before a drop leaves, and of the drop's own, m^3; 0 for drops of a jet.
    hanging: f32,
    leaving: f32,
    // Time constant with which the point runs dry after the rain, s; 0: the rain does not end.
    drain: f32,
    // Unit normal of the surface on which a fall ends; it looks straight down where a fall ends nowhere.
    normal: vec3f,
    unused: u32,
}

struct DripFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Time of the picture (FieldTime).
    seconds: u32,
    fraction: u32,
    is_before: u32,
    // Position of the eye relative to the origin of the points, m.
    eye: vec3f,
    points: u32,
    // Velocity of the wind along the ground, m/s.
    wind: vec3f,
    // End of the rain, s from the time of the picture.
    end: f32,
    // Largest distance of a drop, m.
    farthest: f32,
    // Upper bound of the speed of a drop relative to the eye, m/s.
    fastest: f32,
    unused: vec2u,
}

@group(0) @binding(9) var<uniform> drip_frame: DripFrame;
@group(0) @binding(10) var<storage, read> drip_rows: array<DripRow>;

// Number of drops of a point by time: it rises with the rain, and after it by a part that decays.
struct DripClock {
    // Drops per second while it rains.
    per_s: f32,
    // Number of drops at the time of the picture; if the rain ends before, of all that will ever have left.
    part: f32,
    // End of the rain, s from the time of the picture.
    end: f32,
    // Time constant of the decay, s.
    drain: f32,
}

// A point with its drops, which are counted from one of them.
struct DripPoint {
    row: DripRow,
    clock: DripClock,
    // Number of drop 0, the high word first.
    number: vec2u,
    // The first drop of all, at least -DRIP_FAR.
    begin: i32,
}

// Displacement and velocity of a drop that has fallen from rest, m and m/s.
struct DripFall {
    moved: vec3f,
    velocity: vec3f,
}

// Number of drops that leave a point after the rain.
fn drip_store(clock: DripClock) -> f32 {
    return clock.drain * clock.per_s;
}

// Number of drops that will have left a point in the end.
fn drip_total(clock: DripClock) -> f32 {
    if clock.end < 0.0 {
        return clock.part;
    }
    return clock.part + clock.end * clock.per_s + drip_store(clock);
}

// Number of drops that have left a point at a time, s.
fn drip_reached(clock: DripClock, time: f32) -> f32 {
    if time > clock.end {
        return drip_total(clock) - drip_store(clock) * exp((clock.end - time) / clock.drain);
    }
    if clock.end < 0.0 {
        return clock.part - drip_store(clock) + (time - clock.end) * clock.per_s;
    }
    return clock.part + time * clock.per_s;
}

// Time of a number of drops, s; FIELD_ALWAYS for more than there will be.
fn drip_time(clock: DripClock, drops: f32) -> f32 {
    let rest = drip_total(clock) - drops;
    if rest <= 0.0 {
        return FIELD_ALWAYS;
    }
    let store = drip_store(clock);
    if rest < store {
        return clock.end - clock.drain * log(rest / store);
    }
    if clock.end < 0.0 {
        return clock.end - (rest - store) / clock.per_s;
    }
    return (drops - clock.part) / clock.per_s;
}

// Distance and speed of a drop of a terminal speed that has fallen from rest for a time, m and m/s.
fn drip_rest(terminal: f32, age: f32) -> vec2f {
    if terminal <= 0.0 || age <= 0.0 {
        return vec2f(0.0);
    }
    let x = age * FALL_SPEED_GRAVITY / terminal;
    let square = x * x;
    // ln cosh x = x + ln(1/2 + exp(-2x) / 2), whose digits are lost where x is small.
    var ln_cosh = square * (0.5 - square * (1.0 / 12.0 - square / 45.0));
    if x > 0.25 {
        ln_cosh = x + log(0.5 + 0.5 * exp(-2.0 * x));
    }
    return vec2f(terminal * terminal / FALL_SPEED_GRAVITY * ln_cosh, terminal * tanh(min(x, 20.0)));
}

// A drop of a terminal speed that has fallen from rest for a time in a wind along the ground.
fn drip_fall(terminal: f32, wind: vec3f, age: f32) -> DripFall {
    let time = max(age, 0.0);
    let fallen = drip_rest(terminal, time);
    let across = max(fall_speed_relaxation(terminal).y, 1.0e-9);
    let carried = 1.0 - exp(-time / across);
    return DripFall(wind * (time - across * carried) - vec3f(0.0, fallen.x, 0.0), wind * carried - vec3f(0.0, fallen.y, 0.0));
}

// Diameter, m, of the water that hangs at a point at a fraction of the time between two drops, from the cubes of the whole and of what
// leaves.
fn drip_hanging(hanging: f32, leaving: f32, fraction: f32) -> f32 {
    return pow(max(hanging - leaving * (1.0 - clamp(fraction, 0.0, 1.0)), 0.0), 1.0 / 3.0);
}

// The first drop of a point, counted from one of a number of two words, the high one first and with a sign: -DRIP_FAR or DRIP_FAR where
// that is farther.
fn drip_begin(number: vec2u) -> i32 {
    if i32(number.x) >= 0 {
        return -i32(select(DRIP_FAR, min(number.y, DRIP_FAR), number.x == 0u));
    }
    let yet = 0u - number.y;
    let is_near = number.x == 0xffffffffu && yet > 0u && yet < DRIP_FAR;
    return i32(select(DRIP_FAR, yet, is_near));
}

// Number of a drop that is counted from one of a number of two words, the high one first.
fn drip_number(number: vec2u, drop: i32) -> vec2u {
    let low = number.y + u32(drop);
    let carries = select(select(0u, 0xffffffffu, low > number.y), select(0u, 1u, low < number.y), drop >= 0);
    return vec2u(number.x + carries, low);
}

// Random numbers of a drop of a point, for a dimension.
fn drip_draw(point: DripPoint, drop: i32, dimension: u32) -> vec4u {
    let number = drip_number(point.number, drop);
    return rng_draw(point.row.key, number.y, number.x, dimension);
}

// Largest diameter of a drop of a point, m.
fn drip_largest(row: DripRow) -> f32 {
    return select(row.diameter, drip_hanging(row.hanging, 0.0, 1.0), row.hanging > 0.0);
}

// A point with the number of its drops at the time of the picture or, where the rain ends before, of all of them: there the last ones,
// which are far apart in time, are told best.
fn drip_point(index: u32) -> DripPoint {
    let row = drip_rows[index];
    // Exact: a power of two.
    let per_s = f32(row.units) * bitcast<f32>((127u - row.shift) << 23u);
    let ends = row.drain > 0.0;
    let end = select(FIELD_ALWAYS, drip_frame.end, ends);
    var count = row.left;
    if end >= 0.0 {
        let moved = field_moved(row.units, row.shift, drip_frame.seconds, drip_frame.fraction, drip_frame.is_before);
        count = field_difference(moved, row.due);
    }
    let part = f32(count.z >> 8u) * (FIELD_FRACTION_STEP * 256.0);
    let clock = DripClock(per_s, part, end, select(1.0, row.drain, ends));
    return DripPoint(row, clock, count.xy, drip_begin(count.xy));
}

// True if a point may have drops in the picture.
fn drip_meets(row: DripRow) -> bool {
    let middle = (row.position + row.end) * 0.5 - drip_frame.eye;
    let way = row.position - row.end;
    let margin = sqrt(dot(way, way)) * 0.5 + DRIP_MARGIN + field_frame.half_shutter * drip_frame.fastest;
    let range = min(drip_largest(row) * field_frame.per_diameter, drip_frame.farthest);
    if sqrt(dot(middle, middle)) - margin > range {
        return false;
    }
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        if dot(field_frame.swept[k].xyz, middle) > margin {
            return false;
        }
    }
    return true;
}

// Time at which a drop leaves, s from that of the picture.
fn drip_leaves(point: DripPoint, drop: i32) -> f32 {
    let jitter = rng_unit(drip_draw(point, drop, DRIP_DROP).x);
    return drip_time(point.clock, f32(drop) + DRIP_JITTER * (jitter - 0.5));
}

// The first drop that may leave after a time, s.
fn drip_first(point: DripPoint, time: f32) -> i32 {
    return max(i32(floor(drip_reached(point.clock, time) - DRIP_JITTER - 1.0)), point.begin);
}

// The last drop that may leave before a time, s.
fn drip_last(point: DripPoint, time: f32) -> i32 {
    return i32(floor(drip_reached(point.clock, time) + DRIP_JITTER + 1.0));
}

// Adds a drop to the list, if the picture shows it.
fn drip_add(point: DripPoint, drop: i32, found: EyeDrop) {
    let distance = sqrt(dot(found.offset, found.offset));
    let range = min(found.diameter * field_frame.per_diameter, drip_frame.farthest);
    if distance < field_frame.nearest || distance > range || !field_touches(found, found.present, found.diameter) {
        return;
    }
    let words = drip_draw(point, drop, DRIP_DROP + 1u);
    let beyond = field_beyond(found);
    var listed = found;
    listed.id = words.x ^ words.y;
    listed.id_low = words.y;
    listed.present = vec2f(max(found.present.x, beyond.x), min(found.present.y, beyond.y));
    if listed.present.x > listed.present.y {
        return;
    }
    let slot = atomicAdd(&field_found[0], 1u);
    if slot < field_frame.room {
        field_drops[field_frame.first + slot] = listed;
    }
}

// Lists a drop if it falls during the exposure.
fn drip_falls(point: DripPoint, drop: i32) {
    let row = point.row;
    let half_time = field_frame.half_shutter;
    let age = -drip_leaves(point, drop);
    if age <= -half_time || age - half_time > row.longest || row.until <= age - half_time {
        return;
    }
    let fall = drip_fall(row.terminal, drip_frame.wind, min(age, row.until));
    let present = clamp(vec2f(-age, row.until - age), vec2f(-FIELD_ALWAYS), vec2f(FIELD_ALWAYS));
    // It is there at the time of the picture, or else where it begins or ends.
    let seen = select(max(present.x, 0.0), present.y, present.y < 0.0);
    let start = row.position - drip_frame.eye - vec3f(0.0, row.below, 0.0);
    let offset = start + fall.moved - fall.velocity * seen;
    drip_add(point, drop, EyeDrop(offset, row.diameter, fall.velocity, 0u, present, FIELD_DRIPPED, 0u));
}

// Lists the drops that hang at some time of the exposure.
fn drip_hangs(point: DripPoint) {
    let row = point.row;
    let half_time = field_frame.half_shutter;
    // It has left before the exposure, unless it is the first of all.
    var drop = drip_first(point, -half_time);
    var since = -FIELD_ALWAYS;
    loop {
        let leaves = drip_leaves(point, drop);
        // Before its first drop an edge becomes wet.
        let begin = select(leaves - 1.0 / point.clock.per_s, since, since > -FIELD_ALWAYS);
        if leaves > -half_time && begin < half_time {
            // The last one hangs for good.
            let fraction = select(0.5, (clamp(0.0, begin, leaves) - begin) / (leaves - begin), leaves < FIELD_ALWAYS);
            let diameter = drip_hanging(row.hanging, row.leaving, fraction);
            let offset = row.position - drip_frame.eye - vec3f(0.0, DRIP_HANGS * diameter, 0.0);
            drip_add(point, drop, EyeDrop(offset, diameter, vec3f(0.0), 0u, vec2f(since, leaves), FIELD_DRIPPED, 0u));
        }
        if leaves >= half_time {
            break;
        }
        since = leaves;
        drop += 1;
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_drip_find(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let invocation = invocation_index(id, groups);
    let index = invocation / DRIP_LANES;
    if index >= drip_frame.points || !drip_meets(drip_rows[index]) {
        return;
    }
    let point = drip_point(index);
    let half_time = field_frame.half_shutter;
    let last = drip_last(point, half_time);
    let lane = invocation % DRIP_LANES;
    for (var drop = drip_first(point, -half_time - point.row.longest) + i32(lane); drop <= last; drop += i32(DRIP_LANES)) {
        drip_falls(point, drop);
    }
    if lane == 0u && point.row.hanging > 0.0 {
        drip_hangs(point);
    }
}
