// Pixels by rays: of the picture, and of the environment capture. Both are one kernel, since a software driver
// compiles the walk through the scene anew for each.
// Samples of a pixel that meet one surface are shaded once. Light of sky and surfaces leaves the picture's kernel as what one pixel has
// found of it, on the surface of its first sample and on another one if it shows more; skylight.wgsl takes means over neighbors.
// Twin: downpour_trace::trace.

@group(0) @binding(7) var<storage, read_write> trace_picture: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> trace_ambient: array<TraceAmbient>;
// Of second surfaces in the pixels.
@group(0) @binding(10) var<storage, read_write> trace_others: array<TraceAmbient>;

// Samples of the pixels of a band of rows so far: main_trace_sample.
@group(0) @binding(9) var<storage, read_write> trace_states: array<TraceState>;

// Light that is denoised over neighboring pixels, packed.
struct TraceSlot {
    position: vec3f,
    // The surface's normal; of a gloss, the direction that a mirror would show. Octahedral, 16 bits each.
    normal: u32,
    // Sum of the light's red, green and blue; below zero if it is guessed.
    light: f32,
    // Fractions of it that are red and green, 12 bits each, and the roughness of a gloss, 8 bits; 0: a diffuse base.
    look: u32,
    // Factor of the light, and largest distance of another position from the plane, per distance from the eye (0: there is
    // no light), as halves.
    factor: vec2u,
}

// Ambient sample of a pixel: light of sky and surfaces.
struct TraceAmbient {
    // On the diffuse base of the first opaque surface, over pi.
    base: TraceSlot,
    // In the first gloss or mirror.
    mirror: TraceSlot,
}

// The sum of what samples have found, each with its weight.
struct TraceSum {
    slot: PathSlot,
    weight: f32,
}

// What the samples of a pixel have found: on the surface that the first of them shows, and on another one.
struct TracePair {
    first: TraceSum,
    other: TraceSum,
    // Sum of the light on what else there is, as it is seen.
    rest: vec3f,
}

// A pixel with some of its samples.
struct TraceState {
    sum: vec3f,
    nearest: f32,
    base: TracePair,
    mirror: TracePair,
    last: ViewPath,
}

// A slot, packed.
fn trace_pack(slot: PathSlot) -> TraceSlot {
    if slot.slack <= 0.0 {
        return TraceSlot();
    }
    let sum = slot.light.x + slot.light.y + slot.light.z;
    let parts = slot.light.xy * (1.0 / max(sum, 1.0e-30));
    let rough = select(max(u32(clamp(slot.roughness, 0.0, 1.0) * 255.0 + 0.5), 1u), 0u, slot.roughness <= 0.0);
    let look = u32(clamp(parts.x, 0.0, 1.0) * 4095.0 + 0.5) | u32(clamp(parts.y, 0.0, 1.0) * 4095.0 + 0.5) << 12u | rough << 24u;
    let from_eye = slot.position - render_frame.camera.eye;
    let slack = clamp(slot.slack / max(sqrt(dot(from_eye, from_eye)), 1.0e-20), 1.0e-4, 6.0e4);
    let factor = min(slot.factor, vec3f(6.0e4));
    return TraceSlot(
        slot.position, pack2x16snorm(packing_octahedral_encode(slot.normal)), select(sum, -max(sum, 1.0e-30), slot.guessed > 0u), look,
        vec2u(pack2x16float(factor.xy), pack2x16float(vec2f(factor.z, slack))),
    );
}

// A slot as it was before it was packed.
fn trace_unpack(slot: TraceSlot) -> PathSlot {
    let sum = abs(slot.light);
    let red = f32(slot.look & 4095u) * (sum / 4095.0);
    let green = f32(slot.look >> 12u & 4095u) * (sum / 4095.0);
    let light = vec3f(red, green, max(sum - red - green, 0.0));
    let low = unpack2x16float(slot.factor.x);
    let high = unpack2x16float(slot.factor.y);
    let from_eye = slot.position - render_frame.camera.eye;
    return PathSlot(
        light, high.y * sqrt(dot(from_eye, from_eye)), vec3f(low, high.x), f32(slot.look >> 24u) / 255.0,
        packing_octahedral_decode(unpack2x16snorm(slot.normal)), select(0u, 1u, slot.light < 0.0), slot.position,
    );
}

// True if the gloss of a sample of a wet scene and that of the sum are of a film and of what is dry.
fn trace_apart(sum: TraceSum, sample: PathSlot) -> bool {
    if render_frame.wetness == 0u || min(sum.slot.roughness, sample.roughness) <= 0.0 {
        return false;
    }
    return abs(sum.slot.roughness - sample.roughness) > SKYLIGHT_FILM * max(sum.slot.roughness, sample.roughness);
}

// True if a sample shows the surface of the sum.
fn trace_same(sum: TraceSum, sample: PathSlot) -> bool {
    let off = abs(dot(sum.slot.normal, sample.position - sum.slot.position));
    let alike = dot(sum.slot.normal, sample.normal) > TRACE_SAME_NORMAL && (sum.slot.roughness > 0.0) == (sample.roughness > 0.0);
    return off < sum.slot.slack && alike && !trace_apart(sum, sample);
}

// True if a sample shows the surface of the sum, or there is none yet.
fn trace_takes(sum: TraceSum, sample: PathSlot) -> bool {
    return sum.weight <= 0.0 || trace_same(sum, sample);
}

// The sum with a sample. Where it is, is where the first sample is.
fn trace_sum(sum: TraceSum, sample: PathSlot) -> TraceSum {
    var next = sum;
    if sum.weight <= 0.0 {
        next.slot = sample;
        next.slot.light = vec3f(0.0);
        next.slot.factor = vec3f(0.0);
    }
    let weight = max(path_max(sample.factor), 1.0e-6);
    next.slot.light += sample.light * weight;
    next.slot.factor += sample.factor;
    next.weight += weight;
    return next;
}

// What samples have found, with one more. Light on a third surface is seen as it is, with the noise of its rays.
fn trace_add(pair: TracePair, sample: PathSlot) -> TracePair {
    var next = pair;
    if sample.slack <= 0.0 {
        return next;
    }
    if trace_takes(pair.first, sample) {
        next.first = trace_sum(pair.first, sample);
    } else if trace_takes(pair.other, sample) {
        next.other = trace_sum(pair.other, sample);
    } else {
        next.rest += sample.light * sample.factor;
    }
    return next;
}

// The mean, where `fraction` is one over the number of all samples.
fn trace_mean(sum: TraceSum, fraction: f32) -> TraceSlot {
    if sum.weight <= 0.0 {
        return TraceSlot();
    }
    var mean = sum.slot;
    mean.light /= sum.weight;
    mean.factor *= fraction;
    return trace_pack(mean);
}

// The direction of a position of the picture or of the capture, in pixels from the top left.
fn trace_direction(x: f32, y: f32) -> vec3f {
    if render_frame.projection == SCENE_OCTAHEDRAL {
        return capture_direction(x, y);
    }
    return camera_direction(render_frame.camera, x, y);
}

// A pixel before its first sample.
fn trace_begin() -> TraceState {
    var state = TraceState();
    state.nearest = SCENE_FAR;
    state.last = path_nothing();
    return state;
}

// A texel of the capture: the mean of what its samples have found, where the sky is that of all directions in it, and the
// suns.
fn trace_captured(mean: vec3f, nearest: f32, x: u32, y: u32) -> vec3f {
    var seen = mean;
    if nearest >= SCENE_FAR && render_frame.projection == SCENE_OCTAHEDRAL {
        seen = capture_sky(x, y);
    }
    return seen + capture_suns(x, y);
}

// The pixel with sample `k` of it.
fn trace_sample(state: ptr<function, TraceState>, x: u32, y: u32, k: u32) {
    let n = render_frame.grid;
    let dx = (f32(k % n) + 0.5) / f32(n);
    let dy = (f32(k / n) + 0.5) / f32(n);
    let direction = trace_direction(f32(x) + dx, f32(y) + dy);
    let random = path_lattice_words(x, y, k);
    let last = (*state).last;
    let spared = !spacing_looks(x, y);
    let path = path_trace(render_frame.camera.eye, direction, render_frame.camera.pixel_angle, random, last, spared);
    if render_frame.projection == SCENE_PICTURE {
        (*state).sum += path.radiance;
    } else {
        (*state).sum += path_radiance(path);
    }
    (*state).base = trace_add((*state).base, path.base);
    (*state).mirror = trace_add((*state).mirror, path.mirror);
    (*state).nearest = min((*state).nearest, path.distance);
    (*state).last = path;
    if k > 0u && path.again == 0u {
        // A pixel of more than one surface is worth the rays of all its samples.
        (*state).last.plain = 0u;
    }
    if k + 1u == n * n && render_frame.projection != SCENE_PICTURE {
        (*state).sum = trace_captured((*state).sum * (1.0 / f32(n * n)), (*state).nearest, x, y);
    }
}

// A pixel with all its samples: mean radiance, and the distance of what stands nearest in it. In the picture the light of sky and
// surfaces on its surfaces is left out and goes to the filter.
fn trace_seen(state: TraceState, x: u32, y: u32) -> vec4f {
    if render_frame.projection != SCENE_PICTURE {
        return vec4f(state.sum, state.nearest);
    }
    let fraction = 1.0 / f32(render_frame.grid * render_frame.grid);
    let pixel = y * render_frame.camera.width + x;
    trace_ambient[pixel] = TraceAmbient(trace_mean(state.base.first, fraction), trace_mean(state.mirror.first, fraction));
    trace_others[pixel] = TraceAmbient(trace_mean(state.base.other, fraction), trace_mean(state.mirror.other, fraction));
    return vec4f((state.sum + (state.base.rest + state.mirror.rest)) * fraction, state.nearest);
}

// A pixel with all its samples.
fn trace_pixel(x: u32, y: u32) -> vec4f {
    var state = trace_begin();
    for (var k = 0u; k < render_frame.grid * render_frame.grid; k += 1u) {
        trace_sample(&state, x, y, k);
    }
    return trace_seen(state, x, y);
}

// All samples of the pixels.
@compute @workgroup_size(8, 8, 1)
fn main_trace(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let at = spacing_place(group.xy, groups.xy, invocation) + vec2u(0u, render_frame.first_row);
    if at.x >= render_frame.camera.width || at.y >= render_frame.camera.height {
        return;
    }
    trace_picture[at.y * render_frame.camera.width + at.x] = trace_pixel(at.x, at.y);
}

// One sample of the pixels: that of the turn. For a driver that ends the loops of an invocation after so many turns.
@compute @workgroup_size(8, 8, 1)
fn main_trace_sample(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let place = spacing_place(group.xy, groups.xy, invocation);
    let y = place.y + render_frame.first_row;
    if place.x >= render_frame.camera.width || y >= render_frame.camera.height {
        return;
    }
    let at = place.y * render_frame.camera.width + place.x;
    var state = trace_begin();
    if render_frame.turn > 0u {
        state = trace_states[at];
    }
    trace_sample(&state, place.x, y, render_frame.turn);
    trace_states[at] = state;
}

// The pixels of all those samples.
@compute @workgroup_size(8, 8, 1)
fn main_trace_seen(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.camera.width || y >= render_frame.camera.height {
        return;
    }
    let state = trace_states[id.y * render_frame.camera.width + id.x];
    trace_picture[y * render_frame.camera.width + id.x] = trace_seen(state, id.x, y);
}
