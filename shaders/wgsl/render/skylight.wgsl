// Light of sky and surfaces on surfaces: the mean of what the pixels round a pixel have found on the same surface, times
// what the surface makes of it.
// A neighbour counts as far as its normal agrees and as it is on the plane through the pixel's place; in the gloss, as far as
// it mirrors the same direction, within the lobe.
// Twin: downpour_render::skylight.

@group(0) @binding(1) var<storage, read> skylight_gather: array<TraceGather>;
@group(0) @binding(2) var<storage, read_write> skylight_picture: array<vec4f>;

// How far two mirrored directions agree within the lobe of a roughness.
fn skylight_lobe(cosine: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    return max(1.0 - (1.0 - cosine) / max(SKYLIGHT_LOBE * alpha * alpha, 1.0e-7), 0.0);
}

// What the light of sky and surfaces makes of a pixel, from the pixels round it.
fn skylight_mean(x: u32, y: u32) -> vec3f {
    let own = skylight_gather[y * render_frame.width + x];
    let normal = packing_octahedral_decode(unpack2x16snorm(own.normal));
    let mirrored = packing_octahedral_decode(unpack2x16snorm(own.mirrored));
    let glossy = path_most(own.gloss);
    var sky = own.sky * own.met;
    var met = own.met;
    var mirror = own.mirror * glossy;
    var weight = glossy;
    let left = max(x, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    let top = max(y, SKYLIGHT_RADIUS) - SKYLIGHT_RADIUS;
    for (var row = top; row <= min(y + SKYLIGHT_RADIUS, render_frame.height - 1u); row += 1u) {
        for (var column = left; column <= min(x + SKYLIGHT_RADIUS, render_frame.width - 1u); column += 1u) {
            let other = skylight_gather[row * render_frame.width + column];
            let its_gloss = path_most(other.gloss);
            if (other.met <= 0.0 && its_gloss <= 0.0) || (row == y && column == x) {
                continue;
            }
            let agrees = max(dot(normal, packing_octahedral_decode(unpack2x16snorm(other.normal))), 0.0);
            let fourth = agrees * agrees * agrees * agrees;
            let off = abs(dot(normal, other.place - own.place));
            let near = max(1.0 - off / own.slack, 0.0);
            let counts = fourth * fourth * near * other.met;
            sky += other.sky * counts;
            met += counts;
            if glossy > 0.0 && its_gloss > 0.0 {
                let cosine = dot(mirrored, packing_octahedral_decode(unpack2x16snorm(other.mirrored)));
                let same = skylight_lobe(cosine, own.roughness) * near * its_gloss;
                mirror += other.mirror * same;
                weight += same;
            }
        }
    }
    return own.body * (sky / max(met, 1.0e-6)) + own.gloss * (mirror / max(weight, 1.0e-6));
}

@compute @workgroup_size(8, 8, 1)
fn main_skylight(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.width || y >= render_frame.height {
        return;
    }
    let index = y * render_frame.width + id.x;
    let own = skylight_gather[index];
    if own.met > 0.0 || path_most(own.gloss) > 0.0 {
        let shown = skylight_mean(id.x, y);
        // The distance is not touched: other pixels read it.
        skylight_picture[index].x += shown.x;
        skylight_picture[index].y += shown.y;
        skylight_picture[index].z += shown.z;
    }
}
