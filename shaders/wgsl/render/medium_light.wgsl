// Light of lamps and sun that unresolved drops scatter toward the eye, before a pixel.
// Law: single scattering, L = Int sigma(s) exp(-tau(s)) E(s) p(angle(s)) ds, with the drops' phase function p. For a lamp at the
// distance h from the ray the angle runs evenly along the ray as seen from the lamp, ds / r^2 = d angle / h, so that a part of
// the ray between two angles needs but the integral of p over them (a table), and is exact however near the lamp is.
// Occlusion is tested with one ray per pixel, drawn by the light that each part of the ray and each lamp would give; the mean over
// the pixels around it is taken by medium_filter.wgsl.
// Light that is weakened on its way from the lamp to the drop is taken to be made good by what is scattered forward on it.
// Twin: downpour_render::rain::medium::light.

// The part of a ray that a lamp lights: within its cone and its range.
fn medium_light_span(light: RenderLight, origin: vec3f, direction: vec3f, farthest: f32) -> vec2f {
    var span = vec2f(0.0, farthest);
    if light.kind == SCENE_LIGHT_DIRECTIONAL {
        return select(span, vec2f(farthest), medium_frame.lit == MEDIUM_SPOTS);
    }
    let axis = light.axis;
    let reach = light.range;
    let cone = light.cone;
    let offset = origin - light.position;
    let near = dot(offset, direction);
    if reach > 0.0 {
        span = medium_both(span, medium_roots(1.0, near, dot(offset, offset) - reach * reach));
    }
    let edge = -cone.y / max(cone.x, 1.0e-9);
    if cone.x <= 0.0 || edge <= 0.0 {
        // A lamp that shines everywhere, or over more than half of all directions.
        return select(span, vec2f(farthest), medium_frame.lit == MEDIUM_SPOTS && cone.x <= 0.0);
    }
    // Part of the ray in the cone: (d . axis)^2 = edge^2 d^2, on the side to which the axis points.
    let rate = dot(direction, axis);
    let depth = dot(offset, axis);
    let a = rate * rate - edge * edge;
    let b = rate * depth - edge * edge * near;
    let c = depth * depth - edge * edge * dot(offset, offset);
    let root = b * b - a * c;
    if root <= 0.0 {
        return select(vec2f(farthest), span, c > 0.0 && depth > 0.0);
    }
    let sign_of_a = select(-1.0, 1.0, a >= 0.0);
    let firm = select(-1.0, 1.0, a >= 0.0) * max(abs(a), 1.0e-12);
    let first = (-b - sign_of_a * sqrt(root)) / firm;
    let second = (-b + sign_of_a * sqrt(root)) / firm;
    if a < 0.0 {
        // Between the roots, of which both are on one side of the lamp.
        let middle = depth + rate * 0.5 * (first + second);
        return select(vec2f(farthest), medium_both(span, vec2f(first, second)), middle > 0.0);
    }
    // Beyond one root, on the side to which the ray goes along the axis.
    return medium_both(span, select(vec2f(-MEDIUM_FAR, first), vec2f(second, MEDIUM_FAR), rate > 0.0));
}

// Light found so far before a pixel, and the part of it for which a ray is to be cast.
struct MediumLight {
    // Light if nothing hides it.
    whole: vec3f,
    // Part of the random number that is left.
    rest: f32,
    // Light of the part of the ray that was drawn.
    drawn: vec3f,
    // Part of it that fog scatters, which no roof keeps off, 0 to 1.
    foggy: f32,
    // Sum of distances, weighted by light.
    weighted: f32,
    // First and last distance of the part that was drawn.
    part: vec2f,
    // Lamp that was drawn.
    lamp: u32,
}

// Adds a part of a ray, from one distance to another, that would give `light`; draws it by what it gives.
fn medium_light_add(sum: MediumLight, rain: vec3f, fog: vec3f, lamp: u32, near: f32, far: f32) -> MediumLight {
    let light = rain + fog;
    let fraction = light_weight(light);
    if fraction <= 0.0 {
        return sum;
    }
    let chance = fraction / (light_weight(sum.whole) + fraction);
    var next = sum;
    next.whole += light;
    next.weighted += 0.5 * (near + far) * fraction;
    if sum.rest < chance {
        // The part of the interval that is left is as good as a new number.
        next.rest = sum.rest / chance;
        next.drawn = light;
        next.foggy = light_weight(fog) / fraction;
        next.part = vec2f(near, far);
        next.lamp = lamp;
    } else {
        next.rest = (sum.rest - chance) / max(1.0 - chance, 1.0e-9);
    }
    return next;
}

// The light of a lamp, added part by part.
fn medium_light_lamp(sum: MediumLight, index: u32, direction: vec3f, reach: vec2f, pixel: f32) -> MediumLight {
    let eye = medium_frame.eye;
    let lamp = light_load(index);
    let parallel = lamp.kind == SCENE_LIGHT_DIRECTIONAL;
    let lit = medium_light_span(lamp, eye, direction, select(reach.y, reach.x, parallel));
    // The sky is as it is seen through rain, but not as it is seen through fog.
    let rain_reach = select(MEDIUM_FAR, MEDIUM_SKY_REACH, parallel);
    if lit.y <= lit.x {
        return sum;
    }
    let region = medium_span(direction);
    let outline = medium_outline(direction);
    let offset = lamp.position - eye;
    let nearest = dot(offset, direction);
    let aside = offset - direction * nearest;
    // No ray is thinner than a pixel: the mean over its square of 1 / h is that of 0.284 of its width.
    let least = 0.284 * pixel * max(nearest, 0.0);
    let h = sqrt(dot(aside, aside) + least * least + 1.0e-8);
    // The angle at the lamp, between the ray's direction and the position, runs from behind the drops to before them.
    let first = atan2(h, nearest - lit.x);
    var next = sum;
    var near = lit.x;
    var near_depth = medium_depth(min(near, rain_reach), region, outline);
    var near_fog = medium_fog_depth(medium_frame.fog, direction.y, near);
    var near_angle = first;
    var near_phase = medium_phase_within(first);
    for (var part = 0u; part < MEDIUM_PARTS && near < lit.y; part += 1u) {
        // To the end of the slice, or as far as the direction to the lamp turns by some degrees.
        let slice = medium_node(2u * u32(0.5 * (3.0 * log2(max(near * 1.001 / MEDIUM_NEAR, 1.0)) + 1.0)) + 1u);
        let turned = near_angle + MEDIUM_TURN;
        let turn = select(nearest - h * cos(turned) / max(sin(turned), 1.0e-6), MEDIUM_FAR, parallel || turned > 3.1);
        let far = select(min(min(slice, max(turn, near * 1.001)), lit.y), lit.y, part + 1u == MEDIUM_PARTS);
        let far_depth = medium_depth(min(far, rain_reach), region, outline);
        let far_fog = medium_fog_depth(medium_frame.fog, direction.y, far);
        let far_angle = atan2(h, nearest - far);
        let far_phase = medium_phase_within(far_angle);
        let middle = nearest - h * cos(0.5 * (near_angle + far_angle)) / max(sin(0.5 * (near_angle + far_angle)), 1.0e-6);
        let light = light_sample(lamp, eye + direction * clamp(middle, near, far), 0.0);
        var given = light.irradiance * 3.1415927;
        var foggy = given * medium_frame.fog.w;
        let through_fog = exp(-0.5 * (near_fog + far_fog));
        if parallel {
            let phase = medium_phase_at(drop_glint_angle(light.direction, direction) * 3.1415927);
            given *= phase.rgb * (exp(-near_depth) - exp(-far_depth)) * through_fog;
            foggy *= phase.w * (exp(-near_fog) - exp(-far_fog)) * exp(-0.5 * (near_depth + far_depth));
        } else {
            let square = max(light.distance * light.distance, 1.0e-8);
            let density = (far_depth - near_depth) / max(far - near, 1.0e-6);
            let passed = exp(-0.5 * (near_depth + far_depth)) * through_fog;
            given *= (far_phase - near_phase).rgb * (square / h * density * passed);
            let fog_density = (far_fog - near_fog) / max(far - near, 1.0e-6);
            foggy *= (far_phase - near_phase).w * (square / h * fog_density * passed);
        }
        next = medium_light_add(next, max(given, vec3f(0.0)), max(foggy, vec3f(0.0)), index, near, far);
        near = far;
        near_depth = far_depth;
        near_fog = far_fog;
        near_angle = far_angle;
        near_phase = far_phase;
    }
    return next;
}

// True if the pixels around a pixel that look for light do so for it.
fn medium_light_is_spared(x: u32, y: u32, direction: vec3f) -> bool {
    if spacing_looks(x, y) {
        return false;
    }
    let own = medium_clean[y * render_frame.camera.width + x].w;
    var alike = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        let corner = medium_spread_corner(x, y, k);
        alike += f32(corner.y) * medium_spread_alike(own, medium_clean[corner.x].w);
    }
    let whole = f32(render_frame.ray_spacing * render_frame.ray_spacing);
    return alike >= MEDIUM_SPREAD_MIN * whole && medium_spread_is_even(direction);
}

// Light and optical depth of the unresolved drops before a pixel; light below 0: that of the pixels around it.
fn medium_light_pixel(x: u32, y: u32) {
    let at = medium_frame.columns * medium_frame.rows * MEDIUM_SLICES + 2u * (y * render_frame.camera.width + x);
    let scene = medium_clean[y * render_frame.camera.width + x].w;
    let position = vec2f(f32(x), f32(y)) + 0.5;
    let direction = camera_direction(render_frame.camera, position.x, position.y);
    // The sky is as it is seen through the rain beyond.
    let end = select(scene, MEDIUM_SKY_REACH, scene >= MEDIUM_SKY);
    let depth = medium_open_at(position.x, position.y, end).x;
    if medium_light_is_spared(x, y, direction) {
        medium_out[at] = vec4f(vec3f(-1.0), depth);
        medium_out[at + 1u] = vec4f(0.0);
        return;
    }
    var sum = MediumLight(vec3f(0.0), 0.0, vec3f(0.0), 0.0, 0.0, vec2f(0.0), 0u);
    var seen = vec3f(0.0);
    if medium_frame.lit != MEDIUM_DARK && (medium_frame.all > 0.0 || medium_frame.fog.x > 0.0) {
        let random = path_lattice_words(x, y, MEDIUM_LATTICE);
        sum.rest = rng_unit(random.x);
        let sun_reach = select(MEDIUM_SKY_REACH, MEDIUM_FOG_REACH, medium_frame.fog.x > 0.0);
        let reach = vec2f(min(scene, sun_reach), min(scene, MEDIUM_LAMP_REACH));
        for (var k = 0u; k < render_frame.light_count; k += 1u) {
            sum = medium_light_lamp(sum, k, direction, reach, render_frame.camera.pixel_angle);
        }
        let fraction = light_weight(sum.drawn);
        if fraction > 0.0 {
            let distance = sum.part.x + (sum.part.y - sum.part.x) * rng_unit(random.y);
            let from_position = medium_frame.eye + direction * distance;
            let light = light_sample(light_load(sum.lamp), from_position, 0.0);
            seen = scene_visibility(from_position, light.direction, light.distance)
                * mix(medium_open_at(position.x, position.y, distance).y, 1.0, sum.foggy)
                * (sum.drawn * (light_weight(sum.whole) / fraction));
        }
    }
    let mean = sum.weighted / max(light_weight(sum.whole), 1.0e-20);
    medium_out[at] = vec4f(sum.whole, depth);
    medium_out[at + 1u] = vec4f(seen, mean);
}

@compute @workgroup_size(8, 8, 1)
fn main_medium_light(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let at = spacing_place(group.xy, groups.xy, invocation);
    if at.x < render_frame.camera.width && at.y < render_frame.camera.height {
        medium_light_pixel(at.x, at.y);
    }
}
