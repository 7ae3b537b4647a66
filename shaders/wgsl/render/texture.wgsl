// Textures in a buffer, filtered in the shader, so that the CPU filters them in the same way.
// A slot is three rows of the table: the 2 x 2 part of the coordinates' transform; its offset, the set of coordinates
// and flags; width, height, first texel and number of levels. Levels follow each other, each half as large.
// Twin: downpour_trace::texture.

// The place where a ray's cone meets a surface, an ellipse, in both sets of texture coordinates.
struct TextureFootprint {
    // Its longer diameter on the surface.
    along: vec4f,
    // Its shorter diameter.
    across: vec4f,
    // Samples along the longer one, at most.
    taps: f32,
}

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

// One texel, linear; of a relief: both slopes, the mean of the sum of their squares, and 1.
fn texture_texel(index: u32, flags: u32) -> vec4f {
    let word = render_texels[index];
    if (flags & SCENE_RELIEF) != 0u {
        let steps = vec3f(f32(word & 2047u), f32((word >> 11u) & 2047u), f32(word >> 22u))
            - vec3f(TEXTURE_SLOPE_STEPS, TEXTURE_SLOPE_STEPS, 0.0);
        let slope = steps * (TEXTURE_STEEPEST / TEXTURE_SLOPE_STEPS);
        return vec4f(slope.xy, dot(slope, slope), 1.0);
    }
    let texel = unpack4x8unorm(word);
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

// Variance of the slopes of a relief in a footprint that has two diameters in texels, from the means of the slopes and of their squares.
// Between the middles of texels a relief is taken to be smooth: a footprint far smaller than a texel has none.
fn texture_variance(means: vec4f, along: vec2f, across: vec2f) -> f32 {
    let texels = max(dot(along, along), dot(across, across)) / (TEXTURE_TENT * TEXTURE_TENT);
    return max(means.z - dot(means.xy, means.xy), 0.0) * min(texels, 1.0);
}

// Samples in place of an ellipse with two diameters in texels: the line on which they lie, their number, and the edge of the texels that each
// interpolates, at least 1. They are no farther apart than such texels reach, and have together the ellipse's variance.
fn texture_taps(along: vec2f, across: vec2f, most: f32) -> vec4f {
    let first = dot(along, along);
    let second = dot(across, across);
    let length = sqrt(max(first, second));
    let reach = TEXTURE_SPACE * most;
    let shortest = select(length / TEXTURE_TENT, length / sqrt(TEXTURE_TENT * TEXTURE_TENT + reach * reach), most > 1.0);
    let texel = max(max(sqrt(min(first, second)) / TEXTURE_TENT, shortest), 1.0);
    let wide = TEXTURE_TENT * texel;
    let line = sqrt(max(length * length - wide * wide, 0.0));
    let taps = clamp(ceil(line / (TEXTURE_SPACE * texel)), 1.0, max(most, 1.0));
    // Samples in the middle of their parts have less variance than the line.
    let part = line / (max(length, 1.0e-20) * sqrt(1.0 - 1.0 / max(taps * taps, 2.0)));
    let longer = select(across, along, first >= second);
    return vec4f(longer * select(0.0, part, taps > 1.0), taps, texel);
}

// A slot at the corner's two sets of coordinates; of a relief: the mean of both slopes, the square of the alpha of the lobe of what varies of
// them, and 1.
fn texture_sample(slot: u32, uv: vec4f, footprint: TextureFootprint) -> vec4f {
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
    let size = vec2f(f32(image.x), f32(image.y));
    let along = select(footprint.along.xy, footprint.along.zw, found.uv_set == 1u);
    let across = select(footprint.across.xy, footprint.across.zw, found.uv_set == 1u);
    let longer = vec2f(matrix.x * along.x + matrix.y * along.y, matrix.z * along.x + matrix.w * along.y) * size;
    let shorter = vec2f(matrix.x * across.x + matrix.y * across.y, matrix.z * across.x + matrix.w * across.y) * size;
    let taps = texture_taps(longer, shorter, footprint.taps);
    let lod = clamp(log2(taps.w), 0.0, f32(image.w - 1u));
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
    var weight = (1.0 - fraction) / taps.z;
    var sum = vec4f(0.0);
    // Two levels, or one.
    for (var k = 0u; k < 2u && weight > 0.0; k += 1u) {
        for (var tap = 0.5; tap < taps.z; tap += 1.0) {
            let at = inside + taps.xy / size * (tap / taps.z - 0.5);
            sum += texture_level(first, width, height, at, found.flags) * weight;
        }
        first += u32(width * height);
        width = max(width / 2, 1);
        height = max(height / 2, 1);
        weight = select(0.0, fraction / taps.z, k == 0u);
    }
    if (found.flags & SCENE_RELIEF) != 0u {
        let share = f32((found.flags >> TEXTURE_SHARE_SHIFT) & 255u) / 255.0;
        sum.z = texture_variance(sum, longer, shorter) * share;
    }
    return sum;
}
