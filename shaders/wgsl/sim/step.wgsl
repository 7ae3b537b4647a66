// One step of every drop: Algorithm 1 of Rousseau 2008.
//
// In a frustum a drop that meets a surface bounces or is gone, and so is one that leaves; others come in (enter.wgsl). The
// other volumes keep their number of drops: one that meets a surface bounces or goes on unseen, at its speed, until it
// leaves the volume and comes in elsewhere, where it is open rain again if nothing stands above it.
// Twin: downpour_sim::step.

// Leave out what is not there: pipelines without wind field, collision map or events are faster.
override STEP_FIELD: bool = true;
override STEP_COLLIDES: bool = true;

struct StepFrame {
    // The eye after the step.
    now: VolumeEye,
    // What the origin has moved, m; in a box, up to whole boxes.
    shift: vec3f,
    // Drops of this dispatch, or slots.
    count: u32,
    // Edges of a box; radius, height and unused of a cylinder. m.
    size: vec3f,
    // Number of the first drop.
    first: u32,
    // Middle of a box or cylinder, m.
    centre: vec3f,
    // One of STEP_VOLUME_*.
    volume: u32,
    // Wind where there is no field, m/s.
    wind: vec3f,
    // Duration, s.
    time: f32,
    seed: vec2u,
    // Number of the step.
    step: u32,
    // 1: the eye is elsewhere altogether; no drop has come from where it was.
    elsewhere: u32,
    // The rain area of Im & Sung ends so far from the eye, m.
    farthest: f32,
    // 1: drag as Rousseau 2008.
    average: u32,
    // Events that the buffer holds.
    events: u32,
    // Share of impacts that bounce; share of the speed along the normal that comes back; share of the rest that is lost.
    bounce: f32,
    restitution: f32,
    grip: f32,
    // Diameter of a bounced drop in that of the falling one.
    bounced_size: f32,
    // The longest time of a bounced drop, s.
    bounced_time: f32,
    // Height of the gauge, m, and whether there is one.
    gauge_height: f32,
    gauge: u32,
    // Boxes by which the origin has moved and `shift` does not say, as `step_pack` has them.
    boxes: u32,
    unused_1: u32,
    // The gauge's rectangle: lower x and z, upper x and z, m.
    gauge_area: vec4f,
    // The frustum after the step, and before it, both relative to the origin of now.
    frustum: VolumeFrustum,
    frustum_before: VolumeFrustum,
    // A direction in each plane of the frustum before the step.
    tangents: array<vec4f, VOLUME_PLANES>,
    // By how much drops lag behind the uniform part of the wind, m/s, by their terminal speed.
    lags: array<vec4f, STEP_LAGS>,
    // Steps after which a drop of a frustum is gone.
    oldest: u32,
    // Candidates that may come in, their regions, and the first word of these in the tables.
    candidates: u32,
    regions: u32,
    regions_first: u32,
    // First word of the bins' sizes in the tables.
    sizes_first: u32,
    // Pieces that the drops are in, and the number of this one.
    pieces: u32,
    piece: u32,
    unused_2: u32,
}

// A drop between two steps.
struct StepDrop {
    // m, relative to the origin.
    place: vec3f,
    // Diameter in 16 bits, kind, and count.
    word: u32,
    // m/s.
    velocity: vec3f,
    // In a frustum the number of the step in which it came. In other volumes the bits of the seconds that a bounced drop has
    // been on its way, or an unseen one is behind.
    last: u32,
}

// A drop on its way through a step.
struct StepFlight {
    place: vec3f,
    kind: u32,
    velocity: vec3f,
    seconds: f32,
}

// Where a drop goes on, and its count there.
struct StepKept {
    place: vec3f,
    count: u32,
}

// What is noted of an impact.
struct StepEvent {
    place: vec3f,
    diameter: f32,
    velocity: vec3f,
    // Number of the drop (in a frustum its diameter and count), and in the highest two bits how it met what:
    // COLLISION_* - 1, and 2 more for a bounced drop.
    drop: u32,
}

@group(0) @binding(0) var<uniform> step_frame: StepFrame;
// Place, m, and the drop's word.
@group(0) @binding(1) var<storage, read_write> step_places: array<vec4u>;
// Velocity, m/s, and what StepDrop calls last.
@group(0) @binding(2) var<storage, read_write> step_motions: array<vec4u>;
// Bits of the terminal speeds; sizes of the bins; regions of what comes in.
@group(0) @binding(3) var<storage, read> step_tables: array<u32>;
@group(0) @binding(4) var<storage, read> step_cells: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> step_events: array<StepEvent>;
// Events; drops through the gauge; their volume in units of STEP_GAUGE_UNIT, low and high word; drops that found no slot.
@group(0) @binding(6) var<storage, read_write> step_counts: array<atomic<u32>, 5>;
@group(0) @binding(7) var<uniform> step_grid: WindFieldGrid;

// Kind of a drop.
fn step_kind(word: u32) -> u32 {
    return (word >> STEP_KIND) & 3u;
}

// Count of a drop: in a frustum its number among those that came with it, or the step in which it bounced; in a box the image
// of the box that it is in; else how often it has come in.
fn step_count(word: u32) -> u32 {
    return word >> STEP_COUNT_SHIFT;
}

// A drop's word.
fn step_word(diameter: u32, kind: u32, count: u32) -> u32 {
    return diameter | kind << STEP_KIND | count << STEP_COUNT_SHIFT;
}

// The diameter that a drop shows: a bounced one is smaller.
fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    return select(diameter, diameter * bounced_size, step_kind(word) == STEP_BOUNCED);
}

// Images of a box, in the bits of a count.
fn step_pack(images: vec3f) -> u32 {
    let bits = vec3u(vec3i(images)) & vec3u(7u, STEP_IMAGE_Y, 7u);
    return bits.y | bits.x << STEP_IMAGE_X | bits.z << STEP_IMAGE_Z;
}

// The image of a box that is some images away.
fn step_image(count: u32, away: u32) -> u32 {
    let x = ((count >> STEP_IMAGE_X) + (away >> STEP_IMAGE_X)) & 7u;
    let z = ((count >> STEP_IMAGE_Z) + (away >> STEP_IMAGE_Z)) & 7u;
    return ((count + away) & STEP_IMAGE_Y) | x << STEP_IMAGE_X | z << STEP_IMAGE_Z;
}

// Where the column of a drop of a box stands in the image of the box with a number, m along x and z.
fn step_column(seed: vec2u, drop: u32, count: u32, size: vec3f) -> vec2f {
    let words = rng_draw(seed, drop, count & STEP_IMAGE_Y, STEP_COLUMN);
    return vec2f(rng_unit(words.x), rng_unit(words.y)) * size.xz;
}

// The volume of a drop in units of the gauge.
fn step_measure(diameter: f32) -> u32 {
    return u32(STEP_GAUGE_PER_CUBE * diameter * diameter * diameter + 0.5);
}

// Terminal speed of a diameter.
fn step_speed(diameter: f32) -> f32 {
    let entry = motion_table_entry(diameter);
    let lower = bitcast<f32>(step_tables[entry]);
    return motion_table_speed(lower, bitcast<f32>(step_tables[entry + 1u]), diameter);
}

// Wind at a position.
fn step_wind(at: vec3f) -> vec3f {
    if !STEP_FIELD {
        return step_frame.wind;
    }
    let position = wind_field_locate(step_grid, at);
    var corners: array<vec3f, 8>;
    for (var k = 0u; k < 8u; k += 1u) {
        corners[k] = step_cells[wind_field_index(step_grid, wind_field_corner(position, k))].xyz;
    }
    return wind_field_mix(corners, position.fraction);
}

// Velocity of a drop that comes to a place from the rain around: what it keeps of the wind on its way.
fn step_coming(at: vec3f, speed: f32) -> vec3f {
    let wind = step_wind(at);
    var kept = wind;
    if STEP_FIELD {
        let way = motion_settled(wind, speed) * fall_speed_relaxation(speed).y;
        let first = step_wind(at - way * STEP_AGO_1);
        kept = first * STEP_WEIGHT_1 + step_wind(at - way * STEP_AGO_2) * STEP_WEIGHT_2;
        // Along the fall it is forgotten twice as fast.
        kept.y = 0.5 * (wind.y + first.y);
    }
    let entry = min(u32(speed), STEP_LAGS - 2u);
    let lag = mix(step_frame.lags[entry].xyz, step_frame.lags[entry + 1u].xyz, speed - f32(entry));
    return motion_settled(kept + lag, speed);
}

// Notes an impact; where the buffer is full it is counted alone.
fn step_note(place: vec3f, diameter: f32, velocity: vec3f, drop: u32) {
    let slot = atomicAdd(&step_counts[0], 1u);
    if slot < step_frame.events {
        step_events[slot] = StepEvent(place, diameter, velocity, drop);
    }
}

// Adds a drop to what has gone through the gauge.
fn step_catch(diameter: f32) {
    let measure = step_measure(diameter);
    atomicAdd(&step_counts[1], 1u);
    let low = atomicAdd(&step_counts[2], measure);
    if low + measure < low {
        atomicAdd(&step_counts[3], 1u);
    }
}

// Whether a fall from `high` to `low` goes through the gauge.
fn step_through(high: vec3f, low: vec3f) -> bool {
    if step_frame.gauge == 0u || high.y < step_frame.gauge_height || low.y >= step_frame.gauge_height {
        return false;
    }
    let share = (high.y - step_frame.gauge_height) / (high.y - low.y);
    let at = high + (low - high) * share;
    let area = step_frame.gauge_area;
    return at.x >= area.x && at.z >= area.y && at.x < area.z && at.z < area.w;
}

// A place of the rain area of Im & Sung.
fn step_area(drop: u32) -> vec3f {
    for (var k = 0u; k < STEP_TRIES; k += 1u) {
        let words = rng_draw(step_frame.seed, drop, step_frame.step, STEP_AREA + k);
        let random = vec3f(rng_unit(words.x), rng_unit(words.y), rng_unit(words.z));
        let local = volume_in_sphere(random, step_frame.farthest);
        if volume_in_area(step_frame.now, local, step_frame.farthest) {
            return local;
        }
    }
    return vec3f(0.0, 0.0, 0.5 * step_frame.farthest);
}

// What becomes of a drop within the time of a step. `key` says who it is.
fn step_fly(key: vec2u, number: u32, word: u32, flight: StepFlight) -> StepFlight {
    var kind = flight.kind;
    var velocity = flight.velocity;
    var seconds = flight.seconds;
    let diameter = step_shown(word, step_frame.bounced_size);
    let speed = step_speed(diameter);

    // Next velocity and place.
    let wind = step_wind(flight.place + velocity * (0.5 * step_frame.time));
    var moved: MotionStep;
    if step_frame.average == 1u {
        moved = motion_average(velocity, wind, speed, step_frame.time);
    } else {
        moved = motion_relax(velocity, wind, speed, step_frame.time);
    }
    velocity = moved.velocity;
    var displacement = moved.displacement;
    if kind == STEP_HIDDEN && seconds > 0.0 {
        // It catches up with the rain that it would have been.
        let late = min(seconds, step_frame.time);
        displacement += motion_settled(wind, speed) * late;
        seconds -= late;
    }
    var place = flight.place + displacement;

    // What stands in its way.
    if STEP_COLLIDES {
        if kind != STEP_HIDDEN && step_frame.elsewhere == 0u {
            let hit = collision_find(flight.place, place);
            if hit.kind != COLLISION_OPEN {
                let at = flight.place + displacement * hit.share;
                let how = hit.kind - 1u + select(0u, 2u, kind == STEP_BOUNCED);
                step_note(at, diameter, velocity, number | how << STEP_EVENT_KIND);
                let chance = rng_unit(rng_draw(step_frame.seed, key.x, key.y, STEP_CHANCE).x);
                if kind == STEP_FALLING && hit.kind == COLLISION_SURFACE && chance < step_frame.bounce {
                    kind = STEP_BOUNCED;
                    velocity = motion_bounce(velocity, hit.normal, step_frame.restitution, step_frame.grip);
                    place = at + hit.normal * STEP_CLEAR;
                    seconds = 0.0;
                } else {
                    kind = STEP_HIDDEN;
                }
            }
        }
    }
    if kind == STEP_FALLING && step_through(flight.place, place) {
        step_catch(diameter);
    }
    return StepFlight(place, kind, velocity, seconds);
}

// Whether a drop is in the frustum after the step: where it will be in the middle of the horizon.
fn step_inside(place: vec3f, velocity: vec3f, diameter: f32) -> bool {
    let offset = place + velocity * step_frame.frustum.half_horizon - step_frame.frustum.eye;
    return volume_limit(step_frame.frustum, offset, diameter, step_speed(diameter)) == VOLUME_INSIDE;
}

// A step of a drop of a frustum, whose position is relative to the origin after the step.
fn step_view(drop: StepDrop) -> StepDrop {
    let kind = step_kind(drop.word);
    let bits = drop.word & STEP_DIAMETER;
    var count = step_count(drop.word);
    let number = bits | count << STEP_KIND;
    let flight = step_fly(vec2u(number, drop.last), number, drop.word, StepFlight(drop.place, kind, drop.velocity, 0.0));
    var then = flight.kind;
    if then == STEP_BOUNCED {
        if kind == STEP_FALLING {
            count = step_frame.step & STEP_COUNT;
        } else if f32((step_frame.step - count) & STEP_COUNT) * step_frame.time > step_frame.bounced_time {
            then = STEP_HIDDEN;
        }
    }
    let old = step_frame.step - drop.last > step_frame.oldest;
    if then == STEP_HIDDEN || old || !step_inside(flight.place, flight.velocity, motion_diameter(bits)) {
        then = STEP_GONE;
    }
    return StepDrop(flight.place, step_word(bits, then, count), flight.velocity, drop.last);
}

// A drop of a frustum that is filled anew, of which the position is known where it will be in the middle of the horizon.
fn step_begin(drop: StepDrop) -> StepDrop {
    let bits = drop.word & STEP_DIAMETER;
    let velocity = step_coming(drop.place, step_speed(motion_diameter(bits)));
    let place = drop.place - velocity * step_frame.frustum.half_horizon;
    var kind = STEP_FALLING;
    if STEP_COLLIDES {
        kind = select(STEP_GONE, STEP_FALLING, collision_open(place));
    }
    return StepDrop(place, step_word(bits, kind, step_count(drop.word)), velocity, drop.last);
}

// Where a drop is that came to `place`, and its count, which changes where it has come in anew.
fn step_relocate(drop: u32, count: u32, place: vec3f) -> StepKept {
    let eye = step_frame.now;
    let next = (count + 1u) & STEP_COUNT;
    switch step_frame.volume {
        case STEP_VOLUME_BOX: {
            let images = volume_images(place, step_frame.centre, step_frame.size);
            let kept = place - step_frame.size * images;
            let image = step_image(step_image(count, step_pack(images)), step_frame.boxes);
            if ((image ^ count) & STEP_IMAGE_Y) == 0u {
                return StepKept(kept, image);
            }
            // No drop keeps its column (Rousseau 2006, 7.3), and all boxes of one rain agree.
            let column = step_column(step_frame.seed, drop, image, step_frame.size)
                - step_column(step_frame.seed, drop, count, step_frame.size);
            let moved = kept + vec3f(column.x, 0.0, column.y);
            let across = volume_images(moved, step_frame.centre, step_frame.size) * vec3f(1.0, 0.0, 1.0);
            return StepKept(moved - step_frame.size * across, step_image(image, step_pack(across)));
        }
        case STEP_VOLUME_AREA: {
            if volume_in_area(eye, volume_local(eye, place - eye.place), step_frame.farthest) {
                return StepKept(place, count);
            }
            return StepKept(eye.place + volume_offset(eye, step_area(drop)), next);
        }
        default: {
            let words = rng_draw(step_frame.seed, drop, step_frame.step, STEP_TOP);
            let random = vec2f(rng_unit(words.x), rng_unit(words.y));
            let offset = place - step_frame.centre;
            let half = 0.5 * step_frame.size.y;
            if step_frame.volume == STEP_VOLUME_TARIQ {
                if offset.y >= -half {
                    return StepKept(place, count);
                }
                let across = (random - 0.5) * step_frame.size.xz;
                return StepKept(step_frame.centre + vec3f(across.x, offset.y + step_frame.size.y, across.y), next);
            }
            let radius = step_frame.size.x;
            if offset.y >= -half && dot(offset.xz, offset.xz) <= radius * radius {
                return StepKept(place, count);
            }
            let disc = radius * volume_on_disc(random);
            let height = offset.y + select(0.0, step_frame.size.y, offset.y < -half);
            return StepKept(step_frame.centre + vec3f(disc.x, height, disc.y), next);
        }
    }
}

// A step of a drop of a volume that keeps its number of drops. Its position is relative to the origin after the step.
fn step_slot(number: u32, drop: StepDrop) -> StepDrop {
    let bits = drop.word & STEP_DIAMETER;
    let count = step_count(drop.word);
    var kind = step_kind(drop.word);
    var seconds = bitcast<f32>(drop.last);
    if kind == STEP_BOUNCED {
        seconds += step_frame.time;
    }
    let flight =
        step_fly(vec2u(number, count), number, drop.word, StepFlight(drop.place, kind, drop.velocity, seconds));
    kind = flight.kind;
    seconds = flight.seconds;
    var velocity = flight.velocity;
    if kind == STEP_BOUNCED && seconds > step_frame.bounced_time {
        kind = STEP_HIDDEN;
    }

    // What has left the volume.
    let kept = step_relocate(number, count, flight.place);
    if any(kept.place != flight.place) || step_frame.elsewhere == 1u {
        seconds = 0.0;
        kind = STEP_FALLING;
        if STEP_COLLIDES {
            kind = select(STEP_HIDDEN, STEP_FALLING, collision_open(kept.place));
        }
        velocity = motion_settled(step_wind(kept.place), step_speed(motion_diameter(bits)));
    }
    return StepDrop(kept.place, step_word(bits, kind, kept.count), velocity, bitcast<u32>(seconds));
}

@compute @workgroup_size(256)
fn main_step(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.x + id.y * groups.x * 256u;
    if slot >= step_frame.count {
        return;
    }
    let place = step_places[slot];
    if step_kind(place.w) == STEP_GONE {
        return;
    }
    let motion = step_motions[slot];
    let stored = bitcast<vec3f>(place.xyz);
    var drop = StepDrop(stored - step_frame.shift, place.w, bitcast<vec3f>(motion.xyz), motion.w);
    if step_frame.volume == STEP_VOLUME_VIEW && step_frame.elsewhere == 1u {
        drop = step_begin(StepDrop(stored, drop.word, drop.velocity, drop.last));
    } else if step_frame.volume == STEP_VOLUME_VIEW {
        drop = step_view(drop);
    } else {
        drop = step_slot(step_frame.first + slot, drop);
    }
    step_places[slot] = vec4u(bitcast<vec3u>(drop.place), drop.word);
    step_motions[slot] = vec4u(bitcast<vec3u>(drop.velocity), drop.last);
}
