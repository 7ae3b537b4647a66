// What holds for all ticks of a call, and places on the pane.
// Twin: downpour_lattice::glass::frame.

struct GlassFrame {
    // Cells along x and y.
    size: vec2u,
    seed: vec2u,
    // Number of the first tick.
    first_step: u32,
    // Time of the first tick and length of a tick, in 1/4096 s.
    first_clock: u32,
    clock_step: u32,
    // How many parts of blades there are in a tick.
    blades: u32,
    // What gravity adds to a velocity in one tick.
    gravity: vec2i,
    // Direction of the air along the pane: a unit vector of 16384.
    air: vec2i,
    // Friction of a moving drop, of 256 of that of a resting one.
    kinetic: u32,
    // A drop that moves by a cell leaves a bead if a word is below this.
    trail_chance: u32,
    // Mean mass of a bead.
    trail_mass: u32,
    // How long glass stays wet, in 1/64 s.
    wet_life: u32,
    // Share of the friction that wet glass takes away, of 256.
    wet_ease: u32,
    // How strongly affinity and wetness draw a drop, in sixteenths.
    affinity_pull: u32,
    wet_pull: u32,
    unused: u32,
    // Probability that at least 1, 2, 3, ... 8 drops land in a block in one tick, of 2^32.
    rain_few: vec4u,
    rain_many: vec4u,
}

// Where a cell stands in memory.
fn glass_frame_index(frame: GlassFrame, cell: vec2i) -> u32 {
    return u32(cell.y) * frame.size.x + u32(cell.x);
}

// The cell that stands at a place of memory.
fn glass_frame_cell(frame: GlassFrame, index: u32) -> vec2i {
    return vec2i(i32(index % frame.size.x), i32(index / frame.size.x));
}

// Whether a cell is on the pane.
fn glass_frame_holds(frame: GlassFrame, cell: vec2i) -> bool {
    return all(cell >= vec2i(0)) && all(cell < vec2i(frame.size));
}

// How many drops land in a block of cells, from a random word.
fn glass_frame_landing(frame: GlassFrame, word: u32) -> u32 {
    let few = select(vec4u(0u), vec4u(1u), vec4u(word) < frame.rain_few);
    let many = select(vec4u(0u), vec4u(1u), vec4u(word) < frame.rain_many);
    let both = few + many;
    return both.x + both.y + both.z + both.w;
}
