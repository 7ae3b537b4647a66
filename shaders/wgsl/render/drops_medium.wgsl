// Mean radiance of drops that are not drawn one by one.
// Twin: downpour_render::rain::drops_medium.

// Mean radiance of an unresolved drop before a pixel.
fn drops_medium(x: u32, y: u32) -> vec3f {
    if drops_frame.streak_color == STREAK_WHITE {
        return drops_capture_texel(drops_frame.capture_last, 0, 0);
    }
    let size = vec2f(f32(drops_frame.camera.width), f32(drops_frame.camera.height));
    return streak_lookup_mean(medium_frame.shape, vec2f(f32(x) + 0.5, f32(y) + 0.5) / size);
}
