// Waves that bodies make which move through a puddle: slopes of a lattice of the puddle's own, beside the ripples of the rain.
// A row behind those of the puddle has columns, rows and first texel of the lattice, and the edge of a cell. The lattice begins at the corner of
// the puddle's map and may reach beyond it.
// Twin: downpour_trace::scene::puddle_wake.

struct PuddleWake {
    // Columns, rows and first texel; 0 columns: nothing has moved through the water.
    lattice: vec3u,
    // Edge of a cell, m.
    cell: f32,
}

// Reads the lattice of a puddle's wakes.
fn puddle_wake_load(puddle: u32) -> PuddleWake {
    let row = render_table[render_frame.puddles + puddle * PUDDLE_WATER_ROWS + PUDDLE_WAKE_ROW];
    return PuddleWake(row.xyz, bitcast<f32>(row.w));
}

// A texel of the lattice: slopes along x and z, and the mean of the square of the slope around it.
fn puddle_wake_texel(lattice: vec3u, x: i32, y: i32) -> vec4f {
    let column = clamp(x, 0, i32(lattice.x) - 1);
    let line = clamp(y, 0, i32(lattice.y) - 1);
    return puddle_texel(lattice.z + u32(line) * lattice.x + u32(column));
}

// How much of the waves is shown as slopes with a footprint, in cells: none where they are smaller than the footprint.
fn puddle_wake_shown(footprint: f32) -> f32 {
    return 1.0 - smoothstep(PUDDLE_WAKE_FINE, PUDDLE_WAKE_COARSE, footprint);
}

// Slopes along x and z of the waves in a puddle, and the variance of the slope within a footprint (m).
fn puddle_wake_slope(number: u32, position: vec3f, footprint: f32, depth: f32) -> vec3f {
    let wake = puddle_wake_load(number);
    if wake.lattice.x == 0u {
        return vec3f(0.0);
    }
    let puddle = puddle_load(number);
    let axes = puddle.axes;
    let dx = position.x - puddle.middle.x;
    let dz = position.z - puddle.middle.z;
    let u = (dx * axes.x + dz * axes.y + axes.z) / wake.cell - 0.5;
    let v = (dz * axes.x - dx * axes.y + axes.w) / wake.cell - 0.5;
    let x = i32(floor(u));
    let y = i32(floor(v));
    let fx = u - floor(u);
    let fy = v - floor(v);
    let lattice = wake.lattice;
    let upper = puddle_wake_texel(lattice, x, y) * (1.0 - fx) + puddle_wake_texel(lattice, x + 1, y) * fx;
    let lower = puddle_wake_texel(lattice, x, y + 1) * (1.0 - fx) + puddle_wake_texel(lattice, x + 1, y + 1) * fx;
    let mixed = upper * (1.0 - fy) + lower * fy;
    let shown = puddle_wake_shown(footprint / wake.cell);
    let strength = puddle.ripples.w * smoothstep(0.0, max(puddle.own.x, 1.0e-6), depth);
    return vec3f(mixed.xy * (strength * shown), mixed.z * strength * strength * (1.0 - shown * shown));
}
