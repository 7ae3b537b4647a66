// One step of every drop: Algorithm 1 of Rousseau 2008.
//
// A drop that meets a surface bounces or goes on unseen, at its speed, until it leaves the volume: what comes back on
// the other side is open rain again if nothing stands above it. So nothing is lost and nothing born, and the rain in the
// open keeps its density.
// Twin: downpour_sim::step.

// Leave out what is not there: pipelines without wind field, collision map or events are faster.
override STEP_FIELD: bool = true;
override STEP_COLLIDES: bool = true;

struct StepFrame {
    // The eye before the step, and after it. Each relative to the origin of its time.
    before: VolumeEye,
    now: VolumeEye,
    // What the origin has moved, m; in a box, up to whole boxes.
    shift: vec3f,
    // Drops of this dispatch.
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
    // Distance at which a drop is resolved, per diameter; and at most, m.
    range: f32,
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
    unused: u32,
    // The gauge's rectangle: lower x and z, upper x and z, m.
    gauge_area: vec4f,
    // 1, 2, 4, ... steps back.
    back: array<VolumeBack, STEP_BACKS>,
}

// What is noted of an impact.
struct StepEvent {
    place: vec3f,
    diameter: f32,
    velocity: vec3f,
    // Number of the drop, and in the highest two bits how it met what: COLLISION_* - 1, and 2 more for a bounced drop.
    drop: u32,
}

@group(0) @binding(0) var<uniform> step_frame: StepFrame;
// Place, m, and the drop's word.
@group(0) @binding(1) var<storage, read_write> step_places: array<vec4u>;
// Velocity, m/s, and seconds: how long a bounced drop has been on its way, or how far an unseen one is behind.
@group(0) @binding(2) var<storage, read_write> step_motions: array<vec4u>;
// Terminal speeds.
@group(0) @binding(3) var<storage, read> step_speeds: array<f32>;
@group(0) @binding(4) var<storage, read> step_cells: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> step_events: array<StepEvent>;
// Events; drops through the gauge; their volume in units of STEP_GAUGE_UNIT, low and high word.
@group(0) @binding(6) var<storage, read_write> step_counts: array<atomic<u32>, 4>;
@group(0) @binding(7) var<uniform> step_grid: WindFieldGrid;

// The diameter that a drop shows: a bounced one is smaller.
fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    return select(diameter, diameter * bounced_size, (word >> STEP_KIND) == STEP_BOUNCED);
}

// The volume of a drop in units of the gauge.
fn step_measure(diameter: f32) -> u32 {
    return u32(STEP_GAUGE_PER_CUBE * diameter * diameter * diameter + 0.5);
}

// Terminal speed of a diameter.
fn step_speed(diameter: f32) -> f32 {
    let entry = motion_table_entry(diameter);
    return motion_table_speed(step_speeds[entry], step_speeds[entry + 1u], diameter);
}

// The wind at a place.
fn step_wind(at: vec3f) -> vec3f {
    if !STEP_FIELD {
        return step_frame.wind;
    }
    let place = wind_field_place(step_grid, at);
    var corners: array<vec3f, 8>;
    for (var k = 0u; k < 8u; k += 1u) {
        corners[k] = step_cells[wind_field_index(step_grid, wind_field_corner(place, k))].xyz;
    }
    return wind_field_mix(corners, place.share);
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

// Where the path that leads to a place in view came into view.
fn step_entry(local: vec3f, way: vec3f, range: f32) -> vec3f {
    var found = local;
    for (var k = STEP_BACKS; k > 0u; k -= 1u) {
        let earlier = volume_back(step_frame.back[k - 1u], found, way);
        if volume_in_view(step_frame.now, earlier, range) {
            found = earlier;
        }
    }
    return found;
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

// Where a drop is that moved from `before` (relative to the origin then) to `place`.
fn step_relocate(drop: u32, word: u32, before: vec3f, place: vec3f, displacement: vec3f) -> vec3f {
    let eye = step_frame.now;
    switch step_frame.volume {
        case STEP_VOLUME_BOX: {
            return volume_wrap(place, step_frame.centre, step_frame.size);
        }
        case STEP_VOLUME_VIEW: {
            let range = min(motion_diameter(word & STEP_DIAMETER) * step_frame.range, step_frame.farthest);
            if volume_in_view(eye, volume_local(eye, place - eye.place), range) {
                return place;
            }
            let local = volume_local(step_frame.before, before - step_frame.before.place);
            // What the drop would have moved in the picture if it had been at the eye.
            let way = volume_local(eye, step_frame.before.place - step_frame.shift + displacement - eye.place);
            return eye.place + volume_offset(eye, step_entry(local, way, range));
        }
        case STEP_VOLUME_AREA: {
            if volume_in_area(eye, volume_local(eye, place - eye.place), step_frame.farthest) {
                return place;
            }
            return eye.place + volume_offset(eye, step_area(drop));
        }
        default: {
            let words = rng_draw(step_frame.seed, drop, step_frame.step, STEP_TOP);
            let random = vec2f(rng_unit(words.x), rng_unit(words.y));
            let offset = place - step_frame.centre;
            let half = 0.5 * step_frame.size.y;
            if step_frame.volume == STEP_VOLUME_TARIQ {
                if offset.y >= -half {
                    return place;
                }
                let across = (random - 0.5) * step_frame.size.xz;
                return step_frame.centre + vec3f(across.x, offset.y + step_frame.size.y, across.y);
            }
            let radius = step_frame.size.x;
            if offset.y >= -half && dot(offset.xz, offset.xz) <= radius * radius {
                return place;
            }
            let disc = radius * volume_on_disc(random);
            let height = offset.y + select(0.0, step_frame.size.y, offset.y < -half);
            return step_frame.centre + vec3f(disc.x, height, disc.y);
        }
    }
}

@compute @workgroup_size(256)
fn main_step(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.x + id.y * groups.x * 256u;
    if slot >= step_frame.count {
        return;
    }
    let drop = step_frame.first + slot;
    let stored_place = step_places[slot];
    let stored_motion = step_motions[slot];
    let before = bitcast<vec3f>(stored_place.xyz);
    let from_place = before - step_frame.shift;
    var word = stored_place.w;
    var velocity = bitcast<vec3f>(stored_motion.xyz);
    var seconds = bitcast<f32>(stored_motion.w);
    var kind = word >> STEP_KIND;
    let diameter = step_shown(word, step_frame.bounced_size);
    let speed = step_speed(diameter);

    // Next velocity and place.
    let wind = step_wind(from_place + velocity * (0.5 * step_frame.time));
    var moved: MotionStep;
    if step_frame.average == 1u {
        moved = motion_average(velocity, wind, speed, step_frame.time);
    } else {
        moved = motion_relax(velocity, wind, speed, step_frame.time);
    }
    velocity = moved.velocity;
    var displacement = moved.displacement;
    if kind == STEP_BOUNCED {
        seconds += step_frame.time;
    } else if seconds > 0.0 {
        // It catches up with the rain that it would have been.
        let late = min(seconds, step_frame.time);
        displacement += motion_settled(wind, speed) * late;
        seconds -= late;
    }
    var place = from_place + displacement;

    // What stands in its way.
    if STEP_COLLIDES {
        if kind != STEP_HIDDEN && step_frame.elsewhere == 0u {
            let hit = collision_find(from_place, place);
            if hit.kind != COLLISION_OPEN {
                let at = from_place + displacement * hit.share;
                let how = hit.kind - 1u + select(0u, 2u, kind == STEP_BOUNCED);
                step_note(at, diameter, velocity, drop | how << STEP_EVENT_KIND);
                let chance = rng_unit(rng_draw(step_frame.seed, drop, step_frame.step, STEP_CHANCE).x);
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
        if kind == STEP_BOUNCED && seconds > step_frame.bounced_time {
            kind = STEP_HIDDEN;
        }
    }
    if kind == STEP_FALLING && step_through(from_place, place) {
        step_catch(diameter);
    }

    // What has left the volume.
    let kept = step_relocate(drop, word, before, place, displacement);
    if any(kept != place) || step_frame.elsewhere == 1u {
        place = kept;
        seconds = 0.0;
        kind = STEP_FALLING;
        if STEP_COLLIDES {
            kind = select(STEP_HIDDEN, STEP_FALLING, collision_open(place));
        }
        velocity = motion_settled(step_wind(place), step_speed(motion_diameter(word & STEP_DIAMETER)));
    }
    word = word & STEP_DIAMETER | kind << STEP_KIND;
    step_places[slot] = vec4u(bitcast<vec3u>(place), word);
    step_motions[slot] = vec4u(bitcast<vec3u>(velocity), bitcast<u32>(seconds));
}
