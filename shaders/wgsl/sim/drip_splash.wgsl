// Adds the crowns of drops that have dripped to the list of a picture, in a steady wind, where all drops of a point land in one place.
// Twin: downpour_sim::drips.

@compute @workgroup_size(64, 1, 1)
fn main_drip_splash(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index >= drip_frame.points || drip_rows[index].normal.y < SPLASH_LEVEL {
        return;
    }
    let point = drip_point(index);
    let row = point.row;
    let fall = drip_fall(row.terminal, drip_frame.wind, row.until);
    let landing = row.position - drip_frame.eye - vec3f(0.0, row.below, 0.0) + fall.moved;
    let last = drip_last(point, -row.until);
    for (var drop = drip_first(point, -row.until - SPLASH_MAX_S); drop <= last; drop += 1) {
        let met = drip_leaves(point, drop) + row.until;
        let words = drip_draw(point, drop, DRIP_DROP + 1u);
        let fallen = EyeDrop(
            landing - fall.velocity * met, row.diameter, fall.velocity, words.x ^ words.y, vec2f(0.0, met), FIELD_DRIPPED, words.y,
        );
        let crown = splash_crown(fallen, row.normal);
        if crown.diameter > 0.0 {
            let slot = atomicAdd(&field_found[0], 1u);
            if slot < splash_frame.room {
                field_drops[splash_frame.first + slot] = crown;
            }
        }
    }
}
