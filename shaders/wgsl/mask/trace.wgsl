// A ray through a drop of revolution: two interfaces, exactly.
// Lengths are in units of the drop's volume-equivalent radius. The frame is that of the view: x right, y up, z
// toward the viewer. The gauge of a point is |p| / rho(-p.up / |p|), 1 on the surface; along a line its square G
// is close to a parabola, and the surface is met by Newton steps on the parabola with the value and slope of G and
// the curvature of the reference spheroid.
// Twin: downpour_mask::trace, where the method is derived.

struct MaskTracedDrop {
    // Pixels along an edge of the mask.
    size: u32,
    // Width of a pixel.
    pixel: f32,
    // 1 / A^2 across and 1 / B^2 along the axis of the reference spheroid.
    inverse_wide: f32,
    inverse_tall: f32,
    shape: DropShapeCoefficients,
    // The drop's axis in the frame of the view, of length 1.
    up: vec3f,
    // Refractive index of water relative to air.
    index: f32,
}

struct MaskTraceSurface {
    half_gradient: vec3f,
    excess: f32,
}

// Exit of light from inside a drop, after total reflections.
struct MaskTraceExit {
    point: vec3f,
    // Total reflections on the way there.
    reflections: f32,
    normal: vec3f,
    // 1 if it does not find out, else 0.
    lost: f32,
    inside: vec3f,
    outside: vec3f,
}

struct MaskTraceThrough {
    direction: vec3f,
    transmittance: f32,
    reflected: vec3f,
    reflectance: f32,
    // Light that was reflected inside once without being totally reflected.
    internal: vec3f,
    internal_transmittance: f32,
    reflections: f32,
}

// G - 1 and half of grad G at a point.
fn mask_trace_surface(traced: MaskTracedDrop, point: vec3f) -> MaskTraceSurface {
    let square = max(dot(point, point), MASK_TINY);
    let length = sqrt(square);
    let x = -dot(point, traced.up) / length;
    let radius_slope = drop_shape_radius_slope(traced.shape, x);
    let inverse = 1.0 / radius_slope.x;
    let q = radius_slope.y * inverse;
    let scale_all = inverse * inverse;
    let along = 1.0 + q * x;
    let lift = length * q;
    return MaskTraceSurface((point * along + traced.up * lift) * scale_all, square * scale_all - 1.0);
}

// a . M . b for the matrix M of the reference spheroid.
fn mask_trace_spheroid(traced: MaskTracedDrop, a: vec3f, b: vec3f) -> f32 {
    let along = dot(a, traced.up) * dot(b, traced.up);
    return (dot(a, b) - along) * traced.inverse_wide + along * traced.inverse_tall;
}

// Half the second derivative of the spheroid's gauge squared along a direction.
fn mask_trace_curvature(traced: MaskTracedDrop, direction: vec3f) -> f32 {
    return mask_trace_spheroid(traced, direction, direction);
}

// The step along a line on which G - 1 = excess, dG/dt = 2 slope, d2G/dt2 = 2 curvature, to the root before
// (side = -1) or behind (side = 1) the minimum; to the minimum where there is no root.
fn mask_trace_step(excess: f32, slope: f32, curvature: f32, side: f32) -> f32 {
    let discriminant = slope * slope - curvature * excess;
    let toward = side * slope;
    let root = sqrt(max(discriminant, 0.0));
    // The form that does not cancel depends on the sign of the slope.
    let cancels = toward < 0.0;
    let sum = select(root + toward, root - toward, cancels);
    let safe = max(sum, MASK_TINY);
    let to_root = select(-side * excess / safe, side * sum / curvature, cancels);
    return select(to_root, -slope / curvature, discriminant < 0.0);
}

// The point where a line meets the surface before (side = -1) or behind (side = 1) its nearest approach; the
// nearest approach where it misses.
fn mask_trace_meet(traced: MaskTracedDrop, origin: vec3f, direction: vec3f, side: f32) -> vec3f {
    let curvature = mask_trace_curvature(traced, direction);
    let excess = mask_trace_spheroid(traced, origin, origin) - 1.0;
    let slope = mask_trace_spheroid(traced, origin, direction);
    var point = origin + direction * mask_trace_step(excess, slope, curvature, side);
    for (var step = 0u; step < MASK_TRACE_STEPS; step += 1u) {
        let surface = mask_trace_surface(traced, point);
        let surface_slope = dot(surface.half_gradient, direction);
        point = point + direction * mask_trace_step(surface.excess, surface_slope, curvature, side);
    }
    return point;
}

// The outward normal at a point.
fn mask_trace_normal(traced: MaskTracedDrop, point: vec3f) -> vec3f {
    return normalize(mask_trace_surface(traced, point).half_gradient);
}

// cos 2 psi, with psi the angle between the planes of incidence of two interfaces with the normals from_normal and
// to_normal, on the ray between them. 1 where a plane is not defined.
fn mask_trace_plane_turn(direction: vec3f, from_normal: vec3f, to_normal: vec3f) -> f32 {
    let a = cross(direction, from_normal);
    let b = cross(direction, to_normal);
    let both = dot(a, a) * dot(b, b);
    let along = dot(a, b);
    let turn = 2.0 * along * along / max(both, MASK_TINY) - 1.0;
    return select(turn, 1.0, both < MASK_TINY);
}

// Exit of light that starts at a point of the surface, along `inside_start`, after total reflections.
fn mask_trace_exit(traced: MaskTracedDrop, start: vec3f, inside_start: vec3f) -> MaskTraceExit {
    var inside = inside_start;
    var point = mask_trace_meet(traced, start, inside, 1.0);
    var normal = mask_trace_normal(traced, point);
    var outside = optics_refract(inside, -normal, traced.index);
    var reflections = 0.0;
    for (var k = 0u; k < MASK_TRACE_REFLECTIONS; k += 1u) {
        if outside.w >= 0.0 {
            break;
        }
        inside = optics_reflect(inside, normal);
        point = mask_trace_meet(traced, point, inside, 1.0);
        normal = mask_trace_normal(traced, point);
        outside = optics_refract(inside, -normal, traced.index);
        reflections += 1.0;
    }
    let lost = outside.w < 0.0;
    let one = select(0.0, 1.0, lost);
    return MaskTraceExit(point, reflections + one, normal, one, inside, select(outside.xyz, inside, lost));
}

// Fractions of the power that are reflected where light comes to leave, across and within the plane of incidence.
fn mask_trace_reflectance(exit: MaskTraceExit, index: f32) -> vec2f {
    return optics_fresnel_polarized(max(dot(exit.inside, exit.normal), 0.0), 1.0 / index);
}

// The viewer's ray through the point (x, y) of the image plane, through the drop.
fn mask_trace_through(traced: MaskTracedDrop, x: f32, y: f32) -> MaskTraceThrough {
    let incident = vec3f(0.0, 0.0, -1.0);
    let entry = mask_trace_meet(traced, vec3f(x, y, 0.0), incident, -1.0);
    let entry_normal = mask_trace_normal(traced, entry);
    let entry_fresnel = optics_fresnel_polarized(max(entry_normal.z, 0.0), traced.index);
    let reflectance = (entry_fresnel.x + entry_fresnel.y) * 0.5;
    let reflected = optics_reflect(incident, entry_normal);
    let inside = normalize(optics_refract(incident, entry_normal, 1.0 / traced.index).xyz);

    // Polarization is followed from interface to interface; after a total reflection light counts as unpolarized.
    let exit = mask_trace_exit(traced, entry, inside);
    let turn = mask_trace_plane_turn(inside, entry_normal, exit.normal);
    let followed = (entry_fresnel.y - entry_fresnel.x) * 0.5 * turn;
    let polarized = select(followed, 0.0, exit.reflections > 0.0);
    let exit_fresnel = mask_trace_reflectance(exit, traced.index);
    let entered = 1.0 - reflectance;
    let exit_mean = 1.0 - (exit_fresnel.x + exit_fresnel.y) * 0.5;
    let through = entered * exit_mean + polarized * (exit_fresnel.y - exit_fresnel.x) * 0.5;

    let back = optics_reflect(exit.inside, exit.normal);
    let second = mask_trace_exit(traced, exit.point, back);
    let kept = entered - through;
    let difference = entered * (exit_fresnel.x - exit_fresnel.y);
    let kept_polarized = (difference + polarized * (exit_fresnel.x + exit_fresnel.y)) * 0.5;
    let second_turn = mask_trace_plane_turn(back, exit.normal, second.normal);
    let second_polarized = select(kept_polarized * second_turn, 0.0, second.reflections > 0.0);
    let second_fresnel = mask_trace_reflectance(second, traced.index);
    let second_mean = 1.0 - (second_fresnel.x + second_fresnel.y) * 0.5;
    let internal = kept * second_mean + second_polarized * (second_fresnel.y - second_fresnel.x) * 0.5;
    return MaskTraceThrough(
        normalize(exit.outside),
        select(through, 0.0, exit.lost > 0.0),
        normalize(reflected),
        reflectance,
        normalize(second.outside),
        select(internal, 0.0, exit.lost + second.lost > 0.0),
        exit.reflections,
    );
}
