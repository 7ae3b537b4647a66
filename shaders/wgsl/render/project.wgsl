// Falling drops on a picture: the path of each during the exposure, its oval, its oscillation, and how it is sampled.
// Method: during the exposure a drop moves along a straight line, past an eye that moves and turns. Its path is cut to the part that
// is before the eye and in which the drop is there. What a drop looks like depends on its diameter and on how far above or below
// the eye it is: both are looked up in tables of the masks.
// A splash stands on the surface where the drop met it, along its normal, at the stage of the picture's time: it has rows of its own
// behind those of the diameters, for stages and for elevations above the surface from level to straight above.
// Frequencies of the oscillation are integers, between the entries of a table, so that phases are the same on every device at any
// time (oscillation.wgsl).
// Twin: downpour_render::rain::project.

struct ProjectFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // 1 if drops have an axis in project_rows, for an atlas.
    has_axes: u32,
    unused: vec2u,
    camera: RenderCamera,
    // Velocity of the eye, m/s.
    eye_velocity: vec3f,
    // Exposure time, s.
    shutter: f32,
    // Axis of the camera's rotation, with its angular speed as length, rad/s.
    turning: vec3f,
    // Diameter of the lens's pupil, m.
    aperture: f32,
    // Amplitudes of the modes (2,0) and (3,1), over the radius.
    amplitudes: vec2f,
    // 1 / distance in focus, 1/m.
    inverse_focus: f32,
    // Method of streaks: DROPS_TABLE or DROPS_LOOP.
    streaks: u32,
    // Seed of the phases.
    seed: vec2u,
    // Time of the picture (DropOscillationTime).
    ticks: u32,
    time_offset: f32,
    // Drops, and the room for them: the places behind the last drop are marked as empty.
    count: u32,
    room: u32,
    // 1 if light fades over the exposure, 0 if it has one weight.
    is_fading: u32,
    // 1 if drops of the smallest diameter look the same from everywhere.
    small_are_round: u32,
}

// The part of a path that is shown.
struct ProjectPath {
    // Positions at its begin and end, relative to the eye.
    first: vec3f,
    // Mean depth along the direction to the drop, m.
    depth: f32,
    last: vec3f,
    // The least of it.
    nearest: f32,
    velocity: vec3f,
    // Depth at the end over that at the begin.
    depth_ratio: f32,
    // Part of the exposure.
    part: vec2f,
    moves: bool,
    is_there: bool,
}

// Oscillation during the part of the exposure.
struct ProjectModes {
    // As in ScreenDrop.
    mode_phase: vec4f,
    cycles: vec2f,
    // No part of the surface goes farther, as a fraction of the radius.
    most: f32,
}

// What the masks of a drop say of its outline.
struct ProjectMask {
    index: vec2f,
    half_extent: f32,
    area: f32,
    oval: vec3f,
}

// A drop on the picture, and its velocity relative to it.
struct ProjectShown {
    drop: ScreenDrop,
    velocity: vec3f,
}

@group(0) @binding(0) var<uniform> project_frame: ProjectFrame;
@group(0) @binding(1) var<storage, read> project_drops: array<EyeDrop>;
// Of the masks: half extents by row; areas, then ovals by row and elevation; then the shapes of profiles.wgsl.
@group(0) @binding(2) var<storage, read> project_masks: array<f32>;
// Frequencies of both modes in units of 2^-16 Hz, by the bits of the diameter.
@group(0) @binding(3) var<storage, read> project_frequencies: array<vec2u>;
@group(0) @binding(4) var<storage, read_write> project_list: array<ScreenDrop>;
// Position relative to the scene's origin and radius, m, as drop_light.wgsl reads it; then, for an atlas, the axes and ids.
@group(0) @binding(5) var<storage, read_write> project_rows: array<vec4f>;

// The fraction of a path from `start` to `end` on which it is at least `least`; begin above end: none of it.
fn project_ahead(start: f32, end: f32, least: f32) -> vec2f {
    let begins = start >= least;
    let ends = end >= least;
    if begins && ends {
        return vec2f(0.0, 1.0);
    }
    if begins {
        return vec2f(0.0, (start - least) / (start - end));
    }
    if ends {
        return vec2f((least - start) / (end - start), 1.0);
    }
    return vec2f(1.0, 0.0);
}

// The part of the exposure in which a drop is there; begin above end: none of it.
fn project_present(present: vec2f, shutter: f32) -> vec2f {
    if shutter == 0.0 {
        return select(vec2f(1.0, 0.0), vec2f(0.0, 1.0), present.x <= 0.0 && present.y >= 0.0);
    }
    let part = clamp(present / shutter + 0.5, vec2f(0.0), vec2f(1.0));
    return select(vec2f(1.0, 0.0), part, part.x < part.y);
}

// Time at which a drop is seen at its position: 0 if it is there then, else when it lands or starts.
fn project_seen(present: vec2f) -> f32 {
    return select(max(present.x, 0.0), present.y, present.y < 0.0);
}

// Position relative to the eye at a time relative to the picture's, s.
fn project_position(drop: EyeDrop, time: f32) -> vec3f {
    return eye_drop_position(drop, project_frame.eye_velocity, project_frame.turning, time);
}

// The path of a drop whose middle is at `middle`, or of a splash, which has none.
fn project_path(drop: EyeDrop, middle: vec3f, present: vec2f, is_splash: bool) -> ProjectPath {
    let radius = 0.5 * drop.diameter;
    let distance = sqrt(dot(middle, middle));
    let towards = middle / distance;
    let whole = present.x == 0.0 && present.y == 1.0;
    var path = ProjectPath(
        middle, distance, middle, distance, vec3f(0.0), 1.0, vec2f(0.0, 1.0), false, true,
    );
    let shutter = project_frame.shutter;
    if shutter == 0.0 || is_splash {
        return path;
    }
    let open = project_position(drop, -0.5 * shutter);
    let close = project_position(drop, 0.5 * shutter);
    let forward = project_frame.camera.forward;
    let in_front = project_ahead(dot(open, forward), dot(close, forward), 2.0 * radius + 0.02);
    let beside = project_ahead(dot(open, towards), dot(close, towards), 0.2 * distance);
    let part = vec2f(
        max(max(in_front.x, beside.x), present.x),
        min(min(in_front.y, beside.y), present.y),
    );
    let first = open + (close - open) * part.x;
    let last = open + (close - open) * part.y;
    let depths = vec2f(dot(first, towards), dot(last, towards));
    let shift = last / max(depths.y, 1.0e-6) - first / max(depths.x, 1.0e-6);
    let across = sqrt(dot(shift, shift));
    if part.y <= part.x || !ops_is_finite(across) || across < PROJECT_STILL * radius / distance {
        // A drop that stands before the eye, or what is left of one that is there for a moment.
        path.is_there = whole;
        return path;
    }
    return ProjectPath(
        first,
        0.5 * (depths.x + depths.y),
        last,
        min(depths.x, depths.y),
        (close - open) / shutter,
        depths.y / depths.x,
        part,
        true,
        true,
    );
}

// Frequencies of both modes for a diameter, in units of 2^-16 Hz: linear between the entries, in integers.
fn project_frequency(diameter: f32) -> vec2u {
    let key = clamp(bitcast<u32>(diameter), PROJECT_FIRST_BITS, PROJECT_LAST_BITS) - PROJECT_FIRST_BITS;
    let low = project_frequencies[key >> 16u];
    let down = low - project_frequencies[(key >> 16u) + 1u];
    let part = key & 0xffffu;
    return low - ((down >> vec2u(16u)) * part + (((down & vec2u(0xffffu)) * part) >> vec2u(16u)));
}

// The oscillation of a drop in a part of the exposure.
fn project_modes(drop: EyeDrop, towards: vec3f, part: vec2f) -> ProjectModes {
    let amplitudes = project_frame.amplitudes;
    let is_still = amplitudes.x == 0.0 && amplitudes.y == 0.0;
    if is_still || drop.diameter < PROJECT_OSCILLATES_MIN || drop.diameter > PROJECT_OSCILLATES_MAX {
        return ProjectModes(vec4f(0.0), vec2f(0.0), 0.0);
    }
    let frequency = project_frequency(drop.diameter);
    let phase = drop_oscillation_phase(project_frame.seed, drop.id);
    // Direction in which the mode (3,1) bulges, against the right of the view.
    let azimuth = STREAK_TURN * drop_oscillation_azimuth(project_frame.seed, drop.id);
    let right = drop_glint_right(towards);
    let bulge = amplitudes.y * (cos(azimuth) * right.x + sin(azimuth) * right.z);
    let begin = project_frame.time_offset + project_frame.shutter * (part.x - 0.5);
    let time = DropOscillationTime(project_frame.ticks, begin);
    let turns = vec2f(
        drop_oscillation_turns(frequency.x, phase.x, time),
        drop_oscillation_turns(frequency.y, phase.y, time),
    );
    let open = project_frame.shutter * (part.y - part.x);
    return ProjectModes(
        vec4f(amplitudes.x, bulge, turns - floor(turns)),
        vec2f(frequency) * (DROP_OSCILLATION_TICK * open),
        // P31 reaches 2.07.
        amplitudes.x + 2.1 * amplitudes.y,
    );
}

// A value of the masks between two rows and two elevations; `stride` numbers for each.
fn project_between(first: u32, stride: u32, index: vec2f) -> f32 {
    let low = vec2u(floor(index));
    let part = index - floor(index);
    let high = vec2u(min(low.x + 1u, PROJECT_ROWS - 1u), min(low.y + 1u, DROPS_ELEVATIONS - 1u));
    let near = first + low.x * DROPS_ELEVATIONS * stride;
    let far = first + high.x * DROPS_ELEVATIONS * stride;
    let a = project_masks[near + low.y * stride] * (1.0 - part.y) + project_masks[near + high.y * stride] * part.y;
    let b = project_masks[far + low.y * stride] * (1.0 - part.y) + project_masks[far + high.y * stride] * part.y;
    return a * (1.0 - part.x) + b * part.x;
}

// Position among the masks of a drop that is seen from `elevation` radians above it.
fn project_lookup(diameter: f32, elevation: f32) -> ProjectMask {
    let last = f32(PROJECT_DIAMETERS - 1u);
    let row = clamp(diameter / PROJECT_DIAMETER_STEP - 1.0, 0.0, last);
    let half_turn = f32(DROPS_ELEVATIONS - 1u) * 0.5;
    let turned = clamp((elevation / STREAK_QUARTER + 1.0) * half_turn, 0.0, 2.0 * half_turn);
    // A sphere is the same from everywhere: one mask does.
    let is_sphere = row == 0.0 && project_frame.small_are_round == 1u;
    return project_mask(vec2f(row, select(turned, half_turn, is_sphere)));
}

// The turn of a splash on the picture: how far its normal goes along the up and the right of its view.
fn project_turn(normal: vec3f, right: vec3f, up: vec3f) -> vec2f {
    let turn = vec2f(dot(normal, up), dot(normal, right));
    let size = sqrt(dot(turn, turn));
    if turn.y == 0.0 || size < 1.0e-3 {
        return vec2f(select(1.0, -1.0, turn.x < 0.0), 0.0);
    }
    return turn / size;
}

// Position among the masks of a splash that is seen from `elevation` radians above its surface, at the picture's time.
fn project_splash(present: vec2f, elevation: f32) -> ProjectMask {
    let stage = clamp(-present.x / max(present.y - present.x, 1.0e-9), 0.0, 1.0);
    let rise = PROJECT_SPLASH_TOP * min(stage / SPLASH_RISE_SHARE, 1.0);
    let fall = max(stage - SPLASH_RISE_SHARE, 0.0) / (1.0 - SPLASH_RISE_SHARE);
    let row = rise + (f32(PROJECT_SPLASHES - 1u) - PROJECT_SPLASH_TOP) * fall;
    let turned = elevation / STREAK_QUARTER * f32(DROPS_ELEVATIONS - 1u);
    return project_mask(vec2f(
        f32(PROJECT_DIAMETERS) + clamp(row, 0.0, f32(PROJECT_SPLASHES - 1u)),
        clamp(turned, 0.0, f32(DROPS_ELEVATIONS - 1u)),
    ));
}

// What the masks at a fractional row and elevation say of an outline.
fn project_mask(index: vec2f) -> ProjectMask {
    let low = u32(floor(index.x));
    let part = index.x - floor(index.x);
    let extent = project_masks[low] * (1.0 - part) + project_masks[min(low + 1u, PROJECT_ROWS - 1u)] * part;
    let areas = PROJECT_ROWS;
    let ovals = areas + PROJECT_ROWS * DROPS_ELEVATIONS;
    return ProjectMask(
        index,
        extent,
        project_between(areas, 1u, index),
        vec3f(
            project_between(ovals, 3u, index),
            project_between(ovals + 1u, 3u, index),
            project_between(ovals + 2u, 3u, index),
        ),
    );
}

// The class of a row of the masks: the nearest.
fn project_class(row: f32) -> u32 {
    var found = 0u;
    for (var k = 1u; k < PROJECT_CLASSES; k += 1u) {
        if abs(PROJECT_CLASS_ROWS[k] - row) < abs(PROJECT_CLASS_ROWS[found] - row) {
            found = k;
        }
    }
    return found;
}

// Samples of a drop so many pixels wide: of a streak those of a pixel, of a still drop those along an edge of one; 0: its light is
// spread over the pixels about it. A splash has fewer than a drop: it shows no picture of what is around it.
fn project_grid(width: f32, moves: bool, is_splash: bool) -> u32 {
    if moves {
        if width < PROJECT_THIN {
            return 0u;
        }
        return select(PROJECT_WIDE_SAMPLES, PROJECT_NARROW_SAMPLES, width < PROJECT_NARROW);
    }
    if width < PROJECT_SMALL {
        return 0u;
    }
    if width < 2.0 {
        return select(8u, 5u, is_splash);
    }
    return select(2u, select(4u, 3u, is_splash), width < 16.0);
}

// A drop on the picture; its reach is below 0 where it is on none.
fn project_drop(drop: EyeDrop) -> ProjectShown {
    var shown: ProjectShown;
    shown.drop.reach = -1.0;
    let camera = project_frame.camera;
    let shutter = project_frame.shutter;
    let is_splash = drop.speed <= FIELD_SPLASH;
    // A splash is there for all of the exposure, or not at all.
    let present = project_present(drop.present, select(shutter, 0.0, is_splash));
    if present.x > present.y {
        return shown;
    }
    // The middle of the part of its path that is there.
    let offset = project_position(drop, (0.5 * (present.x + present.y) - 0.5) * shutter);
    let length = sqrt(dot(offset, offset));
    let radius = 0.5 * drop.diameter;
    if length <= 2.0 * radius || radius <= 0.0 || !ops_is_finite(length) {
        return shown;
    }
    let towards = offset / length;
    let cosine = dot(towards, camera.forward);
    if cosine < 0.05 {
        return shown;
    }
    let path = project_path(drop, offset, present, is_splash);
    if !path.is_there {
        return shown;
    }
    let right = drop_glint_right(towards);
    let up = cross(right, towards);
    var normal = vec3f(0.0, 1.0, 0.0);
    if is_splash {
        normal = eye_drop_normal(drop.speed);
    }
    let elevation = asin(clamp(-dot(towards, normal), -1.0, 1.0));
    var mask: ProjectMask;
    if is_splash {
        mask = project_splash(drop.present, elevation);
    } else {
        mask = project_lookup(drop.diameter, elevation);
    }
    let distance = path.depth;
    let slope = radius / distance;
    // The plane of the picture is farther away, and slanted, away from the middle.
    let pixels = slope / (camera.pixel_angle * cosine);
    let width = 2.0 * pixels;
    // Circle of confusion of a thin lens.
    let blur = project_frame.aperture * abs(1.0 / distance - project_frame.inverse_focus) / camera.pixel_angle;
    let is_blurred = blur >= 1.0 && blur > 0.7 * width;
    let grid = select(project_grid(width, path.moves, is_splash), 0u, is_blurred);
    let spread = select(1.0, max(sqrt(0.75 * width * width + blur * blur), 1.0), is_blurred);
    var modes = ProjectModes(vec4f(0.0), vec2f(0.0), 0.0);
    if path.moves {
        modes = project_modes(drop, towards, path.part);
    }
    let larger = distance / path.nearest;
    let sampled = mask.half_extent * pixels * larger * (1.0 + modes.most) / cosine * 1.02 + 1.0;
    let cycles = select(modes.cycles, project_turn(normal, right, up), is_splash);
    let start = vec2f(dot(path.first, right), dot(path.first, up)) / dot(path.first, towards);
    let end = vec2f(dot(path.last, right), dot(path.last, up)) / dot(path.last, towards);
    let first = camera_project(camera, path.first);
    shown.velocity = path.velocity;
    shown.drop = ScreenDrop(
        towards,
        distance,
        camera_project(camera, offset),
        slope,
        mask.half_extent,
        mask.index,
        mask.area * pixels * pixels / cosine,
        grid,
        start,
        end - start,
        first,
        camera_project(camera, path.last) - first,
        mask.oval,
        path.depth_ratio,
        modes.mode_phase,
        cycles,
        path.part.y - path.part.x,
        spread,
        path.nearest - 2.0 * radius,
        select(DROPS_STILL, project_frame.streaks, path.moves),
        project_class(mask.index.x),
        0u,
        select(vec2f(1.0), 2.0 * path.part, path.moves && project_frame.is_fading == 1u),
        select(sampled, 0.5 * (spread + 1.0), grid == 0u),
        drop.id,
    );
    return shown;
}

// The row of the light of lamps on a drop: where it is seen, and its radius; 0 where it is not shown.
fn project_row(drop: EyeDrop, shown: ProjectShown) -> vec4f {
    if shown.drop.reach <= 0.0 {
        return vec4f(0.0);
    }
    let seen = drop.offset + drop.velocity * project_seen(drop.present);
    return vec4f(project_frame.camera.eye + seen, 0.5 * drop.diameter);
}

// The axis of a drop for an atlas, against its motion as the eye sees it, and a number that stays with it.
fn project_axis(shown: ProjectShown) -> vec4f {
    let square = dot(shown.velocity, shown.velocity);
    let axis = select(vec3f(0.0, 1.0, 0.0), -shown.velocity / sqrt(max(square, 1.0e-30)), square > 0.0);
    // Numbers below 2^24: single precision has them exactly.
    return vec4f(axis, f32(shown.drop.id & 0xffffffu));
}

@compute @workgroup_size(64, 1, 1)
fn main_project(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index >= project_frame.room {
        return;
    }
    var shown: ProjectShown;
    shown.drop.reach = -1.0;
    var row = vec4f(0.0);
    if index < project_frame.count {
        shown = project_drop(project_drops[index]);
        row = project_row(project_drops[index], shown);
    }
    project_list[index] = shown.drop;
    project_rows[index] = row;
    if project_frame.has_axes == 1u {
        project_rows[project_frame.room + index] = project_axis(shown);
    }
}
