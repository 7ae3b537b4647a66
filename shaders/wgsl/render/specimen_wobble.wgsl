// A ray through a drop that oscillates, with the surface of mask/wobble.wgsl.
// Such a drop need not be convex. A line is walked in equal parts; in a part at whose ends G turns, its extremum is looked
// for, so that no bulge or hollow wider than a part is missed. The crossing that is found is closed in on by the steps of
// mask_trace_step, and by halves where these leave the bracket.
// Limits: light that has left the drop does not meet it again.
// Twin: downpour_specimen::wobble.

// A drop at one instant.
struct SpecimenWobble {
    shape: DropShapeCoefficients,
    // s2, s3, and what keeps the volume.
    state: vec3f,
    // Refractive index of water relative to air.
    index: f32,
    // 1 / A^2 across and 1 / B^2 along the axis of a spheroid that holds the drop.
    inverse_wide: f32,
    inverse_tall: f32,
}

// G - 1 and half of grad G at a point.
fn specimen_wobble_surface(drop: SpecimenWobble, point: vec3f) -> MaskTraceSurface {
    return mask_wobble_surface(drop.shape, drop.state, point);
}

// G - 1 and half of dG/ds at the position s of a line.
fn specimen_wobble_along(drop: SpecimenWobble, origin: vec3f, direction: vec3f, s: f32) -> vec2f {
    let surface = specimen_wobble_surface(drop, origin + direction * s);
    return vec2f(surface.excess, dot(surface.half_gradient, direction));
}

// Distances at which a line enters and leaves the spheroid around the drop; the second is below the first if it misses.
fn specimen_wobble_span(drop: SpecimenWobble, origin: vec3f, direction: vec3f) -> vec2f {
    let across = vec3f(drop.inverse_wide, drop.inverse_tall, drop.inverse_wide);
    let curvature = dot(direction * across, direction);
    let slope = dot(origin * across, direction);
    let excess = dot(origin * across, origin) - 1.0;
    let discriminant = slope * slope - curvature * excess;
    let root = sqrt(max(discriminant, 0.0));
    let near = (-slope - root) / curvature;
    let far = (root - slope) / curvature;
    return select(vec2f(near, far), vec2f(1.0, -1.0), discriminant < 0.0);
}

// The first point between `start` and `end` at which a line goes into the drop (side = -1) or out of it (side = 1), and 1;
// the second is 0 if there is none. At `start` it is on the other side, or on the surface.
fn specimen_wobble_cross(
    drop: SpecimenWobble,
    origin: vec3f,
    direction: vec3f,
    start: f32,
    end: f32,
    side: f32,
) -> vec2f {
    let part = (end - start) * SPECIMEN_WOBBLE_PART;
    var a = start;
    var b = start;
    var at_a = specimen_wobble_along(drop, origin, direction, start);
    var at_b = at_a;
    var found = false;
    for (var k = 1u; k <= SPECIMEN_WOBBLE_PARTS; k += 1u) {
        b = start + part * f32(k);
        at_b = specimen_wobble_along(drop, origin, direction, b);
        found = side * at_b.x > 0.0;
        if !found && side * at_a.y > 0.0 && side * at_b.y < 0.0 {
            // G turns toward the other side: its extremum by the rule of the false position.
            var low = vec2f(a, at_a.y);
            var high = vec2f(b, at_b.y);
            for (var m = 0u; m < SPECIMEN_WOBBLE_TURNS; m += 1u) {
                let middle = low.x + (high.x - low.x) * (low.y / (low.y - high.y));
                let at_middle = specimen_wobble_along(drop, origin, direction, middle);
                if side * at_middle.x > 0.0 {
                    found = true;
                    b = middle;
                    at_b = at_middle;
                    break;
                }
                if side * at_middle.y > 0.0 {
                    low = vec2f(middle, at_middle.y);
                } else {
                    high = vec2f(middle, at_middle.y);
                }
            }
        }
        if found {
            break;
        }
        a = b;
        at_a = at_b;
    }
    if !found {
        return vec2f(end, 0.0);
    }
    let curvature = max((at_b.y - at_a.y) / (b - a), SPECIMEN_WOBBLE_FLAT);
    // From the end that is outside, where a step to the root on the right side is never ambiguous.
    var s = select(a, b, side > 0.0);
    var at_s = select(at_a, at_b, side > 0.0);
    for (var m = 0u; m < SPECIMEN_WOBBLE_STEPS; m += 1u) {
        let next = s + mask_trace_step(at_s.x, at_s.y, curvature, side);
        let strays = next < a - SPECIMEN_WOBBLE_SLACK || next > b + SPECIMEN_WOBBLE_SLACK;
        s = select(min(max(next, a), b), 0.5 * (a + b), strays);
        at_s = specimen_wobble_along(drop, origin, direction, s);
        if side * at_s.x > 0.0 {
            b = s;
        } else {
            a = s;
        }
    }
    let last = s + mask_trace_step(at_s.x, at_s.y, curvature, side);
    return vec2f(min(max(last, a), b), 1.0);
}

// Distance at which a ray of the camera meets the drop, and 1; the second is 0 if it misses.
fn specimen_wobble_meet(drop: SpecimenWobble, ray: SpecimenRay) -> vec2f {
    let span = specimen_wobble_span(drop, ray.foot, ray.direction);
    let start = max(span.x, -ray.reach);
    if start >= span.y {
        return vec2f(0.0);
    }
    return specimen_wobble_cross(drop, ray.foot, ray.direction, start, span.y, -1.0);
}

// The first interface, at the position s of the ray.
fn specimen_wobble_enter(drop: SpecimenWobble, ray: SpecimenRay, s: f32) -> SpecimenLight {
    let point = ray.foot + ray.direction * s;
    let normal = normalize(specimen_wobble_surface(drop, point).half_gradient);
    return specimen_split_outside(point, normal, ray.direction, drop.index);
}

// The next interface from inside.
fn specimen_wobble_bounce(drop: SpecimenWobble, light: SpecimenLight, least: f32) -> SpecimenLight {
    let end = specimen_wobble_span(drop, light.point, light.inside).y;
    let s = specimen_wobble_cross(drop, light.point, light.inside, 0.0, end, 1.0).x;
    let point = light.point + light.inside * s;
    let normal = normalize(specimen_wobble_surface(drop, point).half_gradient);
    return specimen_split_inside(light, point, normal, drop.index, least);
}
