// Counter-based random numbers: a number is a hash of (seed, id, step, dimension). There is no state, so
// numbers can be drawn in any order, on any device, and at any time step.
// Source: M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020 (pcg4d).
// Twin: downpour_math::rng.

// One round of products between the words.
fn rng_pcg4d_stir(words: vec4u) -> vec4u {
    var v = words;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Mixes four words: each bit of the result depends on each bit of the argument.
fn rng_pcg4d(words: vec4u) -> vec4u {
    let v = rng_pcg4d_stir(words * RNG_PCG_MULTIPLIER + RNG_PCG_INCREMENT);
    return rng_pcg4d_stir(v ^ (v >> vec4u(16u)));
}

// Four words for (64-bit seed as low and high word, id, step, dimension).
fn rng_draw(seed: vec2u, id: u32, step: u32, dimension: u32) -> vec4u {
    let first = rng_pcg4d(vec4u(id, step, dimension, seed.x));
    let second = rng_pcg4d(first + vec4u(seed.y, 0u, 0u, dimension));
    // The high bits of the high seed word have passed through one hash only: one more round spreads them.
    return rng_pcg4d_stir(second ^ (second >> vec4u(16u)));
}

// Maps a word to a number in [0, 1), a multiple of 2^-24.
fn rng_unit(word: u32) -> f32 {
    return f32(word >> 8u) * RNG_UNIT_STEP;
}

// Maps a word to a number in (0, 1], a multiple of 2^-24: safe under a logarithm.
fn rng_unit_positive(word: u32) -> f32 {
    return f32((word >> 8u) + 1u) * RNG_UNIT_STEP;
}
