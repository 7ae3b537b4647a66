// What a drop meets among triangles without holes.
// Twin: downpour_sim::shelter.

// First hit from a distance on, in lengths of `way`; its distance is below 0 if there is none up to another.
fn shelter_hit(start: vec3f, way: vec3f, near: f32, far: f32) -> BvhHit {
    return bvh_hit(start, way, near, far);
}

// Any hit from a distance on, in lengths of `way`; its distance is below 0 if there is none up to another.
fn shelter_hit_any(start: vec3f, way: vec3f, near: f32, far: f32) -> BvhHit {
    return bvh_blocker(start, way, near, far);
}
