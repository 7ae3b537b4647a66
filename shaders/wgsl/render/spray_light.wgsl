// Light of lamps and sun that spray scatters toward the eye, over the part of the light behind it that it takes out.
// Law: single scattering at a place that chance picks along the ray (spray.wgsl), with the phase function of a drop. Occlusion is tested with one
// ray per pixel, to a lamp that is drawn by the light that it would give; the mean over the pixels around it is taken by spray_blend.wgsl.
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

// Light of all lamps at a place of a ray if nothing hid them, and the part of it that comes from one, which a number of [0, 1) draws; that lamp.
struct SprayLight {
    whole: vec3f,
    drawn: vec3f,
    lamp: u32,
}

fn spray_light_at(place: vec3f, direction: vec3f, number: f32) -> SprayLight {
    var sum = SprayLight(vec3f(0.0), vec3f(0.0), 0u);
    var rest = number;
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let given = spray_light_lamp(light_load(k), place, direction);
        let fraction = light_weight(given);
        if fraction > 0.0 {
            sum.whole += given;
            let chance = fraction / light_weight(sum.whole);
            if rest < chance {
                rest /= chance;
                sum.drawn = given;
                sum.lamp = k;
            } else {
                rest = (rest - chance) / max(1.0 - chance, 1.0e-9);
            }
        }
    }
    return sum;
}

// Light on the spray before a pixel.
fn spray_light_pixel(x: u32, y: u32) {
    let at = 2u * (y * render_frame.camera.width + x);
    if spray_light_found[at].w <= 0.0 || medium_frame.lit == MEDIUM_DARK {
        return;
    }
    let direction = camera_direction(render_frame.camera, f32(x) + 0.5, f32(y) + 0.5);
    let place = medium_frame.eye + direction * spray_light_found[at + 1u].w;
    let number = rng_unit(path_lattice_words(x, y, SPRAY_LATTICE).y);
    let sum = spray_light_at(place, direction, number);
    let fraction = light_weight(sum.drawn);
    var seen = vec3f(0.0);
    if fraction > 0.0 {
        let light = light_sample(light_load(sum.lamp), place, SPRAY_LAMP_MIN);
        seen = scene_visibility(place, light.direction, light.distance) * sum.drawn * (light_weight(sum.whole) / fraction);
    }
    spray_light_found[at] = vec4f(sum.whole, spray_light_found[at].w);
    spray_light_found[at + 1u] = vec4f(seen, spray_light_found[at + 1u].w);
}

@compute @workgroup_size(8, 8, 1)
fn main_spray_light(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        spray_light_pixel(id.x, id.y);
    }
}
