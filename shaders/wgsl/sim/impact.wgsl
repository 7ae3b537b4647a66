// Surfaces that drops hit.
// Twin: downpour_sim::impacts::splash_frame.

// Unit normal of a triangle on the side that a drop of a velocity came from.
fn impact_facing(triangle: BvhTriangle, velocity: vec3f) -> vec3f {
    let facet = cross(triangle.edge_1, triangle.edge_2);
    let length = sqrt(dot(facet, facet));
    let normal = select(vec3f(0.0, 1.0, 0.0), facet / max(length, 1.0e-30), length > 0.0);
    return select(normal, -normal, dot(normal, velocity) > 0.0);
}
