// What the water on a pane does to the light of lamps and the sun that falls through it: shadows of drops, and the light that
// they gather. Rows of the table: corner of the pane and texels in a metre; right, down and outward with the pane's width and
// height and the form; size, first row and last level of the texels; mean radius and focal length of the drops; levels. A
// texel is two bytes: share of it that drops cover, and the same gathered in their middles, over PANE_SHADOW_PEAK.
// Twin: downpour_render::glass::shadow, where the method is described.

// A texel of a level: cover, and gathered cover.
fn pane_shadow_texel(level: u32, column: i32, line: i32) -> vec2f {
    let row = render_frame.pane;
    let size = render_table[row + PANE_SHADOW_LEVELS + level];
    let x = u32(clamp(column, 0, i32(size.x) - 1));
    let y = u32(clamp(line, 0, i32(size.y) - 1));
    let index = size.z + y * size.x + x;
    let word = render_table[render_table[row + 4u].z + index / 8u][(index / 2u) % 4u];
    let pair = word >> (16u * (index % 2u));
    return vec2f(f32(pair & 255u), f32((pair >> 8u) & 255u) * PANE_SHADOW_PEAK) / 255.0;
}

// A level at a place of [0, 1], bilinear.
fn pane_shadow_level(level: u32, place: vec2f) -> vec2f {
    let size = vec2f(render_table[render_frame.pane + PANE_SHADOW_LEVELS + level].xy);
    let at = place * size - 0.5;
    let low = floor(at);
    let part = at - low;
    let x = i32(low.x);
    let y = i32(low.y);
    let upper = pane_shadow_texel(level, x, y) * (1.0 - part.x) + pane_shadow_texel(level, x + 1, y) * part.x;
    let lower = pane_shadow_texel(level, x, y + 1) * (1.0 - part.x) + pane_shadow_texel(level, x + 1, y + 1) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// Cover and gathered cover round a place of [0, 1], over a width in metres.
fn pane_shadow_at(place: vec2f, width: f32) -> vec2f {
    let row = render_frame.pane;
    let texels = width * bitcast<f32>(render_table[row].w);
    let level = clamp(log2(max(texels, 1.0)), 0.0, f32(render_table[row + 4u].w));
    let low = floor(level);
    let part = level - low;
    var found = pane_shadow_level(u32(low), place) * (1.0 - part);
    if part > 0.0 {
        found += pane_shadow_level(u32(low) + 1u, place) * part;
    }
    return found;
}

// Share of light that comes through the pane to a place from a distance along a direction; `spread` is half the angle that its
// source takes. 1 where the pane is not between them.
fn pane_shadow_share(place: vec3f, direction: vec3f, distance: f32, spread: f32) -> f32 {
    let row = render_frame.pane;
    if row == 0u {
        return 1.0;
    }
    let corner = bitcast<vec4f>(render_table[row]);
    let across = bitcast<vec4f>(render_table[row + 1u]);
    let down = bitcast<vec4f>(render_table[row + 2u]);
    let outward = bitcast<vec4f>(render_table[row + 3u]);
    let towards = dot(direction, outward.xyz);
    let away = dot(corner.xyz - place, outward.xyz) / select(towards, 1.0, towards == 0.0);
    if abs(towards) < 1.0e-4 || away <= 0.0 || away >= distance {
        return 1.0;
    }
    let on = place + direction * away - corner.xyz;
    let at = vec2f(dot(on, across.xyz) / across.w, dot(on, down.xyz) / down.w);
    if at.x < 0.0 || at.y < 0.0 || at.x > 1.0 || at.y > 1.0 {
        return 1.0;
    }
    // Both surfaces of the glass, and what goes to and fro between them.
    let mirrored = optics_fresnel(abs(towards), GLASS_PICTURE_INDEX);
    let clear = (1.0 - mirrored) / (1.0 + mirrored);
    let soft = 2.0 * away * spread;
    let cover = pane_shadow_at(at, soft);
    if render_table[row + 3u].w == PANE_SHADOW_TATARCHUK {
        return clear * (1.0 - cover.x + cover.y);
    }
    let drops = bitcast<vec4f>(render_table[row + 5u]);
    // How wide the light of a drop is, in its own radii: a point at the focus.
    let wide = abs(1.0 - away / drops.y);
    let gathered = max(1.0 - wide, 0.0);
    let spot = pane_shadow_at(at, soft + 2.0 * drops.x * max(wide - 1.0, 0.0));
    return clear * (1.0 - cover.x + spot.x * (1.0 - gathered) + cover.y * gathered);
}
