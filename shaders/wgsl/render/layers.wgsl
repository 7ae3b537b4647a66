// Rainfall as layers of a texture before a picture, in one pass: the form of Tatarchuk & Isidoro 2006, section 3.1.
// Law: a texture of places, which moves with the rain, gives each cell of the picture a random r; the layer of rain that is seen there is
// at w = p r of the range of parallax p, and the texture of streaks is looked up in its scale. A streak's normal is looked up in a
// coarser level the faster the rain is; it refracts and mirrors what is around the eye and the light of lamps, with
// f = 0.95 (1 - n . v)^4 + 0.05, and is mixed with white (their milk).
// Here distances are meters, and the direction and the amount of rain are those of the weather.
// Twin: downpour_render::rain::layers.

// A lamp: its place relative to the eye, or the direction to it if its light is parallel.
struct LayersLamp {
    place: vec3f,
    is_parallel: u32,
    // Irradiance over pi of a surface that faces it, at 1 m.
    color: vec3f,
    unused: u32,
}

struct LayersFrame {
    // Factor of the opacity of the texture.
    strength: f32,
    // Distance of the farthest layer over that of the nearest.
    parallax: f32,
    // Direction of the fall on the picture, right and up.
    fall: vec2f,
    // Part of a period by which the streaks have moved.
    moved: f32,
    // Rows of cells by which the places have moved: the part of one, and whole ones.
    row_part: f32,
    row: u32,
    // Number of lamps.
    count: u32,
    // Fraction of white.
    milk: f32,
    // Length of streaks over that in the texture.
    stretch: f32,
    // Levels by which the nearest normals are coarser.
    distortion: f32,
    unused: u32,
    lamps: array<LayersLamp, 16>,
}

@group(0) @binding(2) var<uniform> layers_frame: LayersFrame;
// Places, a word each: r, and a shift of the streaks; then the levels of the streaks: opacity and normal.
@group(0) @binding(3) var<storage, read> layers_texture: array<u32>;
@group(0) @binding(4) var<storage, read> layers_clean: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> layers_rain: array<vec4f>;

// The place of a cell: r, and the shift.
fn layers_place(column: u32, row: u32) -> vec3f {
    let edge = LAYERS_PLACES - 1u;
    return unpack4x8unorm(layers_texture[(row & edge) * LAYERS_PLACES + (column & edge)]).xyz;
}

// A texel of a level of the streaks: opacity, and the parts of the normal across and along the fall.
fn layers_texel(level: u32, column: i32, row: i32) -> vec3f {
    let size = LAYERS_SIZE >> level;
    let first = LAYERS_PLACES * LAYERS_PLACES + 4u * (LAYERS_SIZE * LAYERS_SIZE - size * size) / 3u;
    let edge = size - 1u;
    let word = layers_texture[first + (u32(row) & edge) * size + (u32(column) & edge)];
    let found = unpack4x8unorm(word).xyz;
    return vec3f(found.x, found.yz * 2.0 - 1.0);
}

// A level at a position in periods, bilinear.
fn layers_level(level: u32, position: vec2f) -> vec3f {
    let at = position * f32(LAYERS_SIZE >> level) - 0.5;
    let low = floor(at);
    let part = at - low;
    let column = i32(low.x);
    let row = i32(low.y);
    let upper = layers_texel(level, column, row) * (1.0 - part.x) + layers_texel(level, column + 1, row) * part.x;
    let lower = layers_texel(level, column, row + 1) * (1.0 - part.x) + layers_texel(level, column + 1, row + 1) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// The streaks at a position in periods, between two levels.
fn layers_streaks(position: vec2f, level: f32) -> vec3f {
    let within = clamp(level, 0.0, f32(LAYERS_LEVELS - 1u));
    let low = min(u32(within), LAYERS_LEVELS - 2u);
    let part = within - f32(low);
    return layers_level(low, position) * (1.0 - part) + layers_level(low + 1u, position) * part;
}

// Fraction of light that a streak mirrors, by the cosine between its normal and the way to the viewer: equation (f) of the paper.
fn layers_fresnel(cosine: f32) -> f32 {
    let aside = 1.0 - clamp(cosine, 0.0, 1.0);
    return 0.95 * (aside * aside) * (aside * aside) + 0.05;
}

// The way of light that a streak shows, into water, for a ray of a direction and a normal toward the viewer.
fn layers_refracted(direction: vec3f, normal: vec3f) -> vec3f {
    return optics_refract(direction, normal, 1.0 / LAYERS_INDEX).xyz;
}

// The fourth power of a cosine, 0 if it is below 0.
fn layers_lobe(cosine: f32) -> f32 {
    let square = max(cosine, 0.0) * max(cosine, 0.0);
    return square * square;
}

// Light of a lamp that a streak at a place relative to the eye mirrors, and that comes through it.
fn layers_lamp(lamp: LayersLamp, place: vec3f, direction: vec3f, normal: vec3f) -> vec3f {
    var offset = lamp.place - place;
    var square = max(dot(offset, offset), 1.0e-2);
    if lamp.is_parallel > 0u {
        offset = lamp.place;
        square = 1.0;
    }
    let along = offset / max(sqrt(dot(offset, offset)), 1.0e-6);
    let half_way = along - direction;
    let middle = half_way / max(sqrt(dot(half_way, half_way)), 1.0e-6);
    // Blinn's lobe of exponent 16, and Phong's of exponent 4 about the refracted ray: their light would not change with it.
    let fourth = layers_lobe(dot(normal, middle));
    let mirrored = (fourth * fourth) * (fourth * fourth) * layers_fresnel(dot(along, middle)) * max(dot(normal, along), 0.0);
    let through = layers_lobe(dot(layers_refracted(direction, normal), along)) * (1.0 - layers_fresnel(-dot(direction, normal)));
    return lamp.color * ((mirrored * (24.0 / 8.0) + through * (5.0 / 2.0)) / square);
}

// What a pixel shows of the layers before a scene so far away: radiance times opacity, and opacity.
fn layers_pixel(x: u32, y: u32, scene: f32) -> vec4f {
    let camera = drops_frame.camera;
    let wide = sqrt(dot(camera.right, camera.right));
    let high = sqrt(dot(camera.up, camera.up));
    let plane = vec2f(
        (2.0 * (f32(x) + 0.5) / f32(camera.width) - 1.0) * wide,
        (1.0 - 2.0 * (f32(y) + 0.5) / f32(camera.height)) * high,
    );
    let fall = layers_frame.fall;
    let along = dot(plane, fall);
    let across = plane.x * -fall.y + plane.y * fall.x;
    let column = u32(i32(floor(across * LAYERS_COLUMNS)));
    let row = u32(i32(floor(along - layers_frame.row_part))) - layers_frame.row;
    let found = layers_place(column, row);
    // w = p r, over the nearest layer.
    let distance = LAYERS_NEAREST * (1.0 + (layers_frame.parallax - 1.0) * found.x);
    if scene < distance {
        return vec4f(0.0);
    }
    let position = vec2f(
        across * distance + found.y,
        along * distance / layers_frame.stretch - layers_frame.moved + found.z,
    );
    let level = log2(max(distance * camera.pixel_angle * f32(LAYERS_SIZE), 1.0));
    let opacity = min(layers_streaks(position, level).x * layers_frame.strength, 1.0);
    if opacity <= 0.0 {
        return vec4f(0.0);
    }
    let bent = layers_streaks(position, level + layers_frame.distortion * (1.0 - found.x)).yz;
    let direction = camera_direction(camera, f32(x) + 0.5, f32(y) + 0.5);
    let right = camera.right / wide;
    let up = camera.up / high;
    let leaning = (right * -fall.y + up * fall.x) * bent.x + (right * fall.x + up * fall.y) * bent.y - direction;
    let normal = leaning / sqrt(dot(leaning, leaning));
    let cosine = -dot(direction, normal);
    let fresnel = layers_fresnel(cosine);
    let mirrored = optics_reflect(direction, normal);
    let refracted = layers_refracted(direction, normal);
    var seen = drops_capture_about(direction, refracted, LAYERS_WIDTH) * (1.0 - fresnel)
        + drops_capture_about(direction, mirrored, LAYERS_WIDTH) * fresnel;
    for (var k = 0u; k < layers_frame.count; k += 1u) {
        seen += layers_lamp(layers_frame.lamps[k], direction * distance, direction, normal);
    }
    let around = drops_capture_texel(drops_frame.capture_last, 0, 0);
    let white = max(around.x, max(around.y, around.z));
    seen += (vec3f(white) - seen) * layers_frame.milk;
    return vec4f(seen * opacity, opacity);
}

@compute @workgroup_size(8, 8, 1)
fn main_layers(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= drops_frame.camera.width || id.y >= drops_frame.camera.height {
        return;
    }
    let index = id.y * drops_frame.camera.width + id.x;
    let shown = layers_pixel(id.x, id.y, layers_clean[index].w);
    let behind = layers_rain[index];
    layers_rain[index] = behind * (1.0 - shown.w) + vec4f(shown.rgb, 0.0);
}
