// Light of lamps on the unresolved drops before pixels that do not look for it (spacing.wgsl), from the pixels around them that do.
// Law: a mean over the four nearest that do, by their distances on the picture, of those whose rays are as long. A pixel that is like none
// of them, or near whose ray a lamp is, looks itself: beside a lamp the light is inverse to the distance from it.
// Twin: downpour_render::rain::medium::spread.

// Weight of a neighbor, 0 to 1: 1 if its ray is as long, 0 from a relative difference of 20 %.
fn medium_spread_alike(own: f32, other: f32) -> f32 {
    let reach = min(own, MEDIUM_LAMP_REACH);
    let far = min(other, MEDIUM_LAMP_REACH);
    return max(1.0 - abs(reach - far) / (0.2 * max(reach, far)), 0.0);
}

// A column (or row) that looks for light, before or after one of `size`, where those that do lie `spacing` apart with one of them at
// `place`; and its weight in a mean of both, 0 to `spacing`: 0 beside the edge of the picture, where there are not both.
fn medium_spread_side(at: u32, size: u32, spacing: u32, place: u32, after: bool) -> vec2u {
    let past = (at + spacing - place) % spacing;
    let next = at + spacing - past;
    let has_both = at >= past && (past == 0u || next < size);
    let weight = select(0u, select(spacing - past, past, after), has_both);
    return vec2u(select(max(at, past) - past, next, after), weight);
}

// The index of one of the four pixels around a pixel that look for light, and its weight, 0 to the square of the spacing.
fn medium_spread_corner(x: u32, y: u32, corner: u32) -> vec2u {
    let spacing = render_frame.ray_spacing;
    let camera = render_frame.camera;
    let column = medium_spread_side(x, camera.width, spacing, render_frame.ray_column, (corner & 1u) == 1u);
    let row = medium_spread_side(y, camera.height, spacing, render_frame.ray_row, corner >= 2u);
    let weight = column.y * row.y;
    // One without weight may be beyond the picture.
    return vec2u(select(0u, row.x * camera.width + column.x, weight > 0u), weight);
}

// True if no lamp is so near a ray that the pixels around it could not stand for it.
fn medium_spread_is_even(direction: vec3f) -> bool {
    let cell = MEDIUM_SPREAD_CELLS * f32(render_frame.ray_spacing) * render_frame.camera.pixel_angle;
    var even = true;
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let lamp = light_load(k);
        if lamp.kind != SCENE_LIGHT_DIRECTIONAL {
            let offset = lamp.position - medium_frame.eye;
            let nearest = dot(offset, direction);
            let aside = offset - direction * nearest;
            let near = cell * nearest;
            even = even && (nearest <= 0.0 || dot(aside, aside) > near * near);
        }
    }
    return even;
}
