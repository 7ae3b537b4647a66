// Profiles of a picture's streaks in the streak radiance table: which streaks have one, how fine it is, and where it is.
// Method: a streak that is sampled in its pixels has a profile, the finer the wider the streak. Where all profiles together have no
// room, all are made coarser across and in time, until they fit; where even the coarsest do not, none has one, and streaks are averaged by a
// loop. Places are given in any order: what a profile holds does not depend on where it is.
// Twin: downpour_render::rain::profiles.

const PROFILES_PI: f32 = 3.1415927;

struct ProfilesFrame {
    // Drops.
    count: u32,
    // Rays and entries of the table that there is room for.
    max_rays: u32,
    max_entries: u32,
    // Entries of the table before the first profile.
    first_entry: u32,
    // Seed of the phases.
    seed: vec2u,
    // Amplitudes of the oscillation, over the radius.
    amplitudes: vec2f,
    // Class of the drops that are not drawn one by one; PROJECT_NO_CLASS: there is none.
    medium: u32,
    unused_1: u32,
    unused_2: u32,
    unused_3: u32,
}

@group(0) @binding(0) var<uniform> profiles_frame: ProfilesFrame;
@group(0) @binding(1) var<storage, read_write> profiles_list: array<ScreenDrop>;
// Positions and radii of the drops (project.wgsl).
@group(0) @binding(2) var<storage, read> profiles_rows: array<vec4f>;
// Tables of the masks (project.wgsl), of which the shapes are read here.
@group(0) @binding(3) var<storage, read> profiles_masks: array<f32>;
// For each level the rays and the entries of all profiles, as two words each, the low one first; then a bit for each class that is
// wanted, and the numbers of paths, rays, entries, rows of rays and columns of profiles that have a place.
@group(0) @binding(4) var<storage, read_write> profiles_state: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> profiles_paths: array<StreakPath>;
// Each list of jobs begins with their number.
@group(0) @binding(6) var<storage, read_write> profiles_ray_jobs: array<vec2u>;
@group(0) @binding(7) var<storage, read_write> profiles_light_jobs: array<vec2u>;
// Positions and radii of the streaks that have a profile.
@group(0) @binding(8) var<storage, read_write> profiles_streaks: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> profiles_classes: array<StreakPath>;
// Workgroups of the rays, and of the light.
@group(0) @binding(10) var<storage, read_write> profiles_groups: array<u32>;

var<workgroup> profiles_sums: array<atomic<u32>, PROFILES_TOTALS>;

// True if a drop is a streak that is sampled.
fn profiles_is_sampled(drop: ScreenDrop) -> bool {
    return drop.reach > 0.0 && drop.kind == DROPS_TABLE && drop.grid > 0u;
}

// True if a drop shows the mean of its class.
fn profiles_is_mean(drop: ScreenDrop) -> bool {
    return drop.reach > 0.0 && drop.kind != DROPS_STILL && drop.grid == 0u;
}

// True if a drop oscillates.
fn profiles_oscillates(drop: ScreenDrop) -> bool {
    return drop.mode_phase.x != 0.0 || drop.mode_phase.y != 0.0;
}

// Rows of a profile of so many rows of rays: half as many again.
fn profiles_rows_of(rows: u32) -> u32 {
    return select((rows - 1u) * PROFILES_ROWS_FOR_TWO / 2u + 1u, 2u, rows == 2u);
}

// Rows and columns of rays, rows of the profile, and its columns for each of the rays', by the streak's width and turns.
fn profiles_sized(drop: ScreenDrop) -> vec4u {
    // The drop's area on the picture is that of its mask.
    let width = 2.0 * sqrt(drop.area / PROFILES_PI);
    var kind = 0u;
    while kind + 1u < PROFILES_KINDS && width > PROFILES_WIDTHS[kind] {
        kind += 1u;
    }
    let span = streak_span(drop);
    let along = sqrt(dot(drop.along, drop.along)) * (1.0 + span.before + span.after);
    let turned = atan2(along, 1.0) / PROFILES_TURNED;
    let oscillates = profiles_oscillates(drop);
    let turns = select(0.0, drop.cycles.y * (span.last - span.first), oscillates);
    let least = select(1.0, PROFILES_MIN[kind], oscillates);
    let wanted = ceil(max(turns * PROFILES_PER_TURN[kind], turned));
    let rows = 1u + u32(clamp(wanted, least, PROFILES_MAX[kind]));
    return vec4u(rows, u32(PROFILES_COLUMNS[kind]), profiles_rows_of(rows), u32(PROFILES_FINE[kind]));
}

// Sizes of a profile that is made coarser so many times.
fn profiles_coarser(sizes: vec4u, level: u32) -> vec4u {
    if level == 0u {
        return sizes;
    }
    let rows = max(sizes.x / (level + 1u), 2u);
    let columns = max(sizes.y - min(STREAK_SUMS * level, sizes.y), STREAK_SUMS);
    return vec4u(rows, columns, profiles_rows_of(rows), 1u);
}

// Rays of a profile, and its entries in the table.
fn profiles_room(sizes: vec4u) -> vec2u {
    let chords = sizes.x * sizes.y;
    return vec2u(chords * sizes.y, 1u + chords + sizes.z * sizes.y * sizes.w * STREAK_SUMS);
}

// The first level that has room; PROFILES_LEVELS: none has.
fn profiles_level() -> u32 {
    for (var level = 0u; level < PROFILES_LEVELS; level += 1u) {
        let rays = vec2u(atomicLoad(&profiles_state[4u * level]), atomicLoad(&profiles_state[4u * level + 1u]));
        let entries = vec2u(atomicLoad(&profiles_state[4u * level + 2u]), atomicLoad(&profiles_state[4u * level + 3u]));
        let room = profiles_frame.max_entries - profiles_frame.first_entry;
        if rays.y == 0u && rays.x <= profiles_frame.max_rays && entries.y == 0u && entries.x <= room {
            return level;
        }
    }
    return PROFILES_LEVELS;
}

// The shape of a drop of a diameter, for the rays of its streak.
fn profiles_shape(diameter: f32) -> StreakPath {
    let last = f32(PROFILES_SHAPES - 1u);
    let at = clamp(diameter / PROFILES_SHAPE_STEP - 1.0, 0.0, last);
    let low = min(u32(at), PROFILES_SHAPES - 2u);
    let part = at - f32(low);
    let near = PROFILES_SHAPES_BEGIN + low * PROFILES_SHAPE_WORDS;
    var words: array<f32, PROFILES_SHAPE_WORDS>;
    for (var k = 0u; k < PROFILES_SHAPE_WORDS; k += 1u) {
        let a = profiles_masks[near + k];
        words[k] = a + (profiles_masks[near + PROFILES_SHAPE_WORDS + k] - a) * part;
    }
    var path: StreakPath;
    path.shape = DropShapeCoefficients(
        vec4f(words[0], words[1], words[2], words[3]),
        vec4f(words[4], words[5], words[6], words[7]),
        vec4f(words[8], words[9], words[10], words[11]),
    );
    path.volume = vec4f(words[12], words[13], words[14], words[15]);
    path.volume_last = words[16];
    path.wide = words[17];
    path.tall = words[18];
    path.index = words[19];
    return path;
}

@compute @workgroup_size(64, 1, 1)
fn main_profiles_clear(@builtin(global_invocation_id) id: vec3u) {
    if id.x < PROFILES_STATE {
        atomicStore(&profiles_state[id.x], 0u);
    }
    if id.x < arrayLength(&profiles_streaks) {
        profiles_streaks[id.x] = vec4f(0.0);
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_profiles_measure(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation_index(id, groups);
    if index < profiles_frame.count {
        let drop = profiles_list[index];
        if profiles_is_mean(drop) {
            atomicOr(&profiles_state[PROFILES_CLASSES], 1u << drop.shape);
        }
        if profiles_is_sampled(drop) {
            let sizes = profiles_sized(drop);
            for (var level = 0u; level < PROFILES_LEVELS; level += 1u) {
                let room = profiles_room(profiles_coarser(sizes, level));
                atomicAdd(&profiles_sums[2u * level], room.x);
                atomicAdd(&profiles_sums[2u * level + 1u], room.y);
            }
        }
    }
    workgroupBarrier();
    if local < PROFILES_TOTALS {
        let sum = atomicLoad(&profiles_sums[local]);
        let before = atomicAdd(&profiles_state[2u * local], sum);
        if before > 0xffffffffu - sum {
            atomicAdd(&profiles_state[2u * local + 1u], 1u);
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_profiles_place(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index >= profiles_frame.count {
        return;
    }
    let drop = profiles_list[index];
    if !profiles_is_sampled(drop) {
        return;
    }
    let level = profiles_level();
    if level == PROFILES_LEVELS {
        profiles_list[index].kind = DROPS_LOOP;
        return;
    }
    let sizes = profiles_coarser(profiles_sized(drop), level);
    let room = profiles_room(sizes);
    var path = profiles_shape(2.0 * profiles_rows[index].w);
    if profiles_oscillates(drop) {
        path.amplitudes = profiles_frame.amplitudes;
    }
    let azimuth = STREAK_TURN * drop_oscillation_azimuth(profiles_frame.seed, drop.id);
    path.lobe = vec2f(cos(azimuth), sin(azimuth));
    path.rows = sizes.x;
    path.columns = sizes.y;
    path.profile_rows = sizes.z;
    path.fine = sizes.w;
    path.drop = index;
    path.first_ray = atomicAdd(&profiles_state[PROFILES_RAYS], room.x);
    path.first_entry = profiles_frame.first_entry + atomicAdd(&profiles_state[PROFILES_ENTRIES], room.y);
    let number = atomicAdd(&profiles_state[PROFILES_PATHS], 1u);
    profiles_paths[number] = path;
    profiles_streaks[number] = profiles_rows[index];
    profiles_list[index].profile = path.first_entry;
    // Behind the number of jobs.
    let first_row = 1u + atomicAdd(&profiles_state[PROFILES_RAY_JOBS], sizes.x);
    for (var row = 0u; row < sizes.x; row += 1u) {
        profiles_ray_jobs[first_row + row] = vec2u(number, row);
    }
    let parts = (sizes.z * sizes.y + 63u) / 64u;
    let first_part = 1u + atomicAdd(&profiles_state[PROFILES_LIGHT_JOBS], parts);
    for (var part = 0u; part < parts; part += 1u) {
        profiles_light_jobs[first_part + part] = vec2u(number, part * 64u);
    }
}

// Workgroups for so many jobs.
fn profiles_groups_of(jobs: u32) -> vec2u {
    return vec2u(min(jobs, PROFILES_ALONG), (jobs + PROFILES_ALONG - 1u) / PROFILES_ALONG);
}

@compute @workgroup_size(64, 1, 1)
fn main_profiles_finish(@builtin(local_invocation_index) local: u32) {
    if local < PROJECT_CLASSES {
        let wanted = (atomicLoad(&profiles_state[PROFILES_CLASSES]) >> local) & 1u;
        profiles_classes[local].rows = select(wanted, 1u, local == profiles_frame.medium);
    }
    if local == 0u {
        let jobs = vec2u(
            atomicLoad(&profiles_state[PROFILES_RAY_JOBS]),
            atomicLoad(&profiles_state[PROFILES_LIGHT_JOBS]),
        );
        profiles_ray_jobs[0] = vec2u(jobs.x, 0u);
        profiles_light_jobs[0] = vec2u(jobs.y, 0u);
        for (var k = 0u; k < 2u; k += 1u) {
            let groups = profiles_groups_of(jobs[k]);
            profiles_groups[4u * k] = groups.x;
            profiles_groups[4u * k + 1u] = groups.y;
            profiles_groups[4u * k + 2u] = 1u;
        }
    }
}
