// Reflections on wet surfaces in a buffer of half the picture's size: the form of Tatarchuk & Isidoro 2006, section 6.3. A texel is the
// reflection in level ground there; an uneven surface is looked up where level ground would mirror the same way.
// Twin: downpour_trace::impostor, where the method is described.

// True if the scene has that form: the code slows down the rest.
override IMPOSTOR_REFLECTIONS: bool = true;

// Texels of the buffer: red and green, blue, as halves.
@group(0) @binding(11) var<storage, read> impostor_picture: array<vec2u>;

// Columns and rows of the buffer.
fn impostor_size() -> vec2u {
    return (vec2u(render_frame.camera.width, render_frame.camera.height) + 1u) / 2u;
}

// A color as a texel.
fn impostor_pack(light: vec3f) -> vec2u {
    return vec2u(pack2x16float(light.xy), pack2x16float(vec2f(light.z, 0.0)));
}

// The color of a texel.
fn impostor_unpack(texel: vec2u) -> vec3f {
    return vec3f(unpack2x16float(texel.x), unpack2x16float(texel.y).x);
}

// Factor of a reflection toward a viewer, who sees the surface at a cosine; `edge` is the paper's f0.
fn impostor_attenuation(cosine: f32, edge: f32) -> f32 {
    let f = (1.0 - cosine) * edge;
    return max(1.0 - f * f, 0.0);
}

// Position in the buffer, in texels from the top left, of what is mirrored along a direction by a surface that is seen along `towards`.
fn impostor_place(along: vec3f, towards: vec3f) -> vec2f {
    let level = vec3f(along.x, -along.y, along.z);
    let is_before = dot(level, render_frame.camera.forward) > IMPOSTOR_ASIDE;
    return camera_project(render_frame.camera, select(towards, level, is_before)) * 0.5;
}

// A texel of the buffer; beyond its edges, the nearest one.
fn impostor_texel(column: i32, row: i32) -> vec3f {
    let size = impostor_size();
    let x = u32(clamp(column, 0, i32(size.x) - 1));
    let y = u32(clamp(row, 0, i32(size.y) - 1));
    return impostor_unpack(impostor_picture[y * size.x + x]);
}

// The buffer at a position in texels, bilinear.
fn impostor_light(place: vec2f) -> vec3f {
    let size = vec2f(impostor_size());
    let at = clamp(place, vec2f(0.0), size) - 0.5;
    let low = floor(at);
    let part = at - low;
    let left = i32(low.x);
    let top = i32(low.y);
    let upper = impostor_texel(left, top) * (1.0 - part.x) + impostor_texel(left + 1, top) * part.x;
    let lower = impostor_texel(left, top + 1) * (1.0 - part.x) + impostor_texel(left + 1, top + 1) * part.x;
    return upper * (1.0 - part.y) + lower * part.y;
}

// Radiance that a surface mirrors to a viewer who sees it along `towards`, before its reflectance. Its normal warps what its facet mirrors.
fn impostor_mirrored(facet: vec3f, normal: vec3f, towards: vec3f) -> vec3f {
    let warped = facet + (normal - facet) * IMPOSTOR_WARP;
    let unit = warped / sqrt(dot(warped, warped));
    let along = towards - unit * (2.0 * dot(towards, unit));
    let factor = impostor_attenuation(clamp(-dot(towards, normal), 0.0, 1.0), render_frame.impostor_edge);
    return impostor_light(impostor_place(along, towards)) * factor;
}
