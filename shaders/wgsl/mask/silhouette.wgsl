// The outline of a drop in a pixel: how much of the pixel it covers, and where in it a ray should be traced.
// Lengths are in units of the equivalent radius.
// Twin: downpour_mask::silhouette, where the method is derived.

struct MaskSilhouetteCut {
    sample: vec2f,
    coverage: f32,
    traced: f32,
}

// The gauge squared of the reference spheroid at its minimum on the viewer's ray through (x, y).
fn mask_silhouette_estimate(traced: MaskTracedDrop, x: f32, y: f32) -> f32 {
    let toward = vec3f(0.0, 0.0, 1.0);
    let point = vec3f(x, y, 0.0);
    let slope = mask_trace_spheroid(traced, point, toward);
    return mask_trace_spheroid(traced, point, point) - slope * slope / mask_trace_curvature(traced, toward);
}

// Distance from (x, y) to the outline, positive outside, and the unit vector away from it.
fn mask_silhouette_distance(traced: MaskTracedDrop, x: f32, y: f32) -> vec3f {
    let toward = vec3f(0.0, 0.0, 1.0);
    let curvature = mask_trace_curvature(traced, toward);
    var z = -mask_trace_spheroid(traced, vec3f(x, y, 0.0), toward) / curvature;
    for (var step = 0u; step < MASK_SILHOUETTE_STEPS; step += 1u) {
        z = z - mask_trace_surface(traced, vec3f(x, y, z)).half_gradient.z / curvature;
    }
    let surface = mask_trace_surface(traced, vec3f(x, y, z));
    let gx = surface.half_gradient.x;
    let gy = surface.half_gradient.y;
    let across = sqrt(max(gx * gx + gy * gy, MASK_TINY));
    let gauge = sqrt(max(surface.excess + 1.0, 0.0));
    let distance = surface.excess / (gauge + 1.0) * gauge / across;
    return vec3f(distance, gx / across, gy / across);
}

// The fraction of a unit square on the inner side of a line at a distance from the square's center (positive if the
// center is outside), with the line's unit normal (nx, ny).
fn mask_silhouette_area(distance: f32, nx: f32, ny: f32) -> f32 {
    let long = max(abs(nx), abs(ny));
    let short = min(abs(nx), abs(ny));
    let depth = max((long + short) * 0.5 - abs(distance), 0.0);
    let corner = depth * depth / max(long * short, MASK_TINY) * 0.5;
    let band = (depth - short * 0.5) / long;
    let smaller = min(select(band, corner, depth < short), 0.5);
    return select(1.0 - smaller, smaller, distance > 0.0);
}

// Coverage and sample point of the pixel around (x, y).
fn mask_silhouette_cut(traced: MaskTracedDrop, x: f32, y: f32) -> MaskSilhouetteCut {
    let pixel = traced.pixel;
    let estimate = mask_silhouette_estimate(traced, x, y);
    // A large pixel reaches further: the margin of the two thresholds grows with it.
    let reach = (MASK_BLEED + 1.0) * pixel;
    if estimate < MASK_SILHOUETTE_INSIDE - reach {
        return MaskSilhouetteCut(vec2f(x, y), 1.0, 1.0);
    }
    if estimate >= MASK_SILHOUETTE_OUTSIDE + reach * 4.0 {
        return MaskSilhouetteCut(vec2f(x, y), 0.0, 0.0);
    }
    let outline = mask_silhouette_distance(traced, x, y);
    let pixels = outline.x / pixel;
    let extent = (abs(outline.y) + abs(outline.z)) * 0.5;
    let least = pixels + MASK_EDGE_DEPTH;
    let inward = max(max(min((extent + pixels) * 0.5, extent), least), 0.0) * pixel;
    let sample = vec2f(x - outline.y * inward, y - outline.z * inward);
    return MaskSilhouetteCut(
        sample,
        mask_silhouette_area(pixels, outline.y, outline.z),
        select(0.0, 1.0, pixels < MASK_BLEED),
    );
}
