// Crowns of the splashes of drops that have hit something, as a picture shows them.
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
    // Root of the Weber number of a drop of 1 m at 1 m/s.
    strength: f32,
    // Radius of the crown of a drop of 1 m far above the threshold, m.
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

// Root of the Weber number of a drop that meets a surface with a speed toward it.
fn splash_parameter(strength: f32, diameter: f32, speed: f32) -> f32 {
    return strength * speed * sqrt(diameter);
}

// Part of the energy of a drop that is beyond the energy of one that just splashes, from the root of its Weber number.
fn splash_surplus(root: f32) -> f32 {
    let ratio = SPLASH_THRESHOLD / max(root, SPLASH_THRESHOLD);
    return 1.0 - ratio * ratio;
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
    let surplus = splash_surplus(splash_parameter(splash_frame.strength, drop.diameter, toward));
    if normal.y < SPLASH_LEVEL || surplus <= 0.0 {
        return crown;
    }
    let duration = min(SPLASH_RISE_TIMES * surplus * drop.diameter / toward / SPLASH_RISE_SHARE, SPLASH_MAX_S);
    if age < 0.0 || age >= duration {
        return crown;
    }
    let chance = rng_unit(rng_draw(vec2u(drop.id_low, drop.id ^ drop.id_low), 0u, 0u, SPLASH_SIZE).x);
    let random = SPLASH_MIN_SIZE + (SPLASH_MAX_SIZE - SPLASH_MIN_SIZE) * chance;
    let radius = splash_frame.radius * drop.diameter * sqrt(sqrt(drop.diameter) * surplus) * random;
    let offset = drop.offset + drop.velocity * drop.present.y + normal * (radius * splash_middle(age / duration));
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
        eye_drop_standing(normal),
        drop.id_low ^ SPLASH_LOW,
    );
}
