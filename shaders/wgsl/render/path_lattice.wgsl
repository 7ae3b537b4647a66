// Random numbers of a pixel's rays, of which the mean over a window of pixels has no pattern.
// Twin: downpour_trace::path::lattice.

// Words for the rays of sample k of a pixel. The first three are those of a rank-1 lattice, of which the pixels of any
// window of the filter's size have each point once; the last is the pixel's own.
fn path_lattice_words(x: u32, y: u32, k: u32) -> vec4u {
    let seed = rng_draw(vec2u(render_frame.camera.seed, 0u), k, 0u, PATH_DIMENSION);
    let edge = 2u * SKYLIGHT_RADIUS + 1u;
    let points = edge * edge;
    // Scattered, so that a part of the window has points from everywhere.
    let index = ((x % edge) * edge + y % edge) * PATH_LATTICE_SCATTER % points;
    let step = 4294967295u / points;
    return vec4u(
        index * step + seed.x,
        (index * PATH_LATTICE_SECOND % points) * step + seed.y,
        (index * PATH_LATTICE_THIRD % points) * step + seed.z,
        rng_pcg4d(vec4u(x, y, k, seed.w)).x,
    );
}

// Numbers in [0, 1) for ray `index` of `count` of a turn: two for its direction, one for its survival, one for a lamp.
fn path_lattice_numbers(random: vec4u, turn: u32, bounce: u32, index: u32, count: u32) -> vec4f {
    let words = rng_pcg4d(vec4u(random.w, turn, bounce, PATH_DIMENSION));
    let own = vec4f(rng_unit(words.x), rng_unit(words.y), rng_unit(words.z), rng_unit(words.w));
    if bounce > 0u {
        return own;
    }
    // Not quite on the lattice's points, so that their images are not seen one by one.
    let a = fract(rng_unit(random.x) + own.x * PATH_JITTER);
    let b = fract(rng_unit(random.y) + own.y * PATH_JITTER);
    let k = f32(index);
    return vec4f(fract((k + a) / f32(count)), fract(k * 0.618034 + b), own.z, fract(k * 0.618034 + rng_unit(random.z)));
}
