// Radiances of a list of points of streaks. Host: downpour_atlas::gpu.

struct AtlasQuery {
    // From the drop to its light, a unit vector.
    light: vec3f,
    // Equivalent diameter in meters.
    diameter: f32,
    // From the drop to its viewer, a unit vector.
    view: vec3f,
    id: u32,
    // The drop's axis upwards, a unit vector.
    axis: vec3f,
    // Equivalent radii to the right of the middle.
    across: f32,
    // Turns of the mode (2,0) along.
    turns: f32,
    unused: array<u32, 3>,
}

@group(0) @binding(4) var<storage, read> atlas_query_points: array<AtlasQuery>;
@group(0) @binding(5) var<storage, read_write> atlas_query_radiances: array<f32>;

@compute @workgroup_size(64)
fn main_atlas_query(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&atlas_query_points) {
        return;
    }
    let point = atlas_query_points[id.x];
    let slot = atlas_lookup_slot(point.id, point.diameter, point.axis, point.light, point.view);
    atlas_query_radiances[id.x] = atlas_lookup_radiance(slot, point.across, point.turns);
}
