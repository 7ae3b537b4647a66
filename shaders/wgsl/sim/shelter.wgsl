// Drops of a rain in closed form that obstacles have not stopped when the shutter opens; those that are stopped during the exposure get
// the time.
// Method: the path of a drop is followed backwards from the drop to above all obstacles. In a steady wind it is one straight line;
// else it is divided at whole quarters of a second. During the exposure it is straight, as it is drawn.
// What stops drops is asked of `shelter_hit`, of which there are two: among triangles, and among triangles with holes.
// Twin: downpour_sim::shelter.

struct ShelterFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Places of the list that are asked for, and the first of them.
    room: u32,
    first: u32,
    // 1: only drops that are stopped while the shutter is open are asked for; others stay as they are, whatever is above them.
    stopped: u32,
    // Position of the eye relative to the obstacles, m.
    eye: vec3f,
    // Half the exposure time, s.
    half_shutter: f32,
    // Bounds of all obstacles.
    low: vec3f,
    // Time from the last whole quarter of a second to the opening of the shutter, s.
    since_cut: f32,
    high: vec3f,
    // Number of quarters of a second that paths are followed back; 0 in a steady wind.
    cuts: u32,
}

@group(0) @binding(6) var<uniform> shelter_frame: ShelterFrame;
@group(0) @binding(7) var<storage, read_write> shelter_drops: array<EyeDrop>;
// By terminal speed, relative to the drift up to the time of the picture: the drift up to the opening of the shutter, then up to
// each whole quarter of a second before, m.
@group(0) @binding(8) var<storage, read> shelter_drift: array<vec4f>;

// True if nothing is hit within a distance.
fn shelter_clear(start: vec3f, direction: vec3f, distance: f32) -> bool {
    return shelter_hit_any(start, direction, SHELTER_CLEAR, min(distance, BVH_FAR)).distance < 0.0;
}

// Drift of drops of a terminal speed: row 0 up to the opening of the shutter, others up to the quarters before.
fn shelter_carried(row: u32, speed: f32) -> vec3f {
    let position = drift_position(speed);
    let part = position.y;
    let first = row * (FIELD_DRIFT + 1u) + u32(position.x);
    return shelter_drift[first].xyz * (1.0 - part) + shelter_drift[first + 1u].xyz * part;
}

// True if a drop beside all obstacles could have come from them.
fn shelter_could_meet(position: vec3f, speed: f32) -> bool {
    let reach = max(shelter_frame.high.y - position.y, 0.0) * (SHELTER_CARRIED / max(speed, 0.1));
    let low = shelter_frame.low;
    let high = shelter_frame.high;
    return position.x > low.x - reach && position.x < high.x + reach && position.z > low.z - reach
        && position.z < high.z + reach;
}

// True if nothing is between the sky and `start`, which a drop passes after quarter `first` of those before the opening of the shutter;
// it is near `at`, where the drop would be at that opening, or on its path to there.
fn shelter_is_open(start: vec3f, at: vec3f, first: u32, speed: f32, velocity: vec3f) -> bool {
    if shelter_frame.cuts == 0u {
        let length = sqrt(dot(velocity, velocity));
        let back = select(vec3f(0.0, 1.0, 0.0), -velocity / max(length, 1.0e-30), length > 0.0);
        return shelter_clear(start, back, BVH_FAR);
    }
    var position = start;
    let displacement = shelter_carried(0u, speed);
    for (var cut = first; cut < shelter_frame.cuts; cut += 1u) {
        if position.y > shelter_frame.high.y || !shelter_could_meet(position, speed) {
            return true;
        }
        let age = shelter_frame.since_cut + f32(cut) * SHELTER_CUT;
        let carried = displacement - shelter_carried(cut + 1u, speed);
        let next = at - carried + vec3f(0.0, speed * age, 0.0);
        let way = next - position;
        let length = sqrt(dot(way, way));
        if length > 0.0 && !shelter_clear(position, way / length, length) {
            return false;
        }
        position = next;
    }
    return true;
}

@compute @workgroup_size(64, 1, 1)
fn main_shelter(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let number = invocation_index(id, groups);
    let index = shelter_frame.first + number;
    if number >= shelter_frame.room || shelter_drops[index].diameter <= 0.0 {
        return;
    }
    let drop = shelter_drops[index];
    let half_time = shelter_frame.half_shutter;
    let here = shelter_frame.eye + drop.offset;
    // As it is drawn, and as it has moved.
    let start = here - drop.velocity * half_time;
    let at = here + shelter_carried(0u, drop.speed) + vec3f(0.0, drop.speed * half_time, 0.0);
    // The path during the exposure is the shorter one.
    var met = -1.0;
    if half_time > 0.0 {
        met = shelter_hit(start, drop.velocity, 0.0, 2.0 * half_time).distance;
    }
    if shelter_frame.stopped > 0u && met < 0.0 {
        return;
    }
    if !shelter_is_open(start, at, 0u, drop.speed, drop.velocity) {
        shelter_drops[index].diameter = 0.0;
        return;
    }
    if met >= 0.0 {
        let until = min(drop.present.y, met - half_time);
        shelter_drops[index].present.y = until;
        if drop.present.x > until {
            shelter_drops[index].diameter = 0.0;
        }
    }
}
