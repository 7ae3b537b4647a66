// A plate through the rain before it: radiance = plate * transmittance + rain. The distance stays that of the plate.
// Twin: downpour_render::picture.

@group(0) @binding(0) var<uniform> compose_size: vec4u;
@group(0) @binding(1) var<storage, read> compose_plate: array<vec4f>;
@group(0) @binding(2) var<storage, read> compose_rain: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> compose_target: array<vec4f>;
@group(0) @binding(4) var<storage, read> compose_glow: array<vec4f>;

// A pixel of a plate (radiance and distance) through the rain (radiance and transmittance).
fn compose_pixel(plate: vec4f, rain: vec4f) -> vec4f {
    return vec4f(plate.rgb * rain.w + rain.rgb, plate.w);
}

// The rain of a picture (radiance and transmittance) with all that is seen of another picture of the same scene in other light: its plate
// through its own rain, and its glow.
fn compose_lit(rain: vec4f, plate: vec4f, other: vec4f, glow: vec3f) -> vec4f {
    return vec4f(rain.rgb + compose_pixel(plate, other).rgb + glow, rain.w);
}

@compute @workgroup_size(8, 8, 1)
fn main_compose(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= compose_size.x || id.y >= compose_size.y {
        return;
    }
    let i = id.y * compose_size.x + id.x;
    compose_target[i] = compose_pixel(compose_plate[i], compose_rain[i]);
}

// compose_size.z: 1 if the other picture glows.
@compute @workgroup_size(8, 8, 1)
fn main_compose_lit(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= compose_size.x || id.y >= compose_size.y {
        return;
    }
    let i = id.y * compose_size.x + id.x;
    var glow = vec3f(0.0);
    if compose_size.z == 1u {
        glow = compose_glow[i].rgb;
    }
    compose_target[i] = compose_lit(compose_target[i], compose_plate[i], compose_rain[i], glow);
}
