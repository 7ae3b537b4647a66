// Unresolved rain: drops that a picture does not draw one by one, as a medium along a ray.
// Law: a drop takes out what its outline covers (efficiency 1: a camera keeps what is diffracted), so the optical depth of a
// path is the sum of the outlines' areas per volume along it. A drop is unresolved beyond the distance at which its size is
// resolved, and everywhere outside the region in which drops are simulated.
// Twin: downpour_render::rain::medium.

// Unresolved drops of a shell of distances: their streaks on the picture.
struct MediumShell {
    // Number of drops over a pixel that would stand still; 0: there are none.
    count: f32,
    // Length of a streak across the ray, in pixels.
    pixels: f32,
    // Rows of streaks that have passed since time 0: whole ones, and a part of one.
    row: u32,
    part: f32,
}

struct MediumFrame {
    // Columns and rows of the grid of open air.
    columns: u32,
    rows: u32,
    // Lamps that light the drops: MEDIUM_DARK, MEDIUM_LAMPS or MEDIUM_SPOTS.
    lit: u32,
    // Class of drops whose mean radiance the medium has.
    shape: u32,
    // Optical depth of level rays up to MEDIUM_NEAR meters, then a factor of 2^(1/3) farther each, within the region.
    depths: array<vec4f, MEDIUM_QUARTERS>,
    // Unit direction from which drops come.
    rise: vec3f,
    // Extinction of all drops, 1/m, for level rays.
    all: f32,
    // The region in which drops are simulated, relative to the scene's origin: center, and MEDIUM_EVERYWHERE, MEDIUM_BOX, ...
    center: vec3f,
    region: u32,
    // Edges of a box; radius and height of others.
    size: vec3f,
    // Relative excess of the area of a drop's outline from straight above over that from the side.
    flatness: f32,
    // The eye, relative to the scene's origin.
    eye: vec3f,
    // 1: nothing stands anywhere that could keep rain off.
    open: u32,
    // A pane before the eye, which keeps rain off this side of it: unit normal away from the eye, and its distance; 0: none.
    pane: vec4f,
    // Fog: extinction at its base, 1/m; inverse of its height, 1/m (0: the same everywhere); height of the eye above its base, m; albedo.
    fog: vec4f,
    // Fog: width of its phase function, radians; the rest is unused.
    fog_phase: vec4f,
    // Streaks of unresolved drops: unit vector against their motion past the eye, and the seed of their places.
    axis: vec3f,
    seed: u32,
    // Two more axes; 1 if drops have streaks, 0 if the medium is even.
    across: vec3f,
    is_grainy: u32,
    beside: vec3f,
    unused: u32,
    shells: array<MediumShell, MEDIUM_SLICES>,
}

@group(0) @binding(9) var<uniform> medium_frame: MediumFrame;

// Area of the drops' outlines seen along a unit direction, over that from the side.
fn medium_outline(direction: vec3f) -> f32 {
    return 1.0 + medium_frame.flatness * direction.y * direction.y;
}

// Distance of an entry of the table, m.
fn medium_node(entry: u32) -> f32 {
    return MEDIUM_NEAR * exp2(f32(entry) / 3.0);
}

// Optical depth of a level ray within the region.
fn medium_within(distance: f32) -> f32 {
    if distance <= MEDIUM_NEAR {
        return medium_frame.depths[0].x * distance / MEDIUM_NEAR;
    }
    let last = 4u * MEDIUM_QUARTERS - 1u;
    let entry = min(u32(3.0 * log2(distance / MEDIUM_NEAR)), last);
    let near = medium_node(entry);
    let here = medium_frame.depths[entry / 4u][entry % 4u];
    if entry == last {
        return here + medium_frame.all * (distance - near);
    }
    let next = entry + 1u;
    let there = medium_frame.depths[next / 4u][next % 4u];
    return here + (there - here) * clamp((distance - near) / (medium_node(next) - near), 0.0, 1.0);
}

// First and last distance of a coordinate between -half and half, of a ray that begins at `from`.
fn medium_slab(from_position: f32, rate: f32, half: f32) -> vec2f {
    if abs(rate) < 1.0e-9 {
        return select(vec2f(MEDIUM_FAR, 0.0), vec2f(0.0, MEDIUM_FAR), abs(from_position) <= half);
    }
    let a = (-half - from_position) / rate;
    let b = (half - from_position) / rate;
    return vec2f(min(a, b), max(a, b));
}

// First and last distance at which a t^2 + 2 b t + c is below 0, for a above 0.
fn medium_roots(a: f32, b: f32, c: f32) -> vec2f {
    let root = b * b - a * c;
    if root <= 0.0 {
        return vec2f(MEDIUM_FAR, 0.0);
    }
    return vec2f(-b - sqrt(root), -b + sqrt(root)) / a;
}

// The part of two parts of a ray that both have, from its beginning on; nothing is MEDIUM_FAR twice.
fn medium_both(a: vec2f, b: vec2f) -> vec2f {
    let low = max(max(a.x, b.x), 0.0);
    let high = min(a.y, b.y);
    return select(vec2f(MEDIUM_FAR), vec2f(low, high), high > low);
}

// The part of a ray of unit direction that is in the region.
fn medium_region(origin: vec3f, direction: vec3f) -> vec2f {
    let offset = origin - medium_frame.center;
    let whole = vec2f(0.0, MEDIUM_FAR);
    if medium_frame.region == MEDIUM_BOX {
        let half = medium_frame.size * 0.5;
        let x = medium_slab(offset.x, direction.x, half.x);
        let y = medium_slab(offset.y, direction.y, half.y);
        let z = medium_slab(offset.z, direction.z, half.z);
        return medium_both(medium_both(x, y), z);
    }
    if medium_frame.region == MEDIUM_SPHERE {
        let outside = dot(offset, offset) - medium_frame.size.x * medium_frame.size.x;
        return medium_both(medium_roots(1.0, dot(offset, direction), outside), whole);
    }
    if medium_frame.region == MEDIUM_CYLINDER {
        let up = medium_slab(offset.y, direction.y, medium_frame.size.y * 0.5);
        let across = dot(direction.xz, direction.xz);
        let outside = dot(offset.xz, offset.xz) - medium_frame.size.x * medium_frame.size.x;
        if across < 1.0e-9 {
            return select(vec2f(MEDIUM_FAR), medium_both(up, whole), outside < 0.0);
        }
        return medium_both(up, medium_roots(across, dot(offset.xz, direction.xz), outside));
    }
    return whole;
}

// Mean of exp(-x') for x' from 0 to x: (1 - exp(-x)) / x, by its series where the difference would lose digits.
fn medium_decay_mean(x: f32) -> f32 {
    var mean = 1.0 - x * (0.5 - x / 6.0);
    if x > 0.02 {
        mean = (1.0 - exp(-x)) / x;
    }
    return mean;
}

// Optical depth of fog (as in MediumFrame) along a ray whose direction has the upward part `rise`, up to a distance: the integral of
// sigma exp(-max(height, 0) / scale height), in closed form.
fn medium_fog_depth(fog: vec4f, rise: f32, distance: f32) -> f32 {
    let begin = fog.z;
    let end = fog.z + rise * distance;
    let low = min(begin, end);
    let high = max(begin, end);
    if high <= 0.0 || fog.y <= 0.0 {
        return fog.x * distance;
    }
    var below = 0.0;
    var above = distance;
    if low < 0.0 {
        below = distance * (-low / (high - low));
        above = distance * (high / (high - low));
    }
    let foot = max(low, 0.0);
    return fog.x * (below + above * exp(-foot * fog.y) * medium_decay_mean((high - foot) * fog.y));
}

// Part of the light that fog lets through up to a distance along a ray of unit direction from the eye.
fn medium_fog(direction: vec3f, distance: f32) -> f32 {
    return exp(-medium_fog_depth(medium_frame.fog, direction.y, min(distance, MEDIUM_FAR)));
}

// Distance at which a ray from the eye comes through the pane.
fn medium_begin(direction: vec3f) -> f32 {
    let towards = dot(direction, medium_frame.pane.xyz);
    let through = min(medium_frame.pane.w / max(towards, 1.0e-9), MEDIUM_FAR);
    return select(through, 0.0, medium_frame.pane.w <= 0.0);
}

// A ray of unit direction from the eye: the part of it that is in the region, and where it comes through the pane.
fn medium_span(direction: vec3f) -> vec3f {
    return vec3f(medium_region(medium_frame.eye, direction), medium_begin(direction));
}

// Optical depth of all unresolved drops up to a distance, on whichever side of the pane.
fn medium_path(distance: f32, region: vec2f) -> f32 {
    let low = min(distance, region.x);
    let high = max(distance - region.y, 0.0);
    let within = medium_within(clamp(distance, region.x, region.y)) - medium_within(region.x);
    return medium_frame.all * (low + high) + within;
}

// Optical depth of unresolved drops up to a distance along a ray from the eye, if nothing but the pane keeps rain off.
fn medium_depth(distance: f32, span: vec3f, outline: f32) -> f32 {
    return (medium_path(max(distance, span.z), span.xy) - medium_path(span.z, span.xy)) * outline;
}
