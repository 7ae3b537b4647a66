// Invocations of dispatches of several rows of workgroups: a row of workgroups is limited.
// Twin: downpour_gpu::invocation_index.

// Number of an invocation among all of a dispatch of workgroups of 64, by its global id and the number of workgroups.
fn invocation_index(id: vec3u, groups: vec3u) -> u32 {
    return id.y * groups.x * 64u + id.x;
}
