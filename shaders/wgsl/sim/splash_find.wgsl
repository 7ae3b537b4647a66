// Adds the crowns of drops that have hit something in a slice of time to the list of a picture.
// Method: the drops of the slice are found as those of a picture with that exposure (main_field_find), and what they hit as what stops
// drops while the shutter is open (main_shelter).
// Twin: downpour_sim::impacts::splash_frame.

// Drops of the slice, and how many of them were found.
@group(0) @binding(3) var<storage, read> splash_find_drops: array<EyeDrop>;
@group(0) @binding(4) var<storage, read> splash_find_counts: array<u32>;
// The list of the picture, and how many have been found.
@group(0) @binding(5) var<storage, read_write> splash_find_list: array<EyeDrop>;
@group(0) @binding(6) var<storage, read_write> splash_find_found: array<atomic<u32>, 2>;

@compute @workgroup_size(64, 1, 1)
fn main_splash_find(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index == 0u && splash_find_counts[0] > splash_frame.drops {
        // Drops without room are told as such of the list.
        atomicMax(&splash_find_found[0], splash_frame.room + splash_find_counts[0] - splash_frame.drops);
    }
    if index >= splash_frame.drops {
        return;
    }
    let drop = splash_find_drops[index];
    if drop.diameter <= 0.0 || drop.present.y > splash_frame.half_time {
        return;
    }
    let start = splash_frame.eye + drop.offset - drop.velocity * splash_frame.half_time;
    let met = drop.present.y + splash_frame.half_time;
    let hit = bvh_hit(start, drop.velocity, met - SPLASH_AGAIN, met + SPLASH_AGAIN);
    if hit.distance < 0.0 {
        return;
    }
    let crown = splash_crown(drop, impact_facing(bvh_triangles[hit.triangle], drop.velocity));
    if crown.diameter > 0.0 {
        let slot = atomicAdd(&splash_find_found[0], 1u);
        if slot < splash_frame.room {
            splash_find_list[splash_frame.first + slot] = crown;
        }
    }
}
