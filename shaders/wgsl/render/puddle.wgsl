// Puddles. Rows of a puddle in the table: middle of the map; its axes and half edges; columns, rows and first texel of it;
// ripples; color and extinction of the water; more of the ripples; the lattice of wakes (puddle_wake.wgsl); how the water runs
// (puddle_flow.wgsl). After the puddles, one row of the ripples' lattice, those of the rings of single drops, and texels.
// Twin: downpour_trace::puddle::rows.

// Water on the ground.
struct RenderPuddle {
    // Middle of the map.
    middle: vec3f,
    // Cosine and sine of the map's turn, and half its edges, m.
    axes: vec4f,
    // Columns, rows and first row of the texels of the map.
    map: vec3u,
    // Ripples: scale, cosine and sine of the angle, influence.
    ripples: vec4f,
    // Albedo of deep water.
    scattering_albedo: vec3f,
    // Fraction of light that is lost per meter of water, 1/m.
    extinction: f32,
    // Depth of full ripples, and the puddle's own part of the lattice.
    own: vec3f,
    // 1: the rings of single drops are shown where they are large enough.
    rings: f32,
}

// The lattice of the ripples of all puddles.
struct RenderRipples {
    // Columns of the finest level; 0: level water.
    size: u32,
    levels: u32,
    // First row of the texels.
    first: u32,
    // Edge of a cell, m.
    cell: f32,
}

// Reads a puddle.
fn puddle_load(index: u32) -> RenderPuddle {
    let row = render_frame.puddles + index * PUDDLE_WATER_ROWS;
    let look = bitcast<vec4f>(render_table[row + 4u]);
    let more = bitcast<vec4f>(render_table[row + 5u]);
    return RenderPuddle(
        bitcast<vec3f>(render_table[row].xyz), bitcast<vec4f>(render_table[row + 1u]), render_table[row + 2u].xyz,
        bitcast<vec4f>(render_table[row + 3u]), look.rgb, look.w, more.xyz, more.w,
    );
}

// Reads the lattice of the ripples.
fn puddle_ripples() -> RenderRipples {
    let head = render_table[render_frame.puddles + render_frame.puddle_count * PUDDLE_WATER_ROWS];
    return RenderRipples(head.x, head.y, head.z, bitcast<f32>(head.w));
}

// Reads a texel of a map or of the ripples.
fn puddle_texel(row: u32) -> vec4f {
    return bitcast<vec4f>(render_table[row]);
}
