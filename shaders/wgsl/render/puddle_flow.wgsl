// Running water: velocities of a puddle's map, and ripples that it takes along. A pattern that moved with different speeds for long would
// be torn, so two are shown, each for a time around which it is whole, one after the other.
// A row behind those of the puddle has the first texel, the phase and the number of the cycle. A texel has two cells, of each the velocity and the
// slope of the surface, as halves.
// Twin: downpour_trace::scene::puddle_flow.

struct PuddleFlow {
    // First row of the texels; 0: all water stands.
    first: u32,
    // Part of the present cycle that is over.
    phase: f32,
    cycle: u32,
}

// Reads how the water of a puddle runs.
fn puddle_flow_load(puddle: u32) -> PuddleFlow {
    let row = render_table[render_frame.puddles + puddle * PUDDLE_WATER_ROWS + PUDDLE_FLOW_ROW];
    return PuddleFlow(row.x, bitcast<f32>(row.y), row.z);
}

// Velocity along x and z, m/s, and slopes of the surface along them, of a cell of a map.
fn puddle_flow_texel(first: u32, map: vec3u, x: i32, y: i32) -> vec4f {
    let column = u32(clamp(x, 0, i32(map.x) - 1));
    let line = u32(clamp(y, 0, i32(map.y) - 1));
    let index = line * map.x + column;
    let row = render_table[first + index / 2u];
    let words = select(row.xy, row.zw, (index & 1u) == 1u);
    return vec4f(unpack2x16float(words.x), unpack2x16float(words.y));
}

// The same over a position of a puddle, bilinear.
fn puddle_flow_at(first: u32, puddle: RenderPuddle, position: vec3f) -> vec4f {
    let axes = puddle.axes;
    let map = puddle.map;
    let dx = position.x - puddle.middle.x;
    let dz = position.z - puddle.middle.z;
    let u = ((dx * axes.x + dz * axes.y) / axes.z * 0.5 + 0.5) * f32(map.x) - 0.5;
    let v = ((dz * axes.x - dx * axes.y) / axes.w * 0.5 + 0.5) * f32(map.y) - 0.5;
    let x = i32(floor(u));
    let y = i32(floor(v));
    let fx = u - floor(u);
    let fy = v - floor(v);
    let upper = puddle_flow_texel(first, map, x, y) * (1.0 - fx) + puddle_flow_texel(first, map, x + 1, y) * fx;
    let lower = puddle_flow_texel(first, map, x, y + 1) * (1.0 - fx) + puddle_flow_texel(first, map, x + 1, y + 1) * fx;
    return upper * (1.0 - fy) + lower * fy;
}

// How much ripples move with water of a speed, m/s: 0 those of standing water.
fn puddle_flow_moves(speed: f32) -> f32 {
    return smoothstep(0.0, PUDDLE_FLOW_SLOW, speed);
}

// Of the first or the second pattern: time since it was whole, s, and how much of it is shown.
fn puddle_flow_phase(phase: f32, second: u32) -> vec2f {
    let own = phase + 0.5 * f32(second);
    let part = own - floor(own);
    return vec2f((part - 0.5) * PUDDLE_FLOW_PERIOD, 1.0 - abs(2.0 * part - 1.0));
}

// Place of the first or the second pattern in the ripples, another in each cycle.
fn puddle_flow_place(phase: f32, cycle: u32, second: u32) -> vec2f {
    // The second begins in the middle of the first.
    let own = cycle + select(0u, 1u, second == 1u && phase >= 0.5);
    let number = 2u * own + second;
    return vec2f(f32(number % 61u) * 1.37, f32(number % 67u) * 2.11);
}
