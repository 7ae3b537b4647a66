// The reflection buffer: a small environment map, and billboards of shining objects, mirrored in level ground and
// stretched toward the viewer.
// Twin: downpour_trace::impostor::draw.

// Texels of an octahedral map, IMPOSTOR_PROBE along an edge; then two rows for each billboard, the farthest first: its mirrored center and
// half its width; its radiance and half its height, m.
@group(0) @binding(1) var<storage, read> impostor_list: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> impostor_drawn: array<vec2u>;

// Radiance of the environment in a direction, bilinear.
fn impostor_draw_environment(direction: vec3f) -> vec3f {
    let at = (packing_octahedral_encode(direction) * 0.5 + 0.5) * f32(IMPOSTOR_PROBE) - 0.5;
    let low = floor(at);
    let part = at - low;
    var sum = vec3f(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        let upper = vec2u(k & 1u, k >> 1u) == vec2u(1u);
        let weight = select(vec2f(1.0) - part, part, upper);
        let texel = packing_octahedral_texel(IMPOSTOR_PROBE, i32(low.x) + i32(k & 1u), i32(low.y) + i32(k >> 1u));
        sum += impostor_list[texel.y * IMPOSTOR_PROBE + texel.x].xyz * (weight.x * weight.y);
    }
    return sum;
}

// Part of a texel, of width 1, from `offset` on either side of which a line of half length `half` is.
fn impostor_draw_overlap(offset: f32, half: f32) -> f32 {
    return clamp(min(offset + 0.5, half) - max(offset - 0.5, -half), 0.0, 1.0);
}

// Coverage of a texel by a billboard of half size `half` at an offset from its center, right and down, in texels. It is stretched down by
// `stretch` texels, over which it fades; what it gives in all stays the same.
fn impostor_draw_cover(offset: vec2f, half: vec2f, stretch: f32) -> f32 {
    let across = impostor_draw_overlap(offset.x, half.x);
    let below = offset.y - half.y;
    let tail = select(0.0, max(1.0 - below / stretch, 0.0), below > 0.0);
    let along = min(impostor_draw_overlap(offset.y, half.y) + tail, 1.0);
    let kept = 2.0 * half.y / (2.0 * half.y + 0.5 * stretch);
    return across * along * kept;
}

// Radiance of a texel.
fn impostor_draw_texel(x: u32, y: u32) -> vec3f {
    let camera = render_frame.camera;
    let at = vec2f(f32(x) + 0.5, f32(y) + 0.5);
    let seen = camera_direction(camera, 2.0 * at.x, 2.0 * at.y);
    var sum = impostor_draw_environment(vec3f(seen.x, -seen.y, seen.z));
    let texel_angle = 2.0 * camera.pixel_angle;
    let stretch = IMPOSTOR_STRETCH / texel_angle;
    for (var k = 0u; k + 1u < render_frame.impostors; k += 1u) {
        let row = IMPOSTOR_PROBE * IMPOSTOR_PROBE + 2u * k;
        let place = impostor_list[row];
        let light = impostor_list[row + 1u];
        let from_eye = place.xyz - camera.eye;
        let depth = dot(from_eye, camera.forward);
        if depth < IMPOSTOR_NEAREST {
            continue;
        }
        let center = camera_project(camera, from_eye) * 0.5;
        let half = vec2f(place.w, light.w) / (depth * texel_angle);
        let cover = impostor_draw_cover(at - center, half, stretch);
        sum += (light.xyz - sum) * cover;
    }
    return sum;
}

@compute @workgroup_size(8, 8, 1)
fn main_impostor_draw(@builtin(global_invocation_id) id: vec3u) {
    let size = impostor_size();
    if id.x >= size.x || id.y >= size.y {
        return;
    }
    let light = min(impostor_draw_texel(id.x, id.y), vec3f(IMPOSTOR_MAX));
    impostor_drawn[id.y * size.x + id.x] = impostor_pack(light);
}
