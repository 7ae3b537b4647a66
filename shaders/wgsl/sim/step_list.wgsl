// Drops of a state that a picture shows: where they are at its time, and the part of the exposure in which they exist.
//
// A drop moves from the state at its velocity. One that is stopped while the shutter is open is listed with the time at
// which it is, and so are the droplet that rebounds and the crown of the splash. Nothing is stored: the next step computes the same.
// Crowns of earlier steps' impacts: step_splash.wgsl.
// Twin: downpour_sim::step_list.

struct StepListFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Places of the list that are free.
    room: u32,
    unused_2: u32,
    unused_3: u32,
    // Eye, m, relative to the origin of the state.
    eye: vec3f,
    // Time from the state to the picture, s.
    after: f32,
    // Velocity of the eye, m/s, and half the exposure, s.
    velocity: vec3f,
    half_shutter: f32,
    // Axis of the camera's rotation, rad/s, and the least distance of drops, m.
    turning: vec3f,
    nearest: f32,
    // Center and edges of a box, m; the greatest distance of drops, m; one of STEP_VOLUME_*.
    center: vec3f,
    farthest: f32,
    size: vec3f,
    volume: u32,
    // Outward normals of the sides of the picture's pyramid, and of the plane behind the eye.
    sides: array<vec4f, FIELD_SIDES>,
    // A pane before the eye: its unit normal, away from the eye, and its distance, m; 0 without one.
    pane: vec4f,
    seed: vec2u,
    // Distance per diameter at which a drop is resolved.
    range: f32,
    // Fraction of impacts that bounce; fraction of the normal speed that is reflected; of the tangential speed that is lost.
    bounce: f32,
    restitution: f32,
    grip: f32,
    // Diameter of a bounced drop relative to that of the falling one.
    bounced_size: f32,
    // Number of the step after the state, and steps per second.
    step: u32,
    per_second: f32,
    // Drops or slots of this dispatch, and the number of the first.
    count: u32,
    first: u32,
    // Places of the list that are taken.
    known: u32,
}

// Position of a drop at the picture's time if nothing stops it, m, and its word then.
struct StepListPlace {
    position: vec3f,
    word: u32,
}

// A drop, and the droplet that rebounds from what stops it and the crown of its splash; their diameters are 0 where the picture does
// not show them.
struct StepListShown {
    itself: EyeDrop,
    rebound: EyeDrop,
    crown: EyeDrop,
}

@group(0) @binding(11) var<uniform> step_list_frame: StepListFrame;
@group(0) @binding(12) var<storage, read_write> step_list_drops: array<EyeDrop>;
// Drops that were found, of which those beyond the room are lost; drops that were looked at; drops that entered and found no slot, and
// impacts that were not kept.
@group(0) @binding(13) var<storage, read_write> step_list_found: array<atomic<u32>, 3>;

// Id of a drop by what it is known by, constant while the drop exists: a Feistel network, which maps no two of 64 bits to one. Droplets of a
// view that rebounded in one step from drops that entered in one step and are alike share one.
fn step_list_id(high: u32, low: u32) -> vec2u {
    var words = vec2u(high, low);
    for (var turn = 0u; turn < STEP_LIST_TURNS; turn += 1u) {
        var mixed = (words.y ^ words.y >> 16u) * STEP_LIST_MULTIPLIER + turn;
        mixed = (mixed ^ mixed >> 15u) * STEP_LIST_MULTIPLIER;
        words = vec2u(words.y, words.x ^ mixed ^ mixed >> 16u);
    }
    return words;
}

// Where a drop is at the picture's time; in a box it may have come in again.
fn step_list_place(number: u32, drop: StepDrop) -> StepListPlace {
    let here = drop.position + drop.velocity * step_list_frame.after;
    if step_list_frame.volume != STEP_VOLUME_BOX {
        return StepListPlace(here, drop.word);
    }
    let size = step_list_frame.size;
    let away = volume_images(here, step_list_frame.center, size);
    if all(away == vec3f(0.0)) {
        return StepListPlace(here, drop.word);
    }
    let count = step_count(drop.word);
    var image = step_image(count, step_pack(away));
    var at = here - size * away;
    if away.y != 0.0 {
        let seed = step_list_frame.seed;
        let moved = step_column(seed, number, image, size) - step_column(seed, number, count, size);
        at += vec3f(moved.x, 0.0, moved.y);
        let across = volume_images(at, step_list_frame.center, size) * vec3f(1.0, 0.0, 1.0);
        image = step_image(image, step_pack(across));
        at -= size * across;
    }
    var kind = STEP_FALLING;
    if STEP_COLLIDES {
        kind = select(STEP_HIDDEN, STEP_FALLING, collision_open(at - drop.velocity * step_list_frame.after));
    }
    return StepListPlace(at, step_word(drop.word & STEP_DIAMETER, kind, image));
}

// A drop as the eye sees it.
fn step_list_seen(at: vec3f, velocity: vec3f, number: u32, word: u32, last: u32, present: vec2f) -> EyeDrop {
    let is_bounced = step_kind(word) == STEP_BOUNCED;
    let bounced = select(0u, 1u << 30u, is_bounced);
    let diameter = step_shown(word, step_list_frame.bounced_size);
    var id = step_list_id(step_count(word) | bounced, number);
    if step_list_frame.volume == STEP_VOLUME_VIEW {
        id = step_list_id(last, (word & STEP_DIAMETER) | step_count(word) << STEP_KIND | bounced);
    }
    let speed = select(step_speed(diameter), FIELD_BOUNCED, is_bounced);
    return EyeDrop(at - step_list_frame.eye, diameter, velocity, id.x ^ id.y, present, speed, id.y);
}

// The drop in the part of the exposure in which the picture shows it; its diameter is 0 if there is none.
fn step_list_shown(drop: EyeDrop) -> EyeDrop {
    var shown = drop;
    shown.diameter = 0.0;
    let half_time = step_list_frame.half_shutter;
    let open = eye_drop_position(drop, step_list_frame.velocity, step_list_frame.turning, -half_time);
    let close = eye_drop_position(drop, step_list_frame.velocity, step_list_frame.turning, half_time);
    let pane = step_list_frame.pane;
    let outside = eye_drop_outside(dot(pane.xyz, open) - pane.w, dot(pane.xyz, close) - pane.w, half_time);
    shown.present = vec2f(max(drop.present.x, outside.x), min(drop.present.y, outside.y));
    let from_time = max(drop.present.x, -half_time);
    let to_time = min(drop.present.y, half_time);
    let distance = sqrt(dot(drop.offset, drop.offset));
    let range = min(drop.diameter * step_list_frame.range, step_list_frame.farthest);
    let is_there = shown.present.x <= shown.present.y && from_time <= to_time;
    if !is_there || distance < step_list_frame.nearest || distance > range {
        return shown;
    }
    let begin = eye_drop_position(drop, step_list_frame.velocity, step_list_frame.turning, from_time);
    let end = eye_drop_position(drop, step_list_frame.velocity, step_list_frame.turning, to_time);
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        let side = step_list_frame.sides[k].xyz;
        if min(dot(side, begin), dot(side, end)) > VOLUME_RADIUS * drop.diameter {
            return shown;
        }
    }
    shown.diameter = drop.diameter;
    return shown;
}

// Droplet that rebounds from a surface that a drop meets `until` seconds after the picture's time: as if it had always moved.
fn step_list_rebound(place: StepListPlace, velocity: vec3f, number: u32, last: u32, hit: CollisionHit, until: f32) -> EyeDrop {
    let bits = place.word & STEP_DIAMETER;
    let at = place.position + velocity * until + hit.normal * STEP_CLEAR;
    let leaves = motion_bounce(velocity, hit.normal, step_list_frame.restitution, step_list_frame.grip);
    // Half of the remaining exposure slows it down.
    let left = max(0.5 * (step_list_frame.half_shutter - until), 0.0);
    let air = velocity + vec3f(0.0, step_speed(motion_diameter(bits)), 0.0);
    let speed = step_speed(motion_diameter(bits) * step_list_frame.bounced_size);
    let slowed = motion_relax(leaves, air, speed, left).velocity;
    var count = step_count(place.word);
    if step_list_frame.volume == STEP_VOLUME_VIEW {
        let steps = u32(max((until + step_list_frame.after) * step_list_frame.per_second, 0.0));
        count = (step_list_frame.step + steps) & STEP_COUNT;
    }
    let word = step_word(bits, STEP_BOUNCED, count);
    return step_list_seen(at - slowed * until, slowed, number, word, last, vec2f(until, FIELD_ALWAYS));
}

// True if a drop that falls onto a surface rebounds.
fn step_list_bounces(number: u32, word: u32, last: u32) -> bool {
    let count = step_count(word);
    var key = vec2u(number, count);
    if step_list_frame.volume == STEP_VOLUME_VIEW {
        key = vec2u((word & STEP_DIAMETER) | count << STEP_KIND, last);
    }
    let chance = rng_unit(rng_draw(step_list_frame.seed, key.x, key.y, STEP_CHANCE).x);
    return step_kind(word) == STEP_FALLING && chance < step_list_frame.bounce;
}

// A drop and its rebounding droplet, as the picture shows them.
fn step_list_drop(number: u32, drop: StepDrop) -> StepListShown {
    var shown: StepListShown;
    let kind = step_kind(drop.word);
    if kind != STEP_FALLING && kind != STEP_BOUNCED {
        return shown;
    }
    let place = step_list_place(number, drop);
    if step_kind(place.word) == STEP_HIDDEN {
        return shown;
    }
    let always = vec2f(-FIELD_ALWAYS, FIELD_ALWAYS);
    let seen = step_list_seen(place.position, drop.velocity, number, place.word, drop.last, always);
    shown.itself = step_list_shown(seen);
    let is_shown = shown.itself.diameter > 0.0;
    // A picture may show the crown of a drop that it would not show behind the surface.
    if STEP_COLLIDES && (is_shown || splash_frame.strength > 0.0) {
        let half_time = step_list_frame.half_shutter;
        let start = place.position - drop.velocity * step_list_frame.after;
        let hit = collision_find(start, place.position + drop.velocity * half_time);
        if hit.kind == COLLISION_OPEN {
            return shown;
        }
        let until = hit.fraction * (step_list_frame.after + half_time) - step_list_frame.after;
        var falling = seen;
        falling.present.y = until;
        if is_shown {
            shown.itself = step_list_shown(falling);
        }
        if hit.kind == COLLISION_SURFACE && step_kind(place.word) == STEP_FALLING {
            shown.crown = splash_crown(falling, hit.normal);
        }
        if is_shown && hit.kind == COLLISION_SURFACE && step_list_bounces(number, place.word, drop.last) {
            shown.rebound = step_list_shown(step_list_rebound(place, drop.velocity, number, drop.last, hit, until));
        }
    }
    return shown;
}

// Adds a drop to the list, if it is one.
fn step_list_add(drop: EyeDrop) {
    if drop.diameter > 0.0 {
        let slot = atomicAdd(&step_list_found[0], 1u);
        if slot < step_list_frame.room {
            step_list_drops[step_list_frame.known + slot] = drop;
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_step_list_clear(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index < 2u {
        atomicStore(&step_list_found[index], 0u);
    }
    if index == 2u {
        atomicStore(&step_list_found[2], atomicLoad(&step_counts[4]));
    }
    if index < step_list_frame.room {
        step_list_drops[step_list_frame.known + index].diameter = 0.0;
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_step_list(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = invocation_index(id, groups);
    if slot >= step_list_frame.count {
        return;
    }
    let packed = step_positions[slot];
    if step_kind(packed.w) == STEP_GONE {
        return;
    }
    let motion = step_motions[slot];
    let drop = StepDrop(bitcast<vec3f>(packed.xyz), packed.w, bitcast<vec3f>(motion.xyz), motion.w);
    atomicAdd(&step_list_found[1], 1u);
    let shown = step_list_drop(step_list_frame.first + slot, drop);
    step_list_add(shown.itself);
    step_list_add(shown.rebound);
    step_list_add(shown.crown);
}
