// What one ray sees through a drop: refracted and reflected light by the mask, looked up in the capture.
// Law: the light that comes through has the share that the mask's transmittance says, the rest comes from the mirrored
// direction, so nothing is lost: in uniform surroundings a drop vanishes. The mask's directions are for parallel rays;
// a ray of the camera turns them by what it differs from the ray to the drop's middle (first order in the drop's
// angle).
// Limits: the surroundings are those of the eye, not of the drop; a drop does not show other drops.
// Twin: downpour_render::rain::drops_shade.

// A drop as a ray meets it.
struct DropsShade {
    // From the eye to the drop's middle, of length 1.
    towards: vec3f,
    // Half the width of its mask, in equivalent radii.
    half_extent: f32,
    // What the ray differs from `towards`, where it is as far along.
    lean: vec3f,
    // Equivalent radii between samples.
    spacing: f32,
    // Place in the masks: rows of diameters, and of elevations.
    row: vec2f,
}

// The place in the papers' capture of a ray, shifted by what the mask says: the refracted ray meets the plane of the
// capture as far from the ray's own place as the tangent of its deviation.
fn drops_shade_shifted(ray: vec3f, texel: DropsTexel) -> vec2f {
    let depth = max(dot(ray, drops_frame.capture_forward), 1.0e-3);
    let deep = max(-texel.direction.z, 1.0e-3);
    let shift = vec2f(
        texel.direction.x / deep / sqrt(dot(drops_frame.capture_right, drops_frame.capture_right)),
        texel.direction.y / deep / sqrt(dot(drops_frame.capture_up, drops_frame.capture_up)),
    );
    let place = vec2f(
        dot(ray, drops_frame.capture_right) / dot(drops_frame.capture_right, drops_frame.capture_right),
        dot(ray, drops_frame.capture_up) / dot(drops_frame.capture_up, drops_frame.capture_up),
    ) / depth + shift;
    return clamp(vec2f(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y), vec2f(0.0), vec2f(1.0));
}

// What a drop shows at (x, y), in units of half its mask: radiance times coverage, and coverage.
fn drops_shade_ray(drop: DropsShade, x: f32, y: f32) -> vec4f {
    let texel = drops_mask_at(drop.row, x, y);
    if texel.coverage <= 0.0 {
        return vec4f(0.0);
    }
    let right = drops_mask_right(drop.towards);
    let up = cross(right, drop.towards);
    // A sphere's deviation 2 (asin q - asin(q / n)) and its derivative, for the footprint.
    let q = min((x * x + y * y) * drop.half_extent * drop.half_extent, 0.98);
    let bend = 2.0 / sqrt(1.0 - q);
    let shifts = drops_frame.form == DROPS_SHIFT;
    var sum = vec3f(0.0);
    // What comes through, then what is mirrored.
    for (var k = 0u; k < 2u; k += 1u) {
        let mirrored = k == 1u;
        let seen = select(texel.direction, texel.reflected, mirrored);
        let weight = select(texel.transmittance, 1.0 - texel.transmittance, mirrored);
        let footprint = drop.spacing * select(bend - DROPS_STRAIGHT, bend, mirrored);
        let direction = right * seen.x + up * seen.y - drop.towards * seen.z + drop.lean;
        var place = packing_octahedral_encode(direction) * 0.5 + 0.5;
        if shifts {
            place = drops_shade_shifted(drop.towards + drop.lean, texel);
        }
        sum += drops_capture_at(place, footprint) * select(weight, 1.0, shifts);
        if shifts {
            break;
        }
    }
    return vec4f(sum, 1.0) * texel.coverage;
}
