// Drops of a rain in closed form that a picture can resolve.
// Method: diameters are divided into classes, a class has square columns, a column holds chains, and the drops of a chain follow each
// other at the period of the class (downpour_sim::field). FIELD_LANES invocations share the chains
// of a column that the picture may show.
// What decides which drops there are is done in integers, the same on every device: the number of chains (a Poisson number, by
// cumulative probabilities of 64 bits), the diameter (in units of 2^-30 m) and the rate of fall (in units of 2^-29 periods per
// second) of a chain, and how far it has fallen (whole periods, and a fraction of 32 bits), at any time; and, of a rain whose rate
// changes, which drops of the heaviest rain fall. Only then, relative to the eye, positions are f32.
// Twin: downpour_sim::field.

struct FieldClass {
    seed: vec2u,
    // Edge of a column and period along the vertical, m.
    edge: f32,
    period: f32,
    // First node of its sizes, first of its two rows of thresholds, and whole portions of the number of chains.
    first_node: u32,
    first_threshold: u32,
    portions: u32,
    // Number of its first column.
    first_column: u32,
    // First column along x and z, and number of them.
    columns: vec2i,
    counts: vec2u,
    // Column in which the eye is, and position in it; the drift is taken off.
    eye_column: vec2i,
    eye_in_column: vec2f,
    // Periods to the height of the eye: whole ones, and a fraction in units of 2^-32.
    eye_periods: vec2u,
    // Lowest and highest drops of interest, relative to the eye, m.
    heights: vec2f,
    // Middle of the drift along x and z, m.
    drift: vec2f,
    // Radius of the part of a column within these heights with all margins, and its middle height, m.
    reach: f32,
    middle: f32,
    // Height at which a rate that changes holds, in periods: whole ones, and a fraction in units of 2^-32.
    gauge: vec2u,
    // Its first node in a row of the parts that fall, its least diameter in units, and intervals per unit, in units of 2^-32.
    first_kept: u32,
    least_units: u32,
    kept_inverse: u32,
    // Largest distance of a drop of the class, m.
    farthest: f32,
    // By how much what is seen is larger than so many diameters, m.
    margin: f32,
    unused: u32,
}

struct FieldFrame {
    // Outward normals of the pyramid of the picture, and of all that the camera sees during the exposure.
    sides: array<vec4f, FIELD_SIDES>,
    swept: array<vec4f, FIELD_SIDES>,
    // Velocity of the eye, m/s.
    velocity: vec3f,
    // Half the exposure time, s.
    half_shutter: f32,
    // Axis of the camera's rotation, with its angular speed as length, rad/s.
    turning: vec3f,
    // Least distance of a drop, m.
    nearest: f32,
    // Distance up to which a drop is searched for: by its diameter, and so much more, m.
    per_diameter: f32,
    beyond: f32,
    // Time (FieldTime).
    seconds: u32,
    fraction: u32,
    is_before: u32,
    // Classes, all their columns, and room for drops.
    classes: u32,
    columns: u32,
    room: u32,
    // A pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pane: vec4f,
    // Places of the list before the first that is searched for.
    first: u32,
    // Of a rate that changes, the times at which rows of the parts that fall begin, and the length of a row; 0: all drops fall.
    begins: u32,
    kept_row: u32,
    // Radius of what is seen, in diameters.
    radius: f32,
}

@group(0) @binding(0) var<uniform> field_frame: FieldFrame;
@group(0) @binding(1) var<storage, read> field_classes: array<FieldClass>;
// Diameter and rate of fall at the nodes of each class.
@group(0) @binding(2) var<storage, read> field_nodes: array<vec2u>;
// Cumulative probabilities, the high word first: FIELD_THRESHOLDS for a whole portion, and as many for the rest, for each class.
@group(0) @binding(3) var<storage, read> field_thresholds: array<vec2u>;
// By terminal speed the drift of drops, less what is taken off, m, and their velocity due to the wind, m/s.
@group(0) @binding(4) var<storage, read> field_drift: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> field_drops: array<EyeDrop>;
// Drops that were found, which may be more than there is room for; and drops that were looked at.
@group(0) @binding(6) var<storage, read_write> field_found: array<atomic<u32>, 3>;
// Of a rate that changes: times (FieldTime), and row by row parts of the drops that fall, in units of 2^-32, by their diameters.
@group(0) @binding(7) var<storage, read> field_begins: array<vec4u>;
@group(0) @binding(8) var<storage, read> field_parts: array<u32>;

// Drift and velocity of a drop of some speed.
struct FieldCarried {
    drift: vec3f,
    wind: vec3f,
}

// A column of air that may hold drops of a class, with the key of its random numbers.
struct FieldColumn {
    kind: FieldClass,
    place: vec2i,
    key: vec2u,
}

// A chain of drops of one size in a column, a period apart.
struct FieldChain {
    index: u32,
    // Diameter and rate of fall, in their units.
    size: vec2u,
    // Where in its period the chain is at time 0.
    phase: u32,
    // Terminal speed, m/s.
    speed: f32,
    carried: FieldCarried,
    // Drop 0 above the eye, in periods: whole ones, and the rest.
    above: u32,
    part: f32,
    // First and last drop that may be shown, counted from the eye.
    places: vec2i,
}

// Number of thresholds of a row below a number of two words, the high one first.
fn field_reached(first: u32, word: vec2u) -> u32 {
    var low = 0u;
    var high = FIELD_THRESHOLDS;
    while low < high {
        let middle = (low + high) / 2u;
        let threshold = field_thresholds[first + middle];
        if threshold.x < word.x || (threshold.x == word.x && threshold.y < word.y) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// Number of chains of a column.
fn field_count(key: vec2u, first: u32, portions: u32) -> u32 {
    var count = 0u;
    for (var portion = 0u; portion <= portions; portion += 1u) {
        let word = rng_draw(key, portion, 0u, FIELD_CHAIN_COUNT);
        count += field_reached(first + select(0u, FIELD_THRESHOLDS, portion == portions), word.xy);
    }
    return count;
}

// A part of a number, in units of 2^-16, rounded down in two pieces.
fn field_part(whole: u32, part: u32) -> u32 {
    return (whole >> 16u) * part + (((whole & 0xffffu) * part) >> 16u);
}

// A number between two others, by a fraction in units of 2^-16.
fn field_between(a: u32, b: u32, part: u32) -> u32 {
    if b >= a {
        return a + field_part(b - a, part);
    }
    return a - field_part(a - b, part);
}

// Fraction of the distance from a node of the sizes to the next, in units of 2^-16.
fn field_fraction(word: u32) -> u32 {
    // Exact: the fraction has no more bits than a number of f32.
    return u32(distribution_table_position(word).fraction * 65536.0);
}

// Diameter and rate of fall of a chain, by a random word.
fn field_size(first: u32, word: u32) -> vec2u {
    let node = first + distribution_table_position(word).index;
    let part = field_fraction(word);
    let a = field_nodes[node];
    let b = field_nodes[node + 1u];
    return vec2u(field_between(a.x, b.x, part), field_between(a.y, b.y, part));
}

// The product of two numbers: low and high word.
fn field_product(a: u32, b: u32) -> vec2u {
    let low = (a & 0xffffu) * (b & 0xffffu);
    let cross = (a >> 16u) * (b & 0xffffu);
    let middle = (a & 0xffffu) * (b >> 16u) + (low >> 16u) + (cross & 0xffffu);
    return vec2u(a * b, (a >> 16u) * (b >> 16u) + (cross >> 16u) + (middle >> 16u));
}

// What goes on at a rate, in units of 2^-shift per second, up to a time: whole ones in two words, the high one first, and a fraction in
// units of 2^-32. `shift`: 1 to 31.
fn field_moved(rate: u32, shift: u32, seconds: u32, fraction: u32, is_before: u32) -> vec3u {
    // Three words, in units of 2^-(32 + shift).
    let a = field_product(rate, fraction);
    let b = field_product(rate, seconds);
    let second = a.y + b.x;
    let third = b.y + select(0u, 1u, second < a.y);
    let rest = 32u - shift;
    let moved = vec3u(third >> shift, (second >> shift) | (third << rest), (a.x >> shift) | (second << rest));
    if is_before == 1u {
        return field_difference(vec3u(0u), moved);
    }
    return moved;
}

// Periods that a chain has fallen at the time of the picture: whole ones, and a fraction in units of 2^-32.
fn field_fallen(rate: u32, seconds: u32, fraction: u32, is_before: u32) -> vec2u {
    return field_moved(rate, 29u, seconds, fraction, is_before).yz;
}

// Difference of two numbers of two words, the high one first.
fn field_less(a: vec2u, b: vec2u) -> vec2u {
    return vec2u(a.x - b.x - select(0u, 1u, a.y < b.y), a.y - b.y);
}

// Difference of two numbers of three words, the high one first.
fn field_difference(a: vec3u, b: vec3u) -> vec3u {
    let borrows = a.y < b.y || (a.y == b.y && a.z < b.z);
    return vec3u(a.x - b.x - select(0u, 1u, borrows), field_less(a.yz, b.yz));
}

// True if a number of two words, the high one first and with a sign, is below another.
fn field_is_below(a: vec2u, b: vec2u) -> bool {
    return i32(a.x) < i32(b.x) || (a.x == b.x && a.y < b.y);
}

// Number of times by which a chain of a rate of fall has fallen no farther than a drop is above the height of the rate: the row of the
// time at which the drop passes that height.
fn field_row(rate: u32, above: vec2u) -> u32 {
    var low = 0u;
    var high = field_frame.begins;
    while low < high {
        let middle = (low + high) / 2u;
        let begin = field_begins[middle];
        if field_is_below(above, field_fallen(rate, begin.x, begin.y, begin.z)) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

// Interval of a class in the table of the parts that fall, and fraction of the interval in units of 2^-16, for a number of units of
// diameter above its least.
fn field_interval(units: u32, inverse: u32) -> vec2u {
    let product = field_product(units, inverse);
    if product.y >= FIELD_KEPT_INTERVALS {
        return vec2u(FIELD_KEPT_INTERVALS - 1u, 0xffffu);
    }
    return vec2u(product.y, product.x >> 16u);
}

// True if a drop falls: drop `number` of a chain of a phase, a diameter and a rate of fall.
fn field_falls(column: FieldColumn, chain: FieldChain, number: u32) -> bool {
    if field_frame.kept_row == 0u {
        return true;
    }
    let row = field_row(chain.size.y, field_less(vec2u(number, chain.phase), column.kind.gauge));
    let place = field_interval(max(chain.size.x, column.kind.least_units) - column.kind.least_units, column.kind.kept_inverse);
    let first = row * field_frame.kept_row + column.kind.first_kept + place.x;
    let limit = field_between(field_parts[first], field_parts[first + 1u], place.y);
    let word = rng_draw(column.key, chain.index, number, FIELD_THIN).x;
    return word < limit || limit == 0xffffffffu;
}

// Drift and velocity of drops of a terminal speed: linear between the entries.
fn field_carried(speed: f32) -> FieldCarried {
    let position = drift_position(speed);
    let low = u32(position.x);
    let part = position.y;
    let drift = field_drift[2u * low].xyz * (1.0 - part) + field_drift[2u * low + 2u].xyz * part;
    let wind = field_drift[2u * low + 1u].xyz * (1.0 - part) + field_drift[2u * low + 3u].xyz * part;
    return FieldCarried(drift, wind);
}

// Part of the exposure in which a drop is beyond the pane before the eye, if there is one.
fn field_beyond(drop: EyeDrop) -> vec2f {
    let half_time = field_frame.half_shutter;
    let begin = eye_drop_position(drop, field_frame.velocity, field_frame.turning, -half_time);
    let end = eye_drop_position(drop, field_frame.velocity, field_frame.turning, half_time);
    let pane = field_frame.pane;
    return eye_drop_outside(dot(pane.xyz, begin) - pane.w, dot(pane.xyz, end) - pane.w, half_time);
}

// True if what is seen of a drop within a radius, m, touches the picture in a part of the exposure, s from the picture's time.
fn field_touches(drop: EyeDrop, part: vec2f, radius: f32) -> bool {
    let half_time = field_frame.half_shutter;
    let times = clamp(part, vec2f(-half_time), vec2f(half_time));
    let begin = eye_drop_position(drop, field_frame.velocity, field_frame.turning, times.x);
    let end = eye_drop_position(drop, field_frame.velocity, field_frame.turning, times.y);
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        let side = field_frame.sides[k].xyz;
        if min(dot(side, begin), dot(side, end)) > radius {
            return false;
        }
    }
    return true;
}

// True if the path of what is seen touches the picture, and it is between the least distance and that up to which drops are searched
// for.
fn field_shows(drop: EyeDrop, kind: FieldClass) -> bool {
    let distance = sqrt(dot(drop.offset, drop.offset));
    let range = min(drop.diameter * field_frame.per_diameter + field_frame.beyond, kind.farthest);
    if distance < field_frame.nearest || distance > range {
        return false;
    }
    let half_time = field_frame.half_shutter;
    return field_touches(drop, vec2f(-half_time, half_time), field_frame.radius * drop.diameter + kind.margin);
}

// True if a column of a class may hold drops of the picture.
fn field_meets(kind: FieldClass, column: vec2i) -> bool {
    let aside = (vec2f(column - kind.eye_column) + 0.5 - kind.eye_in_column) * kind.edge + kind.drift;
    let offset = vec3f(aside.x, kind.middle, aside.y);
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        if dot(field_frame.swept[k].xyz, offset) > kind.reach {
            return false;
        }
    }
    return true;
}

// A column that is searched, by its number.
fn field_column(index: u32) -> FieldColumn {
    var number = 0u;
    while number + 1u < field_frame.classes && index >= field_classes[number + 1u].first_column {
        number += 1u;
    }
    let kind = field_classes[number];
    let nth = index - kind.first_column;
    let place = kind.columns + vec2i(vec2u(nth / kind.counts.y, nth % kind.counts.y));
    let words = rng_pcg4d(vec4u(vec2u(place), kind.seed));
    return FieldColumn(kind, place, vec2u(words.x ^ words.z, words.y ^ words.w));
}

// A chain of a column.
fn field_chain(column: FieldColumn, index: u32) -> FieldChain {
    let words = rng_draw(column.key, index, 0u, FIELD_CHAIN);
    let size = field_size(column.kind.first_node, words.x);
    let speed = f32(size.y) * FIELD_RATE_STEP * column.kind.period;
    let carried = field_carried(speed);
    let fallen = field_fallen(size.y, field_frame.seconds, field_frame.fraction, field_frame.is_before);
    let above = field_less(field_less(vec2u(0u, words.y), fallen), column.kind.eye_periods);
    let part = f32(above.y >> 8u) * (FIELD_FRACTION_STEP * 256.0);
    let heights = (column.kind.heights - carried.drift.y) / column.kind.period - part;
    let places = vec2i(i32(ceil(heights.x)), i32(floor(heights.y)));
    return FieldChain(index, size, words.y, speed, carried, above.x, part, places);
}

// A drop of a chain, counted from the eye.
fn field_drop(column: FieldColumn, chain: FieldChain, place: i32) -> EyeDrop {
    let words = rng_draw(column.key, chain.index, u32(place) - chain.above, FIELD_PLACE);
    let in_column = (vec2f(words.xy >> vec2u(8u)) + 0.5) * (FIELD_FRACTION_STEP * 256.0);
    let aside = (vec2f(column.place - column.kind.eye_column) + (in_column - column.kind.eye_in_column)) * column.kind.edge;
    return EyeDrop(
        vec3f(aside.x, (f32(place) + chain.part) * column.kind.period, aside.y) + chain.carried.drift,
        f32(chain.size.x) * FIELD_DIAMETER_STEP,
        chain.carried.wind - vec3f(0.0, chain.speed, 0.0),
        words.z ^ words.w,
        vec2f(-FIELD_ALWAYS, FIELD_ALWAYS),
        chain.speed,
        words.w,
    );
}

// Lists the drops of a chain.
fn field_list(column: FieldColumn, chain: FieldChain) {
    for (var place = chain.places.x; place <= chain.places.y; place += 1) {
        if !field_falls(column, chain, u32(place) - chain.above) {
            continue;
        }
        var drop = field_drop(column, chain, place);
        atomicAdd(&field_found[1], 1u);
        drop.present = field_beyond(drop);
        if drop.present.x <= drop.present.y && field_shows(drop, column.kind) {
            let slot = atomicAdd(&field_found[0], 1u);
            if slot < field_frame.room {
                field_drops[field_frame.first + slot] = drop;
            }
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_field_clear(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index < 3u {
        atomicStore(&field_found[index], 0u);
    }
    if index < field_frame.room {
        field_drops[field_frame.first + index].diameter = 0.0;
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_field_find(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let invocation = invocation_index(id, groups);
    let index = invocation / FIELD_LANES;
    if index >= field_frame.columns {
        return;
    }
    let column = field_column(index);
    if !field_meets(column.kind, column.place) {
        return;
    }
    let count = field_count(column.key, column.kind.first_threshold, column.kind.portions);
    for (var chain = invocation % FIELD_LANES; chain < count; chain += FIELD_LANES) {
        field_list(column, field_chain(column, chain));
    }
}
