// Light of lamps and the sun that falls through the water on a pane: shadows of drops, and the light that
// they gather. A texel is two bytes: fraction of it that drops cover, and the same gathered in their middles, over
// PANE_SHADOW_PEAK.
// Twin: downpour_trace::pane_shadow, where the method is described.

// A texel of a level: cover, and gathered cover.
fn pane_shadow_texel(texels: u32, level: u32, column: i32, line: i32) -> vec2f {
    let size = pane_level(level);
    let x = u32(clamp(column, 0, i32(size.x) - 1));
    let y = u32(clamp(line, 0, i32(size.y) - 1));
    let index = size.z + y * size.x + x;
    let word = pane_texels(texels + index / 8u)[(index / 2u) % 4u];
    let pair = word >> (16u * (index % 2u));
    return vec2f(f32(pair & 255u), f32((pair >> 8u) & 255u) * PANE_SHADOW_PEAK) / 255.0;
}

// A level at a position in [0, 1], bilinear.
fn pane_shadow_level(texels: u32, level: u32, position: vec2f) -> vec2f {
    let size = vec2f(pane_level(level).xy);
    let at = position * size - 0.5;
    let low = floor(at);
    let part = at - low;
    let x = i32(low.x);
    let y = i32(low.y);
    let upper = pane_shadow_texel(texels, level, x, y) * (1.0 - part.x) + pane_shadow_texel(texels, level, x + 1, y) * part.x;
    let lower = pane_shadow_texel(texels, level, x, y + 1) * (1.0 - part.x) + pane_shadow_texel(texels, level, x + 1, y + 1) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// Cover and gathered cover around a position of [0, 1], over a width in meters.
fn pane_shadow_at(pane: RenderPane, position: vec2f, width: f32) -> vec2f {
    let texels = width * pane.texels_per_meter;
    let level = clamp(log2(max(texels, 1.0)), 0.0, f32(pane.last));
    let low = floor(level);
    let part = level - low;
    var found = pane_shadow_level(pane.first, u32(low), position) * (1.0 - part);
    if part > 0.0 {
        found += pane_shadow_level(pane.first, u32(low) + 1u, position) * part;
    }
    return found;
}

// Fraction of light that comes through the pane to a position from a distance along a direction; `spread` is half the angle that its
// source takes. 1 where the pane is not between them.
fn pane_shadow_fraction(position: vec3f, direction: vec3f, distance: f32, spread: f32) -> f32 {
    if render_frame.pane == 0u {
        return 1.0;
    }
    let pane = pane_load();
    let towards = dot(direction, pane.outward);
    let away = dot(pane.corner - position, pane.outward) / select(towards, 1.0, towards == 0.0);
    if abs(towards) < 1.0e-4 || away <= 0.0 || away >= distance {
        return 1.0;
    }
    let on = position + direction * away - pane.corner;
    let at = vec2f(dot(on, pane.across) / pane.width, dot(on, pane.down) / pane.height);
    if at.x < 0.0 || at.y < 0.0 || at.x > 1.0 || at.y > 1.0 {
        return 1.0;
    }
    // Both surfaces of the glass, and what goes to and fro between them.
    let mirrored = optics_fresnel(abs(towards), GLASS_PICTURE_INDEX);
    let clear = (1.0 - mirrored) / (1.0 + mirrored);
    let soft = 2.0 * away * spread;
    let cover = pane_shadow_at(pane, at, soft);
    if pane.form == PANE_SHADOW_TATARCHUK {
        return clear * (1.0 - cover.x + cover.y);
    }
    // Width of the light of a drop, in its own radii: a point at the focus.
    let wide = abs(1.0 - away / pane.drops.y);
    let gathered = max(1.0 - wide, 0.0);
    let spot = pane_shadow_at(pane, at, soft + 2.0 * pane.drops.x * max(wide - 1.0, 0.0));
    return clear * (1.0 - cover.x + spot.x * (1.0 - gathered) + cover.y * gathered);
}
