// The radiance of a color of a host application.
// Twin: downpour_render::host.

// A color times the radiance of 1: none where it is below 0 or no number, and no more than half precision holds.
fn host_radiance_checked(color: vec3f, scale: f32) -> vec3f {
    let light = color * scale;
    return select(vec3f(0.0), min(light, vec3f(HOST_BRIGHTEST)), light >= vec3f(0.0));
}
