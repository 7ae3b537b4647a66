// The patterns of an atlas between their texels. They stand behind the masks: columns, rows, half of the width in equivalent
// radii; layers from an elevation to the next, layers from a diameter to the next, a word of nothing; then halves, two a word: layers,
// rows, columns, and at the end of each row its mean.
// Law: over the width and a turn the mean of a layer is that of a disk of even light, so that a texel says how many times
// as bright it is as the disk would be, in the time in which the drop moves on by its diameter. So is that of any mixture.
// Twin: downpour_render::rain::drops_atlas.

// Three layers of the lower diameter and elevation, -1 if they are to be mirrored, else 1; weights of the three, weights of the higher
// diameter and of the higher elevation.
struct DropsAtlasStreak {
    layers: vec3u,
    side: f32,
    weights: vec3f,
    parts: vec2f,
}

// A streak out of three rows of a drop's light; its color is in the first.
fn drops_atlas_streak(first: vec4f, second: vec4f, third: vec4f) -> DropsAtlasStreak {
    return DropsAtlasStreak(vec3u(second.xyz), first.w, vec3f(second.w, third.x, 1.0 - second.w - third.x), third.yz);
}

// Layers from those of the lower diameter and elevation to those of one of the four neighbors.
fn drops_atlas_step(corner: u32) -> u32 {
    let head = drops_frame.atlas;
    return (corner & 1u) * drops_masks[head + 4u] + (corner >> 1u) * drops_masks[head + 3u];
}

// A half by its number.
fn drops_atlas_half(index: u32) -> f32 {
    let pair = unpack2x16float(drops_masks[drops_frame.atlas + DROPS_ATLAS_HEAD + (index >> 1u)]);
    return select(pair.x, pair.y, (index & 1u) == 1u);
}

// A texel. Rows wrap around. The column behind the last is the mean of the row.
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

// A streak so many equivalent radii to the right of the middle, after `turns` turns of the mode (2,0).
fn drops_atlas_across(streak: DropsAtlasStreak, across: f32, turns: f32) -> f32 {
    let half = 0.5 * f32(drops_masks[drops_frame.atlas]);
    let extent = bitcast<f32>(drops_masks[drops_frame.atlas + 2u]);
    let column = half + half * clamp(across * streak.side / extent, -2.0, 2.0);
    let row = (turns - floor(turns)) * f32(drops_masks[drops_frame.atlas + 1u]);
    var shown = 0.0;
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let weight = atlas_corner(streak.parts.x, streak.parts.y, corner);
        if weight > 0.0 {
            let layers = streak.layers + vec3u(drops_atlas_step(corner));
            shown += weight * (streak.weights.x * drops_atlas_layer(layers.x, column, row)
                + streak.weights.y * drops_atlas_layer(layers.y, column, row)
                + streak.weights.z * drops_atlas_layer(layers.z, column, row));
        }
    }
    return shown;
}

// The mean over the width, so many turns along.
fn drops_atlas_along(streak: DropsAtlasStreak, turns: f32) -> f32 {
    let columns = i32(drops_masks[drops_frame.atlas]);
    let row = i32((turns - floor(turns)) * f32(drops_masks[drops_frame.atlas + 1u]));
    var shown = 0.0;
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let weight = atlas_corner(streak.parts.x, streak.parts.y, corner);
        if weight > 0.0 {
            let layers = streak.layers + vec3u(drops_atlas_step(corner));
            shown += weight * (streak.weights.x * drops_atlas_texel(layers.x, columns, row)
                + streak.weights.y * drops_atlas_texel(layers.y, columns, row)
                + streak.weights.z * drops_atlas_texel(layers.z, columns, row));
        }
    }
    return shown;
}
