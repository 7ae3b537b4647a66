// The mask of a drop of revolution: one invocation per texel, rows from the top.
// Twin: downpour_mask::drop.

@group(0) @binding(0) var<uniform> mask_drop_traced: MaskTracedDrop;
@group(0) @binding(1) var<storage, read_write> mask_drop_texels: array<MaskTexel>;

// The texel in column `column` of row `row`.
fn mask_drop_texel(traced: MaskTracedDrop, column: u32, row: u32) -> MaskTexel {
    let middle = f32(traced.size) * 0.5;
    let x = (f32(column) + 0.5 - middle) * traced.pixel;
    let y = (middle - f32(row) - 0.5) * traced.pixel;
    let cut = mask_silhouette_cut(traced, x, y);
    if cut.traced == 0.0 {
        return MaskTexel(vec3f(0.0), 0.0, vec3f(0.0), 0.0, vec3f(0.0), 0.0, 0u);
    }
    let through = mask_trace_through(traced, cut.sample.x, cut.sample.y);
    return MaskTexel(
        through.direction,
        cut.coverage,
        through.reflected,
        through.transmittance,
        through.internal,
        through.internal_transmittance,
        u32(through.reflections),
    );
}

@compute @workgroup_size(8, 8, 1)
fn main_mask_drop(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= mask_drop_traced.size || id.y >= mask_drop_traced.size {
        return;
    }
    mask_drop_texels[id.y * mask_drop_traced.size + id.x] = mask_drop_texel(mask_drop_traced, id.x, id.y);
}
