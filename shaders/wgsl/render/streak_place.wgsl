// Places across a drop and along a chord: the rim, where the light changes fastest, has more of them.
// Twin: downpour_render::rain::streak_place.

// Position between -1 and 1 of a place among `count` cells: 0 is the first edge, a half the middle of the first cell.
fn streak_place_position(place: f32, count: u32) -> f32 {
    return sin(STREAK_QUARTER * (place * (2.0 / f32(count)) - 1.0));
}

// The place of a position: 0 at -1, `count` at 1.
fn streak_place_index(position: f32, count: u32) -> f32 {
    return (asin(clamp(position, -1.0, 1.0)) / STREAK_QUARTER * 0.5 + 0.5) * f32(count);
}
