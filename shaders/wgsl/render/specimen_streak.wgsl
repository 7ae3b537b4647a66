// The streak of one exact drop: the mean over an exposure of a drop that falls and oscillates.
// A drop that falls is a ray that rises: in the drop's frame, at u radii of fall after the middle of the exposure, the ray
// of the camera is shifted by u along +Y. It meets the spheroid that holds the drop for one interval of u, which is known in
// closed form; the rest of the exposure shows the sky, with its exact weight. The interval is cut into equal parts, one
// instant in each, all at the same position of their part, which is drawn for each sample of the picture.
// u is in units of the volume-equivalent radius. Everything else is as in render/specimen.wgsl.
// Twin: downpour_specimen::streak.

struct SpecimenStreak {
    oscillation: DropOscillation,
    // Volume over that of the shape at rest: 1 + s2 (x + s2 (y + s2 z)) + s3^2 (w + s2 volume_last).
    volume: vec4f,
    volume_last: f32,
    // 1 / A^2 and 1 / B^2 of the spheroid that holds the drop at any time.
    inverse_wide: f32,
    inverse_tall: f32,
    // Radii per second.
    speed: f32,
    // Radii of fall in half of the exposure.
    farthest: f32,
    // Instants per sample of the picture.
    instants: u32,
    // The first trace of this dispatch, and how many there are. A pixel has samples^2 * instants of them.
    first: u32,
    count: u32,
}

// Time interval in which a ray meets the drop.
struct SpecimenPassage {
    // The foot of the shifted ray where the drop's axis and the ray are nearest to each other.
    foot: vec3f,
    // u there.
    middle: f32,
    // The interval of u.
    first: f32,
    last: f32,
    // Its fraction of the exposure.
    cover: f32,
}

@group(0) @binding(4) var<uniform> specimen_streak: SpecimenStreak;

// The interval in which a ray meets the spheroid that holds the drop.
fn specimen_streak_passage(streak: SpecimenStreak, ray: SpecimenRay) -> SpecimenPassage {
    let d = ray.direction;
    let level = max(d.x * d.x + d.z * d.z, SPECIMEN_TINY);
    let aside = d.x * ray.foot.z - d.z * ray.foot.x;
    let foot = vec3f(-d.z, 0.0, d.x) * (aside / level);
    let middle = -ray.foot.y / level;
    let room = level - aside * aside * streak.inverse_wide;
    let tall = level / streak.inverse_tall + d.y * d.y / streak.inverse_wide;
    let half = sqrt(max(room, 0.0)) * sqrt(tall) / level;
    let first = max(middle - half, -streak.farthest);
    let last = min(middle + half, streak.farthest);
    let still = select(0.0, 1.0, first <= last && room > 0.0);
    let moving = max(last - first, 0.0) / max(2.0 * streak.farthest, SPECIMEN_TINY);
    return SpecimenPassage(foot, middle, first, last, select(still, moving, streak.farthest > 0.0));
}

// A ray in the frame of the drop, after u radii of fall.
fn specimen_streak_shift(ray: SpecimenRay, passage: SpecimenPassage, u: f32) -> SpecimenRay {
    let d = ray.direction;
    let rise = vec3f(-(d.x * d.y), d.x * d.x + d.z * d.z, -(d.z * d.y));
    return SpecimenRay(passage.foot + rise * (u - passage.middle), ray.reach - u * d.y, d);
}

// s2, s3, and what keeps the volume, at a time in seconds from the middle of the exposure.
fn specimen_streak_state(streak: SpecimenStreak, seconds: f32) -> vec3f {
    let time = DropOscillationTime(0u, seconds);
    let s = drop_oscillation_displacement(streak.oscillation, time, 0.0);
    let even = s.x * (streak.volume.x + s.x * (streak.volume.y + s.x * streak.volume.z));
    let odd = s.y * s.y * (streak.volume.w + s.x * streak.volume_last);
    return vec3f(s, drop_oscillation_inverse_cube_root(1.0 + (even + odd)));
}

// Position of a sample's instants in their parts of the exposure, in [0, 1).
fn specimen_streak_offset(pixel: u32, sample: u32) -> f32 {
    return rng_unit(rng_draw(vec2u(0u), pixel, sample, SPECIMEN_STREAK_DIMENSION).x);
}

// The radiance along a ray in the frame of the drop.
fn specimen_streak_radiance(drop: SpecimenWobble, ray: SpecimenRay) -> vec3f {
    let meets = specimen_wobble_meet(drop, ray);
    if meets.y == 0.0 {
        return specimen_sky_light(ray.direction);
    }
    var light = specimen_wobble_enter(drop, ray, meets.x);
    var radiance = specimen_sky_light(light.exit) * light.fraction;
    for (var k = 0u; k <= SPECIMEN_STREAK_REFLECTIONS; k += 1u) {
        if light.rest <= 0.0 {
            break;
        }
        let least = select(SPECIMEN_MIN_FRACTION, SPECIMEN_ALL, k == SPECIMEN_STREAK_REFLECTIONS);
        light = specimen_wobble_bounce(drop, light, least);
        if light.fraction > 0.0 {
            radiance += specimen_sky_light(light.exit) * light.fraction;
        }
    }
    return radiance;
}

// Term of trace k in the sum over the samples of a pixel. The first instant of a sample brings the uncovered time.
fn specimen_streak_trace(view: SpecimenView, streak: SpecimenStreak, column: u32, row: u32, k: u32) -> vec3f {
    let samples = view.camera.samples;
    let sample = k / streak.instants;
    let instant = k % streak.instants;
    let middle = vec2f(view.size * samples) * 0.5;
    let line = row * samples + sample / samples;
    let x = f32(column * samples + sample % samples) - middle.x + specimen_jitter(line);
    let y = middle.y - (f32(line) + 0.5);
    let ray = specimen_ray(view.camera, x, y);
    let passage = specimen_streak_passage(streak, ray);
    var sum = vec3f(0.0);
    if instant == 0u {
        sum = specimen_sky_light(ray.direction) * (1.0 - passage.cover);
    }
    if passage.cover > 0.0 {
        let inverse = 1.0 / f32(streak.instants);
        let part = (f32(instant) + specimen_streak_offset(row * view.size.x + column, sample)) * inverse;
        let u = passage.first + (passage.last - passage.first) * part;
        let state = specimen_streak_state(streak, u / streak.speed);
        let traced = view.traced;
        let drop = SpecimenWobble(traced.shape, state, traced.index, streak.inverse_wide, streak.inverse_tall);
        let shifted = specimen_streak_shift(ray, passage, u);
        sum += specimen_streak_radiance(drop, shifted) * (passage.cover * inverse);
    }
    return sum;
}

@compute @workgroup_size(8, 8, 1)
fn main_specimen_streak(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= specimen_view.size.x || id.y >= specimen_view.rows {
        return;
    }
    var sum = vec3f(0.0);
    for (var k = 0u; k < specimen_streak.count; k += 1u) {
        let trace = specimen_streak.first + k;
        sum += specimen_streak_trace(specimen_view, specimen_streak, id.x, specimen_view.first_row + id.y, trace);
    }
    let samples = specimen_view.camera.samples;
    let part = sum * (1.0 / f32(samples * samples));
    let at = (id.y * specimen_view.size.x + id.x) * 3u;
    for (var c = 0u; c < 3u; c += 1u) {
        if ((specimen_view.channels >> c) & 1u) != 0u {
            let before = select(specimen_pixels[at + c], 0.0, specimen_streak.first == 0u);
            specimen_pixels[at + c] = before + part[c];
        }
    }
}
