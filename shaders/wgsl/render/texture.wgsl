// Textures in a buffer, filtered in the shader, so that the CPU filters them in the same way.
// A slot is three rows of the table: the 2 x 2 part of the coordinates' transform; its offset, the set of coordinates
// and flags; width, height, first texel and number of levels. Levels follow each other, each half as large.
// Twin: downpour_trace::texture.

// Two neighbors, the i-th and the next, brought into the texture: indices of texels along an edge of n. Integers are divided
// once: that is slow.
fn texture_wrap(i: i32, n: i32, repeats: bool, mirrors: bool) -> vec2i {
    if repeats || mirrors {
        let period = select(2 * n, n, repeats);
        let rest = i % period;
        let at = select(rest, rest + period, rest < 0);
        let both = vec2i(at, select(at + 1, 0, at + 1 == period));
        return select(min(both, vec2i(2 * n - 1) - both), both, repeats);
    }
    return clamp(vec2i(i, i + 1), vec2i(0), vec2i(n - 1));
}

// One texel, linear.
fn texture_texel(index: u32, flags: u32) -> vec4f {
    let texel = unpack4x8unorm(render_texels[index]);
    if (flags & SCENE_ROOTED) != 0u {
        return vec4f(texel.rgb * texel.rgb, texel.a);
    }
    return texel;
}

// A level at texture coordinates, bilinear.
fn texture_level(first: u32, width: i32, height: i32, uv: vec2f, flags: u32) -> vec4f {
    let x = uv.x * f32(width) - 0.5;
    let y = uv.y * f32(height) - 0.5;
    let fx = x - floor(x);
    let fy = y - floor(y);
    let ix = i32(floor(x));
    let iy = i32(floor(y));
    let u = vec2u(texture_wrap(ix, width, (flags & SCENE_REPEAT_U) != 0u, (flags & SCENE_MIRROR_U) != 0u));
    let v = vec2u(texture_wrap(iy, height, (flags & SCENE_REPEAT_V) != 0u, (flags & SCENE_MIRROR_V) != 0u));
    let rows = vec2u(first) + v * u32(width);
    let a = texture_texel(rows.x + u.x, flags);
    let b = texture_texel(rows.x + u.y, flags);
    let c = texture_texel(rows.y + u.x, flags);
    let d = texture_texel(rows.y + u.y, flags);
    let top = a * (1.0 - fx) + b * fx;
    let bottom = c * (1.0 - fx) + d * fx;
    return top * (1.0 - fy) + bottom * fy;
}

// A slot at the corner's two sets of coordinates. `spread` is the logarithm to base 2 of the width of the pixel in
// units of texture coordinates.
fn texture_sample(slot: u32, uv: vec4f, spread: f32) -> vec4f {
    let found = material_slot(slot);
    let matrix = found.matrix;
    let image = found.image;
    let chosen = select(uv.xy, uv.zw, found.uv_set == 1u);
    let moved = vec2f(
        matrix.x * chosen.x + matrix.y * chosen.y + found.offset.x,
        matrix.z * chosen.x + matrix.w * chosen.y + found.offset.y,
    );
    // Far outside, a coordinate has no fraction left.
    let inside = clamp(moved, vec2f(-4096.0), vec2f(4096.0));
    let texels = 0.5 * log2(f32(image.x) * f32(image.y));
    let lod = clamp(spread + texels, 0.0, f32(image.w - 1u));
    var first = image.z;
    var width = i32(image.x);
    var height = i32(image.y);
    let level = u32(lod);
    for (var k = 0u; k < level; k += 1u) {
        first += u32(width * height);
        width = max(width / 2, 1);
        height = max(height / 2, 1);
    }
    let fraction = select(lod - f32(level), 0.0, level + 1u >= image.w);
    var weight = 1.0 - fraction;
    var sum = vec4f(0.0);
    // Two levels, or one.
    for (var k = 0u; k < 2u && weight > 0.0; k += 1u) {
        sum += texture_level(first, width, height, inside, found.flags) * weight;
        first += u32(width * height);
        width = max(width / 2, 1);
        height = max(height / 2, 1);
        weight = select(0.0, fraction, k == 0u);
    }
    return sum;
}
