// A picture through a pane of glass with water on it, ray by ray through the lens.
// Law: a ray from the lens meets the pane, goes straight through it, leaves the water by Snell's law at the local normal,
// and shows what stands in its new direction: the picture where that is in it, else the capture of what is around the eye.
// The position of a point is given by the distance in its own direction. Light that is not transmitted (Fresnel, exact,
// incoherent sum over the reflections within the pane) shows the eye's side, whose light is a fraction of that of the
// environment; so does what is totally reflected back to the eye. A lens of some size is a set of points: what is out
// of focus is blurred by as much as the lens says, and no light is lost.
// Limits: the pane's thickness does not shift what is behind it; light that is totally reflected within a drop and leaves
// it elsewhere continues without a second refraction.
// Twin: downpour_render::glass::picture.

struct GlassPictureFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Lamps, and the least radius of the disks of drops that show them, m.
    lights: u32,
    lit_from: f32,
    // Blades of wipers.
    blade_count: u32,
    camera: RenderCamera,
    // The pane's axes in the world, of length 1: right, down, out of it.
    across: vec3f,
    // Bins along x and y.
    columns: u32,
    down: vec3f,
    rows: u32,
    outward: vec3f,
    // Bins in a meter.
    bins: f32,
    // From the eye to the pane's upper left corner.
    corner: vec3f,
    // Cells of the lattice in a meter.
    cells: f32,
    size: vec2f,
    wet_size: vec2u,
    // Radius of the lens, m.
    lens: f32,
    focus: u32,
    fresnel: u32,
    // Light on the eye's side, relative to that of the environment.
    room: f32,
    samples: u32,
    // The coarsest level of the picture, and of the capture.
    last: u32,
    capture_size: u32,
    capture_last: u32,
    // Angle of a texel of the capture.
    capture_texel: f32,
    // Height of the film where glass_picture_wet is largest, m; 0 for no film.
    film: f32,
    // Refractive indices.
    water: f32,
    first_row: u32,
    // Width, height and first texel of each level of the picture.
    levels: array<vec4u, GLASS_PICTURE_LEVELS>,
    blades: array<GlassPictureBlade, GLASS_PICTURE_BLADES>,
}

// Surface of the pane that a ray meets.
struct GlassPictureHit {
    normal: vec3f,
    // 0 where the glass is dry.
    wet: f32,
    // Rate at which the normal turns, 1/m.
    curvature: f32,
    // 1 where it is a drop that shows lamps.
    lit: f32,
}

@group(0) @binding(0) var<uniform> glass_picture_frame: GlassPictureFrame;
@group(0) @binding(1) var<storage, read> glass_picture_drops: array<GlassPictureDrop>;
// First the indices at which the lists of the bins begin (one more than there are bins), then the lists.
@group(0) @binding(2) var<storage, read> glass_picture_bins: array<u32>;
// Height of the film of the cells, 65535 for the largest: two to a word.
@group(0) @binding(3) var<storage, read> glass_picture_wet: array<u32>;
@group(0) @binding(4) var<storage, read> glass_picture_lens: array<vec4f>;
@group(0) @binding(5) var<storage, read> glass_picture_behind: array<vec4f>;
@group(0) @binding(6) var<storage, read> glass_picture_capture: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> glass_picture_made: array<vec4f>;
// Those that shine on the pane, at least one.
@group(0) @binding(8) var<storage, read> glass_picture_sources: array<GlassPictureLight>;

// Height of the film of a cell, 0 to 1.
fn glass_picture_wetness(column: i32, row: i32) -> f32 {
    let size = vec2i(glass_picture_frame.wet_size);
    let x = u32(clamp(column, 0, size.x - 1));
    let y = u32(clamp(row, 0, size.y - 1));
    let index = y * glass_picture_frame.wet_size.x + x;
    let height = (glass_picture_wet[index / 2u] >> (16u * (index % 2u))) & 65535u;
    return f32(height) / 65535.0;
}

// Height of the film and its slopes: the quadratic B-spline over the cells.
fn glass_picture_film(position: vec2f) -> vec3f {
    let at = position * glass_picture_frame.cells - 0.5;
    let middle = floor(at + 0.5);
    let t = at - middle;
    var sum = vec3f(0.0);
    for (var j = 0; j < 3; j += 1) {
        let wy = glass_picture_spline(t.y, j);
        for (var i = 0; i < 3; i += 1) {
            let wet = glass_picture_wetness(i32(middle.x) + i - 1, i32(middle.y) + j - 1);
            let wx = glass_picture_spline(t.x, i);
            sum += vec3f(wx.x * wy.x, wx.y * wy.x, wx.x * wy.y) * wet;
        }
    }
    let per_meter = glass_picture_frame.film * glass_picture_frame.cells;
    return vec3f(sum.x * glass_picture_frame.film, sum.y * per_meter, sum.z * per_meter);
}

// Weight of the cell before, at or after a position, and how it changes; t is -0.5 to 0.5.
fn glass_picture_spline(t: f32, which: i32) -> vec2f {
    if which == 0 {
        return vec2f(0.5 * (0.5 - t) * (0.5 - t), t - 0.5);
    }
    if which == 1 {
        return vec2f(0.75 - t * t, -2.0 * t);
    }
    return vec2f(0.5 * (0.5 + t) * (0.5 + t), t + 0.5);
}

// The surface that a ray leaves by, which enters the water at a position of the glass.
fn glass_picture_meet(position: vec2f, aside: vec2f) -> GlassPictureHit {
    let column = min(u32(max(position.x * glass_picture_frame.bins, 0.0)), glass_picture_frame.columns - 1u);
    let row = min(u32(max(position.y * glass_picture_frame.bins, 0.0)), glass_picture_frame.rows - 1u);
    let bin = row * glass_picture_frame.columns + column;
    var highest = 0.0;
    var found = 0u;
    for (var k = glass_picture_bins[bin]; k < glass_picture_bins[bin + 1u]; k += 1u) {
        let index = glass_picture_bins[k];
        let height = glass_picture_water_cap(glass_picture_drops[index], position).x;
        if height > highest {
            highest = height;
            found = index;
        }
    }
    if highest > 0.0 {
        let drop = glass_picture_drops[found];
        let z = glass_picture_water_leave(drop, position, aside);
        let cap = glass_picture_water_cap(drop, position + aside * z);
        let lit = select(0.0, 1.0, drop.radius >= glass_picture_frame.lit_from);
        return GlassPictureHit(glass_picture_water_normal(cap.yz), 1.0, 1.0 / drop.sphere, lit);
    }
    if glass_picture_frame.film <= 0.0 {
        return GlassPictureHit(vec3f(0.0, 0.0, 1.0), 0.0, 0.0, 0.0);
    }
    let film = glass_picture_film(position);
    return GlassPictureHit(glass_picture_water_normal(film.yz), select(0.0, 1.0, film.x > 0.0), 0.0, 0.0);
}

// A texel of a level of the picture; the nearest where there is none.
fn glass_picture_texel(level: u32, column: i32, row: i32) -> vec4f {
    let size = glass_picture_frame.levels[level];
    let x = u32(clamp(column, 0, i32(size.x) - 1));
    let y = u32(clamp(row, 0, i32(size.y) - 1));
    return glass_picture_behind[size.z + y * size.x + x];
}

// A texel of a level of the capture. Beyond an edge, the octahedral map continues mirrored about the edge's middle.
fn glass_picture_environment_texel(level: u32, column: i32, row: i32) -> vec4f {
    let whole = glass_picture_frame.capture_size;
    let size = whole >> level;
    let texel = packing_octahedral_texel(size, column, row);
    let first = 4u * (whole * whole - size * size) / 3u;
    return glass_picture_capture[first + texel.y * size + texel.x];
}

// A level of the picture or of the capture at a position in [0, 1], bilinear.
fn glass_picture_level(of_capture: bool, level: u32, position: vec2f) -> vec3f {
    var size = vec2f(f32(glass_picture_frame.capture_size >> level));
    if !of_capture {
        size = vec2f(glass_picture_frame.levels[level].xy);
    }
    let at = position * size - 0.5;
    let low = floor(at);
    let part = at - low;
    var sum = vec3f(0.0);
    for (var k = 0; k < 4; k += 1) {
        let step = vec2i(k & 1, k >> 1u);
        let fraction = select(1.0 - part.x, part.x, step.x == 1) * select(1.0 - part.y, part.y, step.y == 1);
        let cell = vec2i(low) + step;
        if fraction > 0.0 {
            if of_capture {
                sum += glass_picture_environment_texel(level, cell.x, cell.y).rgb * fraction;
            } else {
                sum += glass_picture_texel(level, cell.x, cell.y).rgb * fraction;
            }
        }
    }
    return sum;
}

// The picture or the capture at a position of [0, 1], for a footprint in texels of its finest level.
fn glass_picture_at(of_capture: bool, position: vec2f, footprint: f32) -> vec3f {
    let last = f32(select(glass_picture_frame.last, glass_picture_frame.capture_last, of_capture));
    let level = clamp(log2(max(footprint, 1.0e-6)), 0.0, last);
    let low = floor(level);
    let part = level - low;
    var fraction = 1.0 - part;
    var sum = vec3f(0.0);
    for (var k = 0u; k < 2u && fraction > 0.0; k += 1u) {
        sum += glass_picture_level(of_capture, u32(low) + k, position) * fraction;
        fraction = select(0.0, part, k == 0u);
    }
    return sum;
}

// Radiance of the environment map in a direction, averaged over a footprint in radians.
fn glass_picture_environment(direction: vec3f, footprint: f32) -> vec3f {
    let position = packing_octahedral_encode(direction) * 0.5 + 0.5;
    return glass_picture_at(true, position, footprint / glass_picture_frame.capture_texel);
}

// Projects a direction onto the picture: -1 to 1 right and up, and its depth.
fn glass_picture_project(direction: vec3f) -> vec3f {
    let depth = dot(direction, glass_picture_frame.camera.forward);
    return vec3f(camera_place(glass_picture_frame.camera, direction, max(depth, 1.0e-6)), depth);
}

// Radiance along a ray that begins at an offset from the eye. Its footprint is an angle.
fn glass_picture_seen(from_eye: vec3f, direction: vec3f, shift: vec2f, footprint: f32) -> vec3f {
    let size = vec2f(f32(glass_picture_frame.camera.width), f32(glass_picture_frame.camera.height));
    let guess = glass_picture_project(direction);
    var distance = 0.0;
    if guess.z > 0.0 && abs(guess.x) < 1.0 && abs(guess.y) < 1.0 {
        let pixel = vec2f(0.5 + 0.5 * guess.x, 0.5 - 0.5 * guess.y) * size;
        distance = glass_picture_texel(0u, i32(pixel.x), i32(pixel.y)).w;
    } else {
        let texel = (packing_octahedral_encode(direction) * 0.5 + 0.5) * f32(glass_picture_frame.capture_size);
        distance = glass_picture_environment_texel(0u, i32(texel.x), i32(texel.y)).w;
    }
    let to = direction + from_eye / clamp(distance, 0.1, GLASS_PICTURE_FAR);
    let position = glass_picture_project(to);
    let texels = max(footprint / glass_picture_frame.camera.pixel_angle, 1.0);
    // Toward the picture's edge the capture takes over, within the footprint.
    let at = vec2f(0.5 + 0.5 * position.x, 0.5 - 0.5 * position.y) + shift / size;
    let inside = min(min(at.x, 1.0 - at.x) * size.x, min(at.y, 1.0 - at.y) * size.y);
    let fraction = select(0.0, clamp((inside + 0.5) / texels, 0.0, 1.0), position.z > 0.0);
    var sum = vec3f(0.0);
    if fraction > 0.0 {
        sum = glass_picture_at(false, at, texels) * fraction;
    }
    if fraction < 1.0 {
        sum += glass_picture_environment(to, footprint) * (1.0 - fraction);
    }
    return sum;
}

// Radiance of the lamps and the sun in a drop: they are points, and in no picture of the scene behind the pane.
fn glass_picture_lights(from_eye: vec3f, direction: vec3f, footprint: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var k = 0u; k < glass_picture_frame.lights; k += 1u) {
        sum += glass_picture_light_seen(glass_picture_sources[k], from_eye, direction, footprint);
    }
    return sum;
}

// A direction of the pane in the world.
fn glass_picture_world(v: vec3f) -> vec3f {
    return glass_picture_frame.across * v.x + glass_picture_frame.down * v.y + glass_picture_frame.outward * v.z;
}

// Radiance of the interior ambient along a ray that leaves water toward the eye's side, in a direction of the pane.
fn glass_picture_inside(v: vec3f) -> vec3f {
    let aside = v.xy * glass_picture_frame.water;
    let out = vec3f(aside, -sqrt(max(1.0 - dot(aside, aside), 1.0e-4)));
    return glass_picture_environment(glass_picture_world(out), GLASS_PICTURE_MIRROR) * glass_picture_frame.room;
}

// Fraction of the light that the outer surface reflects: that of water under a normal, or that of dry glass.
fn glass_picture_outer(cosine: f32, met: GlassPictureHit, within: f32) -> f32 {
    if met.wet == 0.0 {
        return optics_fresnel(cosine, GLASS_PICTURE_INDEX);
    }
    var surface = optics_fresnel(within, 1.0 / glass_picture_frame.water);
    if glass_picture_frame.fresnel == GLASS_PICTURE_TATARCHUK && surface < 1.0 {
        surface = optics_fresnel_tatarchuk(within);
    }
    let glass = sqrt(max(1.0 - (1.0 - cosine * cosine) / (GLASS_PICTURE_INDEX * GLASS_PICTURE_INDEX), 0.0));
    let inner = optics_fresnel(glass, glass_picture_frame.water / GLASS_PICTURE_INDEX);
    return 1.0 - (1.0 - surface) * (1.0 - inner);
}

// Radiance along a ray that meets the pane at a position, in a direction of the pane. `from_eye` is that position
// relative to the eye; `spread` are the angle between neighboring rays, and their distance on the pane.
fn glass_picture_through(position: vec2f, d: vec3f, from_eye: vec3f, shift: vec2f, spread: vec2f) -> vec3f {
    let water = glass_picture_frame.water;
    let aside = d.xy / water;
    let w = vec3f(aside, sqrt(max(1.0 - dot(aside, aside), 0.0)));
    let met = glass_picture_meet(position, w.xy / w.z);
    let within = dot(w, met.normal);
    let first = optics_fresnel(d.z, GLASS_PICTURE_INDEX);
    let outer = glass_picture_outer(d.z, met, max(within, 0.0));
    let bent = optics_refract(w, -met.normal, water);
    let total = met.wet > 0.0 && (bent.w <= 0.0 || within <= 0.0);
    let leaves = select(select(vec3f(d), bent.xyz, met.wet > 0.0), w, total);
    let through = select((1.0 - first) * (1.0 - outer) / (1.0 - first * outer), 0.0, total);
    var sum = vec3f(0.0);
    if through > 0.0 {
        let turned = (water - 1.0) * met.curvature / max(dot(leaves, met.normal), 0.2);
        let footprint = spread.x + spread.y * turned;
        sum = glass_picture_seen(from_eye, glass_picture_world(leaves), shift, footprint) * through;
        if met.lit > 0.0 {
            sum += glass_picture_lights(from_eye, glass_picture_world(leaves), footprint) * through;
        }
    }
    let back = optics_reflect(w, -met.normal);
    var rest = 1.0 - through;
    if total && back.z > 0.0 {
        // Out on the other side of the drop.
        let footprint = spread.x + 2.0 * spread.y * met.curvature;
        sum = glass_picture_seen(from_eye, glass_picture_world(back), shift, footprint) * (1.0 - first);
        rest = first;
    }
    if glass_picture_frame.room > 0.0 {
        let mirror = glass_picture_world(vec3f(d.xy, -d.z));
        sum += glass_picture_environment(mirror, GLASS_PICTURE_MIRROR) * (glass_picture_frame.room * first);
        let away = select(back, vec3f(back.xy, -back.z), back.z > 0.0);
        sum += glass_picture_inside(away) * max(rest - first, 0.0);
    }
    return sum;
}

// Radiance of a diffuse surface of the eye's side of a blade. `aside` is where its rounded face is turned, of length 1; `across` is how far
// it is turned there, -1 to 1. What it sees of the room and of the scene is as much as a face of that slope sees.
fn glass_picture_diffuse(aside: vec2f, across: f32) -> vec3f {
    let turned = 0.8 * across;
    let upright = sqrt(1.0 - turned * turned);
    let outside = 0.5 - 0.5 * upright;
    let to_room = glass_picture_world(vec3f(aside * turned, -upright));
    let room = glass_picture_environment(to_room, GLASS_PICTURE_DIFFUSE) * glass_picture_frame.room;
    let side = select(-1.0, 1.0, turned > 0.0);
    let to_scene = glass_picture_world(vec3f(aside * (side * 0.70710678), 0.70710678));
    return room * (1.0 - outside) + glass_picture_environment(to_scene, GLASS_PICTURE_DIFFUSE) * outside;
}

// Radiance of the wipers along a ray that meets the pane at a position, in a direction of the pane, at a fraction of the exposure; and 1,
// or 0 where there is none.
fn glass_picture_wiper(position: vec2f, d: vec3f, fraction: f32) -> vec4f {
    for (var k = 0u; k < glass_picture_frame.blade_count; k += 1u) {
        let direction = glass_picture_blade_at(glass_picture_frame.blades[k], fraction);
        let part = glass_picture_blade_part(glass_picture_frame.blades[k], direction, position);
        if part.y > 0.0 {
            let first = optics_fresnel(d.z, GLASS_PICTURE_INDEX);
            let aside = vec2f(-direction.y, direction.x);
            var sum = glass_picture_diffuse(aside, part.x) * (part.y * (1.0 - first));
            if glass_picture_frame.room > 0.0 {
                let mirror = glass_picture_world(vec3f(d.xy, -d.z));
                sum += glass_picture_environment(mirror, GLASS_PICTURE_MIRROR) * (glass_picture_frame.room * first);
            }
            return vec4f(sum, 1.0);
        }
    }
    return vec4f(0.0);
}

// A sample of a pixel: a position of the lens (xy, in its radius) and of the pixel (zw), and a fraction
// of the exposure.
fn glass_picture_sample(x: f32, y: f32, distance: f32, at: vec4f, moment: f32) -> vec3f {
    let ray = camera_direction(glass_picture_frame.camera, x + at.z, y + at.w);
    let right = glass_picture_frame.camera.right / sqrt(dot(glass_picture_frame.camera.right, glass_picture_frame.camera.right));
    let up = glass_picture_frame.camera.up / sqrt(dot(glass_picture_frame.camera.up, glass_picture_frame.camera.up));
    let from_eye = (right * at.x + up * at.y) * glass_picture_frame.lens;
    // The scene behind is looked up at the pixel's center: it is sampled already.
    let shift = vec2f(0.5 - at.z, 0.5 - at.w);
    let plane = dot(glass_picture_frame.corner, glass_picture_frame.outward);
    let towards = dot(ray, glass_picture_frame.outward);
    let far = min(distance, GLASS_PICTURE_FAR);
    let pane = plane / max(towards, 1.0e-6);
    if towards < 1.0e-3 || pane > far {
        return glass_picture_seen(vec3f(0.0), ray, shift, glass_picture_frame.camera.pixel_angle);
    }
    let depth = select(far, pane, glass_picture_frame.focus == GLASS_PICTURE_GLASS);
    let aim = ray * depth - from_eye;
    let direction = aim / sqrt(dot(aim, aim));
    let d = vec3f(
        dot(direction, glass_picture_frame.across),
        dot(direction, glass_picture_frame.down),
        max(dot(direction, glass_picture_frame.outward), 1.0e-4),
    );
    let way = (plane - dot(from_eye, glass_picture_frame.outward)) / d.z;
    let met = from_eye + direction * way;
    let on = met - glass_picture_frame.corner;
    let position = vec2f(dot(on, glass_picture_frame.across), dot(on, glass_picture_frame.down));
    let among = sqrt(1.0 / f32(glass_picture_frame.samples));
    let apart = glass_picture_frame.lens * GLASS_PICTURE_APART * among;
    let pixel = glass_picture_frame.camera.pixel_angle;
    if position.x < 0.0 || position.y < 0.0 || position.x > glass_picture_frame.size.x || position.y > glass_picture_frame.size.y {
        return glass_picture_seen(from_eye, direction, shift, pixel + apart * abs(1.0 / depth - 1.0 / far));
    }
    let wiper = glass_picture_wiper(position, d, moment);
    if wiper.w > 0.0 {
        return wiper.xyz;
    }
    let angle = pixel * among + apart * abs(1.0 / depth - 1.0 / far);
    let spread = vec2f(angle, pixel * pane * among + apart * abs(1.0 - pane / depth));
    return glass_picture_through(position, d, met, shift, spread);
}

// A pixel.
fn glass_picture_pixel(x: u32, y: u32) -> vec3f {
    let distance = glass_picture_texel(0u, i32(x), i32(y)).w;
    var sum = vec3f(0.0);
    for (var k = 0u; k < glass_picture_frame.samples; k += 1u) {
        let moment = fract((f32(k) + 0.5) * GLASS_PICTURE_MOMENT);
        sum += glass_picture_sample(f32(x), f32(y), distance, glass_picture_lens[k], moment);
    }
    return sum / f32(glass_picture_frame.samples);
}

@compute @workgroup_size(8, 8, 1)
fn main_glass_picture(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + glass_picture_frame.first_row;
    if id.x >= glass_picture_frame.camera.width || y >= glass_picture_frame.camera.height {
        return;
    }
    glass_picture_made[y * glass_picture_frame.camera.width + id.x] = vec4f(glass_picture_pixel(id.x, y), 1.0);
}
