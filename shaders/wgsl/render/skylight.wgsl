// Light of sky and surfaces on surfaces: means over what the pixels around a pixel have found on the same surface, times what
// the surface makes of it. The kernel makes one pass: means over windows, then wider means of them, the last of which it adds to the
// picture; then what these are on the other surfaces of a pixel.
// Twin: downpour_trace::skylight, where the method is described.

@group(0) @binding(1) var<storage, read> skylight_ambient: array<TraceAmbient>;
// Means of each pixel's two slots: color, and the variance of its luminance.
@group(0) @binding(2) var<storage, read> skylight_before: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> skylight_means: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> skylight_picture: array<vec4f>;
@group(0) @binding(9) var<storage, read> skylight_others: array<TraceAmbient>;

// A slot of a pixel, unpacked.
struct SkylightSlot {
    light: vec3f,
    slack: f32,
    // Of the surface.
    normal: vec3f,
    roughness: f32,
    // Of what counts as the same: the normal, or the direction that a mirror would show.
    direction: vec3f,
    // Weight of its light.
    weight: f32,
    position: vec3f,
}

// Agreement of two mirrored directions within the lobe of a roughness, 0 to 1.
fn skylight_lobe(cosine: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    return max(1.0 - (1.0 - cosine) / max(SKYLIGHT_LOBE * alpha * alpha, 1.0e-7), 0.0);
}

// Pixels to each side of a window that holds enough rays, if so many of a pixel look for light.
fn skylight_radius(rays: u32, spacing: u32) -> u32 {
    if spacing > 1u || rays <= 1u {
        return SKYLIGHT_RADIUS;
    }
    return select(SKYLIGHT_RADIUS - 1u, 1u, rays >= SKYLIGHT_MANY);
}

// Weight of a pixel by its distance along an edge, in pixels, in a window of a radius.
fn skylight_hat(from_pixel: u32, to_pixel: u32, radius: u32) -> f32 {
    return f32(radius + 1u - (max(from_pixel, to_pixel) - min(from_pixel, to_pixel)));
}

// A slot, unpacked.
fn skylight_unpack(packed: TraceSlot) -> SkylightSlot {
    let found = trace_unpack(packed);
    let weight = select(1.0, SKYLIGHT_GUESSED, found.guessed > 0u);
    var normal = found.normal;
    if found.roughness > 0.0 {
        // Between what is seen and what is mirrored.
        let seen = found.position - render_frame.camera.eye;
        let sum = found.normal - seen / max(sqrt(dot(seen, seen)), 1.0e-20);
        normal = sum / max(sqrt(dot(sum, sum)), 1.0e-20);
    }
    return SkylightSlot(found.light, found.slack, normal, found.roughness, found.normal, weight, found.position);
}

// A slot of a pixel, unpacked.
fn skylight_slot(pixel: u32, slot: u32) -> SkylightSlot {
    if slot > 0u {
        return skylight_unpack(skylight_ambient[pixel].mirror);
    }
    return skylight_unpack(skylight_ambient[pixel].base);
}

// Factor of the light of a slot of a pixel.
fn skylight_factor(pixel: u32, slot: u32) -> vec3f {
    if slot > 0u {
        return trace_unpack(skylight_ambient[pixel].mirror).factor;
    }
    return trace_unpack(skylight_ambient[pixel].base).factor;
}

// Agreement of the roughness of two glosses, 0 to 1: a film and the dry surface beside it mirror different things.
fn skylight_film(own: f32, other: f32) -> f32 {
    let apart = abs(own - other) / max(max(own, other), 1.0e-6);
    return clamp((SKYLIGHT_FILM - apart) / SKYLIGHT_FILM_EDGE, 0.0, 1.0);
}

// Degree to which two pixels show the same surface, 0 to 1.
fn skylight_same(own: SkylightSlot, other: SkylightSlot) -> f32 {
    if other.slack <= 0.0 || (own.roughness > 0.0) != (other.roughness > 0.0) {
        return 0.0;
    }
    let off = abs(dot(own.normal, other.position - own.position));
    let near = max(1.0 - off / own.slack, 0.0);
    let cosine = dot(own.direction, other.direction);
    if own.roughness > 0.0 {
        if render_frame.wetness > 0u {
            return skylight_lobe(cosine, own.roughness) * near * skylight_film(own.roughness, other.roughness);
        }
        return skylight_lobe(cosine, own.roughness) * near;
    }
    let agrees = max(cosine, 0.0);
    let fourth = agrees * agrees * agrees * agrees;
    return fourth * fourth * near;
}

// Weight of a pixel in the mean of another: the degree to which both show the same surface. If no ray has looked for the light of that
// one, any surface is better than none, and best is one that faces or mirrors the same way.
fn skylight_near(own: SkylightSlot, other: SkylightSlot) -> f32 {
    let same = skylight_same(own, other);
    if own.weight >= 1.0 || other.slack <= 0.0 || (own.roughness > 0.0) != (other.roughness > 0.0) {
        return same;
    }
    let alike = skylight_lobe(dot(own.direction, other.direction), SKYLIGHT_LOOSE_ROUGHNESS);
    return max(same, SKYLIGHT_LOOSE * max(alike, SKYLIGHT_LOOSE));
}

// Degree to which two means are the same but for their noise, 0 to 1; variances are those of the means.
fn skylight_alike(own: vec4f, other: vec4f) -> f32 {
    let apart = color_luminance(own.xyz) - color_luminance(other.xyz);
    return max(1.0 - apart * apart / max(SKYLIGHT_NOISE * (own.w + other.w), 1.0e-20), 0.0);
}

// The mean of the window around a pixel, and the variance of its luminance: of the pixels whose rays have looked for light, or of all
// where none of those shows anything like it.
fn skylight_mean(x: u32, y: u32, slot: u32) -> vec4f {
    let own = skylight_slot(y * render_frame.camera.width + x, slot);
    if own.slack <= 0.0 {
        return vec4f(0.0);
    }
    var sum = vec3f(0.0);
    var squares = 0.0;
    var weight = 0.0;
    var weights = 0.0;
    let radius = skylight_radius(render_frame.sky_rays, render_frame.ray_spacing);
    let right = min(x + radius, render_frame.camera.width - 1u);
    let bottom = min(y + radius, render_frame.camera.height - 1u);
    for (var turn = 0u; turn < 2u && weight <= 0.0; turn += 1u) {
        let apart = select(render_frame.ray_spacing, 1u, turn > 0u);
        let left = spacing_first(x, apart, radius, render_frame.ray_column);
        for (var row = spacing_first(y, apart, radius, render_frame.ray_row); row <= bottom; row += apart) {
            for (var column = left; column <= right; column += apart) {
                let other = skylight_slot(row * render_frame.camera.width + column, slot);
                var counts = skylight_hat(x, column, radius) * skylight_hat(y, row, radius) * other.weight;
                if row != y || column != x {
                    counts *= skylight_near(own, other);
                }
                if counts > 0.0 {
                    let luminance = color_luminance(other.light);
                    sum += other.light * counts;
                    squares += luminance * luminance * counts;
                    weight += counts;
                    weights += counts * counts;
                }
            }
        }
    }
    let mean = sum / weight;
    let luminance = color_luminance(mean);
    let variance = max(squares / weight - luminance * luminance, 0.0);
    // Effective number of samples; one alone gives no variance.
    let count = weight * weight / weights;
    return vec4f(mean, variance / max(count - 1.0, 0.5) + luminance * luminance / (count * count));
}

// The mean of means `step` pixels apart that show the same.
fn skylight_wide(x: u32, y: u32, slot: u32, step: u32) -> vec4f {
    let here = y * render_frame.camera.width + x;
    let own = skylight_slot(here, slot);
    let mean = skylight_before[2u * here + slot];
    if own.slack <= 0.0 {
        return vec4f(0.0);
    }
    var sum = mean.xyz * 4.0;
    var variance = mean.w * 16.0;
    var weight = 4.0;
    for (var k = 0u; k < 9u; k += 1u) {
        let column = x + k % 3u * step;
        let row = y + k / 3u * step;
        if k == 4u || column < step || row < step || column - step >= render_frame.camera.width
            || row - step >= render_frame.camera.height {
            continue;
        }
        let other = (row - step) * render_frame.camera.width + column - step;
        let its = skylight_before[2u * other + slot];
        let kernel = select(2.0, 1.0, k % 2u == 0u);
        let counts = kernel * skylight_same(own, skylight_slot(other, slot)) * skylight_alike(mean, its);
        sum += its.xyz * counts;
        variance += its.w * counts * counts;
        weight += counts;
    }
    return vec4f(sum / weight, variance / (weight * weight));
}

// A slot of the other surface of a pixel.
fn skylight_packed(pixel: u32, slot: u32) -> TraceSlot {
    if slot > 0u {
        return skylight_others[pixel].mirror;
    }
    return skylight_others[pixel].base;
}

// Light on the other surface of a pixel, times what that makes of it: the mean of the means of the pixels around it that show that surface
// first; what has been found of it where it is the other one counts little beside them.
fn skylight_other(x: u32, y: u32, slot: u32) -> vec3f {
    let packed = skylight_packed(y * render_frame.camera.width + x, slot);
    let own = skylight_unpack(packed);
    if own.slack <= 0.0 {
        return vec3f(0.0);
    }
    var weight = 0.0;
    var sum = vec3f(0.0);
    let radius = skylight_radius(render_frame.sky_rays, render_frame.ray_spacing);
    let right = min(x + radius, render_frame.camera.width - 1u);
    let bottom = min(y + radius, render_frame.camera.height - 1u);
    for (var row = spacing_first(y, 1u, radius, 0u); row <= bottom; row += 1u) {
        for (var column = spacing_first(x, 1u, radius, 0u); column <= right; column += 1u) {
            let other = row * render_frame.camera.width + column;
            let hat = skylight_hat(x, column, radius) * skylight_hat(y, row, radius);
            let counts = hat * skylight_near(own, skylight_slot(other, slot));
            let its = skylight_unpack(skylight_packed(other, slot));
            var few = hat * SKYLIGHT_OWN * its.weight;
            if row != y || column != x {
                few *= skylight_near(own, its);
            }
            sum += skylight_before[2u * other + slot].xyz * counts + its.light * few;
            weight += counts + few;
        }
    }
    return trace_unpack(packed).factor * (sum / weight);
}

@compute @workgroup_size(8, 8, 1)
fn main_skylight(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.camera.width || y >= render_frame.camera.height {
        return;
    }
    let index = y * render_frame.camera.width + id.x;
    let step = render_frame.turn;
    if step > SKYLIGHT_PASSES {
        skylight_picture[index] += vec4f(skylight_other(id.x, y, 0u) + skylight_other(id.x, y, 1u), 0.0);
        return;
    }
    for (var slot = 0u; slot < 2u; slot += 1u) {
        var mean = vec4f(0.0);
        if step == 0u {
            mean = skylight_mean(id.x, y, slot);
        } else {
            // As far apart as the weights of a window reach, so that they add up to the same everywhere.
            let reach = skylight_radius(render_frame.sky_rays, render_frame.ray_spacing) + 1u;
            mean = skylight_wide(id.x, y, slot, reach << (step - 1u));
        }
        skylight_means[2u * index + slot] = mean;
    }
    if step == SKYLIGHT_PASSES {
        let of_base = skylight_factor(index, 0u) * skylight_means[2u * index].xyz;
        let of_mirror = skylight_factor(index, 1u) * skylight_means[2u * index + 1u].xyz;
        skylight_picture[index] += vec4f(of_base + of_mirror, 0.0);
    }
}
