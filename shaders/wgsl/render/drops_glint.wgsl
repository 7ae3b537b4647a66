// Glints of lamps on a drop, pixel by pixel.
// Law: a glint is a small bright image of a lamp. What a pixel has of it is the part of the image that lies in the pixel, so that all
// pixels have all of its light, however small the drop is on the picture: the image may reach over the drop's edge by a pixel, as it
// would in any lens. On a still drop it is a bump as wide as the lamp's image, on one that moves a box, drawn out along the path.
// Twin: downpour_render::rain::drops_glint.

// Light of lamps on each drop of the list: the mean over it, and its brightest glints.
@group(0) @binding(8) var<storage, read> drops_light: array<vec4f>;

// The first of a drop's numbers of light.
fn drops_glint_row(index: u32) -> u32 {
    return index * (1u + drops_frame.glints);
}

// Light of lamps that has no position on a drop, as a radiance over all of it: the mean less its glints.
fn drops_glint_rest(index: u32) -> vec3f {
    let row = drops_glint_row(index);
    var light = drops_light[row].rgb;
    // An atlas has streaks, and nothing of a drop that stands still but its mean.
    let count = select(drops_frame.glints, 0u, drops_frame.atlas > 0u);
    for (var k = 1u; k <= count; k += 1u) {
        let glint = drops_light[row + k];
        if glint.w > 0.0 {
            light -= glint.rgb;
        }
    }
    return max(light, vec3f(0.0));
}

// Position on the picture of a point of a drop's disk, pixels from its middle: the disk is drawn out to the drop's oval.
fn drops_glint_offset(drop: ScreenDrop, position: vec2f) -> vec2f {
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let at = (position * drop.oval.xy + vec2f(0.0, drop.oval.z)) * drop.slope;
    return camera_project(drops_frame.camera, drop.towards + right * at.x + up * at.y)
        - camera_project(drops_frame.camera, drop.towards);
}

// Light of a drop's glints in a pixel, as a radiance over all of the pixel.
fn drops_glint_light(index: u32, drop: ScreenDrop, x: u32, y: u32) -> vec3f {
    var light = vec3f(0.0);
    if drops_frame.atlas > 0u {
        return light;
    }
    let row = drops_glint_row(index);
    let pixels = drop.slope / drops_frame.camera.pixel_angle * sqrt(drop.oval.x * drop.oval.y);
    for (var k = 1u; k <= drops_frame.glints; k += 1u) {
        let glint = drops_light[row + k];
        if glint.w <= 0.0 {
            continue;
        }
        let position = drop_glint_unpack(glint.w);
        // Images do not reach out of the drop, but for a pixel.
        let room = max(1.0 - sqrt(dot(position, position)), 0.0);
        let image = drop_glint_image(glint.w);
        let offset = drops_glint_offset(drop, position);
        var part = 0.0;
        if drop.kind == DROPS_STILL {
            let reach = max(min(DROPS_GLINT_BUMP * image, room) * pixels, 1.0);
            part = drop_glint_pixel(drop.position + offset - vec2f(f32(x), f32(y)), reach);
        } else {
            let width = max(min(DROPS_GLINT_BOX * image, 2.0 * room) * pixels, 1.0);
            let from_pixel = drop.first + offset - vec2f(f32(x) + 0.5, f32(y) + 0.5);
            part = drop.fraction * streak_mean(from_pixel, drop.screen_delta, width, drop.weights);
        }
        light += glint.rgb * (drop.area * part);
    }
    return light;
}
