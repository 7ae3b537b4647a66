// Droplets of the parts of paths that were listed; see bounce.wgsl.
// Twin: downpour_sim::impacts::bounced, which computes in f64.

// A droplet of a drop that has hit a surface with a normal at the end of a time in a part of its path.
fn bounce_hit_droplet(drop: EyeDrop, after: f32, normal: vec3f) -> BounceDroplet {
    let begin = bounce_frame.first_time + drop.present.x * BOUNCE_SLICE + after;
    let leaves = motion_bounce(drop.velocity, normal, bounce_frame.restitution, bounce_frame.grip);
    let start = drop.offset + drop.velocity * after + normal * STEP_CLEAR;
    let speed = drop.present.y;
    let follows = bounce_carried(begin, speed);
    return BounceDroplet(start, begin, leaves, speed, follows, drop.diameter * bounce_frame.size);
}

// Age at which a droplet hits something, up to an age; below 0 if it does not.
fn bounce_hit_stopped(droplet: BounceDroplet, age: f32) -> f32 {
    let steps = u32(max(ceil(age / BOUNCE_STEP), 0.0));
    var before = bounce_frame.eye + droplet.start;
    for (var k = 1u; k <= steps; k += 1u) {
        let next = bounce_frame.eye + bounce_at(droplet, f32(k) * BOUNCE_STEP).moved;
        let hit = shelter_hit(before, (next - before) / BOUNCE_STEP, 0.0, BOUNCE_STEP);
        if hit.distance >= 0.0 {
            return f32(k - 1u) * BOUNCE_STEP + hit.distance;
        }
        before = next;
    }
    return -1.0;
}

// The droplet of a part of a path, as the picture shows it; of diameter 0 if there is none.
fn bounce_hit_part(drop: EyeDrop) -> EyeDrop {
    var none = drop;
    none.diameter = 0.0;
    let start = bounce_frame.eye + drop.offset;
    let hit = shelter_hit(start, drop.velocity, 0.0, BOUNCE_SLICE);
    if hit.distance < 0.0 {
        return none;
    }
    let normal = impact_facing(bvh_triangles[hit.triangle], drop.velocity);
    let droplet = bounce_hit_droplet(drop, hit.distance, normal);
    var listed = bounce_listed(droplet, drop);
    if listed.diameter <= 0.0 {
        return none;
    }
    // What the drop has passed before, from where it is at the end of all parts.
    let left = f32(bounce_frame.slices) - drop.present.x;
    let moved = bounce_row(u32(drop.present.x), drop.speed).moved
        + vec3f(0.0, drop.speed * left * BOUNCE_SLICE, 0.0);
    let cut = u32(ceil(max(left * BOUNCE_SLICE - shelter_frame.since_cut, 0.0) / SHELTER_CUT));
    if !shelter_is_open(start, start - moved, cut, drop.speed, drop.velocity) {
        return none;
    }
    let age = -droplet.begin;
    let half_time = bounce_frame.half_shutter;
    let stopped = bounce_hit_stopped(droplet, min(age + half_time, bounce_frame.longest));
    if stopped >= 0.0 {
        listed.present.y = stopped - age;
    }
    if listed.present.y <= -half_time {
        return none;
    }
    return bounce_outside(listed);
}

@compute @workgroup_size(64, 1, 1)
fn main_bounce_hit(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index >= min(atomicLoad(&bounce_parts.count), bounce_frame.parts) {
        return;
    }
    bounce_parts.drops[index] = bounce_hit_part(bounce_parts.drops[index]);
}
