// Octahedral map: a unit vector as two numbers in [-1, 1].
// Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010; Z. Cigolle et al., JCGT 3(2), 2014.
// Twin: downpour_math::packing.

// Sign of x as 1 or -1; zero counts as positive.
fn packing_sign(x: f32) -> f32 {
    return select(-1.0, 1.0, x >= 0.0);
}

// Maps a direction (any length above 0) to the square [-1, 1]^2.
fn packing_octahedral_encode(direction: vec3f) -> vec2f {
    let norm = abs(direction.x) + abs(direction.y) + abs(direction.z);
    let inverse = 1.0 / max(norm, PACKING_MIN_NORM);
    let x = direction.x * inverse;
    let y = direction.y * inverse;
    if direction.z >= 0.0 {
        return vec2f(x, y);
    }
    return vec2f((1.0 - abs(y)) * packing_sign(x), (1.0 - abs(x)) * packing_sign(y));
}

// Maps a point of the square to a unit vector.
fn packing_octahedral_decode(square: vec2f) -> vec3f {
    let z = 1.0 - abs(square.x) - abs(square.y);
    let fold = max(-z, 0.0);
    let x = square.x - fold * packing_sign(square.x);
    let y = square.y - fold * packing_sign(square.y);
    let inverse = 1.0 / sqrt(x * x + y * y + z * z);
    return vec3f(x * inverse, y * inverse, z * inverse);
}

// Texel of an octahedral map of `size` texels along an edge. Beyond an edge, the map continues mirrored about the edge's middle.
fn packing_octahedral_texel(size: u32, column: i32, row: i32) -> vec2u {
    let edge = i32(size);
    var x = column;
    var y = row;
    if x < 0 || x >= edge {
        x = clamp(x, 0, edge - 1);
        y = edge - 1 - y;
    }
    if y < 0 || y >= edge {
        y = clamp(y, 0, edge - 1);
        x = edge - 1 - x;
    }
    return vec2u(vec2i(clamp(x, 0, edge - 1), clamp(y, 0, edge - 1)));
}
