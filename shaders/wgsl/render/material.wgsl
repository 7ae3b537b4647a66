// Materials and textures. Rows of a material in the table: base color; emission and metalness; roughness, strength of normals and of
// occlusion, cutoff; flags, transmission, index of refraction and
// porosity; texture slots; color and fraction of diffuse transmission. Rows of a slot: 2 x 2 transform; offset, set of
// coordinates and flags; width, height, first texel and levels.
// Twin: downpour_trace::material.

// Appearance of a surface, with rows of texture slots.
struct RenderMaterial {
    // Base color, linear, and alpha.
    base: vec4f,
    emission: vec3f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    // Below this alpha a masked material has a hole.
    cutoff: f32,
    // SCENE_MASKED, SCENE_BLENDED, SCENE_DOUBLE_SIDED, SCENE_UNLIT.
    flags: u32,
    // Fraction of light that passes a thin dielectric.
    transmission: f32,
    // Fraction of light that leaves it on its other side, scattered evenly.
    diffuse_transmission: f32,
    // Color of that light.
    diffuse_transmission_color: vec3f,
    ior: f32,
    // Porosity; below 0: by the roughness.
    porosity: f32,
    // Slots of base color, metallic-roughness, normal and emission, then of occlusion, transmission, diffuse transmission and its color; SCENE_NONE for
    // none.
    maps: vec4u,
    more: vec4u,
}

// A texture as a material uses it.
struct RenderSlot {
    // Rows of the 2 x 2 part of the coordinates' transform.
    matrix: vec4f,
    offset: vec2f,
    // Set of coordinates, 0 or 1.
    uv_set: u32,
    // SCENE_ROOTED, SCENE_REPEAT_U and its like.
    flags: u32,
    // Width, height, first texel, and levels.
    image: vec4u,
}

// Reads a material.
fn material_load(index: u32) -> RenderMaterial {
    let row = index * SCENE_MATERIAL_ROWS;
    let base = bitcast<vec4f>(render_table[row]);
    let glow = bitcast<vec4f>(render_table[row + 1u]);
    let look = bitcast<vec4f>(render_table[row + 2u]);
    let through = render_table[row + 3u];
    let optics = bitcast<vec3f>(through.yzw);
    let behind = bitcast<vec4f>(render_table[row + 6u]);
    return RenderMaterial(
        base, glow.rgb, glow.w, look.x, look.y, look.z, look.w, through.x, optics.x, behind.w, behind.rgb, optics.y,
        optics.z, render_table[row + 4u], render_table[row + 5u],
    );
}

// Reads a texture slot.
fn material_slot(row: u32) -> RenderSlot {
    let header = render_table[row + 1u];
    return RenderSlot(
        bitcast<vec4f>(render_table[row]), bitcast<vec2f>(header.xy), header.z, header.w, render_table[row + 2u],
    );
}
