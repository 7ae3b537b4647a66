// The streaks of an atlas between their texels. They stand behind the masks: columns, rows, half of the width in equivalent
// radii, a word of nothing; then halves, two a word: layers, rows, columns, and at the end of each row its mean.
// Law: over the width and a turn the mean of a layer is that of a disc of even light, so that a texel says how many times
// as bright it is as the disc would be, in the time in which the drop moves on by its diameter.
// Twin: downpour_render::rain::drops_atlas.

// Three layers, their parts in the light, and -1 if they are to be mirrored, else 1.
struct DropsAtlasStreak {
    layers: vec3u,
    side: f32,
    shares: vec3f,
}

// A streak out of two rows of a drop's light; its colour is in the first.
fn drops_atlas_streak(first: vec4f, second: vec4f) -> DropsAtlasStreak {
    let share = abs(first.w) - 1.0;
    let side = select(1.0, -1.0, first.w < 0.0);
    return DropsAtlasStreak(vec3u(second.xyz), side, vec3f(share, second.w, 1.0 - share - second.w));
}

// A half by its number.
fn drops_atlas_half(index: u32) -> f32 {
    let pair = unpack2x16float(drops_masks[drops_frame.atlas + DROPS_ATLAS_HEAD + (index >> 1u)]);
    return select(pair.x, pair.y, (index & 1u) == 1u);
}

// A texel. Rows go round. The column behind the last is the mean of the row.
fn drops_atlas_texel(layer: u32, column: i32, row: i32) -> f32 {
    let columns = drops_masks[drops_frame.atlas];
    let rows = i32(drops_masks[drops_frame.atlas + 1u]);
    let down = u32(((row % rows) + rows) % rows);
    return drops_atlas_half((layer * u32(rows) + down) * (columns + 1u) + u32(column));
}

// The same where a column that is outside is 0.
fn drops_atlas_within(layer: u32, column: i32, row: i32) -> f32 {
    let columns = i32(drops_masks[drops_frame.atlas]);
    if column < 0 || column >= columns {
        return 0.0;
    }
    return drops_atlas_texel(layer, column, row);
}

// A layer at so many columns and rows from its corner: bilinear.
fn drops_atlas_layer(layer: u32, across: f32, down: f32) -> f32 {
    let u = across - 0.5;
    let v = down - 0.5;
    let left = floor(u);
    let top = floor(v);
    let x = u - left;
    let y = v - top;
    let column = i32(left);
    let row = i32(top);
    let above = drops_atlas_within(layer, column, row) * (1.0 - x) + drops_atlas_within(layer, column + 1, row) * x;
    let below = drops_atlas_within(layer, column, row + 1) * (1.0 - x)
        + drops_atlas_within(layer, column + 1, row + 1) * x;
    return above * (1.0 - y) + below * y;
}

// A streak so many equivalent radii to the right of the middle, so many turns of the mode (2,0) along.
fn drops_atlas_across(streak: DropsAtlasStreak, across: f32, turns: f32) -> f32 {
    let half = 0.5 * f32(drops_masks[drops_frame.atlas]);
    let extent = bitcast<f32>(drops_masks[drops_frame.atlas + 2u]);
    let column = half + half * clamp(across * streak.side / extent, -2.0, 2.0);
    let row = (turns - floor(turns)) * f32(drops_masks[drops_frame.atlas + 1u]);
    return streak.shares.x * drops_atlas_layer(streak.layers.x, column, row)
        + streak.shares.y * drops_atlas_layer(streak.layers.y, column, row)
        + streak.shares.z * drops_atlas_layer(streak.layers.z, column, row);
}

// The mean over the width, so many turns along.
fn drops_atlas_along(streak: DropsAtlasStreak, turns: f32) -> f32 {
    let columns = i32(drops_masks[drops_frame.atlas]);
    let row = i32((turns - floor(turns)) * f32(drops_masks[drops_frame.atlas + 1u]));
    return streak.shares.x * drops_atlas_texel(streak.layers.x, columns, row)
        + streak.shares.y * drops_atlas_texel(streak.layers.y, columns, row)
        + streak.shares.z * drops_atlas_texel(streak.layers.z, columns, row);
}
