// What a drop meets among triangles with holes, such as painted leaves: rain falls through them.
// Twin: downpour_sim::shelter.

// First hit from a distance on that is no hole, in lengths of `way`; its distance is below 0 if there is none up to another.
fn shelter_hit(start: vec3f, way: vec3f, near: f32, far: f32) -> BvhHit {
    return shelter_hit_walk(start, way, near, far, false);
}

// Any hit from a distance on that is no hole, in lengths of `way`; its distance is below 0 if there is none up to another.
fn shelter_hit_any(start: vec3f, way: vec3f, near: f32, far: f32) -> BvhHit {
    return shelter_hit_walk(start, way, near, far, true);
}

// The first hit that is no hole or, if `any`, any.
fn shelter_hit_walk(start: vec3f, way: vec3f, near: f32, far: f32, any: bool) -> BvhHit {
    let step = SHELTER_CLEAR / max(sqrt(dot(way, way)), SHELTER_CLEAR);
    var begin = near;
    for (var hole = 0u; hole < SHELTER_HOLES; hole += 1u) {
        let hit = bvh_walk(start, way, begin, far, any);
        if hit.distance < 0.0 || !surface_is_open(SurfaceHit(hit.distance, hit.triangle, hit.u, hit.v)) {
            return hit;
        }
        begin = max(hit.distance, begin) + step;
    }
    return BvhHit(-1.0, 0u, 0.0, 0.0);
}
