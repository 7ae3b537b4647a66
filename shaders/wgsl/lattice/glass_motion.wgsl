// Motion of a drop on a pane: forces, friction, and the choice among the three cells ahead of it.
//
// Tatarchuk & Isidoro 2006, section 5, after Kaneda et al. 1999; the static friction is Furmidge's. Velocities are
// integers: 16384 is one cell per tick. Directions are octants: 0 along +x, then by eighths of a turn toward +y,
// which is down the pane. Divisions of signed numbers round toward 0, shifts of them down, as in Rust.
// Twin: downpour_lattice::glass::motion.

// Integer part of the square root of a number below 2^31.
fn glass_motion_root(n: u32) -> u32 {
    // The device's root may be off by a few units in the last place; the integers correct it.
    var root = u32(sqrt(f32(n)));
    while root * root > n {
        root -= 1u;
    }
    while (root + 1u) * (root + 1u) <= n {
        root += 1u;
    }
    return root;
}

// Length of a vector whose components are below 2^15.
fn glass_motion_length(v: vec2i) -> u32 {
    return glass_motion_root(u32(v.x * v.x + v.y * v.y));
}

// Packs a velocity into a word.
fn glass_motion_pack(v: vec2i) -> u32 {
    return (u32(v.x) & 0xffffu) | (u32(v.y) << 16u);
}

// Unpacks a velocity from a word.
fn glass_motion_unpack(word: u32) -> vec2i {
    return vec2i(i32(word << 16u) >> 16u, i32(word) >> 16u);
}

// Octant of a vector below 2^15.
fn glass_motion_octant(v: vec2i) -> u32 {
    let size = abs(v);
    // tan(22.5 degrees) = 106 / 256.
    if 256 * min(size.x, size.y) > 106 * max(size.x, size.y) {
        if v.y > 0 {
            return select(3u, 1u, v.x > 0);
        }
        return select(5u, 7u, v.x > 0);
    }
    if size.x > size.y {
        return select(4u, 0u, v.x > 0);
    }
    return select(6u, 2u, v.y >= 0);
}

// Offset of the next cell along an octant.
fn glass_motion_offset(octant: u32) -> vec2i {
    let o = octant & 7u;
    let x = select(0, 1, o == 7u || o < 2u) - select(0, 1, o > 2u && o < 6u);
    let y = select(0, 1, o > 0u && o < 4u) - select(0, 1, o > 4u);
    return vec2i(x, y);
}

// Component of the unit vector along an octant, in units of 1/256.
fn glass_motion_unit(octant: u32) -> i32 {
    return select(256, 181, (octant & 1u) == 1u);
}

// Velocity after a tick: driven, slowed by friction that never reverses it and by the viscosity of the water, and
// limited to one cell per tick.
fn glass_motion_slide(v: vec2i, drive: vec2i, hold: u32, slow: u32) -> vec2i {
    let driven = clamp(v + drive, vec2i(-32767), vec2i(32767));
    let size = glass_motion_length(driven);
    if size <= hold {
        return vec2i(0);
    }
    let left = driven - driven * i32(hold) / i32(size);
    let slowed = left * i32(slow) / GLASS_CELL;
    let speed = glass_motion_length(slowed);
    if speed > u32(GLASS_CELL) {
        return slowed * GLASS_CELL / i32(speed);
    }
    return slowed;
}

// Weight of a cell in the random choice: the fourth power of the velocity's fraction along it, times the attraction of
// affinity, times that of wetness. At most 2^14.
fn glass_motion_weight(v: vec2i, octant: u32, affinity: u32, wetness: u32, pull: vec2u) -> u32 {
    let step = glass_motion_offset(octant);
    let size = i32(max(glass_motion_length(v), 1u));
    let along = u32(clamp((v.x * step.x + v.y * step.y) * glass_motion_unit(octant) / size, 0, 256));
    let squared = (along * along) >> 8u;
    let grip = min(64u + ((affinity * pull.x) >> 4u), 1023u);
    let wet = min(256u + ((wetness * pull.y) >> 4u), 2047u);
    return (((squared * squared) >> 8u) * grip * wet) >> 15u;
}

// Chooses one of three by a random word and their weights (at most 2^14 each); 3 if all weights are 0.
fn glass_motion_choose(weights: vec3u, word: u32) -> u32 {
    let sum = weights.x + weights.y + weights.z;
    if sum == 0u {
        return 3u;
    }
    let at = ((word >> 16u) * sum) >> 16u;
    return select(select(2u, 1u, at < weights.x + weights.y), 0u, at < weights.x);
}

// Turns a velocity by a quarter of the difference toward an octant.
fn glass_motion_turn(v: vec2i, octant: u32) -> vec2i {
    let size = i32(glass_motion_length(v));
    let along = glass_motion_offset(octant) * ((size * glass_motion_unit(octant)) / 256);
    return (v * 3 + along) / 4;
}

// Velocity of a drop after merging with drops at rest.
fn glass_motion_merged(v: vec2i, class_before: u32, mass: u32) -> vec2i {
    if glass_size_class(mass) <= class_before {
        return v;
    }
    let fraction = (glass_size_floor(class_before) << 10u) / glass_size_floor(glass_size_class(mass));
    return v * i32(fraction) / 1024;
}

// Wetness of the glass where water moved at `stamp` (0: never), 0 to 255.
fn glass_motion_wetness(clock: u32, stamp: u32, life: u32) -> u32 {
    if stamp == 0u {
        return 0u;
    }
    let age = min((clock - min(clock, stamp)) >> 6u, life);
    return 255u - age * 255u / life;
}
