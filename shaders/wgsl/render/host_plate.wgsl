// The plate of a host application: its color and depth textures as radiance and distance of each pixel.
// Law: a perspective depth buffer is linear in the inverse of the depth along the view direction.
// Twin: downpour_render::host.

struct HostPlateFrame {
    // Inverse depth, 1/m, at the value 0 of the depth texture, and how much more it is at 1.
    inverse: vec2f,
    // Value of the depth texture where nothing was drawn.
    clear: f32,
    // Radiance of the color 1.
    scale: f32,
    camera: RenderCamera,
}

@group(0) @binding(0) var<uniform> host_plate_frame: HostPlateFrame;
@group(0) @binding(1) var host_plate_color: texture_2d<f32>;
@group(0) @binding(2) var host_plate_depth: texture_depth_2d;
@group(0) @binding(3) var<storage, read_write> host_plate_pixels: array<vec4f>;

// Distance along a ray, m, of a value of the depth texture; `slant` is the length of the ray at depth 1.
fn host_plate_distance(value: f32, inverse: vec2f, clear: f32, slant: f32) -> f32 {
    let inverse_depth = inverse.x + value * inverse.y;
    if value == clear || inverse_depth < HOST_FARTHEST {
        return SCENE_FAR;
    }
    return slant / inverse_depth;
}

@compute @workgroup_size(8, 8, 1)
fn main_host_plate(@builtin(global_invocation_id) id: vec3u) {
    let camera = host_plate_frame.camera;
    if id.x >= camera.width || id.y >= camera.height {
        return;
    }
    let color = textureLoad(host_plate_color, id.xy, 0).rgb;
    let value = textureLoad(host_plate_depth, id.xy, 0);
    let ray = camera_ray(camera, f32(id.x) + 0.5, f32(id.y) + 0.5);
    let slant = sqrt(dot(ray, ray));
    let distance = host_plate_distance(value, host_plate_frame.inverse, host_plate_frame.clear, slant);
    let radiance = host_radiance_checked(color, host_plate_frame.scale);
    host_plate_pixels[id.y * camera.width + id.x] = vec4f(radiance, distance);
}
