// Parameters of a call, and indices of cells.
// Twin: downpour_lattice::glass::frame.

struct GlassFrame {
    // Number of cells along x and y.
    size: vec2u,
    seed: vec2u,
    // Number of the first tick.
    first_step: u32,
    // Time of the first tick and length of a tick, in 1/4096 s.
    first_clock: u32,
    clock_step: u32,
    // Number of blade parts per tick.
    blades: u32,
    // Change of velocity by gravity in one tick.
    gravity: vec2i,
    // Direction of the air along the pane: a unit vector of length 16384.
    air: vec2i,
    // Friction of a moving drop relative to that of a resting one, in units of 1/256.
    kinetic: u32,
    // A drop that moves by a cell leaves a bead if a random word is below this.
    trail_chance: u32,
    // Mean mass of a bead.
    trail_mass: u32,
    // Time that glass stays wet, in 1/64 s.
    wet_life: u32,
    // Fraction by which wetness reduces friction, in units of 1/256.
    wet_ease: u32,
    // Attraction by affinity and by wetness, in sixteenths.
    affinity_pull: u32,
    wet_pull: u32,
    // Fraction of its water that flows down a vertical ridge by a cell in one tick, in units of 1/262144 for each unit
    // of mass.
    ridge_drain: u32,
    // Mass of a cell of a level ridge from which on it sags.
    ridge_hold: u32,
    // Ticks for which a ridge takes all drops that it touches after a blade has pushed it.
    ridge_fresh: u32,
    unused_1: u32,
    unused_2: u32,
    // Probability that at least 1, 2, 3, ... 8 drops land in a block in one tick, in units of 2^-32.
    rain_few: vec4u,
    rain_many: vec4u,
}

// Index of a cell in memory.
fn glass_frame_index(frame: GlassFrame, cell: vec2i) -> u32 {
    return u32(cell.y) * frame.size.x + u32(cell.x);
}

// Cell at an index in memory.
fn glass_frame_cell(frame: GlassFrame, index: u32) -> vec2i {
    return vec2i(i32(index % frame.size.x), i32(index / frame.size.x));
}

// True if a cell is on the pane.
fn glass_frame_holds(frame: GlassFrame, cell: vec2i) -> bool {
    return all(cell >= vec2i(0)) && all(cell < vec2i(frame.size));
}

// Number of drops that land in a block of cells, from a random word.
fn glass_frame_landing(frame: GlassFrame, word: u32) -> u32 {
    let few = select(vec4u(0u), vec4u(1u), vec4u(word) < frame.rain_few);
    let many = select(vec4u(0u), vec4u(1u), vec4u(word) < frame.rain_many);
    let both = few + many;
    return both.x + both.y + both.z + both.w;
}
