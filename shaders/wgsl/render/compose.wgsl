// A plate through the rain before it: radiance = plate * transmittance + rain. The distance stays that of the plate.
// Twin: downpour_render::picture.

@group(0) @binding(0) var<uniform> compose_size: vec4u;
@group(0) @binding(1) var<storage, read> compose_plate: array<vec4f>;
@group(0) @binding(2) var<storage, read> compose_rain: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> compose_target: array<vec4f>;

// A pixel of a plate (radiance and distance) through the rain (radiance and transmittance).
fn compose_pixel(plate: vec4f, rain: vec4f) -> vec4f {
    return vec4f(plate.rgb * rain.w + rain.rgb, plate.w);
}

@compute @workgroup_size(8, 8, 1)
fn main_compose(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= compose_size.x || id.y >= compose_size.y {
        return;
    }
    let i = id.y * compose_size.x + id.x;
    compose_target[i] = compose_pixel(compose_plate[i], compose_rain[i]);
}
