// The part of space that drops are simulated in, and where a drop goes that has left it.
//
// In a box (Rousseau 2006, 7; 2008, 2.1) the rain is periodic: a drop goes to the opposite face. In a view (Im & Sung
// 2022, 3.A and B) it is the pyramid of the picture up to the distance at which its size is resolved: the drop goes back
// along the path that it came relative to the picture, to the first place on it that is in view. Both map the volume
// onto itself and keep every part's size, so that a uniform density stays uniform however the camera moves.
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

// A number of steps backwards of the path relative to the picture, for a drop whose own way is `s` in each of them: from
// c to turn c - sum s.
struct VolumeBack {
    turn: mat3x3f,
    sum: mat3x3f,
}

// A place in the periodic image of a box that is round `centre`.
fn volume_wrap(place: vec3f, centre: vec3f, size: vec3f) -> vec3f {
    return place - size * floor((place - centre) / size + 0.5);
}

// What the eye sees of an offset from it: to the right, up, and ahead.
fn volume_local(eye: VolumeEye, offset: vec3f) -> vec3f {
    return vec3f(dot(offset, eye.right), dot(offset, eye.up), dot(offset, eye.forward));
}

// The offset from the eye of what it sees.
fn volume_offset(eye: VolumeEye, local: vec3f) -> vec3f {
    return eye.right * local.x + eye.up * local.y + eye.forward * local.z;
}

// Whether a place is in the pyramid of the picture and no farther than `range`.
fn volume_in_view(eye: VolumeEye, local: vec3f, range: f32) -> bool {
    return abs(local.x) <= local.z * eye.half_width && abs(local.y) <= local.z * eye.half_height
        && dot(local, local) <= range * range;
}

// A place on the path some steps ago.
fn volume_back(back: VolumeBack, local: vec3f, way: vec3f) -> vec3f {
    return back.turn * local - back.sum * way;
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
