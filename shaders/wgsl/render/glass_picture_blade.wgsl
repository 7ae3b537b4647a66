// Blade and arm of a wiper on a pane, as outlines in the pane's coordinates: a rubber lip, the holder behind it, which narrows toward
// its ends, and the arm from the pivot to the blade's middle. They are opaque, and as far from the eye as the pane.
// Law: while the shutter is open the blade passes through the given directions; a sample of a pixel sees it at one moment.
// Limits: the faces are diffuse, and round across; drops do not refract the blade, and it casts no shadow.
// Twin: downpour_render::glass::blade.

struct GlassPictureBlade {
    // Meters on the pane: x right, y down it.
    pivot: vec2f,
    // Start and end of the rubber, m from the pivot.
    reach: vec2f,
    // Directions of the blade, of length 1, at even times from the opening of the shutter to its closing: two to a vector.
    directions: array<vec4f, GLASS_PICTURE_BLADE_ROWS>,
}

// A direction of the blade, by its number.
fn glass_picture_blade_direction(blade: GlassPictureBlade, k: u32) -> vec2f {
    let two = blade.directions[k / 2u];
    return select(two.zw, two.xy, k % 2u == 0u);
}

// Direction of the blade, of length 1, at a fraction of the time that the shutter is open.
fn glass_picture_blade_at(blade: GlassPictureBlade, fraction: f32) -> vec2f {
    let last = f32(2u * GLASS_PICTURE_BLADE_ROWS - 1u);
    let at = clamp(fraction, 0.0, 1.0) * last;
    let low = min(floor(at), last - 1.0);
    let part = at - low;
    let k = u32(low);
    let v = glass_picture_blade_direction(blade, k) * (1.0 - part) + glass_picture_blade_direction(blade, k + 1u) * part;
    return v / sqrt(max(dot(v, v), 1.0e-12));
}

// What a position of the pane shows of a blade that points in a direction of length 1: how far across the part the position is, -1 to 1,
// and the part's diffuse reflectance, 0 where there is none.
fn glass_picture_blade_part(blade: GlassPictureBlade, direction: vec2f, position: vec2f) -> vec2f {
    let away = position - blade.pivot;
    let along = away.x * direction.x + away.y * direction.y;
    let aside = away.y * direction.x - away.x * direction.y;
    let length = max(blade.reach.y - blade.reach.x, 1.0e-6);
    let share = (along - blade.reach.x) / length;
    if share >= 0.0 && share <= 1.0 {
        if abs(aside) <= GLASS_PICTURE_LIP {
            return vec2f(aside / GLASS_PICTURE_LIP, GLASS_PICTURE_RUBBER);
        }
        let half = GLASS_PICTURE_HOLDER + (GLASS_PICTURE_HOLDER_END - GLASS_PICTURE_HOLDER) * abs(2.0 * share - 1.0);
        if abs(aside) <= half {
            return vec2f(aside / half, GLASS_PICTURE_METAL);
        }
    }
    let middle = max(0.5 * (blade.reach.x + blade.reach.y), 1.0e-6);
    let of_arm = along / middle;
    if of_arm >= 0.0 && of_arm <= 1.0 {
        let half = GLASS_PICTURE_ARM + (GLASS_PICTURE_ARM_END - GLASS_PICTURE_ARM) * of_arm;
        if abs(aside) <= half {
            return vec2f(aside / half, GLASS_PICTURE_METAL);
        }
    }
    return vec2f(0.0);
}
