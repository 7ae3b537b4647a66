// A ray through a drop that oscillates, for pictures of many: to where its light leaves, three times over.
// The surface is r = rho(x) f(x, h) scale with f = 1 + s2 P20(x) + 3/2 s3 (1 - 5 x^2) h. p is a point, x = -p.y / |p| and
// h = p.x / |p|. Lengths are in units of the volume-equivalent radius; the drop's origin is at 0, its axis is +Y, the lobe of
// the mode (3,1) is toward +X. The gauge squared is G = |p|^2 / r^2. With q = rho' / rho + f_x / f and k = f_h / f,
// 1/2 grad G = (p (1 + q x + k h) + |p| (q up - k right)) / r^2.
// The surface is met by the steps of mask_trace_step from the spheroid that the mode (2,0) makes of the drop.
// Law: at each interface light is split into what leaves and what stays, unpolarized each time; what is left after the third
// exit leaves elsewhere, and is in no fraction.
// Limits: a drop is taken to be met once on the way in and once on the way out; light that has not left after
// MASK_WOBBLE_BOUNCES interfaces is not followed.
// Twin: downpour_mask::wobble.

// A drop at one instant.
struct MaskWobbleDrop {
    shape: DropShapeCoefficients,
    // s2, s3, and what keeps the volume.
    state: vec3f,
    // Refractive index of water relative to air.
    index: f32,
    // 1 / A^2 across and 1 / B^2 along the axis of the spheroid where the search begins.
    inverse_wide: f32,
    inverse_tall: f32,
}

// The light of one ray where it leaves: reflected outside, and at the first three exits from inside.
struct MaskWobbleLight {
    outer: vec3f,
    first: vec3f,
    second: vec3f,
    third: vec3f,
    // Fractions of the light, in this order; what they leave of 1 is not followed.
    fractions: vec4f,
    // Interfaces passed up to there (from 1); 0 where there is no exit.
    interfaces: vec4f,
}

// G - 1 and half of grad G at a point.
fn mask_wobble_surface(shape: DropShapeCoefficients, state: vec3f, point: vec3f) -> MaskTraceSurface {
    let square = max(dot(point, point), MASK_TINY);
    let length = sqrt(square);
    let inverse_length = 1.0 / length;
    let x = -(point.y * inverse_length);
    let h = point.x * inverse_length;
    let radius_slope = drop_shape_radius_slope(shape, x);
    let lobe = 1.5 * state.y * (1.0 - 5.0 * x * x);
    let factor = 1.0 + state.x * drop_oscillation_legendre_20(x) + lobe * h;
    let by_x = 3.0 * state.x * x - 15.0 * state.y * x * h;
    let inverse_factor = 1.0 / factor;
    let q = radius_slope.y / radius_slope.x + by_x * inverse_factor;
    let k = lobe * inverse_factor;
    let inverse = 1.0 / (radius_slope.x * factor * state.z);
    let scale_all = inverse * inverse;
    let along = 1.0 + q * x + k * h;
    let gradient = point * along + vec3f(-(length * k), length * q, 0.0);
    return MaskTraceSurface(gradient * scale_all, square * scale_all - 1.0);
}

// a . M . b for the matrix M of the spheroid.
fn mask_wobble_spheroid(drop: MaskWobbleDrop, a: vec3f, b: vec3f) -> f32 {
    return (a.x * b.x + a.z * b.z) * drop.inverse_wide + a.y * b.y * drop.inverse_tall;
}

// The point where a line meets the surface before (side = -1) or behind (side = 1) its nearest approach; the nearest approach
// where it misses.
fn mask_wobble_meet(drop: MaskWobbleDrop, origin: vec3f, direction: vec3f, side: f32) -> vec3f {
    let curvature = mask_wobble_spheroid(drop, direction, direction);
    let excess = mask_wobble_spheroid(drop, origin, origin) - 1.0;
    let slope = mask_wobble_spheroid(drop, origin, direction);
    var point = origin + direction * mask_trace_step(excess, slope, curvature, side);
    for (var step = 0u; step < MASK_WOBBLE_STEPS; step += 1u) {
        let surface = mask_wobble_surface(drop.shape, drop.state, point);
        let surface_slope = dot(surface.half_gradient, direction);
        point = point + direction * mask_trace_step(surface.excess, surface_slope, curvature, side);
    }
    return point;
}

// Distance along a line of its nearest approach, from a guess.
fn mask_wobble_nearest(drop: MaskWobbleDrop, origin: vec3f, direction: vec3f, guess: f32) -> f32 {
    let curvature = mask_wobble_spheroid(drop, direction, direction);
    var along = guess;
    for (var step = 0u; step < MASK_WOBBLE_NEAREST_STEPS; step += 1u) {
        let surface = mask_wobble_surface(drop.shape, drop.state, origin + direction * along);
        along = along - dot(surface.half_gradient, direction) / curvature;
    }
    return along;
}

// Exit of the light of a ray from the drop. The ray should meet it; one that misses is treated as grazing.
fn mask_wobble_light(drop: MaskWobbleDrop, origin: vec3f, direction: vec3f) -> MaskWobbleLight {
    var point = mask_wobble_meet(drop, origin, direction, -1.0);
    let entry_normal = normalize(mask_wobble_surface(drop.shape, drop.state, point).half_gradient);
    let reflectance = optics_fresnel(-dot(direction, entry_normal), drop.index);
    var light = MaskWobbleLight(
        optics_reflect(direction, entry_normal),
        vec3f(0.0),
        vec3f(0.0),
        vec3f(0.0),
        vec4f(reflectance, 0.0, 0.0, 0.0),
        vec4f(1.0, 0.0, 0.0, 0.0),
    );
    var inside = normalize(optics_refract(direction, entry_normal, 1.0 / drop.index).xyz);
    var rest = 1.0 - reflectance;
    var found = 0u;
    for (var bounce = 0u; bounce < MASK_WOBBLE_BOUNCES && found < MASK_WOBBLE_EXITS; bounce += 1u) {
        point = mask_wobble_meet(drop, point, inside, 1.0);
        let normal = normalize(mask_wobble_surface(drop.shape, drop.state, point).half_gradient);
        let kept = optics_fresnel(dot(inside, normal), 1.0 / drop.index);
        if kept < 1.0 {
            found += 1u;
            let outside = normalize(optics_refract(inside, -normal, drop.index).xyz);
            if found == 1u {
                light.first = outside;
            } else if found == 2u {
                light.second = outside;
            } else {
                light.third = outside;
            }
            light.fractions[found] = rest * (1.0 - kept);
            light.interfaces[found] = f32(bounce + 2u);
        }
        rest *= kept;
        inside = optics_reflect(inside, normal);
    }
    return light;
}
