// Colors of linear BT.709.
// Twin: downpour_math::color.

// Luminance of a color.
fn color_luminance(color: vec3f) -> f32 {
    return dot(color, vec3f(0.2126, 0.7152, 0.0722));
}
