// Light of lamps and sun on falling drops: for each drop the mean radiance over its disk, and its brightest glints.
// Forms: geometric optics of a sphere, by a table over the scattering angle; the streaks of an atlas; the formula of Rousseau 2006, section 6; the
// cones of Im & Sung 2022, section III.C. One ray per drop and lamp says what of the lamp is hidden.
// Twin: downpour_render::rain::light, where the method is described.

const DROP_LIGHT_PI: f32 = 3.1415927;

struct DropLightFrame {
    // DROP_LIGHT_TRACED, DROP_LIGHT_ATLAS, DROP_LIGHT_ROUSSEAU, DROP_LIGHT_IM_SUNG or DROP_LIGHT_NONE.
    form: u32,
    // Drops.
    count: u32,
    // Rows that are kept of each drop besides its mean: glints, one each, lamps, two each, or streaks of an atlas, three each.
    glints: u32,
    // First lamp of this dispatch, which has DROP_LIGHT_LAMPS of them at most.
    first_light: u32,
    // Terms of the formula of Rousseau 2006: DROP_LIGHT_EXTERNAL, DROP_LIGHT_INTERNAL, or both.
    terms: u32,
}

// Position relative to the scene's origin, and radius, meters. For the atlas then for each drop its axis, against its motion
// as the eye sees it, and its id.
@group(0) @binding(6) var<storage, read> drop_light_drops: array<vec4f>;
// For each drop its mean radiance, then its glints: their part of the mean, and their position and the lamp's image, packed. Or its streaks: their part
// of the mean, and -1 if it is mirrored, else 1; the three layers, and the weight of the first; the weight of the second, those of the
// higher diameter and of the higher elevation, and 0. Or its
// lamps in the form of Rousseau 2006: the irradiance over pi, and -1 less what the formula gives on the mean; the direction. Or its
// lamps for the profile of its streak: the irradiance, and the chord from the middle to the edge of the disk (in the form of
// Rousseau 2006 the irradiance over pi, and -1); the direction, and how bright the drop is by it.
@group(0) @binding(8) var<storage, read_write> drop_light_out: array<vec4f>;
@group(0) @binding(9) var<uniform> drop_light_frame: DropLightFrame;

// A row of the table at a scattering angle over pi: linear between the middles of the intervals.
fn drop_light_entry(row: u32, angle: f32) -> vec4f {
    let last = DROP_LIGHT_ENTRIES - 1u;
    let position = clamp(angle * f32(DROP_LIGHT_ENTRIES) - 0.5, 0.0, f32(last));
    let low = u32(position);
    let part = position - f32(low);
    let first = row * DROP_LIGHT_ENTRIES;
    let here = drop_light_table[first + low];
    let there = drop_light_table[first + min(low + 1u, last)];
    return here + (there - here) * part;
}

// Im & Sung 2022, equations (7) to (10): irradiance over pi at a position in a spot's cone, which is a pile of circles. What is
// within the inner cone is lit, between the two cones light fades. Nothing of other lamps.
fn drop_light_cone(light: RenderLight, position: vec3f, least: f32) -> vec3f {
    let cone = light.cone;
    if light.kind == SCENE_LIGHT_DIRECTIONAL || cone.x <= 0.0 {
        return vec3f(0.0);
    }
    let offset = position - light.position;
    let below = dot(offset, light.axis);
    let height = select(SCENE_FAR, light.range, light.range > 0.0);
    if below <= 0.0 || below > height {
        return vec3f(0.0);
    }
    let outer = clamp(-cone.y / cone.x, 1.0e-3, 1.0);
    let inner = clamp((1.0 - cone.y) / cone.x, outer, 1.0);
    let circle = below * sqrt(max(1.0 - outer * outer, 0.0)) / outer;
    let core = below * sqrt(max(1.0 - inner * inner, 0.0)) / inner;
    let aside = offset - light.axis * below;
    let away = sqrt(dot(aside, aside));
    let fraction = clamp((circle - away) / max(circle - core, 1.0e-6 * below), 0.0, 1.0);
    let square = max(dot(offset, offset), max(least * least, 1.0e-8));
    return light.color * (fraction / square);
}

// The mean over a drop's disk of what Rousseau's formula gives at its pixels.
fn drop_light_mean(towards: vec3f, light: vec3f, terms: u32) -> f32 {
    let right = drop_glint_right(towards);
    let up = cross(right, towards);
    var sum = 0.0;
    for (var k = 0u; k < DROP_LIGHT_RINGS * DROP_LIGHT_POINTS; k += 1u) {
        let square = (f32(k / DROP_LIGHT_POINTS) + 0.5) / f32(DROP_LIGHT_RINGS);
        let angle = 2.0 * DROP_LIGHT_PI * (f32(k % DROP_LIGHT_POINTS) + 0.5) / f32(DROP_LIGHT_POINTS);
        let away = sqrt(square);
        let normal = right * (away * cos(angle)) + up * (away * sin(angle)) - towards * sqrt(1.0 - square);
        sum += drop_glint_rousseau(normal, -towards, light, terms);
    }
    return sum / f32(DROP_LIGHT_RINGS * DROP_LIGHT_POINTS);
}

// First row of the faintest of the lights of a drop, `rows` rows each from `first` on, if it is fainter than `fraction`; else 0.
fn drop_light_weakest(first: u32, rows: u32, fraction: f32) -> u32 {
    var weakest = 0u;
    var least = fraction;
    for (var k = rows; k <= drop_light_frame.glints; k += rows) {
        let kept = light_weight(drop_light_out[first + k - rows].rgb);
        if kept < least {
            least = kept;
            weakest = first + k - rows;
        }
    }
    return weakest;
}

// Keeps a glint of a drop if it is brighter than the least of those that are kept.
fn drop_light_keep(first: u32, glint: vec4f) {
    let weakest = drop_light_weakest(first, 1u, light_weight(glint.rgb));
    if weakest > 0u {
        drop_light_out[weakest] = glint;
    }
}

// Keeps a lamp of a drop in the form of Rousseau 2006, two rows, if it is brighter than the least of those that are kept.
fn drop_light_keep_facing(first: u32, light: vec4f, direction: vec4f) {
    let weakest = drop_light_weakest(first, 2u, light_weight(light.rgb));
    if weakest > 0u {
        drop_light_out[weakest] = light;
        drop_light_out[weakest + 1u] = direction;
    }
}

// Keeps a streak of an atlas, three rows, if it is brighter than the least of those that are kept.
fn drop_light_keep_streak(first: u32, radiance: vec3f, streak: AtlasSlot) {
    let weakest = drop_light_weakest(first, DROP_ATLAS_ROWS, light_weight(radiance));
    if weakest > 0u {
        drop_light_out[weakest] = vec4f(radiance, streak.side);
        drop_light_out[weakest + 1u] = vec4f(vec3f(streak.layers), streak.weights.x);
        drop_light_out[weakest + 2u] = vec4f(streak.weights.y, streak.parts, 0.0);
    }
}

// The chord from the middle to the edge of a lamp's disk as a drop sees it: no lamp has less than the sun's.
fn drop_light_reach(light: RenderLight, spread: f32) -> f32 {
    return max(max(light.chord, spread), DROP_LIGHT_REACH);
}

// Radius of the image of a lamp on a drop's disk, in radii of the drop: of the disk that has its area. Law: a lamp whose rays leave the
// drop at `position` from the axis is an ellipse there: along the side of the lamp as large as its disk times the change of the
// position with the scattering angle, around the axis as large as its disk times the position over the angle's sine.
fn drop_light_image(path: u32, angle: f32, sine: f32, position: f32, reach: f32) -> f32 {
    let step = 1.0 / f32(DROP_LIGHT_ENTRIES);
    let change = drop_light_entry(path, angle + step).w - drop_light_entry(path, angle - step).w;
    let along = abs(change) / (2.0 * DROP_LIGHT_PI * step);
    let around = abs(position) / max(sine, step);
    return min(reach * sqrt(along * around), 1.0);
}

// Mean radiance of a lamp over a drop's whole disk, from the lamp's irradiance over pi and its direction.
fn drop_light_whole(lit: vec3f, direction: vec3f, towards: vec3f) -> vec3f {
    if drop_light_frame.form == DROP_LIGHT_LAMPS_ROUSSEAU {
        return lit * drop_light_mean(towards, direction, drop_light_frame.terms);
    }
    let angle = drop_glint_angle(direction, towards);
    return lit * DROP_LIGHT_PI * drop_light_entry(0u, angle).rgb;
}

// Keeps a lamp of a streak if it is brighter than the least of those that are kept; returns what the drop shows on the mean of
// the lamp that is not kept.
fn drop_light_keep_lamp(slot: u32, lit: vec3f, reach: f32, direction: vec3f, towards: vec3f) -> vec3f {
    let whole = drop_light_whole(lit, direction, towards);
    let fraction = light_weight(whole);
    var least = fraction;
    var weakest = slot;
    var found = false;
    for (var k = 0u; k + 1u < drop_light_frame.glints; k += 2u) {
        let kept = drop_light_out[slot + k + 1u].w;
        if kept < least {
            least = kept;
            weakest = slot + k;
            found = true;
        }
    }
    if !found {
        return whole;
    }
    let old = drop_light_out[weakest];
    let way = drop_light_out[weakest + 1u].xyz;
    let is_rousseau = drop_light_frame.form == DROP_LIGHT_LAMPS_ROUSSEAU;
    let factor = select(DROP_LIGHT_PI, 1.0, is_rousseau);
    drop_light_out[weakest] = vec4f(lit * factor, select(reach, -1.0, is_rousseau));
    drop_light_out[weakest + 1u] = vec4f(direction, fraction);
    if old.w == 0.0 {
        return vec3f(0.0);
    }
    return drop_light_whole(old.rgb / factor, way, towards);
}

// The light on a drop: adds this dispatch's lamps to those before.
fn drop_light_of(index: u32) {
    let drop = drop_light_drops[index];
    // An empty place in the list.
    if drop.w <= 0.0 {
        return;
    }
    let slot = index * (1u + drop_light_frame.glints);
    var sum = vec3f(0.0);
    if drop_light_frame.first_light > 0u {
        sum = drop_light_out[slot].rgb;
    } else {
        for (var k = 1u; k <= drop_light_frame.glints; k += 1u) {
            drop_light_out[slot + k] = vec4f(0.0);
        }
    }
    let offset = drop.xyz - render_frame.camera.eye;
    let towards = offset / sqrt(max(dot(offset, offset), DROP_GLINT_TINY));
    let right = drop_glint_right(towards);
    let up = cross(right, towards);
    let form = drop_light_frame.form;
    let end = min(drop_light_frame.first_light + DROP_LIGHT_LAMPS, render_frame.light_count);
    for (var k = drop_light_frame.first_light; k < end && form != DROP_LIGHT_NONE; k += 1u) {
        let lamp = light_load(k);
        let light = light_sample(lamp, drop.xyz, drop.w);
        var lit = light.irradiance;
        if form == DROP_LIGHT_IM_SUNG {
            lit = drop_light_cone(lamp, drop.xyz, drop.w);
        }
        if light_weight(lit) <= 0.0 {
            continue;
        }
        lit *= scene_visibility(drop.xyz, light.direction, light.distance);
        let reach = drop_light_reach(lamp, light.spread);
        if form == DROP_LIGHT_IM_SUNG {
            sum += lit;
        } else if form == DROP_LIGHT_LAMPS_TRACED || form == DROP_LIGHT_LAMPS_ROUSSEAU {
            sum += drop_light_keep_lamp(slot + 1u, lit, reach, light.direction, towards);
        } else if form == DROP_LIGHT_ROUSSEAU {
            let mean = drop_light_mean(towards, light.direction, drop_light_frame.terms);
            sum += lit * mean;
            drop_light_keep_facing(slot + 1u, vec4f(lit, -1.0 - mean), vec4f(light.direction, 0.0));
        } else if form == DROP_LIGHT_ATLAS {
            let about = drop_light_drops[drop_light_frame.count + index];
            let streak = drop_atlas_slot(u32(about.w), 2.0 * drop.w, about.xyz, light.direction, -towards);
            let radiance = lit * (DROP_LIGHT_PI * streak.amount);
            sum += radiance;
            drop_light_keep_streak(slot + 1u, radiance, streak);
        } else {
            let angle = drop_glint_angle(light.direction, towards);
            let side = drop_glint_side(light.direction, right, up);
            let sine = drop_glint_sine(light.direction, towards);
            let irradiance = lit * DROP_LIGHT_PI;
            sum += irradiance * drop_light_entry(0u, angle).rgb;
            for (var path = 1u; path <= DROP_LIGHT_PATHS && drop_light_frame.glints > 0u; path += 1u) {
                let entry = drop_light_entry(path, angle);
                let image = drop_light_image(path, angle, sine, entry.w, reach);
                drop_light_keep(slot + 1u, vec4f(irradiance * entry.rgb, drop_glint_pack(side * entry.w, image)));
            }
        }
    }
    drop_light_out[slot] = vec4f(sum, 0.0);
}

@compute @workgroup_size(64, 1, 1)
fn main_drop_light(@builtin(global_invocation_id) id: vec3u) {
    if id.x < drop_light_frame.count {
        drop_light_of(id.x);
    }
}
