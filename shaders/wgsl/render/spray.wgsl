// Spray: the layer of droplets over what rain hits, before each pixel.
// Law: the extinction is that at a surface times exp(-height over the nearest surface below / h), where nothing keeps the rain off; below the
// first surface that rain meets there is none.
// Method: the ray is followed through the map of heights (spray_map.wgsl), cell by cell where it is above all heights of a cell, else
// texel by texel, with heights that are linear between texels and the integral of the law in closed form.
// Twin: downpour_render::rain::spray.

@group(0) @binding(6) var<storage, read> spray_clean: array<vec4f>;
@group(0) @binding(7) var<storage, read> spray_map: array<f32>;
// For each pixel two: light of lamps if nothing hid them, and as halves optical depth and share of the nearer place; light of lamps that one ray
// has seen, and as halves the distances of the two places that stand for the spray.
@group(0) @binding(8) var<storage, read_write> spray_found: array<vec4f>;

// Position in texels of a square of a point `way` from another of the plane: the difference from the square's corner first, which has more digits.
fn spray_texel(level: u32, foot: vec2f, way: vec2f) -> vec2f {
    let square = spray_frame.levels[level];
    return ((foot - square.xy) + way) * square.w;
}

// The first square from `level` on in which a point `way` from another of the plane is; SPRAY_LEVELS: none.
fn spray_level(level: u32, foot: vec2f, way: vec2f) -> u32 {
    var found = level;
    while found < SPRAY_LEVELS {
        let texel = spray_texel(found, foot, way);
        if min(texel.x, texel.y) >= 1.0 && max(texel.x, texel.y) < f32(SPRAY_SIZE - 2u) {
            break;
        }
        found += 1u;
    }
    return found;
}

// The height of what rain hits at a position in texels of a square, linear between texels.
fn spray_height(level: u32, texel: vec2f) -> f32 {
    let last = f32(SPRAY_SIZE - 2u);
    let low = clamp(floor(texel), vec2f(0.0), vec2f(last));
    let part = clamp(texel - low, vec2f(0.0), vec2f(1.0));
    let first = (level * SPRAY_SIZE + u32(low.y)) * SPRAY_SIZE + u32(low.x);
    let near = spray_map[first] * (1.0 - part.x) + spray_map[first + 1u] * part.x;
    let far = spray_map[first + SPRAY_SIZE] * (1.0 - part.x) + spray_map[first + SPRAY_SIZE + 1u] * part.x;
    return near * (1.0 - part.y) + far * part.y;
}

// No height of the cell of a position in texels, and of its neighbors toward greater ones, is above this.
fn spray_roof(level: u32, texel: vec2f) -> f32 {
    let cell = min(vec2u(texel) / SPRAY_CELL, vec2u(SPRAY_CELLS - 1u));
    let next = min(cell + 1u, vec2u(SPRAY_CELLS - 1u));
    let first = SPRAY_LEVELS * SPRAY_SIZE * SPRAY_SIZE + level * SPRAY_CELLS * SPRAY_CELLS;
    let near = max(spray_map[first + cell.y * SPRAY_CELLS + cell.x], spray_map[first + cell.y * SPRAY_CELLS + next.x]);
    let far = max(spray_map[first + next.y * SPRAY_CELLS + cell.x], spray_map[first + next.y * SPRAY_CELLS + next.x]);
    return max(near, far);
}

// Way along a coordinate in texels that changes by `rate` a meter, in meters, to the border of its cell. What is on a border is in the cell
// ahead.
fn spray_border(texel: f32, rate: f32) -> f32 {
    if abs(rate) < 1.0e-6 {
        return SPRAY_FAR;
    }
    let edge = f32(SPRAY_CELL);
    let cell = floor((texel + sign(rate) * SPRAY_AHEAD) / edge);
    return max(((cell + select(0.0, 1.0, rate > 0.0)) * edge - texel) / rate, 0.0);
}

// Mean of exp(-gap) between two gaps over a surface, in heights of the decrease; nothing below it.
fn spray_between(a: f32, b: f32) -> f32 {
    let low = min(a, b);
    let high = max(a, b);
    if high < 0.0 {
        return 0.0;
    }
    let above = select(1.0, high / (high - low), low < 0.0);
    let foot = max(low, 0.0);
    return above * exp(-foot) * medium_decay_mean(high - foot);
}

// Spray along a ray: its optical depth, and two places that have the mean, the variance and the third moment of the distances at which light
// is taken out (Gauss's rule of two points): what is on two surfaces has a place on each.
struct SprayAlong {
    depth: f32,
    near: f32,
    far: f32,
    // Share of the nearer one, 0 to 1.
    share: f32,
}

// Two places of a weight and of moments of the distance from the first place.
fn spray_places(depth: f32, first: f32, last: f32, moments: vec4f) -> SprayAlong {
    if moments.x <= 0.0 {
        return SprayAlong(depth, first, first, 1.0);
    }
    let mean = moments.y / moments.x;
    let square = moments.z / moments.x;
    let variance = max(square - mean * mean, 0.0);
    let spread = sqrt(variance);
    if spread <= 1.0e-3 * (last - first) {
        return SprayAlong(depth, first + mean, first + mean, 1.0);
    }
    let third = moments.w / moments.x - mean * (3.0 * square - 2.0 * mean * mean);
    let lean = clamp(third / (variance * spread), -1.0e3, 1.0e3) * 0.5;
    let root = sqrt(1.0 + lean * lean);
    let near = clamp(first + mean + spread * (lean - root), first, last);
    let far = clamp(first + mean + spread * (lean + root), first, last);
    return SprayAlong(depth, near, far, 0.5 * (1.0 + lean / root));
}

// Spray along a ray of unit direction from the eye between two distances.
fn spray_along(direction: vec3f, begin: f32, end: f32) -> SprayAlong {
    let eye = spray_frame.eye;
    let lean = spray_frame.lean;
    let foot = eye.xz - lean * eye.y;
    let rate = direction.xz - lean * direction.y;
    let pace = sqrt(dot(rate, rate));
    let reach = SPRAY_REACH * spray_frame.height;
    var level = 0u;
    var at = begin;
    var depth = 0.0;
    // Weight and moments of the distance from the first place where there is some.
    var moments = vec4f(0.0);
    var first = begin;
    var last = begin;
    // Height of the ray over the surface, and whether it is known.
    var gap = 0.0;
    var known = false;
    for (var turn = 0u; turn < SPRAY_TURNS && at < end; turn += 1u) {
        let next_level = spray_level(level, foot, rate * at);
        if next_level >= SPRAY_LEVELS {
            break;
        }
        known = known && next_level == level;
        level = next_level;
        let square = spray_frame.levels[level];
        let texel = spray_texel(level, foot, rate * at);
        let speed = rate * square.w;
        // A little into the next cell.
        let border = min(spray_border(texel.x, speed.x), spray_border(texel.y, speed.y)) + 0.01 * square.z / max(pace, 1.0e-6);
        let leaves = min(at + border, end);
        let height = eye.y + direction.y * at;
        if min(height, eye.y + direction.y * leaves) > spray_roof(level, texel + sign(speed) * SPRAY_AHEAD) + reach {
            at = leaves;
            known = false;
            continue;
        }
        if !known {
            gap = height - spray_height(level, texel);
        }
        let next = min(at + square.z / max(pace, 1.0e-6), leaves);
        let way = next - at;
        let there = eye.y + direction.y * next - spray_height(level, texel + speed * way);
        let part = spray_frame.extinction * spray_between(gap / spray_frame.height, there / spray_frame.height) * way;
        if part > 0.0 {
            let weight = part * exp(-depth - 0.5 * part);
            last = at + 0.5 * way;
            if depth <= 0.0 {
                first = last;
            }
            let x = last - first;
            moments += weight * vec4f(1.0, x, x * x, x * x * x);
            depth += part;
        }
        at = next;
        gap = there;
        known = true;
    }
    return spray_places(depth, first, last, moments);
}

// Spray before a pixel.
fn spray_pixel(x: u32, y: u32) -> SprayAlong {
    let scene = spray_clean[y * render_frame.camera.width + x].w;
    let direction = camera_direction(render_frame.camera, f32(x) + 0.5, f32(y) + 0.5);
    return spray_along(direction, medium_begin(direction), min(scene, SPRAY_FAR));
}

@compute @workgroup_size(8, 8, 1)
fn main_spray(@builtin(global_invocation_id) id: vec3u) {
    if id.x < render_frame.camera.width && id.y < render_frame.camera.height {
        let found = spray_pixel(id.x, id.y);
        let at = 2u * (id.y * render_frame.camera.width + id.x);
        let halves = vec2u(pack2x16float(vec2f(min(found.depth, 6.0e4), found.share)), pack2x16float(vec2f(min(found.near, 6.0e4), min(found.far, 6.0e4))));
        spray_found[at] = vec4f(0.0, 0.0, 0.0, bitcast<f32>(halves.x));
        spray_found[at + 1u] = vec4f(0.0, 0.0, 0.0, bitcast<f32>(halves.y));
    }
}
