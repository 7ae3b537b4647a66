// The environment capture around the eye: what drops show of the scene. On an octahedral map, or as the papers' wide picture.
// Law: a texel holds the mean radiance of its directions. The sun is no part of the sky (its light is parallel); its
// disk goes into the texel that holds its direction, as irradiance over solid angle.
// The map's halves: +z in the middle of the square, -z in its corners.
// Twin: downpour_trace::capture.

// The direction of a position of the map, in texels from the top left.
fn capture_direction(x: f32, y: f32) -> vec3f {
    let scale = 2.0 / f32(render_frame.camera.width);
    return packing_octahedral_decode(vec2f(x * scale - 1.0, y * scale - 1.0));
}

// The mean of the sky over a texel of the map that shows nothing else: a sun of a sky map is narrower than a texel.
fn capture_sky(x: u32, y: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var k = 0u; k < CAPTURE_SKY * CAPTURE_SKY; k += 1u) {
        let dx = (f32(k % CAPTURE_SKY) + 0.5) / f32(CAPTURE_SKY);
        let dy = (f32(k / CAPTURE_SKY) + 0.5) / f32(CAPTURE_SKY);
        sum += sky_level(0u, capture_direction(f32(x) + dx, f32(y) + dy));
    }
    return sum / f32(CAPTURE_SKY * CAPTURE_SKY);
}

// The light of parallel sources in a texel.
fn capture_suns(x: u32, y: u32) -> vec3f {
    let size = f32(render_frame.camera.width);
    if render_frame.projection != SCENE_OCTAHEDRAL || render_frame.suns_out > 0u {
        return vec3f(0.0);
    }
    var sum = vec3f(0.0);
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let lamp = light_load(k);
        if lamp.kind != SCENE_LIGHT_DIRECTIONAL {
            continue;
        }
        let light = light_sample(lamp, render_frame.camera.eye, 0.0);
        let square = packing_octahedral_encode(light.direction);
        let position = clamp((square * 0.5 + 0.5) * size, vec2f(0.0), vec2f(size - 1.0));
        if u32(position.x) != x || u32(position.y) != y {
            continue;
        }
        // A square of the plane |x| + |y| + |z| = 1, seen from its middle.
        let norm = abs(light.direction.x) + abs(light.direction.y) + abs(light.direction.z);
        let texel_over_pi = CAPTURE_AREA_OVER_PI / (size * size) * norm * norm * norm;
        let visible = scene_visibility(render_frame.camera.eye, light.direction, SCENE_FAR);
        sum += light.irradiance * visible / texel_over_pi;
    }
    return sum;
}
