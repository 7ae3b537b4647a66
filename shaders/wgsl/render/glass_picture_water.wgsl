// Water on a pane as smooth surfaces: each drop is a cap of a sphere over its disk, with an outline that is not quite round,
// drawn out behind if it runs, and steeper on the side to which its weight pulls it (from the receding angle to the
// advancing one). Water ahead of a wiper is a ridge: pieces of a cylinder with round ends, which overlap.
// Meters on the pane: x right, y down it, z out of it, away from the eye.
// Twin: downpour_render::glass::water.

struct GlassPictureDrop {
    // Middle of the disk.
    center: vec2f,
    // Radius of the disk, and of the sphere whose cap it is.
    radius: f32,
    sphere: f32,
    // Direction in which it runs, of length 1.
    along: vec2f,
    // Inverse of how much longer it is behind its middle than before it.
    behind: f32,
    // Relative excess of the slope on one side over that on the other.
    lean: f32,
    // Direction of the steeper side, of length 1.
    droop: vec2f,
    // Half of the axis of a ridge: the cap is that of the nearest position of the axis. 0: a drop.
    axis: vec2f,
    // The outline: what is added to the squared distance with the cosine and the sine of twice the angle, and of thrice.
    lobes: vec4f,
}

// Vector from the center of a drop, or the nearest position of a ridge's axis, to a position.
fn glass_picture_water_away(drop: GlassPictureDrop, position: vec2f) -> vec2f {
    let away = position - drop.center;
    let axis = drop.axis;
    let squared = axis.x * axis.x + axis.y * axis.y;
    let fraction = (away.x * axis.x + away.y * axis.y) / max(squared, 1.0e-18);
    return away - axis * clamp(fraction, -1.0, 1.0);
}

// Height over the glass, and its slopes along x and y. Beyond the outline the height is below 0.
fn glass_picture_water_cap(drop: GlassPictureDrop, position: vec2f) -> vec3f {
    let away = glass_picture_water_away(drop, position);
    let ahead = away.x * drop.along.x + away.y * drop.along.y;
    let stretch = select(drop.behind, 1.0, ahead > 0.0);
    let x = ahead * stretch;
    let y = away.y * drop.along.x - away.x * drop.along.y;
    let l = drop.lobes;
    let r = 1.0 / drop.radius;
    let squared = x * x + y * y + l.x * (x * x - y * y) + l.y * (2.0 * x * y)
        + (l.z * (x * x * x - 3.0 * x * y * y) + l.w * (3.0 * x * x * y - y * y * y)) * r;
    let of_x = 2.0 * x + l.x * (2.0 * x) + l.y * (2.0 * y)
        + (l.z * (3.0 * x * x - 3.0 * y * y) + l.w * (6.0 * x * y)) * r;
    let of_y = 2.0 * y - l.x * (2.0 * y) + l.y * (2.0 * x)
        + (l.w * (3.0 * x * x - 3.0 * y * y) - l.z * (6.0 * x * y)) * r;
    let whole = drop.sphere * drop.sphere;
    let root = sqrt(max(whole - squared, whole * 1.0e-4));
    let height = root - sqrt(whole - drop.radius * drop.radius);
    let steep = -0.5 / root;
    let down_x = steep * of_x * stretch;
    let down_y = steep * of_y;
    let slope = drop.along * down_x + vec2f(-drop.along.y, drop.along.x) * down_y;
    let pulled = drop.lean * r;
    // A ridge grows along its axis.
    let off = position - drop.center;
    let fraction = max(1.0 + pulled * (off.x * drop.droop.x + off.y * drop.droop.y), 0.1);
    return vec3f(height * fraction, slope * fraction + drop.droop * (height * pulled));
}

// The highest that a drop may be.
fn glass_picture_water_top(drop: GlassPictureDrop) -> f32 {
    let whole = drop.sphere * drop.sphere;
    return (drop.sphere - sqrt(whole - drop.radius * drop.radius)) * (1.0 + 1.5 * drop.lean);
}

// Height at which a ray that enters a drop at a position of the glass leaves it. `aside` is how far it goes along the pane for
// each meter away from it. The bracket of regula falsi (Illinois).
fn glass_picture_water_leave(drop: GlassPictureDrop, position: vec2f, aside: vec2f) -> f32 {
    var low = 0.0;
    var high = glass_picture_water_top(drop);
    var above = glass_picture_water_cap(drop, position).x;
    var below = glass_picture_water_cap(drop, position + aside * high).x - high;
    if below >= 0.0 {
        return high;
    }
    var z = 0.0;
    var side = 0;
    for (var k = 0u; k < GLASS_PICTURE_TURNS; k += 1u) {
        z = low + (high - low) * (above / (above - below));
        let off = glass_picture_water_cap(drop, position + aside * z).x - z;
        if off > 0.0 {
            low = z;
            above = off;
            below = select(below, 0.5 * below, side == 1);
            side = 1;
        } else {
            high = z;
            below = off;
            above = select(above, 0.5 * above, side == 2);
            side = 2;
        }
    }
    return z;
}

// The unit normal of a surface from its slopes.
fn glass_picture_water_normal(slope: vec2f) -> vec3f {
    return vec3f(-slope, 1.0) / sqrt(1.0 + slope.x * slope.x + slope.y * slope.y);
}
