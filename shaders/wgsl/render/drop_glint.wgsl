// Position on a drop at which the light of a lamp leaves it, as the viewer sees it; and radiance of a lamp in a pixel of
// a drop after Rousseau 2006. Nothing here reads a buffer: any shader may use it.
// `light` leads from the drop to the lamp, `towards` from the eye to the drop; directions have length 1. Positions on the
// disk are in radii, along the right and the up of the view.
// Twin: downpour_render::rain::glint.

// The right of the view of a drop, level; where the view is plumb, +x.
fn drop_glint_right(towards: vec3f) -> vec3f {
    let sideways = vec3f(-towards.z, 0.0, towards.x);
    let level = dot(sideways, sideways);
    return select(vec3f(1.0, 0.0, 0.0), sideways / sqrt(max(level, DROP_GLINT_TINY)), level > DROP_GLINT_AXIS);
}

// The scattering angle over pi: 0 for a lamp behind the drop, 1 for one behind the eye.
fn drop_glint_angle(light: vec3f, towards: vec3f) -> f32 {
    let apart = light - towards;
    let along = light + towards;
    // Sine and cosine of half the angle, twice: exact at both ends, where a cosine of the angle would not be.
    let s = sqrt(dot(apart, apart));
    let c = sqrt(dot(along, along));
    let t = min(s, c) / max(max(s, c), DROP_GLINT_TINY);
    let octant = octant_turns(t);
    return 4.0 * select(octant, 0.25 - octant, c < s);
}

// The side of the disk on which the lamp stands, of length 1; right where it stands on none.
fn drop_glint_side(light: vec3f, right: vec3f, up: vec3f) -> vec2f {
    let side = vec2f(dot(light, right), dot(light, up));
    let square = dot(side, side);
    return select(vec2f(1.0, 0.0), side / sqrt(max(square, DROP_GLINT_TINY)), square > DROP_GLINT_AXIS);
}

// A position on the disk and the radius of a lamp's image there, up to a radius of the disk, as the bits of one number: the position
// within 1/1022 of a radius, the image finer the smaller it is.
fn drop_glint_pack(position: vec2f, image: f32) -> f32 {
    let steps = vec2u(floor(clamp(position, vec2f(-1.0), vec2f(1.0)) * DROP_GLINT_STEPS + 0.5 * DROP_GLINT_RANGE));
    let width = u32(sqrt(clamp(image, 0.0, 1.0)) * DROP_GLINT_WIDTHS + 0.5);
    return bitcast<f32>(DROP_GLINT_NUMBER | (steps.x << 19u) | (steps.y << 9u) | width);
}

// The unpacked position.
fn drop_glint_unpack(word: f32) -> vec2f {
    let bits = bitcast<u32>(word);
    let steps = vec2f(vec2u(bits >> 19u, bits >> 9u) & vec2u(DROP_GLINT_MASK));
    return (steps + (0.5 - 0.5 * DROP_GLINT_RANGE)) / DROP_GLINT_STEPS;
}

// The unpacked radius of the image.
fn drop_glint_image(word: f32) -> f32 {
    let width = f32(bitcast<u32>(word) & DROP_GLINT_WIDTH_MASK) / DROP_GLINT_WIDTHS;
    return width * width;
}

// The sine of the scattering angle: twice that of its half times the cosine of its half, exact at both ends.
fn drop_glint_sine(light: vec3f, towards: vec3f) -> f32 {
    let apart = light - towards;
    let along = light + towards;
    return 0.5 * sqrt(dot(apart, apart) * dot(along, along));
}

// The part of a bump from -1 to 1 that lies before a position, 0 to 1.
fn drop_glint_before(position: f32) -> f32 {
    let t = clamp(0.5 + 0.5 * position, 0.0, 1.0);
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// The part of a glint that a pixel has: a bump that reaches `reach` pixels from its middle, which is `offset` pixels from the pixel's
// upper left corner. All pixels together have all of it.
fn drop_glint_pixel(offset: vec2f, reach: f32) -> f32 {
    let across = drop_glint_before((1.0 - offset.x) / reach) - drop_glint_before(-offset.x / reach);
    let down = drop_glint_before((1.0 - offset.y) / reach) - drop_glint_before(-offset.y / reach);
    return across * down;
}

// The level part of a direction, (x, z), of length 1; nothing of a plumb one.
fn drop_glint_level(direction: vec3f) -> vec2f {
    let level = direction.xz;
    return level / sqrt(max(dot(level, level), DROP_GLINT_TINY));
}

// Rousseau 2006, section 6, at a position with a normal: (V_PE . V_N) (A_2 + A_3), to be multiplied with the lamp's color and
// attenuation. The plane in which rays do not go sideways is the level one. `terms` is DROP_LIGHT_EXTERNAL for A_2,
// DROP_LIGHT_INTERNAL for A_3, or both.
fn drop_glint_rousseau(normal: vec3f, to_eye: vec3f, light: vec3f, terms: u32) -> f32 {
    let facing = dot(to_eye, normal);
    let lit = dot(light, normal);
    let outside = max(0.0, lit);
    let across = -dot(drop_glint_level(light), drop_glint_level(normal));
    let within = max(0.0, across * (1.0 + lit));
    let shown_outside = select(outside, 0.0, (terms & DROP_LIGHT_EXTERNAL) == 0u);
    let shown_within = select(within, 0.0, (terms & DROP_LIGHT_INTERNAL) == 0u);
    return facing * (shown_outside + shown_within);
}
