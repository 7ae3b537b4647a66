// Part of space in which drops are simulated.
//
// In a box (Rousseau 2006, 7; 2008, 2.1) the rain is periodic: a drop moves to the opposite face. In a view the volume
// is the frustum of the picture up to the distance at which a size is resolved (after Im & Sung 2022, 3.A and B),
// widened by the path of a drop during the horizon, the time that pictures of one state cover: five planes and a ball.
// Twin: downpour_sim::volume.

// Eye and its view.
struct VolumeEye {
    // Position, m, relative to the origin of its time.
    position: vec3f,
    // Half the width and height of the picture at distance 1.
    half_width: f32,
    // Unit vectors to the right, up and forward.
    right: vec3f,
    half_height: f32,
    up: vec3f,
    unused_1: u32,
    forward: vec3f,
    unused_2: u32,
}

// Frustum of a picture with margins, for drops at their positions in the middle of the horizon.
struct VolumeFrustum {
    // Outward unit normals of right, left, top, bottom and back; fourth component: speed along them of the air at the
    // eye relative to the eye, m/s. All planes pass through the eye.
    planes: array<vec4f, VOLUME_PLANES>,
    // Position of the eye, m.
    eye: vec3f,
    // Speed of the air at the eye relative to the eye, m/s.
    air: f32,
    // Half the time that pictures of one state cover, s.
    half_horizon: f32,
    // Half the longest time from a state to the opening of the shutter, s.
    half_wait: f32,
    // Bound on the deviation of the wind, and of the drops' velocity due to it, from the wind at the eye: m/s;
    // increase per m of distance, 1/s; maximum, m/s.
    spread: f32,
    spread_slope: f32,
    spread_max: f32,
    // Distance at which a drop is resolved, per diameter; and its maximum, m.
    range: f32,
    farthest: f32,
    unused: u32,
}

// Number of edges of a box around `center` between a position and its periodic image in the box.
fn volume_images(position: vec3f, center: vec3f, size: vec3f) -> vec3f {
    return floor((position - center) / size + 0.5);
}

// Distance at which a diameter is resolved, m.
fn volume_range(frustum: VolumeFrustum, diameter: f32) -> f32 {
    return min(diameter * frustum.range, frustum.farthest);
}

// Bound on the deviation of the wind, and of the drops' velocity due to it, within a distance of the eye, m/s.
fn volume_spread(frustum: VolumeFrustum, range: f32) -> f32 {
    return min(frustum.spread + frustum.spread_slope * range, frustum.spread_max);
}

// Index of the first limit of the frustum that a drop at `offset` from the eye violates: a plane, VOLUME_BALL, or
// VOLUME_INSIDE. `speed` is its terminal speed.
fn volume_limit(frustum: VolumeFrustum, offset: vec3f, diameter: f32, speed: f32) -> u32 {
    let range = volume_range(frustum, diameter);
    let spread = volume_spread(frustum, range);
    let radius = VOLUME_RADIUS * diameter;
    for (var k = 0u; k < VOLUME_PLANES; k += 1u) {
        let plane = frustum.planes[k];
        let margin = radius + frustum.half_horizon * (abs(plane.w - speed * plane.y) + spread);
        if dot(plane.xyz, offset) > margin {
            return k;
        }
    }
    let reach = range + frustum.half_wait * (speed + frustum.air + spread);
    return select(VOLUME_INSIDE, VOLUME_BALL, dot(offset, offset) > reach * reach);
}

// Converts an offset from the eye to camera space: right, up, and forward.
fn volume_local(eye: VolumeEye, offset: vec3f) -> vec3f {
    return vec3f(dot(offset, eye.right), dot(offset, eye.up), dot(offset, eye.forward));
}

// Converts camera space to an offset from the eye.
fn volume_offset(eye: VolumeEye, local: vec3f) -> vec3f {
    return eye.right * local.x + eye.up * local.y + eye.forward * local.z;
}

// True if a position is in the rain area of Im & Sung: in the pyramid and in the sphere between eye and `range`.
fn volume_in_area(eye: VolumeEye, local: vec3f, range: f32) -> bool {
    let radius = 0.5 * range;
    let from_middle = local - vec3f(0.0, 0.0, radius);
    return abs(local.x) <= local.z * eye.half_width && abs(local.y) <= local.z * eye.half_height
        && dot(from_middle, from_middle) <= radius * radius;
}

// Position in the sphere by Im & Sung, (3) and (4): three random numbers in [0, 1). Dense near the middle.
fn volume_in_sphere(random: vec3f, range: f32) -> vec3f {
    let radius = 0.5 * range;
    let along = 2.0 * random.y - 1.0;
    let across = sqrt(max(1.0 - along * along, 0.0));
    let angle = VOLUME_TURN * (random.x - 0.5);
    let distance = radius * (2.0 * random.z - 1.0);
    return vec3f(distance * across * cos(angle), distance * across * sin(angle), radius + distance * along);
}

// Position on a disk of radius 1, from two random numbers in [0, 1).
fn volume_on_disk(random: vec2f) -> vec2f {
    let angle = VOLUME_TURN * (random.x - 0.5);
    return sqrt(random.y) * vec2f(cos(angle), sin(angle));
}
