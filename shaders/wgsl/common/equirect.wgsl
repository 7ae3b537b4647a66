// Equirectangular maps: +Y is up; u = 0.5 + atan2(z, x) / 2 pi, v = 0.5 - asin(y) / pi from the top.
// Twin: downpour_math::equirect.

// Texture coordinates of a direction of length 1; u = 0.5 at the poles.
fn equirect_coordinates(direction: vec3f) -> vec2f {
    // The angle of (y, horizontal) is asin(y), and does not lose its digits near the poles.
    let horizontal = sqrt(direction.x * direction.x + direction.z * direction.z);
    let turn = select(0.0, atan2(direction.z, direction.x), horizontal > EQUIRECT_POLE);
    return vec2f(0.5 + turn * 0.15915494, 0.5 - atan2(direction.y, horizontal) * 0.31830987);
}
