// The light of the sky: an equirectangular map, the same at coarser levels, and its irradiance.
// +Y is up; u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top.
// Twin: downpour_trace::sky.

// A level of the sky in a direction, bilinear.
fn sky_level(level: u32, direction: vec3f) -> vec3f {
    let size = render_frame.sky_levels[level];
    let uv = equirect_coordinates(direction);
    let width = i32(size.x);
    let height = i32(size.y);
    let x = uv.x * f32(size.x) - 0.5;
    let y = clamp(uv.y * f32(size.y) - 0.5, 0.0, f32(size.y) - 1.0);
    let fx = x - floor(x);
    let fy = y - floor(y);
    let left = ((i32(floor(x)) % width) + width) % width;
    let right = (left + 1) % width;
    let above = i32(floor(y)) * width;
    let below = min(i32(floor(y)) + 1, height - 1) * width;
    let first = i32(size.z);
    let a = render_sky[first + above + left].rgb;
    let b = render_sky[first + above + right].rgb;
    let c = render_sky[first + below + left].rgb;
    let d = render_sky[first + below + right].rgb;
    return (a * (1.0 - fx) + b * fx) * (1.0 - fy) + (c * (1.0 - fx) + d * fx) * fy;
}

// The sky as a ray sees it that is as wide as `width` at distance 1.
fn sky_cone(direction: vec3f, width: f32) -> vec3f {
    // Texels of the map across the ray; a texel between its neighbors is wider than one alone.
    let texels = width * f32(render_frame.sky_levels[0].y) * SKY_CONE_TEXELS;
    let level = min(log2(max(texels, 1.0)), f32(SCENE_SKY_LEVELS - 1u));
    let below = u32(level);
    let fraction = level - f32(below);
    var weight = 1.0 - fraction;
    var sum = vec3f(0.0);
    // Two levels, or one.
    for (var k = 0u; k < 2u && weight > 0.0; k += 1u) {
        sum += sky_level(below + k, direction) * weight;
        weight = select(0.0, fraction, k == 0u);
    }
    return sum;
}

// Irradiance over pi of the whole sky on a surface: what a white diffuse surface shows.
fn sky_irradiance(normal: vec3f) -> vec3f {
    let x = normal.x;
    let y = normal.y;
    let z = normal.z;
    var sum = render_frame.sky_irradiance[0].rgb;
    sum += render_frame.sky_irradiance[1].rgb * y;
    sum += render_frame.sky_irradiance[2].rgb * z;
    sum += render_frame.sky_irradiance[3].rgb * x;
    sum += render_frame.sky_irradiance[4].rgb * (x * y);
    sum += render_frame.sky_irradiance[5].rgb * (y * z);
    sum += render_frame.sky_irradiance[6].rgb * (3.0 * z * z - 1.0);
    sum += render_frame.sky_irradiance[7].rgb * (x * z);
    sum += render_frame.sky_irradiance[8].rgb * (x * x - y * y);
    return max(sum, vec3f(0.0));
}
