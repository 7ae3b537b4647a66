// The light of the sky on surfaces: the mean of what the pixels round a pixel have found on the same surface, times what
// the surface makes of it.
// A neighbour counts as far as its normal agrees and as it is on the plane through the pixel's place.
// Twin: downpour_render::skylight.

@group(0) @binding(1) var<storage, read> skylight_gather: array<TraceGather>;
@group(0) @binding(2) var<storage, read_write> skylight_picture: array<vec4f>;

// The place that a pixel shows, relative to the eye.
fn skylight_place(x: u32, y: u32) -> vec3f {
    return scene_direction(f32(x) + 0.5, f32(y) + 0.5) * skylight_picture[y * render_frame.width + x].w;
}

// Light of the sky over pi, and the open share of the sky, over the pixels round a pixel.
fn skylight_mean(x: u32, y: u32) -> vec4f {
    let own = skylight_gather[y * render_frame.width + x];
    let normal = packing_octahedral_decode(unpack2x16snorm(own.normal));
    let place = skylight_place(x, y);
    let distance = sqrt(dot(place, place));
    // How far from the plane a neighbour may be: what two pixels are apart, and a little more where it is slanted.
    let slack = distance * (render_frame.pixel_angle * 2.0 + SKYLIGHT_SLACK);
    var sum = own.sky * own.met;
    var weight = own.met;
    let left = max(x, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    let top = max(y, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    for (var row = top; row <= min(y + SKYLIGHT_RADIUS, render_frame.height - 1u); row += 1u) {
        for (var column = left; column <= min(x + SKYLIGHT_RADIUS, render_frame.width - 1u); column += 1u) {
            let other = skylight_gather[row * render_frame.width + column];
            if other.met <= 0.0 || (row == y && column == x) {
                continue;
            }
            let agrees = max(dot(normal, packing_octahedral_decode(unpack2x16snorm(other.normal))), 0.0);
            let fourth = agrees * agrees * agrees * agrees;
            let off = abs(dot(normal, skylight_place(column, row) - place));
            let near = max(1.0 - off / slack, 0.0);
            let counts = fourth * fourth * near * other.met;
            sum += other.sky * counts;
            weight += counts;
        }
    }
    return sum / max(weight, 1.0e-6);
}

@compute @workgroup_size(8, 8, 1)
fn main_skylight(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.width || y >= render_frame.height {
        return;
    }
    let index = y * render_frame.width + id.x;
    let own = skylight_gather[index];
    if own.met > 0.0 {
        let sky = skylight_mean(id.x, y);
        let shown = own.body * sky.rgb + own.gloss * (sky.w * sky.w);
        // The distance is not touched: other pixels read it.
        skylight_picture[index].x += shown.x;
        skylight_picture[index].y += shown.y;
        skylight_picture[index].z += shown.z;
    }
}
