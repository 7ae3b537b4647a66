// The environment map of a host application: what its picture shows, and for directions beyond its borders a sky map of the
// host, or else the picture's border, blurred the more the farther a direction is outside. Directions away from the view are
// mirrored, so that the map has no seam.
// Twin: downpour_render::host.

struct HostEnvironmentFrame {
    // Width, height and first texel of each level of the picture.
    levels: array<vec4u, HOST_LEVELS>,
    camera: RenderCamera,
    // Texels along an edge of the map that is made.
    size: u32,
    // The coarsest level of the picture.
    last: u32,
    // 1: directions beyond the picture's borders show the host's sky map.
    has_sky: u32,
    // Radiance of the color 1 of the sky map.
    sky_scale: f32,
}

@group(0) @binding(0) var<uniform> host_environment_frame: HostEnvironmentFrame;
@group(0) @binding(1) var<storage, read> host_environment_plate: array<vec4f>;
@group(0) @binding(2) var host_environment_sky: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> host_environment_map: array<vec4f>;

// Position on the picture of a direction, pixels, clamped to its borders, and how far outside it is, in halves of the picture.
fn host_environment_position(camera: RenderCamera, direction: vec3f) -> vec3f {
    let along = dot(direction, camera.forward);
    let place = camera_place(camera, direction, max(abs(along), HOST_MIN_DEPTH));
    let size = vec2f(f32(camera.width), f32(camera.height));
    let at = (0.5 + 0.5 * clamp(vec2f(place.x, -place.y), vec2f(-1.0), vec2f(1.0))) * size;
    let outside = clamp(max(abs(place.x), abs(place.y)) - 1.0, 0.0, 1.0);
    return vec3f(at, select(outside, 1.0, along <= 0.0));
}

// A texel of a level of the picture; the nearest where there is none.
fn host_environment_texel(level: u32, column: i32, row: i32) -> vec3f {
    let size = host_environment_frame.levels[level];
    let x = u32(clamp(column, 0, i32(size.x) - 1));
    let y = u32(clamp(row, 0, i32(size.y) - 1));
    return host_environment_plate[size.z + y * size.x + x].rgb;
}

// A level of the picture at a position in its pixels, bilinear.
fn host_environment_level(level: u32, place: vec2f) -> vec3f {
    let size = host_environment_frame.levels[level];
    let finest = host_environment_frame.levels[0];
    let at = place * vec2f(f32(size.x) / f32(finest.x), f32(size.y) / f32(finest.y)) - 0.5;
    let low = floor(at);
    let part = at - low;
    let column = i32(low.x);
    let row = i32(low.y);
    let upper = mix(host_environment_texel(level, column, row), host_environment_texel(level, column + 1, row), part.x);
    let lower =
        mix(host_environment_texel(level, column, row + 1), host_environment_texel(level, column + 1, row + 1), part.x);
    return mix(upper, lower, part.y);
}

// The picture at a position, as a mean over `width` pixels.
fn host_environment_picture(place: vec2f, width: f32) -> vec3f {
    let level = min(log2(max(width, 1.0)), f32(host_environment_frame.last));
    let finer = u32(level);
    let coarser = min(finer + 1u, host_environment_frame.last);
    return mix(host_environment_level(finer, place), host_environment_level(coarser, place), level - f32(finer));
}

// Direction of a position in a texel of the map, in parts of the texel.
fn host_environment_direction(x: u32, y: u32, dx: f32, dy: f32) -> vec3f {
    let scale = 2.0 / f32(host_environment_frame.size);
    return packing_octahedral_decode(vec2f((f32(x) + dx) * scale - 1.0, (f32(y) + dy) * scale - 1.0));
}

// The mean of the host's sky map over a texel.
fn host_environment_seen(x: u32, y: u32) -> vec3f {
    let size = vec2f(textureDimensions(host_environment_sky));
    var sum = vec3f(0.0);
    for (var k = 0u; k < HOST_SKY_TAPS * HOST_SKY_TAPS; k += 1u) {
        let dx = (f32(k % HOST_SKY_TAPS) + 0.5) / f32(HOST_SKY_TAPS);
        let dy = (f32(k / HOST_SKY_TAPS) + 0.5) / f32(HOST_SKY_TAPS);
        let uv = equirect_coordinates(host_environment_direction(x, y, dx, dy));
        let at = vec2u(clamp(uv * size, vec2f(0.0), size - 1.0));
        sum += host_radiance_checked(textureLoad(host_environment_sky, at, 0).rgb, host_environment_frame.sky_scale);
    }
    return sum / f32(HOST_SKY_TAPS * HOST_SKY_TAPS);
}

// A texel of the map.
fn host_environment_radiance(x: u32, y: u32) -> vec3f {
    let frame = host_environment_frame;
    let direction = host_environment_direction(x, y, 0.5, 0.5);
    let at = host_environment_position(frame.camera, direction);
    let texel = HOST_SPHERE / f32(frame.size) / frame.camera.pixel_angle;
    let blurred = texel + at.z * HOST_BLUR * f32(frame.camera.height);
    if frame.has_sky == 0u {
        return host_environment_picture(at.xy, blurred);
    }
    let border = clamp(at.z * HOST_BORDER, 0.0, 1.0);
    if border >= 1.0 {
        return host_environment_seen(x, y);
    }
    let picture = host_environment_picture(at.xy, texel);
    if border <= 0.0 {
        return picture;
    }
    return mix(picture, host_environment_seen(x, y), border);
}

@compute @workgroup_size(8, 8, 1)
fn main_host_environment(@builtin(global_invocation_id) id: vec3u) {
    let size = host_environment_frame.size;
    if id.x >= size || id.y >= size {
        return;
    }
    host_environment_map[id.y * size + id.x] = vec4f(host_environment_radiance(id.x, id.y), 0.0);
}
