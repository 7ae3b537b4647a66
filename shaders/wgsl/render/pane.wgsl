// The pane that throws shadows. Rows in the table: corner and texels in a meter; right, down and outward with the pane's width, height
// and the form; size, first row after the pane's and last level of the texels; mean radius and focal length of the drops; levels; texels.
// Twin: downpour_render::glass::shade.

// A pane before the lamps.
struct RenderPane {
    corner: vec3f,
    texels_per_meter: f32,
    across: vec3f,
    // Width, m.
    width: f32,
    down: vec3f,
    // Height, m.
    height: f32,
    outward: vec3f,
    // PANE_SHADOW_LENS or PANE_SHADOW_TATARCHUK.
    form: u32,
    // First row of the texels.
    first: u32,
    // Coarsest level.
    last: u32,
    // Mean radius and focal length of the drops, m.
    drops: vec2f,
}

// Reads the pane.
fn pane_load() -> RenderPane {
    let row = render_frame.pane;
    let corner = bitcast<vec4f>(render_table[row]);
    let across = bitcast<vec4f>(render_table[row + 1u]);
    let down = bitcast<vec4f>(render_table[row + 2u]);
    let outward = render_table[row + 3u];
    let texels = render_table[row + 4u];
    return RenderPane(
        corner.xyz, corner.w, across.xyz, across.w, down.xyz, down.w, bitcast<vec3f>(outward.xyz), outward.w,
        row + texels.z, texels.w, bitcast<vec2f>(render_table[row + 5u].xy),
    );
}

// Reads columns, rows and first texel of a level.
fn pane_level(level: u32) -> vec3u {
    return render_table[render_frame.pane + PANE_SHADOW_LEVELS + level].xyz;
}

// Reads eight texels.
fn pane_texels(row: u32) -> vec4u {
    return render_table[row];
}
