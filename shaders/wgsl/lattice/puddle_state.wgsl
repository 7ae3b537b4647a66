// Heights and velocities in memory: eight words per quad, or four if they are stored in 16 bits.
// Twin: downpour_lattice::puddle::lattice.

struct PuddleStateQuad {
    // Height, m.
    height: vec4f,
    // Velocity, m/s.
    velocity: vec4f,
}

@group(0) @binding(0) var<uniform> puddle_grid: PuddleGrid;
// A byte per cell.
@group(0) @binding(1) var<storage, read> puddle_links: array<u32>;
@group(0) @binding(2) var<storage, read> puddle_state: array<vec4u>;

// Converts a finite number to a half, to nearest, ties to even. By integers: the built-in functions are not available
// everywhere, and may round either way.
fn puddle_state_half(value: f32) -> u32 {
    let limited = min(max(value, -65504.0), 65504.0);
    let bits = bitcast<u32>(limited);
    let magnitude = bits & 0x7fffffffu;
    let normal = (magnitude + 0xfffu + ((magnitude >> 13u) & 1u) - 0x38000000u) >> 13u;
    // Below 2^-14: in units of 2^-24.
    let small = u32(round(min(abs(limited), 1.0) * 16777216.0));
    return ((bits >> 16u) & 0x8000u) | select(normal, small, magnitude < 0x38800000u);
}

// Converts a finite half to a float.
fn puddle_state_float(half: u32) -> f32 {
    let magnitude = half & 0x7fffu;
    let normal = bitcast<f32>((magnitude << 13u) + 0x38000000u);
    let small = f32(magnitude) * 5.9604645e-8;
    let value = select(normal, small, magnitude < 0x400u);
    return select(value, -value, (half & 0x8000u) != 0u);
}

// Packs height and velocity into 16 bits each.
fn puddle_state_pack(height: f32, velocity: f32) -> u32 {
    return puddle_state_half(height * PUDDLE_HALF_SCALE) | (puddle_state_half(velocity * PUDDLE_HALF_SCALE) << 16u);
}

// Unpacks height and velocity of `puddle_state_pack`.
fn puddle_state_unpack(word: u32) -> vec2f {
    return vec2f(puddle_state_float(word & 0xffffu), puddle_state_float(word >> 16u)) * (1.0 / PUDDLE_HALF_SCALE);
}

// Loads the state of a quad.
fn puddle_state_load(quad: u32) -> PuddleStateQuad {
    if puddle_grid.half_storage != 0u {
        let words = puddle_state[quad];
        let a = puddle_state_unpack(words.x);
        let b = puddle_state_unpack(words.y);
        let c = puddle_state_unpack(words.z);
        let d = puddle_state_unpack(words.w);
        return PuddleStateQuad(vec4f(a.x, b.x, c.x, d.x), vec4f(a.y, b.y, c.y, d.y));
    }
    return PuddleStateQuad(bitcast<vec4f>(puddle_state[2u * quad]), bitcast<vec4f>(puddle_state[2u * quad + 1u]));
}

// Packs a quad into four words of 16-bit numbers.
fn puddle_state_words(h: vec4f, v: vec4f) -> vec4u {
    return vec4u(
        puddle_state_pack(h.x, v.x),
        puddle_state_pack(h.y, v.y),
        puddle_state_pack(h.z, v.z),
        puddle_state_pack(h.w, v.w),
    );
}
