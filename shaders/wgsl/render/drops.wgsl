// Drops as refractive particles that face the camera: what the precomputed masks say about a viewer's ray, looked up in
// the captured surroundings.
// Law: the light that comes through has the share that the mask's transmittance says, the rest comes from the mirrored
// direction, so nothing is lost: in uniform surroundings a drop vanishes. The mask's directions are for parallel rays;
// a ray of the camera turns them by what it differs from the ray to the drop's middle (first order in the drop's
// angle).
// A drop below a pixel covers the pixels round its middle by its area, so its light does not depend on where it falls;
// a larger one is sampled on a grid in each pixel.
// Limits: the surroundings are those of the eye, not of the drop; a drop does not show other drops.
// Drops that are not drawn are a veil: they take out as much of what is behind them as their cross-sections say, and show
// the mean of what is about the ray instead. The sky is taken to be as it is seen through them.
// Twin: downpour_render::rain::drops.

struct DropsFrame {
    // The camera's axes: half the picture at distance 1.
    right: vec3f,
    width: u32,
    up: vec3f,
    height: u32,
    forward: vec3f,
    pixel_angle: f32,
    // Axes of the capture in the papers' form: the whole of it at distance 1.
    capture_right: vec3f,
    // Texels along an edge of the capture.
    capture_size: u32,
    capture_up: vec3f,
    // The coarsest level of the capture.
    capture_last: u32,
    capture_forward: vec3f,
    // Angle of a texel of the capture.
    capture_texel: f32,
    // The form of refraction: DROPS_DIRECTION or DROPS_SHIFT.
    form: u32,
    // Texels along an edge of a mask.
    mask_size: u32,
    // Tiles across the picture.
    tiles_across: u32,
    // What the optical depth grows by beyond the table, 1/m.
    veil_beyond: f32,
    // Optical depths of the drops that are too small or too far to be drawn: at DROPS_VEIL_NEAR metres, then a factor of
    // 2^(1/3) farther each.
    veil: array<vec4f, DROPS_VEIL_QUARTERS>,
}

// A drop on the picture.
struct DropsDrop {
    // From the eye to the drop's middle, of length 1.
    towards: vec3f,
    // Metres from the eye.
    distance: f32,
    // Place of the middle on the picture, pixels from the top left.
    place: vec2f,
    // Equivalent radius over distance.
    slope: f32,
    // Half the width of its mask, in equivalent radii.
    half_extent: f32,
    // Place in the masks: rows of diameters, and of elevations.
    row: vec2f,
    // Area on the picture, pixels.
    area: f32,
    // Samples along an edge of a pixel; 0: the drop is below a pixel.
    grid: u32,
}

// What a mask says.
struct DropsTexel {
    // Direction of the light that comes through, in the frame of the view: right, up, towards the viewer.
    direction: vec3f,
    coverage: f32,
    reflected: vec3f,
    transmittance: f32,
}

@group(0) @binding(0) var<uniform> drops_frame: DropsFrame;
@group(0) @binding(1) var<storage, read> drops_list: array<DropsDrop>;
// First the places where the tiles' lists begin (one more than there are tiles), then the lists.
@group(0) @binding(2) var<storage, read> drops_tiles: array<u32>;
@group(0) @binding(3) var<storage, read> drops_masks: array<u32>;
@group(0) @binding(4) var<storage, read> drops_capture: array<vec4f>;
@group(0) @binding(5) var<storage, read> drops_clean: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> drops_layer: array<vec4f>;

// A vector of length 1, or the vector itself if it has none.
fn drops_unit(v: vec3f) -> vec3f {
    return v / max(sqrt(dot(v, v)), 1.0e-20);
}

// The right of the view of a drop whose axis is the world's vertical.
fn drops_right(towards: vec3f) -> vec3f {
    let sideways = vec3f(-towards.z, 0.0, towards.x);
    let level = dot(sideways, sideways);
    return select(vec3f(1.0, 0.0, 0.0), sideways / sqrt(max(level, 1.0e-20)), level > 1.0e-12);
}

// A texel of a mask.
fn drops_mask_texel(layer: u32, column: i32, row: i32) -> DropsTexel {
    let last = i32(drops_frame.mask_size) - 1;
    let x = u32(clamp(column, 0, last));
    let y = u32(clamp(row, 0, last));
    let at = ((layer * drops_frame.mask_size + y) * drops_frame.mask_size + x) * DROPS_TEXEL_WORDS;
    let shares = unpack2x16unorm(drops_masks[at + 2u]);
    return DropsTexel(
        packing_octahedral_decode(unpack2x16snorm(drops_masks[at])),
        shares.x,
        packing_octahedral_decode(unpack2x16snorm(drops_masks[at + 1u])),
        shares.y,
    );
}

// Adds a weighted texel to a sum. Texels outside the drop have no direction to add.
fn drops_add(sum: DropsTexel, texel: DropsTexel, weight: f32) -> DropsTexel {
    let covered = weight * texel.coverage;
    return DropsTexel(
        sum.direction + texel.direction * covered,
        sum.coverage + covered,
        sum.reflected + texel.reflected * covered,
        sum.transmittance + texel.transmittance * covered,
    );
}

// A mask between its texels: sums weighted by coverage. (u, v) in [0, 1] from the top left.
fn drops_mask_layer(sum: DropsTexel, layer: u32, u: f32, v: f32, weight: f32) -> DropsTexel {
    let x = u * f32(drops_frame.mask_size) - 0.5;
    let y = v * f32(drops_frame.mask_size) - 0.5;
    let left = i32(floor(x));
    let top = i32(floor(y));
    let fx = x - floor(x);
    let fy = y - floor(y);
    var s = drops_add(sum, drops_mask_texel(layer, left, top), weight * (1.0 - fx) * (1.0 - fy));
    s = drops_add(s, drops_mask_texel(layer, left + 1, top), weight * fx * (1.0 - fy));
    s = drops_add(s, drops_mask_texel(layer, left, top + 1), weight * (1.0 - fx) * fy);
    return drops_add(s, drops_mask_texel(layer, left + 1, top + 1), weight * fx * fy);
}

// What the masks say for a drop at (x, y) in units of half the mask, up and right: between diameters and elevations.
fn drops_mask(row: vec2f, x: f32, y: f32) -> DropsTexel {
    let u = 0.5 + 0.5 * x;
    let v = 0.5 - 0.5 * y;
    let low = floor(row);
    let part = row - low;
    let first = u32(low.x) * DROPS_ELEVATIONS + u32(low.y);
    var sum = DropsTexel(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    // Two elevations of two diameters. One text for all: each copy of it is compiled again.
    for (var k = 0u; k < 4u; k += 1u) {
        let of_diameter = select(1.0 - part.x, part.x, k >= 2u);
        let weight = of_diameter * select(1.0 - part.y, part.y, (k & 1u) == 1u);
        if weight > 0.0 {
            sum = drops_mask_layer(sum, first + (k / 2u) * DROPS_ELEVATIONS + (k & 1u), u, v, weight);
        }
    }
    return DropsTexel(
        drops_unit(sum.direction),
        sum.coverage,
        drops_unit(sum.reflected),
        sum.transmittance / max(sum.coverage, 1.0e-20),
    );
}

// A texel of a level of the capture. Beyond an edge the octahedral map goes on at the edge's mirror image.
fn drops_capture_texel(level: u32, column: i32, row: i32) -> vec3f {
    let whole = drops_frame.capture_size;
    let size = whole >> level;
    let edge = i32(size);
    var x = column;
    var y = row;
    if drops_frame.form == DROPS_DIRECTION {
        if x < 0 || x >= edge {
            x = clamp(x, 0, edge - 1);
            y = edge - 1 - y;
        }
        if y < 0 || y >= edge {
            y = clamp(y, 0, edge - 1);
            x = edge - 1 - x;
        }
    }
    x = clamp(x, 0, edge - 1);
    y = clamp(y, 0, edge - 1);
    let first = 4u * (whole * whole - size * size) / 3u;
    return drops_capture[first + u32(y) * size + u32(x)].rgb;
}

// A level of the capture at a place of [0, 1], bilinear.
fn drops_capture_level(level: u32, place: vec2f) -> vec3f {
    let size = f32(drops_frame.capture_size >> level);
    let x = place.x * size - 0.5;
    let y = place.y * size - 0.5;
    let left = i32(floor(x));
    let top = i32(floor(y));
    let fx = x - floor(x);
    let fy = y - floor(y);
    let upper = drops_capture_texel(level, left, top) * (1.0 - fx)
        + drops_capture_texel(level, left + 1, top) * fx;
    let lower = drops_capture_texel(level, left, top + 1) * (1.0 - fx)
        + drops_capture_texel(level, left + 1, top + 1) * fx;
    return upper * (1.0 - fy) + lower * fy;
}

// The capture at a place of [0, 1], for a footprint of some angle.
fn drops_capture_at(place: vec2f, footprint: f32) -> vec3f {
    let last = f32(drops_frame.capture_last);
    let level = clamp(log2(max(footprint / drops_frame.capture_texel, 1.0e-6)), 0.0, last);
    let low = floor(level);
    let part = level - low;
    var share = 1.0 - part;
    var sum = vec3f(0.0);
    for (var k = 0u; k < 2u && share > 0.0; k += 1u) {
        sum += drops_capture_level(u32(low) + k, place) * share;
        share = select(0.0, part, k == 0u);
    }
    return sum;
}

// The place in the papers' capture of a ray, shifted by what the mask says: the refracted ray meets the plane of the
// capture as far from the ray's own place as the tangent of its deviation.
fn drops_shifted(ray: vec3f, texel: DropsTexel) -> vec2f {
    let depth = max(dot(ray, drops_frame.capture_forward), 1.0e-3);
    let deep = max(-texel.direction.z, 1.0e-3);
    let shift = vec2f(
        texel.direction.x / deep / sqrt(dot(drops_frame.capture_right, drops_frame.capture_right)),
        texel.direction.y / deep / sqrt(dot(drops_frame.capture_up, drops_frame.capture_up)),
    );
    let place = vec2f(
        dot(ray, drops_frame.capture_right) / dot(drops_frame.capture_right, drops_frame.capture_right),
        dot(ray, drops_frame.capture_up) / dot(drops_frame.capture_up, drops_frame.capture_up),
    ) / depth + shift;
    return clamp(vec2f(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y), vec2f(0.0), vec2f(1.0));
}

// The ray through a place of the picture, in pixels from the top left, of any length.
fn drops_ray(x: f32, y: f32) -> vec3f {
    let u = 2.0 * x / f32(drops_frame.width) - 1.0;
    let v = 1.0 - 2.0 * y / f32(drops_frame.height);
    return drops_frame.forward + drops_frame.right * u + drops_frame.up * v;
}

// What a drop shows at (x, y), in units of half its mask, for samples that are `spacing` equivalent radii apart:
// radiance times coverage, and coverage. `lean` is what the ray differs from the ray to the drop's middle.
fn drops_sample(drop: DropsDrop, x: f32, y: f32, lean: vec3f, spacing: f32) -> vec4f {
    let texel = drops_mask(drop.row, x, y);
    if texel.coverage <= 0.0 {
        return vec4f(0.0);
    }
    let right = drops_right(drop.towards);
    let up = cross(right, drop.towards);
    // A sphere's deviation 2 (asin q - asin(q / n)) and its derivative, for the footprint.
    let q = min((x * x + y * y) * drop.half_extent * drop.half_extent, 0.98);
    let bend = 2.0 / sqrt(1.0 - q);
    let shifts = drops_frame.form == DROPS_SHIFT;
    var sum = vec3f(0.0);
    // What comes through, then what is mirrored.
    for (var k = 0u; k < 2u; k += 1u) {
        let mirrored = k == 1u;
        let seen = select(texel.direction, texel.reflected, mirrored);
        let weight = select(texel.transmittance, 1.0 - texel.transmittance, mirrored);
        let footprint = spacing * select(bend - DROPS_STRAIGHT, bend, mirrored);
        let direction = right * seen.x + up * seen.y - drop.towards * seen.z + lean;
        var place = packing_octahedral_encode(direction) * 0.5 + 0.5;
        if shifts {
            place = drops_shifted(drop.towards + lean, texel);
        }
        sum += drops_capture_at(place, footprint) * select(weight, 1.0, shifts);
        if shifts {
            break;
        }
    }
    return vec4f(sum, 1.0) * texel.coverage;
}

// The share of a pixel that a drop of less than a pixel covers: its area, over the pixels round its middle.
fn drops_spread(drop: DropsDrop, x: u32, y: u32) -> f32 {
    let wx = max(1.0 - abs(f32(x) + 0.5 - drop.place.x), 0.0);
    let wy = max(1.0 - abs(f32(y) + 0.5 - drop.place.y), 0.0);
    return min(drop.area * wx * wy, 1.0);
}

// A drop over a pixel: radiance times coverage, and coverage. Below a pixel it is its mean radiance.
fn drops_pixel(drop: DropsDrop, x: u32, y: u32) -> vec4f {
    let small = drop.grid == 0u;
    let spread = drops_spread(drop, x, y);
    if small && spread <= 0.0 {
        return vec4f(0.0);
    }
    let right = drops_right(drop.towards);
    let up = cross(right, drop.towards);
    let n = select(drop.grid, DROPS_SMALL_GRID, small);
    let extent = drop.half_extent * drop.slope;
    let of_mask = 2.0 * drop.half_extent / f32(n);
    let spacing = select(drops_frame.pixel_angle / (drop.slope * f32(n)), of_mask, small);
    var sum = vec4f(0.0);
    for (var k = 0u; k < n * n; k += 1u) {
        let dx = (f32(k % n) + 0.5) / f32(n);
        let dy = (f32(k / n) + 0.5) / f32(n);
        var sx = 2.0 * dx - 1.0;
        var sy = 2.0 * dy - 1.0;
        var lean = vec3f(0.0);
        if !small {
            let ray = drops_ray(f32(x) + dx, f32(y) + dy);
            let depth = max(dot(ray, drop.towards), 1.0e-6);
            lean = ray / depth - drop.towards;
            sx = dot(lean, right) / extent;
            sy = dot(lean, up) / extent;
        }
        if abs(sx) < 1.0 && abs(sy) < 1.0 {
            sum += drops_sample(drop, sx, sy, lean, spacing);
        }
    }
    if small {
        return vec4f(sum.rgb / max(sum.w, 1.0e-20), 1.0) * spread;
    }
    return sum / f32(n * n);
}

// The optical depth of the drops that are not drawn, up to a distance.
fn drops_veil(distance: f32) -> f32 {
    let last = 4u * DROPS_VEIL_QUARTERS - 1u;
    let position = 3.0 * log2(max(distance / DROPS_VEIL_NEAR, 1.0));
    let entry = min(u32(position), last);
    let next = min(entry + 1u, last);
    let here = drops_frame.veil[entry / 4u][entry % 4u];
    let there = drops_frame.veil[next / 4u][next % 4u];
    let farthest = DROPS_VEIL_NEAR * exp2(f32(last) / 3.0);
    return here + (there - here) * min(position - f32(entry), 1.0) + drops_frame.veil_beyond * max(distance - farthest, 0.0);
}

// What drops that are not drawn show before a pixel, and what is left of what is behind them.
fn drops_veiled(x: u32, y: u32, distance: f32) -> vec4f {
    if distance >= DROPS_SKY {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let left = exp(-drops_veil(distance));
    let ray = drops_ray(f32(x) + 0.5, f32(y) + 0.5);
    var place = packing_octahedral_encode(ray) * 0.5 + 0.5;
    if drops_frame.form == DROPS_SHIFT {
        place = drops_shifted(ray, DropsTexel(vec3f(0.0, 0.0, -1.0), 1.0, vec3f(0.0), 1.0));
    }
    return vec4f(drops_capture_at(place, DROPS_VEIL_SPREAD) * (1.0 - left), left);
}

// The rain over a pixel: radiance, and the transmittance of the scene behind it. Drops are in order of distance.
fn drops_over(x: u32, y: u32) -> vec4f {
    let tile = (y / DROPS_TILE) * drops_frame.tiles_across + x / DROPS_TILE;
    let scene = drops_clean[y * drops_frame.width + x].w;
    var radiance = vec3f(0.0);
    var transmittance = 1.0;
    for (var k = drops_tiles[tile]; k < drops_tiles[tile + 1u]; k += 1u) {
        let drop = drops_list[drops_tiles[k]];
        if drop.distance >= scene || transmittance < DROPS_OPAQUE {
            break;
        }
        let shown = drops_pixel(drop, x, y);
        radiance += shown.rgb * transmittance;
        transmittance *= 1.0 - shown.w;
    }
    let veiled = drops_veiled(x, y, scene);
    return vec4f(radiance + veiled.rgb * transmittance, veiled.w * transmittance);
}

@compute @workgroup_size(8, 8, 1)
fn main_drops(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= drops_frame.width || id.y >= drops_frame.height {
        return;
    }
    drops_layer[id.y * drops_frame.width + id.x] = drops_over(id.x, id.y);
}
