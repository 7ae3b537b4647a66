// One exact drop, large, in front of a sky map.
// Law: geometrical optics with all orders of light. A ray of the camera is reflected and refracted where it enters
// the drop, and again wherever it meets the surface from inside; each branch that leaves carries the fraction that
// Fresnel's equations for unpolarized light give it, and the radiance of the sky where it goes.
// Lengths are in units of the drop's volume-equivalent radius; the frame is the world's: +Y up, the drop's origin
// at 0. Radiance is linear, in the units of the map.
// Sky map: equirectangular, u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top, bilinear between the
// middles of texels, round in u. To its light come lamps far away: disks of even radiance on the sphere of the sky.
// Limits: light that has left the drop does not meet it again (it is convex up to 5.9 mm); 256 internal reflections.
// Twin: downpour_specimen.

struct SpecimenCamera {
    // Unit vectors: right, up, and from the drop to the camera.
    right: vec3f,
    // Slope of a ray (the tangent of its angle to the axis) per sample.
    step: f32,
    up: vec3f,
    // Distance of the camera from the drop's origin.
    distance: f32,
    back: vec3f,
    // Samples along an edge of a pixel.
    samples: u32,
}

struct SpecimenView {
    traced: MaskTracedDrop,
    camera: SpecimenCamera,
    // Pixels of the picture, and texels of the sky.
    size: vec2u,
    sky: vec2u,
    // First row of the band, and its number of rows.
    first_row: u32,
    rows: u32,
    // Bit c: the color c is written.
    channels: u32,
}

// A ray of the camera: the point that is nearest to the origin, and how far behind it the camera is.
struct SpecimenRay {
    foot: vec3f,
    reach: f32,
    direction: vec3f,
}

// Light on its way: what left at the last interface, and what is still inside.
struct SpecimenLight {
    // Point of the last interface.
    point: vec3f,
    // Fraction of the light that left there.
    fraction: f32,
    // Direction of the light that left.
    exit: vec3f,
    // Fraction of the light that is still inside.
    rest: f32,
    // Its direction.
    inside: vec3f,
}

// A disk of the sky: toward its middle, the squared chord from there to its edge, and its radiance. Zeros are no lamp.
struct SpecimenLamp {
    direction: vec3f,
    reach: f32,
    radiance: vec3f,
}

@group(0) @binding(0) var<uniform> specimen_view: SpecimenView;
@group(0) @binding(1) var<storage, read> specimen_map: array<f32>;
@group(0) @binding(2) var<storage, read_write> specimen_pixels: array<f32>;
@group(0) @binding(3) var<uniform> specimen_lamps: array<SpecimenLamp, SPECIMEN_LAMPS>;

// The ray through the point (x, y) of the picture, in samples from its middle.
fn specimen_ray(camera: SpecimenCamera, x: f32, y: f32) -> SpecimenRay {
    let qx = x * camera.step;
    let qy = y * camera.step;
    let across = camera.right * qx + camera.up * qy;
    let square = qx * qx + qy * qy;
    let inverse = 1.0 / (1.0 + square);
    let root = sqrt(inverse);
    // distance * back + reach * direction, without the difference of two large vectors.
    let foot = (camera.back * square + across) * (camera.distance * inverse);
    return SpecimenRay(foot, camera.distance * root, (across - camera.back) * root);
}

// True if the ray meets the drop: the gauge at the nearest point is below 1, and that point is before the camera.
fn specimen_hits(traced: MaskTracedDrop, ray: SpecimenRay) -> bool {
    let curvature = mask_trace_curvature(traced, ray.direction);
    let slope = mask_trace_spheroid(traced, ray.foot, ray.direction);
    var along = -slope / curvature;
    let estimate = mask_trace_spheroid(traced, ray.foot, ray.foot) + slope * along;
    if estimate < MASK_SILHOUETTE_INSIDE || estimate >= MASK_SILHOUETTE_OUTSIDE {
        return estimate < MASK_SILHOUETTE_INSIDE && -ray.reach < along;
    }
    for (var step = 0u; step < SPECIMEN_NEAREST_STEPS; step += 1u) {
        let surface = mask_trace_surface(traced, ray.foot + ray.direction * along);
        along = along - dot(surface.half_gradient, ray.direction) / curvature;
    }
    let nearest = mask_trace_surface(traced, ray.foot + ray.direction * along);
    return nearest.excess < 0.0 && -ray.reach < along;
}

// Light that meets a drop at a point with a normal: what is reflected outside leaves, the rest enters.
fn specimen_split_outside(point: vec3f, normal: vec3f, direction: vec3f, index: f32) -> SpecimenLight {
    let reflectance = optics_fresnel(-dot(direction, normal), index);
    let inside = optics_refract(direction, normal, 1.0 / index).xyz;
    let exit = optics_reflect(direction, normal);
    return SpecimenLight(point, reflectance, exit, 1.0 - reflectance, normalize(inside));
}

// Light that meets the surface from inside at a point with a normal. If less than `least` would stay inside, all leaves: in the
// direction of the last exit, if nothing is transmitted here.
fn specimen_split_inside(light: SpecimenLight, point: vec3f, normal: vec3f, index: f32, least: f32) -> SpecimenLight {
    let reflectance = optics_fresnel(dot(light.inside, normal), 1.0 / index);
    let through = optics_refract(light.inside, -normal, index).xyz;
    let total = !(reflectance < 1.0);
    let kept = light.rest * reflectance;
    let rest = select(kept, 0.0, kept < least);
    let exit = select(through, light.exit, total);
    return SpecimenLight(point, light.rest - rest, exit, rest, optics_reflect(light.inside, normal));
}

// The first interface.
fn specimen_enter(traced: MaskTracedDrop, ray: SpecimenRay) -> SpecimenLight {
    let point = mask_trace_meet(traced, ray.foot, ray.direction, -1.0);
    return specimen_split_outside(point, mask_trace_normal(traced, point), ray.direction, traced.index);
}

// The next interface from inside.
fn specimen_bounce(traced: MaskTracedDrop, light: SpecimenLight, least: f32) -> SpecimenLight {
    let point = mask_trace_meet(traced, light.point, light.inside, 1.0);
    return specimen_split_inside(light, point, mask_trace_normal(traced, point), traced.index, least);
}

// The angle of the point (x, y) in turns, in [-0.5, 0.5]; 0 at the origin.
fn specimen_turns(y: f32, x: f32) -> f32 {
    let wide = abs(x);
    let tall = abs(y);
    let t = min(wide, tall) / max(max(wide, tall), SPECIMEN_TINY);
    let octant = octant_turns(t);
    let quadrant = select(octant, 0.25 - octant, wide < tall);
    let half = select(quadrant, 0.5 - quadrant, x < 0.0);
    return select(half, -half, y < 0.0);
}

// Position of a direction (of any length) on the sky map: u from the left, v from the top, both in [0, 1].
fn specimen_sky_position(direction: vec3f) -> vec2f {
    let level = sqrt(direction.x * direction.x + direction.z * direction.z);
    let turn = specimen_turns(direction.z, direction.x);
    let rise = specimen_turns(direction.y, level);
    return vec2f(0.5 + turn, 0.5 - (rise + rise));
}

// One texel of the sky map.
fn specimen_sky_texel(column: u32, row: u32) -> vec3f {
    let at = (row * specimen_view.sky.x + column) * 3u;
    return vec3f(specimen_map[at], specimen_map[at + 1u], specimen_map[at + 2u]);
}

// The radiance of the sky at a position of its map.
fn specimen_sky(position: vec2f) -> vec3f {
    let width = f32(specimen_view.sky.x);
    let last = f32(specimen_view.sky.y - 1u);
    let x = position.x * width - 0.5;
    let y = min(max(position.y * (last + 1.0) - 0.5, 0.0), last);
    let left = floor(x);
    let top = floor(y);
    let next = left + 1.0;
    let column = u32(select(min(left, width - 1.0), width - 1.0, left < 0.0));
    let right = u32(select(next, 0.0, next >= width));
    let row = u32(top);
    let below = u32(min(top + 1.0, last));
    let fx = x - left;
    let fy = y - top;
    let a = specimen_sky_texel(column, row);
    let b = specimen_sky_texel(right, row);
    let c = specimen_sky_texel(column, below);
    let d = specimen_sky_texel(right, below);
    let upper = a + (b - a) * fx;
    let lower = c + (d - c) * fx;
    return upper + (lower - upper) * fy;
}

// The radiance of one lamp in a direction of length 1.
fn specimen_lamp(lamp: SpecimenLamp, direction: vec3f) -> vec3f {
    let apart = direction - lamp.direction;
    return select(vec3f(0.0), lamp.radiance, dot(apart, apart) < lamp.reach);
}

// The radiance of all lamps along a direction of length 1. Written out: a loop would come to a driver's limit of turns.
fn specimen_sky_lamps(direction: vec3f) -> vec3f {
    var light = specimen_lamp(specimen_lamps[0], direction);
    light += specimen_lamp(specimen_lamps[1], direction);
    light += specimen_lamp(specimen_lamps[2], direction);
    light += specimen_lamp(specimen_lamps[3], direction);
    light += specimen_lamp(specimen_lamps[4], direction);
    light += specimen_lamp(specimen_lamps[5], direction);
    light += specimen_lamp(specimen_lamps[6], direction);
    light += specimen_lamp(specimen_lamps[7], direction);
    return light;
}

// The radiance of the map and of the lamps along a direction of length 1.
fn specimen_sky_light(direction: vec3f) -> vec3f {
    return specimen_sky(specimen_sky_position(direction)) + specimen_sky_lamps(direction);
}

// The radiance of the sample (x, y), in samples from the middle of the picture.
fn specimen_radiance(view: SpecimenView, x: f32, y: f32) -> vec3f {
    let ray = specimen_ray(view.camera, x, y);
    if !specimen_hits(view.traced, ray) {
        return specimen_sky_light(ray.direction);
    }
    var light = specimen_enter(view.traced, ray);
    var radiance = specimen_sky_light(light.exit) * light.fraction;
    for (var k = 0u; k <= SPECIMEN_REFLECTIONS; k += 1u) {
        if light.rest <= 0.0 {
            break;
        }
        let least = select(SPECIMEN_MIN_FRACTION, SPECIMEN_ALL, k == SPECIMEN_REFLECTIONS);
        light = specimen_bounce(view.traced, light, least);
        if light.fraction > 0.0 {
            radiance += specimen_sky_light(light.exit) * light.fraction;
        }
    }
    return radiance;
}

// Position of the samples of a line within their cells, 0 to 1. Each line is shifted against the next by the golden ratio
// (a rank-1 lattice): what is narrower than a cell, as the image of a small lamp that a falling drop draws out along a
// column, is not missed, or met, by all lines alike.
fn specimen_jitter(line: u32) -> f32 {
    return rng_unit(line * SPECIMEN_LATTICE);
}

// The pixel in column `column` of row `row`: the mean of its samples.
fn specimen_pixel(view: SpecimenView, column: u32, row: u32) -> vec3f {
    let samples = view.camera.samples;
    let middle = vec2f(view.size * samples) * 0.5;
    var sum = vec3f(0.0);
    for (var b = 0u; b < samples; b += 1u) {
        let line = row * samples + b;
        let y = middle.y - (f32(line) + 0.5);
        for (var a = 0u; a < samples; a += 1u) {
            let x = f32(column * samples + a) - middle.x + specimen_jitter(line);
            sum += specimen_radiance(view, x, y);
        }
    }
    return sum * (1.0 / f32(samples * samples));
}

@compute @workgroup_size(8, 8, 1)
fn main_specimen(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= specimen_view.size.x || id.y >= specimen_view.rows {
        return;
    }
    let pixel = specimen_pixel(specimen_view, id.x, specimen_view.first_row + id.y);
    let at = (id.y * specimen_view.size.x + id.x) * 3u;
    if (specimen_view.channels & 1u) != 0u {
        specimen_pixels[at] = pixel.x;
    }
    if (specimen_view.channels & 2u) != 0u {
        specimen_pixels[at + 1u] = pixel.y;
    }
    if (specimen_view.channels & 4u) != 0u {
        specimen_pixels[at + 2u] = pixel.z;
    }
}
