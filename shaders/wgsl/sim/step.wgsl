// One step of every drop: Algorithm 1 of Rousseau 2008.
//
// In a frustum a drop that hits a surface bounces or is gone, and so is one that leaves; others enter (enter.wgsl). The
// other volumes keep their number of drops: one that hits a surface bounces or continues hidden, at its speed, until it
// leaves the volume and re-enters elsewhere, where it is visible again if nothing is above it.
// Twin: downpour_sim::step.

// False for inputs that are absent: pipelines without wind field, collision map or events are faster.
override STEP_FIELD: bool = true;
override STEP_COLLIDES: bool = true;

struct StepFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Time from the beginning of kept_span to the step, s.
    kept_since: f32,
    unused_2: u32,
    unused_3: u32,
    // The eye after the step.
    now: VolumeEye,
    // Displacement of the origin, m; in a box, modulo whole boxes.
    shift: vec3f,
    // Number of drops of this dispatch, or of slots.
    count: u32,
    // Edges of a box; radius, height and unused of a cylinder. m.
    size: vec3f,
    // Number of the first drop.
    first: u32,
    // Center of a box or cylinder, m.
    center: vec3f,
    // One of STEP_VOLUME_*.
    volume: u32,
    // Wind without a field, m/s.
    wind: vec3f,
    // Duration, s.
    time: f32,
    seed: vec2u,
    // Number of the step.
    step: u32,
    // 1 after a jump of the eye: no drop of the old position is in view.
    elsewhere: u32,
    // Radius of the rain area of Im & Sung around the eye, m.
    farthest: f32,
    // 1 for the drag of Rousseau 2008.
    average: u32,
    // Capacity of the event buffer.
    events: u32,
    // Fraction of impacts that bounce; fraction of the normal speed that is reflected; fraction of the tangential
    // speed that is lost.
    bounce: f32,
    restitution: f32,
    grip: f32,
    // Diameter of a bounced drop relative to that of the falling one.
    bounced_size: f32,
    // Maximum time of a bounced drop, s.
    bounced_time: f32,
    // Height of the gauge, m, and 1 if there is one.
    gauge_height: f32,
    gauge: u32,
    // Displacement of the origin in whole boxes, not included in `shift`, packed by `step_pack`.
    boxes: u32,
    // Room for the impacts of a span of time that are kept.
    kept_room: u32,
    // Rectangle of the gauge: lower x and z, upper x and z, m.
    gauge_area: vec4f,
    // Frustum after the step, and before it, both relative to the current origin.
    frustum: VolumeFrustum,
    frustum_before: VolumeFrustum,
    // Direction in each plane of the frustum before the step.
    tangents: array<vec4f, VOLUME_PLANES>,
    // Lag of drops behind the uniform part of the wind, m/s, by their terminal speed.
    lags: array<vec4f, STEP_LAGS>,
    // Number of steps after which a drop of a frustum is removed.
    oldest: u32,
    // Number of candidates that may enter, number of their regions, and index of the first word of these in the tables.
    candidates: u32,
    regions: u32,
    regions_first: u32,
    // Index of the first word of the bins' sizes in the tables.
    sizes_first: u32,
    // Number of pieces of the drops, and index of this one.
    pieces: u32,
    piece: u32,
    // Span of time whose impacts are kept with those of this step, s.
    kept_span: u32,
}

// A drop between two steps.
struct StepDrop {
    // Position, m, relative to the origin.
    position: vec3f,
    // Diameter in 16 bits, kind, and count.
    word: u32,
    // Velocity, m/s.
    velocity: vec3f,
    // In a frustum the number of the step in which it entered. In other volumes the bits of a time in seconds: since
    // the bounce of a bounced drop, or the delay of a hidden one.
    last: u32,
}

// A moving drop within a step.
struct StepFlight {
    position: vec3f,
    kind: u32,
    velocity: vec3f,
    seconds: f32,
}

// Position of a drop wrapped into the volume, and its count there.
struct StepKept {
    position: vec3f,
    count: u32,
}

// Record of an impact.
struct StepEvent {
    position: vec3f,
    diameter: f32,
    velocity: vec3f,
    // Number of the drop (in a frustum its diameter and count), and in the highest two bits the kind of drop and
    // surface: COLLISION_* - 1, and 2 more for a bounced drop.
    drop: u32,
    // Unit vector from the surface toward the side that the drop came from: octahedral.
    normal: vec2f,
    // Time from the beginning of the step to the impact, s; of an impact that is kept, from the beginning of its span.
    time: f32,
    // With the number what the drop is known by: in a frustum the step in which it entered, else its count.
    last: u32,
}

@group(0) @binding(0) var<uniform> step_frame: StepFrame;
// Position, m, and the drop's word.
@group(0) @binding(1) var<storage, read_write> step_positions: array<vec4u>;
// Velocity, m/s, and `last` of StepDrop.
@group(0) @binding(2) var<storage, read_write> step_motions: array<vec4u>;
// Bits of the terminal speeds; sizes of the bins; regions of entering drops.
@group(0) @binding(3) var<storage, read> step_tables: array<u32>;
@group(0) @binding(4) var<storage, read> step_cells: array<vec4f>;
// Impacts since they were last taken, and behind them those of each span of time that are kept.
@group(0) @binding(5) var<storage, read_write> step_events: array<StepEvent>;
// Counters: events; drops through the gauge; their volume in units of STEP_GAUGE_UNIT, low and high word; drops
// without slot; impacts of each span that are kept.
@group(0) @binding(6) var<storage, read_write> step_counts: array<atomic<u32>, STEP_COUNTERS>;
@group(0) @binding(7) var<uniform> step_grid: WindFieldGrid;

// Kind of a drop.
fn step_kind(word: u32) -> u32 {
    return (word >> STEP_KIND) & 3u;
}

// Count of a drop: in a frustum its number among those that entered with it, or the step in which it bounced; in a box
// the image of the box that it is in; else the number of its re-entries.
fn step_count(word: u32) -> u32 {
    return word >> STEP_COUNT_SHIFT;
}

// Word of a drop.
fn step_word(diameter: u32, kind: u32, count: u32) -> u32 {
    return diameter | kind << STEP_KIND | count << STEP_COUNT_SHIFT;
}

// Visible diameter of a drop: a bounced one is smaller.
fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    return select(diameter, diameter * bounced_size, step_kind(word) == STEP_BOUNCED);
}

// Packs images of a box into the bits of a count.
fn step_pack(images: vec3f) -> u32 {
    let bits = vec3u(vec3i(images)) & vec3u(7u, STEP_IMAGE_Y, 7u);
    return bits.y | bits.x << STEP_IMAGE_X | bits.z << STEP_IMAGE_Z;
}

// Image of a box at an offset of some images.
fn step_image(count: u32, away: u32) -> u32 {
    let x = ((count >> STEP_IMAGE_X) + (away >> STEP_IMAGE_X)) & 7u;
    let z = ((count >> STEP_IMAGE_Z) + (away >> STEP_IMAGE_Z)) & 7u;
    return ((count + away) & STEP_IMAGE_Y) | x << STEP_IMAGE_X | z << STEP_IMAGE_Z;
}

// Position of the column of a drop in an image of the box, m along x and z.
fn step_column(seed: vec2u, drop: u32, count: u32, size: vec3f) -> vec2f {
    let words = rng_draw(seed, drop, count & STEP_IMAGE_Y, STEP_COLUMN);
    return vec2f(rng_unit(words.x), rng_unit(words.y)) * size.xz;
}

// Volume of a drop in units of the gauge.
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

// Velocity of a drop that arrives at a position from the surrounding rain: its relaxation to the wind on its path.
fn step_coming(at: vec3f, speed: f32) -> vec3f {
    let wind = step_wind(at);
    var kept = wind;
    if STEP_FIELD {
        let way = motion_settled(wind, speed) * fall_speed_relaxation(speed).y;
        let first = step_wind(at - way * STEP_AGO_1);
        kept = first * STEP_WEIGHT_1 + step_wind(at - way * STEP_AGO_2) * STEP_WEIGHT_2;
        // Along the fall it relaxes twice as fast.
        kept.y = 0.5 * (wind.y + first.y);
    }
    let entry = min(u32(speed), STEP_LAGS - 2u);
    let lag = mix(step_frame.lags[entry].xyz, step_frame.lags[entry + 1u].xyz, speed - f32(entry));
    return motion_settled(kept + lag, speed);
}

// True if an impact may make a splash: that of a drop that fell, on a surface that does not look down.
fn step_splashes(event: StepEvent) -> bool {
    return event.drop >> STEP_EVENT_KIND == 0u && packing_octahedral_decode(event.normal).y >= SPLASH_LEVEL;
}

// Records an impact, and keeps it if it may make a splash; where there is no room it is only counted.
fn step_note(event: StepEvent) {
    let slot = atomicAdd(&step_counts[0], 1u);
    if slot < step_frame.events {
        step_events[slot] = event;
    }
    if step_frame.kept_room > 0u && step_splashes(event) {
        let span = step_frame.kept_span;
        let place = atomicAdd(&step_counts[STEP_COUNTS + span], 1u);
        if place < step_frame.kept_room {
            var kept = event;
            kept.time += step_frame.kept_since;
            step_events[step_frame.events + span * step_frame.kept_room + place] = kept;
        }
    }
}

// Adds a drop to the gauge.
fn step_catch(diameter: f32) {
    let measure = step_measure(diameter);
    atomicAdd(&step_counts[1], 1u);
    let low = atomicAdd(&step_counts[2], measure);
    if low + measure < low {
        atomicAdd(&step_counts[3], 1u);
    }
}

// True if a fall from `high` to `low` passes through the gauge.
fn step_through(high: vec3f, low: vec3f) -> bool {
    if step_frame.gauge == 0u || high.y < step_frame.gauge_height || low.y >= step_frame.gauge_height {
        return false;
    }
    let fraction = (high.y - step_frame.gauge_height) / (high.y - low.y);
    let at = high + (low - high) * fraction;
    let area = step_frame.gauge_area;
    return at.x >= area.x && at.z >= area.y && at.x < area.z && at.z < area.w;
}

// Random position in the rain area of Im & Sung.
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

// Moves a drop for the duration of a step. `key` identifies the drop.
fn step_fly(key: vec2u, number: u32, word: u32, flight: StepFlight) -> StepFlight {
    var kind = flight.kind;
    var velocity = flight.velocity;
    var seconds = flight.seconds;
    let diameter = step_shown(word, step_frame.bounced_size);
    let speed = step_speed(diameter);

    // Next velocity and position.
    let wind = step_wind(flight.position + velocity * (0.5 * step_frame.time));
    var moved: MotionStep;
    if step_frame.average == 1u {
        moved = motion_average(velocity, wind, speed, step_frame.time);
    } else {
        moved = motion_relax(velocity, wind, speed, step_frame.time);
    }
    velocity = moved.velocity;
    var displacement = moved.displacement;
    if kind == STEP_HIDDEN && seconds > 0.0 {
        // It catches up with the rain that it replaces.
        let late = min(seconds, step_frame.time);
        displacement += motion_settled(wind, speed) * late;
        seconds -= late;
    }
    var position = flight.position + displacement;

    // Obstacles on its path.
    if STEP_COLLIDES {
        if kind != STEP_HIDDEN && step_frame.elsewhere == 0u {
            let hit = collision_find(flight.position, position);
            if hit.kind != COLLISION_OPEN {
                let at = flight.position + displacement * hit.fraction;
                let how = hit.kind - 1u + select(0u, 2u, kind == STEP_BOUNCED);
                step_note(StepEvent(
                    at,
                    diameter,
                    velocity,
                    number | how << STEP_EVENT_KIND,
                    packing_octahedral_encode(hit.normal),
                    hit.fraction * step_frame.time,
                    key.y,
                ));
                let chance = rng_unit(rng_draw(step_frame.seed, key.x, key.y, STEP_CHANCE).x);
                if kind == STEP_FALLING && hit.kind == COLLISION_SURFACE && chance < step_frame.bounce {
                    kind = STEP_BOUNCED;
                    velocity = motion_bounce(velocity, hit.normal, step_frame.restitution, step_frame.grip);
                    position = at + hit.normal * STEP_CLEAR;
                    seconds = 0.0;
                } else {
                    kind = STEP_HIDDEN;
                }
            }
        }
    }
    if kind == STEP_FALLING && step_through(flight.position, position) {
        step_catch(diameter);
    }
    return StepFlight(position, kind, velocity, seconds);
}

// True if a drop is in the frustum after the step, by its position in the middle of the horizon.
fn step_inside(position: vec3f, velocity: vec3f, diameter: f32) -> bool {
    let offset = position + velocity * step_frame.frustum.half_horizon - step_frame.frustum.eye;
    return volume_limit(step_frame.frustum, offset, diameter, step_speed(diameter)) == VOLUME_INSIDE;
}

// Makes a step of a drop of a frustum, whose position is relative to the origin after the step.
fn step_view(drop: StepDrop) -> StepDrop {
    let kind = step_kind(drop.word);
    let bits = drop.word & STEP_DIAMETER;
    var count = step_count(drop.word);
    let number = bits | count << STEP_KIND;
    let flight = step_fly(vec2u(number, drop.last), number, drop.word, StepFlight(drop.position, kind, drop.velocity, 0.0));
    var then = flight.kind;
    if then == STEP_BOUNCED {
        if kind == STEP_FALLING {
            count = step_frame.step & STEP_COUNT;
        } else if f32((step_frame.step - count) & STEP_COUNT) * step_frame.time > step_frame.bounced_time {
            then = STEP_HIDDEN;
        }
    }
    let old = step_frame.step - drop.last > step_frame.oldest;
    if then == STEP_HIDDEN || old || !step_inside(flight.position, flight.velocity, motion_diameter(bits)) {
        then = STEP_GONE;
    }
    return StepDrop(flight.position, step_word(bits, then, count), flight.velocity, drop.last);
}

// Initial state of a drop of a refilled frustum, from its position in the middle of the horizon.
fn step_begin(drop: StepDrop) -> StepDrop {
    let bits = drop.word & STEP_DIAMETER;
    let velocity = step_coming(drop.position, step_speed(motion_diameter(bits)));
    let position = drop.position - velocity * step_frame.frustum.half_horizon;
    var kind = STEP_FALLING;
    if STEP_COLLIDES {
        kind = select(STEP_GONE, STEP_FALLING, collision_open(position));
    }
    return StepDrop(position, step_word(bits, kind, step_count(drop.word)), velocity, drop.last);
}

// Wraps the position of a drop into the volume; returns it and its count, which changes on re-entry.
fn step_relocate(drop: u32, count: u32, position: vec3f) -> StepKept {
    let eye = step_frame.now;
    let next = (count + 1u) & STEP_COUNT;
    switch step_frame.volume {
        case STEP_VOLUME_BOX: {
            let images = volume_images(position, step_frame.center, step_frame.size);
            let kept = position - step_frame.size * images;
            let image = step_image(step_image(count, step_pack(images)), step_frame.boxes);
            if ((image ^ count) & STEP_IMAGE_Y) == 0u {
                return StepKept(kept, image);
            }
            // No drop keeps its column (Rousseau 2006, 7.3), and all boxes of one rain agree.
            let column = step_column(step_frame.seed, drop, image, step_frame.size)
                - step_column(step_frame.seed, drop, count, step_frame.size);
            let moved = kept + vec3f(column.x, 0.0, column.y);
            let across = volume_images(moved, step_frame.center, step_frame.size) * vec3f(1.0, 0.0, 1.0);
            return StepKept(moved - step_frame.size * across, step_image(image, step_pack(across)));
        }
        case STEP_VOLUME_AREA: {
            if volume_in_area(eye, volume_local(eye, position - eye.position), step_frame.farthest) {
                return StepKept(position, count);
            }
            return StepKept(eye.position + volume_offset(eye, step_area(drop)), next);
        }
        default: {
            let words = rng_draw(step_frame.seed, drop, step_frame.step, STEP_TOP);
            let random = vec2f(rng_unit(words.x), rng_unit(words.y));
            let offset = position - step_frame.center;
            let half = 0.5 * step_frame.size.y;
            if step_frame.volume == STEP_VOLUME_TARIQ {
                if offset.y >= -half {
                    return StepKept(position, count);
                }
                let across = (random - 0.5) * step_frame.size.xz;
                return StepKept(step_frame.center + vec3f(across.x, offset.y + step_frame.size.y, across.y), next);
            }
            let radius = step_frame.size.x;
            if offset.y >= -half && dot(offset.xz, offset.xz) <= radius * radius {
                return StepKept(position, count);
            }
            let disk = radius * volume_on_disk(random);
            let height = offset.y + select(0.0, step_frame.size.y, offset.y < -half);
            return StepKept(step_frame.center + vec3f(disk.x, height, disk.y), next);
        }
    }
}

// Makes a step of a drop of a volume with a constant number of drops. Its position is relative to the origin after the
// step.
fn step_slot(number: u32, drop: StepDrop) -> StepDrop {
    let bits = drop.word & STEP_DIAMETER;
    let count = step_count(drop.word);
    var kind = step_kind(drop.word);
    var seconds = bitcast<f32>(drop.last);
    if kind == STEP_BOUNCED {
        seconds += step_frame.time;
    }
    let flight =
        step_fly(vec2u(number, count), number, drop.word, StepFlight(drop.position, kind, drop.velocity, seconds));
    kind = flight.kind;
    seconds = flight.seconds;
    var velocity = flight.velocity;
    if kind == STEP_BOUNCED && seconds > step_frame.bounced_time {
        kind = STEP_HIDDEN;
    }

    // It may have left the volume.
    let kept = step_relocate(number, count, flight.position);
    if any(kept.position != flight.position) || step_frame.elsewhere == 1u {
        seconds = 0.0;
        kind = STEP_FALLING;
        if STEP_COLLIDES {
            kind = select(STEP_HIDDEN, STEP_FALLING, collision_open(kept.position));
        }
        velocity = motion_settled(step_wind(kept.position), step_speed(motion_diameter(bits)));
    }
    return StepDrop(kept.position, step_word(bits, kind, kept.count), velocity, bitcast<u32>(seconds));
}

@compute @workgroup_size(256)
fn main_step(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.x + id.y * groups.x * 256u;
    if slot >= step_frame.count {
        return;
    }
    let packed = step_positions[slot];
    if step_kind(packed.w) == STEP_GONE {
        return;
    }
    let motion = step_motions[slot];
    let stored = bitcast<vec3f>(packed.xyz);
    var drop = StepDrop(stored - step_frame.shift, packed.w, bitcast<vec3f>(motion.xyz), motion.w);
    if step_frame.volume == STEP_VOLUME_VIEW && step_frame.elsewhere == 1u {
        drop = step_begin(StepDrop(stored, drop.word, drop.velocity, drop.last));
    } else if step_frame.volume == STEP_VOLUME_VIEW {
        drop = step_view(drop);
    } else {
        drop = step_slot(step_frame.first + slot, drop);
    }
    step_positions[slot] = vec4u(bitcast<vec3u>(drop.position), drop.word);
    step_motions[slot] = vec4u(bitcast<vec3u>(drop.velocity), drop.last);
}
