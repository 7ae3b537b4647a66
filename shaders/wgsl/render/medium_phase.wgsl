// How drops and fog scatter light: a table over the scattering angle, 0: straight on.
// Twin: downpour_render::rain::medium::phase.

// Integral of the phase functions of drops (by color) and of fog over the scattering angle, from 0 to each multiple of
// pi / MEDIUM_ANGLES.
@group(0) @binding(7) var<storage, read> medium_phase: array<vec4f>;

// The integral of the phase functions up to an angle.
fn medium_phase_within(angle: f32) -> vec4f {
    let position = clamp(angle * (f32(MEDIUM_ANGLES) / 3.1415927), 0.0, f32(MEDIUM_ANGLES));
    let low = min(u32(position), MEDIUM_ANGLES - 1u);
    let part = position - f32(low);
    return (medium_phase[low] * (1.0 - part) + medium_phase[low + 1u] * part);
}

// The phase functions at an angle: their mean over half an interval of the table to each side.
fn medium_phase_at(angle: f32) -> vec4f {
    let width = 3.1415927 / f32(MEDIUM_ANGLES);
    let low = max(angle - 0.5 * width, 0.0);
    let high = min(angle + 0.5 * width, 3.1415927);
    return (medium_phase_within(high) - medium_phase_within(low)) / (high - low);
}
