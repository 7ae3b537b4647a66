// Crowns of the splashes of drops that have hit something in a slice of time.
// Method: the drops of the slice are found as those of a picture with that exposure (main_field_find), and what they hit as what stops
// drops while the shutter is open (main_shelter). The crowns are added to the list of the picture.
// Twin: downpour_sim::impacts::splash_frame.

struct SplashFrame {
    // Outward normals of the pyramid of the picture.
    sides: array<vec4f, FIELD_SIDES>,
    // A pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pane: vec4f,
    // Position of the eye relative to the obstacles, m.
    eye: vec3f,
    // Half the length of the slice, s.
    half_time: f32,
    // Time of the picture from the middle of the slice, s.
    now: f32,
    // Splash parameter of a drop of 1 m at 1 m/s.
    strength: f32,
    // Radius of the crown of a drop of 1 m, m.
    radius: f32,
    // Distance up to which crowns are listed: by their radius, and in any case, m.
    per_radius: f32,
    farthest: f32,
    // Room for the drops of the slice.
    drops: u32,
    // Places of the list before the first that is searched for, and room after it.
    first: u32,
    room: u32,
}

@group(0) @binding(0) var<uniform> splash_frame: SplashFrame;
// Drops of the slice, and how many of them were found.
@group(0) @binding(3) var<storage, read> splash_drops: array<EyeDrop>;
@group(0) @binding(4) var<storage, read> splash_counts: array<u32>;
// The list of the picture, and how many have been found.
@group(0) @binding(5) var<storage, read_write> splash_list: array<EyeDrop>;
@group(0) @binding(6) var<storage, read_write> splash_found: array<atomic<u32>, 2>;

// Splash parameter of a drop that meets a surface with a speed toward it.
fn splash_parameter(strength: f32, diameter: f32, speed: f32) -> f32 {
    return strength * speed * sqrt(sqrt(speed)) * sqrt(diameter * sqrt(diameter));
}

// Half the height of a crown at a stage, in its radius.
fn splash_middle(stage: f32) -> f32 {
    let rise = clamp(stage / SPLASH_RISE_SHARE, 0.0, 1.0);
    let fall = clamp((stage - SPLASH_RISE_SHARE) / (1.0 - SPLASH_RISE_SHARE), 0.0, 1.0);
    let left = 1.0 - fall;
    let up = rise * (2.0 - rise);
    let height = 0.05 + (SPLASH_WALL - 0.05) * up * left * sqrt(left) - 0.045 * fall;
    let fingers = 0.01 + (SPLASH_FINGERS - 0.01) * up * (1.0 - fall * fall) - 0.008 * fall;
    return 0.5 * (height + fingers);
}

// Crown of a drop that has met a surface with a normal, as the picture shows it; of diameter 0 if there is none.
fn splash_crown(drop: EyeDrop, normal: vec3f) -> EyeDrop {
    var crown = drop;
    crown.diameter = 0.0;
    let age = splash_frame.now - drop.present.y;
    let toward = -dot(drop.velocity, normal);
    if normal.y < SPLASH_LEVEL || toward <= 0.0
        || splash_parameter(splash_frame.strength, drop.diameter, toward) <= SPLASH_THRESHOLD {
        return crown;
    }
    let duration = min(SPLASH_RISE_TIMES * drop.diameter / toward / SPLASH_RISE_SHARE, SPLASH_MAX_S);
    if age < 0.0 || age >= duration {
        return crown;
    }
    let chance = rng_unit(rng_draw(vec2u(drop.id_low, drop.id ^ drop.id_low), 0u, 0u, SPLASH_SIZE).x);
    let random = SPLASH_MIN_SIZE + (SPLASH_MAX_SIZE - SPLASH_MIN_SIZE) * chance;
    let radius = splash_frame.radius * drop.diameter * sqrt(sqrt(drop.diameter)) * random;
    let offset = drop.offset + drop.velocity * drop.present.y
        + vec3f(0.0, radius * splash_middle(age / duration), 0.0);
    let range = min(radius * splash_frame.per_radius, splash_frame.farthest);
    if sqrt(dot(offset, offset)) >= range || dot(splash_frame.pane.xyz, offset) < splash_frame.pane.w {
        return crown;
    }
    for (var k = 0u; k < FIELD_SIDES; k += 1u) {
        // The mask reaches beyond the largest radius, to the droplets of the rim.
        if dot(splash_frame.sides[k].xyz, offset) > 1.5 * radius {
            return crown;
        }
    }
    return EyeDrop(
        offset,
        2.0 * radius,
        vec3f(0.0),
        drop.id ^ SPLASH_HIGH ^ SPLASH_LOW,
        vec2f(-age, duration - age),
        FIELD_SPLASH,
        drop.id_low ^ SPLASH_LOW,
    );
}

@compute @workgroup_size(64, 1, 1)
fn main_splash(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index == 0u && splash_counts[0] > splash_frame.drops {
        // Drops without room are told as such of the list.
        atomicMax(&splash_found[0], splash_frame.room + splash_counts[0] - splash_frame.drops);
    }
    if index >= splash_frame.drops {
        return;
    }
    let drop = splash_drops[index];
    if drop.diameter <= 0.0 || drop.present.y > splash_frame.half_time {
        return;
    }
    let start = splash_frame.eye + drop.offset - drop.velocity * splash_frame.half_time;
    let met = drop.present.y + splash_frame.half_time;
    let hit = bvh_hit(start, drop.velocity, met - SPLASH_AGAIN, met + SPLASH_AGAIN);
    if hit.distance < 0.0 {
        return;
    }
    let crown = splash_crown(drop, impact_facing(bvh_triangles[hit.triangle], drop.velocity));
    if crown.diameter > 0.0 {
        let slot = atomicAdd(&splash_found[0], 1u);
        if slot < splash_frame.room {
            splash_list[splash_frame.first + slot] = crown;
        }
    }
}
