// Light of sky and surfaces on surfaces in live frames: the running mean of what a frame and all before it have found, where they show the
// same surface. One dispatch takes the frame into the mean and changes its picture.
// Twin: downpour_trace::running_light, where the method is described.

// Running means of a slot of a pixel.
struct RunningMean {
    // Over all frames that count.
    color: vec3f,
    // Number of these; 0: there are none.
    weight: f32,
    // Over the last few.
    recent: vec3f,
    // Variance of the luminance of one frame, over the last few.
    variance: f32,
}

// The frame before is temporal_frame and temporal_ambient; this frame's light is in skylight_ambient and skylight_before.
@group(0) @binding(10) var<storage, read> running_before: array<RunningMean>;
@group(0) @binding(11) var<storage, read_write> running_after: array<RunningMean>;

// Number of frames over which what a gloss mirrors stays within its lobe, if the direction turns by a chord per frame.
fn running_light_steady(chord: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    return RUNNING_LOBE * alpha * sqrt(2.0 * SKYLIGHT_LOBE) / max(chord, 1.0e-6);
}

// The running means of the frame before, where a slot's surface was in it.
fn running_light_before(pixel: u32, slot: u32, own: SkylightSlot) -> RunningMean {
    var found = RunningMean(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    let sought = temporal_position(pixel, own);
    let from_eye = sought.xyz + temporal_frame.shift - temporal_frame.camera.eye;
    if sought.w <= 0.0 || temporal_frame.max_weight <= 0.0 || dot(from_eye, temporal_frame.camera.forward) <= 0.0 {
        return found;
    }
    let at = camera_project(temporal_frame.camera, from_eye) - vec2f(0.5);
    let size = vec2f(vec2u(temporal_frame.camera.width, temporal_frame.camera.height));
    let corner = floor(at);
    let part = at - corner;
    var counted = 0.0;
    for (var k = 0u; k < 4u; k += 1u) {
        let step = vec2f(vec2u(k & 1u, k >> 1u));
        let place = corner + step;
        if any(place < vec2f(0.0)) || any(place >= size) {
            continue;
        }
        let there = u32(place.y) * temporal_frame.camera.width + u32(place.x);
        let same = skylight_same(own, temporal_slot(there, slot));
        let near = vec2f(1.0) - abs(part - step);
        let counts = near.x * near.y * same;
        let before = running_before[2u * there + slot];
        found.color += before.color * counts;
        found.recent += before.recent * counts;
        found.variance += before.variance * counts;
        found.weight += before.weight * same * counts;
        counted += counts;
    }
    if counted <= 0.0 {
        return found;
    }
    found = RunningMean(found.color / counted, found.weight / counted, found.recent / counted, found.variance / counted);
    var most = temporal_frame.max_weight;
    if own.roughness > 0.0 {
        let now = own.position - render_frame.camera.eye;
        let turned = now / max(sqrt(dot(now, now)), 1.0e-20) - from_eye / max(sqrt(dot(from_eye, from_eye)), 1.0e-20);
        most = min(temporal_frame.max_gloss, running_light_steady(sqrt(dot(turned, turned)), own.roughness));
    }
    found.weight = min(found.weight, most);
    return found;
}

// Part of a mean of the light before that counts beside a newer one: all of it up to a difference that noise makes. Both have the variance
// of their luminance.
fn running_light_kept(newer: vec4f, before: vec4f) -> f32 {
    return min(4.0 * skylight_alike(newer, before), 1.0);
}

// Running means with one more frame, whose mean has a variance.
fn running_light_next(before: RunningMean, mean: vec4f) -> RunningMean {
    let last = min(before.weight, RUNNING_RECENT);
    let variance = (mean.w + before.variance * last) / (1.0 + last);
    // Light that has changed by much is not waited for.
    let of_before = vec4f(before.color, variance / max(before.weight, 1.0));
    let weight = before.weight * running_light_kept(vec4f(mean.xyz, RUNNING_DOUBT * variance), of_before);
    let few = min(weight, RUNNING_RECENT);
    let recent = (mean.xyz + before.recent * few) / (1.0 + few);
    let color = (mean.xyz + before.color * weight) / (1.0 + weight);
    // Where the last few frames say that it has changed, only they count.
    let kept = running_light_kept(vec4f(recent, variance / (1.0 + few)), vec4f(color, variance / (1.0 + weight)));
    return RunningMean(recent + (color - recent) * kept, 1.0 + weight * kept, recent, variance);
}

@compute @workgroup_size(8, 8, 1)
fn main_running_light(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= render_frame.camera.width || id.y >= render_frame.camera.height {
        return;
    }
    let pixel = id.y * render_frame.camera.width + id.x;
    var change = vec3f(0.0);
    for (var slot = 0u; slot < 2u; slot += 1u) {
        let mean = skylight_before[2u * pixel + slot];
        let own = skylight_slot(pixel, slot);
        var after = RunningMean(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
        if own.slack > 0.0 {
            after = running_light_next(running_light_before(pixel, slot, own), mean);
        }
        running_after[2u * pixel + slot] = after;
        change += skylight_factor(pixel, slot) * (after.color - mean.xyz);
    }
    skylight_picture[pixel] += vec4f(change, 0.0);
}
