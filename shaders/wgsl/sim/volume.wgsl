// The part of space that drops are simulated in.
//
// In a box (Rousseau 2006, 7; 2008, 2.1) the rain is periodic: a drop goes to the opposite face. In a view it is the
// frustum of the picture up to the distance at which a size is resolved (after Im & Sung 2022, 3.A and B), wider by the way
// of a drop during the horizon, the time that pictures of one state cover: five planes and a ball.
// Twin: downpour_sim::volume.

// The eye, and the part of space that it sees.
struct VolumeEye {
    // m.
    place: vec3f,
    // Half the width and height of the picture at distance 1.
    half_width: f32,
    // Unit vectors.
    right: vec3f,
    half_height: f32,
    up: vec3f,
    unused_1: u32,
    forward: vec3f,
    unused_2: u32,
}

// The frustum of a picture, with margins, about which drops are where they will be in the middle of the horizon.
struct VolumeFrustum {
    // Outward unit normals of right, left, top, bottom and back; the speed along them, relative to the eye, of the air at
    // the eye, m/s. All planes go through the eye.
    planes: array<vec4f, VOLUME_PLANES>,
    // m.
    eye: vec3f,
    // Speed of the air at the eye relative to the eye, m/s.
    air: f32,
    // Half the time that pictures of one state cover, s.
    half_horizon: f32,
    // Half the longest time from a state to the opening of the shutter, s.
    half_wait: f32,
    // How far the wind, and what drops keep of it, leaves that at the eye: m/s; m/s per m of distance; at most, m/s.
    spread: f32,
    spread_slope: f32,
    spread_most: f32,
    // Distance at which a drop is resolved, per diameter; and at most, m.
    range: f32,
    farthest: f32,
    unused: u32,
}

// How many edges of a box around `centre` a position is away from its periodic image in the box.
fn volume_images(place: vec3f, centre: vec3f, size: vec3f) -> vec3f {
    return floor((place - centre) / size + 0.5);
}

// Distance at which a diameter is resolved, m.
fn volume_range(frustum: VolumeFrustum, diameter: f32) -> f32 {
    return min(diameter * frustum.range, frustum.farthest);
}

// Bound on the difference of the wind from that at the eye within a distance, and of what drops keep of it, m/s.
fn volume_spread(frustum: VolumeFrustum, range: f32) -> f32 {
    return min(frustum.spread + frustum.spread_slope * range, frustum.spread_most);
}

// Index of the first limit of the frustum beyond which a drop is that is at `offset` from the eye: a plane, VOLUME_BALL, or
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

// What the eye sees of an offset from it: to the right, up, and ahead.
fn volume_local(eye: VolumeEye, offset: vec3f) -> vec3f {
    return vec3f(dot(offset, eye.right), dot(offset, eye.up), dot(offset, eye.forward));
}

// The offset from the eye of what it sees.
fn volume_offset(eye: VolumeEye, local: vec3f) -> vec3f {
    return eye.right * local.x + eye.up * local.y + eye.forward * local.z;
}

// Whether a place is in the rain area of Im & Sung: in the pyramid and in the sphere between eye and `range`.
fn volume_in_area(eye: VolumeEye, local: vec3f, range: f32) -> bool {
    let radius = 0.5 * range;
    let from_middle = local - vec3f(0.0, 0.0, radius);
    return abs(local.x) <= local.z * eye.half_width && abs(local.y) <= local.z * eye.half_height
        && dot(from_middle, from_middle) <= radius * radius;
}

// A place in the sphere by Im & Sung, (3) and (4): three random numbers of [0, 1). Dense about the middle.
fn volume_in_sphere(random: vec3f, range: f32) -> vec3f {
    let radius = 0.5 * range;
    let along = 2.0 * random.y - 1.0;
    let across = sqrt(max(1.0 - along * along, 0.0));
    let angle = VOLUME_TURN * (random.x - 0.5);
    let distance = radius * (2.0 * random.z - 1.0);
    return vec3f(distance * across * cos(angle), distance * across * sin(angle), radius + distance * along);
}

// A place on a disc of radius 1, from two random numbers of [0, 1).
fn volume_on_disc(random: vec2f) -> vec2f {
    let angle = VOLUME_TURN * (random.x - 0.5);
    return sqrt(random.y) * vec2f(cos(angle), sin(angle));
}
