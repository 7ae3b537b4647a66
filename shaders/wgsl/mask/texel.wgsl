// One texel of a mask: what the drop does to the viewer's ray through it.
// Host type: downpour_mask::MaskTexel.

struct MaskTexel {
    // Direction of the light that is seen through the drop; 0 where nothing is traced.
    direction: vec3f,
    // Covered fraction of the texel.
    coverage: f32,
    // Direction of the light that is seen by reflection on the outside.
    reflected: vec3f,
    // Fraction of unpolarized light that comes through.
    transmittance: f32,
    // Direction of the light that is seen after one reflection inside that was not total.
    internal: vec3f,
    // Fraction of unpolarized light that comes so.
    internal_transmittance: f32,
    // Total reflections inside.
    reflections: u32,
}
