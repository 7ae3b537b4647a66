// Light of sky and surfaces on surfaces over the frames of a clip: the mean of what a frame and those before it have found, where they
// show the same surface. One dispatch adds one of the frames before; the last one changes the picture.
// Twin: downpour_trace::temporal, where the method is described.

struct TemporalFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // How many frames have been added before; 0: this is the first.
    turn: u32,
    // 1: no frame comes after it.
    is_last: u32,
    // Greatest number of frames of a running mean (running_light.wgsl) that count beside this one; 0: there is none.
    max_weight: f32,
    // Camera of the frame before.
    camera: RenderCamera,
    // From positions of this frame to the same positions in the coordinates of that frame, m.
    shift: vec3f,
    // The same of what a gloss mirrors.
    max_gloss: f32,
}

// Of that frame: what its pixels have found, and the means over neighbors of it. This frame's are in skylight_ambient and skylight_before.
@group(0) @binding(5) var<uniform> temporal_frame: TemporalFrame;
@group(0) @binding(6) var<storage, read> temporal_ambient: array<TraceAmbient>;
@group(0) @binding(7) var<storage, read> temporal_means: array<vec4f>;
// Sum of each pixel's two slots so far: color, and the weight of it.
@group(0) @binding(8) var<storage, read_write> temporal_sums: array<vec4f>;

// Pixel of a camera's picture that shows a position; (-1, -1): none does.
fn temporal_pixel(camera: RenderCamera, position: vec3f) -> vec2i {
    let from_eye = position - camera.eye;
    if dot(from_eye, camera.forward) <= 0.0 {
        return vec2i(-1);
    }
    let at = floor(camera_project(camera, from_eye));
    if at.x >= 0.0 && at.x < f32(camera.width) && at.y >= 0.0 && at.y < f32(camera.height) {
        return vec2i(at);
    }
    return vec2i(-1);
}

// Position at which another frame shows the surface of a slot, and 1; 0: there is no light on it.
fn temporal_position(pixel: u32, own: SkylightSlot) -> vec4f {
    if own.slack <= 0.0 {
        return vec4f(0.0);
    }
    var position = own.position;
    if own.roughness <= 0.0 {
        // A mirror's position is that of what it shows: the mirror is where its own base is.
        let base = skylight_slot(pixel, 0u);
        if base.slack <= 0.0 {
            return vec4f(0.0);
        }
        position = base.position;
    }
    return vec4f(position, 1.0);
}

// A slot of a pixel of the frame before, with the position that it has in this one.
fn temporal_slot(pixel: u32, slot: u32) -> SkylightSlot {
    var packed = temporal_ambient[pixel].base;
    if slot > 0u {
        packed = temporal_ambient[pixel].mirror;
    }
    var found = skylight_unpack(packed);
    found.position -= temporal_frame.shift;
    return found;
}

// The mean of a slot in the frame before, with its weight beside this frame's mean: none where that frame does not show the same surface, or
// shows it in another light.
fn temporal_before(pixel: u32, slot: u32) -> vec4f {
    let own = skylight_slot(pixel, slot);
    let sought = temporal_position(pixel, own);
    if sought.w <= 0.0 {
        return vec4f(0.0);
    }
    let at = temporal_pixel(temporal_frame.camera, sought.xyz + temporal_frame.shift);
    if at.x < 0 {
        return vec4f(0.0);
    }
    let there = u32(at.y) * temporal_frame.camera.width + u32(at.x);
    let other = temporal_slot(there, slot);
    let mean = temporal_means[2u * there + slot];
    let weight = skylight_same(own, other) * skylight_alike(skylight_before[2u * pixel + slot], mean);
    return vec4f(mean.xyz * weight, weight);
}

@compute @workgroup_size(8, 8, 1)
fn main_temporal(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= render_frame.camera.width || id.y >= render_frame.camera.height {
        return;
    }
    let pixel = id.y * render_frame.camera.width + id.x;
    var change = vec3f(0.0);
    for (var slot = 0u; slot < 2u; slot += 1u) {
        let own = skylight_before[2u * pixel + slot].xyz;
        var sum = vec4f(own, 1.0);
        if temporal_frame.turn > 0u {
            sum = temporal_sums[2u * pixel + slot];
        }
        sum += temporal_before(pixel, slot);
        if temporal_frame.is_last > 0u {
            change += skylight_factor(pixel, slot) * (sum.xyz / sum.w - own);
        } else {
            temporal_sums[2u * pixel + slot] = sum;
        }
    }
    if temporal_frame.is_last > 0u {
        skylight_picture[pixel] += vec4f(change, 0.0);
    }
}
