// Light of lamps and sun that spray scatters toward the eye, over the part of the light behind it that it takes out.
// Law: single scattering at the two places that stand for the spray of a ray (spray.wgsl), with the phase function of a drop. Occlusion is
// tested with one ray per pixel that looks (spacing.wgsl), to a lamp from a place that are drawn by the light that they would give; the mean over the pixels around it is
// taken by spray_blend.wgsl.
// Twin: downpour_render::rain::spray::light.

@group(0) @binding(8) var<storage, read_write> spray_light_found: array<vec4f>;

// Light of a lamp at a place of a ray of unit direction.
fn spray_light_lamp(lamp: RenderLight, place: vec3f, direction: vec3f) -> vec3f {
    // Among lamps, spots alone may shine.
    if medium_frame.lit == MEDIUM_SPOTS && (lamp.kind == SCENE_LIGHT_DIRECTIONAL || lamp.cone.x <= 0.0) {
        return vec3f(0.0);
    }
    let light = light_sample(lamp, place, SPRAY_LAMP_MIN);
    let phase = medium_phase_at(drop_glint_angle(light.direction, direction) * 3.1415927);
    return light.irradiance * 3.1415927 * phase.rgb;
}

// Light of all lamps on spray if nothing hid them, and the part of it that comes from one of them to one place.
struct SprayLight {
    whole: vec3f,
    // Part of the random number that is left.
    rest: f32,
    drawn: vec3f,
    lamp: u32,
    // Distance of that place.
    at: f32,
}

// Adds the light of all lamps at a place of a ray, of which a share counts.
fn spray_light_add(sum: SprayLight, direction: vec3f, at: f32, share: f32) -> SprayLight {
    var next = sum;
    if share <= 0.0 {
        return next;
    }
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let given = spray_light_lamp(light_load(k), medium_frame.eye + direction * at, direction) * share;
        let fraction = light_weight(given);
        if fraction > 0.0 {
            next.whole += given;
            let chance = fraction / light_weight(next.whole);
            if next.rest < chance {
                // The part of the interval that is left is as good as a new number.
                next.rest /= chance;
                next.drawn = given;
                next.lamp = k;
                next.at = at;
            } else {
                next.rest = (next.rest - chance) / max(1.0 - chance, 1.0e-9);
            }
        }
    }
    return next;
}

// Light on the spray before a pixel.
fn spray_light_pixel(x: u32, y: u32) {
    let index = 2u * (y * render_frame.camera.width + x);
    let halves = vec2u(bitcast<u32>(spray_light_found[index].w), bitcast<u32>(spray_light_found[index + 1u].w));
    // Optical depth and share of the nearer place.
    let pair = unpack2x16float(halves.x);
    if pair.x <= 0.0 || medium_frame.lit == MEDIUM_DARK {
        return;
    }
    let places = unpack2x16float(halves.y);
    let direction = camera_direction(render_frame.camera, f32(x) + 0.5, f32(y) + 0.5);
    var sum = SprayLight(vec3f(0.0), rng_unit(path_lattice_words(x, y, SPRAY_LATTICE).x), vec3f(0.0), 0u, 0.0);
    sum = spray_light_add(sum, direction, places.x, pair.y);
    sum = spray_light_add(sum, direction, places.y, 1.0 - pair.y);
    let fraction = light_weight(sum.drawn);
    // Below 0: the pixels around it look.
    var seen = vec3f(-1.0);
    if spacing_looks(x, y) {
        seen = vec3f(0.0);
    }
    if fraction > 0.0 && seen.x >= 0.0 {
        let place = medium_frame.eye + direction * sum.at;
        let light = light_sample(light_load(sum.lamp), place, SPRAY_LAMP_MIN);
        seen = scene_visibility(place, light.direction, light.distance) * sum.drawn * (light_weight(sum.whole) / fraction);
    }
    spray_light_found[index] = vec4f(sum.whole, spray_light_found[index].w);
    spray_light_found[index + 1u] = vec4f(seen, spray_light_found[index + 1u].w);
}

@compute @workgroup_size(8, 8, 1)
fn main_spray_light(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let at = spacing_place(group.xy, groups.xy, invocation);
    if at.x < render_frame.camera.width && at.y < render_frame.camera.height {
        spray_light_pixel(at.x, at.y);
    }
}
