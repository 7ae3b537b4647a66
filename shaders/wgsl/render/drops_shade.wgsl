// Radiance along one ray through a drop: light that is refracted, mirrored, and reflected inside once, by the mask,
// looked up in the capture.
// Law: each has the fraction that the mask says; what is left, light that is reflected inside twice and more, is the mean of all
// that is about. So nothing is lost: in a uniform environment a drop vanishes. The mask's directions are for parallel rays;
// a ray of the camera turns them by what it differs from the ray to the drop's middle (first order in the drop's
// angle).
// Limits: the environment is that of the eye, not of the drop; a drop does not show other drops.
// Twin: downpour_render::rain::drops_shade.

// A drop as a ray meets it.
struct DropsShade {
    // From the eye to the drop's middle, of length 1.
    towards: vec3f,
    // Half the width of its mask, in equivalent radii.
    half_extent: f32,
    // Right of its mask, of length 1.
    right: vec3f,
    // Difference of the ray from `towards` at the same distance along it.
    lean: vec3f,
    // Equivalent radii between samples.
    spacing: f32,
    // Index of its mask, fractional: diameter, elevation.
    mask_index: vec2f,
}

// The position in the papers' capture of a ray, shifted by what the mask says.
fn drops_shade_shifted(ray: vec3f, texel: DropsTexel) -> vec2f {
    return drops_capture_shifted(ray, texel.direction);
}

// Light of a drop at (x, y), in units of half its mask: radiance times coverage, and coverage.
fn drops_shade_ray(drop: DropsShade, x: f32, y: f32) -> vec4f {
    return drops_shade_texel(drop, drops_mask_at(drop.mask_index, x, y), x, y);
}

// The same by the values of the mask there.
fn drops_shade_texel(drop: DropsShade, texel: DropsTexel, x: f32, y: f32) -> vec4f {
    if texel.coverage <= 0.0 {
        return vec4f(0.0);
    }
    let right = drop.right;
    let up = cross(right, drop.towards);
    // A sphere's deviation 2 (asin q - asin(q / n)) and its derivative, for the footprint.
    let q = min((x * x + y * y) * drop.half_extent * drop.half_extent, 0.98);
    let bend = 2.0 / sqrt(1.0 - q);
    if drops_frame.form == DROPS_SHIFT {
        let position = drops_shade_shifted(drop.towards + drop.lean, texel);
        return vec4f(drops_capture_at(position, drop.spacing * (bend - DROPS_STRAIGHT)), 1.0) * texel.coverage;
    }
    let rest = max(1.0 - texel.transmittance - texel.reflectance - texel.internal_transmittance, 0.0);
    var sum = drops_capture_texel(drops_frame.capture_last, 0, 0) * rest;
    // Transmitted light, light mirrored at the outside, and light reflected inside.
    for (var k = 0u; k < 3u; k += 1u) {
        var seen = texel.direction;
        var weight = texel.transmittance;
        var footprint = drop.spacing * (bend - DROPS_STRAIGHT);
        if k == 1u {
            seen = texel.reflected;
            weight = texel.reflectance;
            footprint = drop.spacing * bend;
        } else if k == 2u {
            seen = texel.internal;
            weight = texel.internal_transmittance;
            footprint = drop.spacing * max(abs(bend - 2.0 * DROPS_STRAIGHT), 1.0);
        }
        let direction = right * seen.x + up * seen.y - drop.towards * seen.z + drop.lean;
        sum += drops_capture_at(packing_octahedral_encode(direction) * 0.5 + 0.5, footprint) * weight;
    }
    return vec4f(sum, 1.0) * texel.coverage;
}
