// Lamps and the sun as a drop on a pane shows them: bright spots, the quasi-caustic highlights of Tatarchuk and Isidoro 2006.
// Law: a drop is a lens that images a source of light; radiance times solid angle is the irradiance that comes through. The
// image is spread over what neighboring rays see apart, or over the source where that is larger; its sum stays.
// Twin: downpour_render::glass::light.

struct GlassPictureLight {
    // From the eye, m; a sun is far.
    position: vec3f,
    // Half the angle that it takes, radians.
    radius: f32,
    // Irradiance at the eye of a surface that faces it.
    color: vec3f,
    // From the eye, m.
    distance: f32,
}

// Fraction of a source's light per solid angle, at a squared distance in direction from its middle: a paraboloid whose integral
// is 1.
fn glass_picture_light_lobe(away: f32, radius: f32) -> f32 {
    let squared = radius * radius;
    return max(1.0 - away / squared, 0.0) * GLASS_PICTURE_LIGHT_PEAK / squared;
}

// Radiance of a source in a direction from a position of the pane, for a footprint of some angle.
fn glass_picture_light_seen(light: GlassPictureLight, from_eye: vec3f, direction: vec3f, footprint: f32) -> vec3f {
    let way = light.position - from_eye;
    let squared = max(dot(way, way), 1.0e-6);
    let away = direction - way / sqrt(squared);
    let width = footprint * GLASS_PICTURE_LIGHT_WIDTH;
    let radius = sqrt(light.radius * light.radius + width * width);
    let nearer = light.distance * light.distance / squared;
    return light.color * (nearer * glass_picture_light_lobe(dot(away, away), radius));
}
