// Precomputed masks of drops, between their texels, diameters and elevations.
// Law: sums are weighted by coverage, so that texels outside the drop have no say in a direction.
// Twin: downpour_render::rain::drops_mask.

// Values of a mask at a point.
struct DropsTexel {
    // Direction of the light that comes through, in the frame of the view: right, up, toward the viewer.
    direction: vec3f,
    coverage: f32,
    reflected: vec3f,
    transmittance: f32,
    // Direction of the light that is reflected inside once.
    internal: vec3f,
    internal_transmittance: f32,
    // Fraction that is reflected outside.
    reflectance: f32,
}

@group(0) @binding(2) var<storage, read> drops_masks: array<u32>;

// A vector of length 1, or the vector itself if it has none.
fn drops_mask_unit(v: vec3f) -> vec3f {
    return v / max(sqrt(dot(v, v)), 1.0e-20);
}

// A texel of a mask.
fn drops_mask_texel(layer: u32, column: i32, row: i32) -> DropsTexel {
    let last = i32(drops_frame.mask_size) - 1;
    let x = u32(clamp(column, 0, last));
    let y = u32(clamp(row, 0, last));
    let at = ((layer * drops_frame.mask_size + y) * drops_frame.mask_size + x) * DROPS_TEXEL_WORDS;
    let fractions = unpack2x16unorm(drops_masks[at + 3u]);
    let more = unpack2x16unorm(drops_masks[at + 4u]);
    return DropsTexel(
        packing_octahedral_decode(unpack2x16snorm(drops_masks[at])),
        fractions.x,
        packing_octahedral_decode(unpack2x16snorm(drops_masks[at + 1u])),
        fractions.y,
        packing_octahedral_decode(unpack2x16snorm(drops_masks[at + 2u])),
        more.x,
        more.y,
    );
}

// Adds a weighted texel to a sum. Texels outside the drop have no direction to add.
fn drops_mask_add(sum: DropsTexel, texel: DropsTexel, weight: f32) -> DropsTexel {
    let covered = weight * texel.coverage;
    return DropsTexel(
        sum.direction + texel.direction * covered,
        sum.coverage + covered,
        sum.reflected + texel.reflected * covered,
        sum.transmittance + texel.transmittance * covered,
        sum.internal + texel.internal * covered,
        sum.internal_transmittance + texel.internal_transmittance * covered,
        sum.reflectance + texel.reflectance * covered,
    );
}

// Normalizes a sum of weighted texels.
fn drops_mask_mean(sum: DropsTexel) -> DropsTexel {
    let whole = max(sum.coverage, 1.0e-20);
    return DropsTexel(
        drops_mask_unit(sum.direction),
        sum.coverage,
        drops_mask_unit(sum.reflected),
        sum.transmittance / whole,
        drops_mask_unit(sum.internal),
        sum.internal_transmittance / whole,
        sum.reflectance / whole,
    );
}

// A mask between its texels: sums weighted by coverage. (u, v) in [0, 1] from the top left.
fn drops_mask_layer(sum: DropsTexel, layer: u32, u: f32, v: f32, weight: f32) -> DropsTexel {
    let x = u * f32(drops_frame.mask_size) - 0.5;
    let y = v * f32(drops_frame.mask_size) - 0.5;
    let left = i32(floor(x));
    let top = i32(floor(y));
    let fx = x - floor(x);
    let fy = y - floor(y);
    var s = drops_mask_add(sum, drops_mask_texel(layer, left, top), weight * (1.0 - fx) * (1.0 - fy));
    s = drops_mask_add(s, drops_mask_texel(layer, left + 1, top), weight * fx * (1.0 - fy));
    s = drops_mask_add(s, drops_mask_texel(layer, left, top + 1), weight * (1.0 - fx) * fy);
    return drops_mask_add(s, drops_mask_texel(layer, left + 1, top + 1), weight * fx * fy);
}

// Values of the masks for a drop at (x, y) in units of half the mask, right and up, interpolated between diameters and
// elevations.
fn drops_mask_at(row: vec2f, x: f32, y: f32) -> DropsTexel {
    let u = 0.5 + 0.5 * x;
    let v = 0.5 - 0.5 * y;
    let low = floor(row);
    let part = row - low;
    let first = u32(low.x) * DROPS_ELEVATIONS + u32(low.y);
    var sum = DropsTexel(vec3f(0.0), 0.0, vec3f(0.0), 0.0, vec3f(0.0), 0.0, 0.0);
    // Two elevations of two diameters. One text for all: each copy of it is compiled again.
    for (var k = 0u; k < 4u; k += 1u) {
        let of_diameter = select(1.0 - part.x, part.x, k >= 2u);
        let weight = of_diameter * select(1.0 - part.y, part.y, (k & 1u) == 1u);
        if weight > 0.0 {
            sum = drops_mask_layer(sum, first + (k / 2u) * DROPS_ELEVATIONS + (k & 1u), u, v, weight);
        }
    }
    return drops_mask_mean(sum);
}
