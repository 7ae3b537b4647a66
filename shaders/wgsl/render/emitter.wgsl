// Surfaces that shine, as lights: a place on one of them is drawn for all, by what each may give.
// A tree of spheres is in the words behind the texels, 8 for each node: center and square of the radius; power, first of two
// children or triangle, color and mark of a triangle, and its area times its opacity.
// Twin: downpour_trace::emitter, where the method is described.

// A node of the tree.
struct EmitterNode {
    center: vec3f,
    // Square of the radius.
    square: f32,
    // Sum of emission times area.
    power: f32,
    // First of the two children, or the triangle.
    next: u32,
    // Of a triangle: fractions of its emission that are red and green, 12 bits each, and bit 31.
    color: u32,
    // Area of the triangle times its mean opacity.
    area: f32,
}

// Reads a node.
fn emitter_load(index: u32) -> EmitterNode {
    let first = render_frame.emitters + index * EMITTER_WORDS;
    let sphere = bitcast<vec4f>(vec4u(
        render_texels[first], render_texels[first + 1u], render_texels[first + 2u], render_texels[first + 3u],
    ));
    return EmitterNode(
        sphere.xyz, sphere.w, bitcast<f32>(render_texels[first + 4u]), render_texels[first + 5u],
        render_texels[first + 6u], bitcast<f32>(render_texels[first + 7u]),
    );
}

// What emitters within a sphere may give to a surface: 0 if all of them are below its horizon. `offset`: of the sphere's
// center from the surface.
fn emitter_weight(offset: vec3f, square: f32, power: f32, normal: vec3f) -> f32 {
    let from_center = dot(offset, offset);
    let radius = sqrt(square);
    let height = dot(normal, offset) + radius;
    if height <= 0.0 {
        return 0.0;
    }
    let cosine = clamp(height / (sqrt(from_center) + radius), EMITTER_GRAZING, 1.0);
    return power * cosine / max(from_center, max(square, EMITTER_NEAREST));
}

// A place of one of the surfaces that shine, drawn for all of them, as a light: of color 0 if none shines on the surface.
// `numbers` are uniform in [0, 1).
fn emitter_draw(position: vec3f, normal: vec3f, numbers: vec3f) -> RenderLight {
    var light = RenderLight();
    light.kind = SCENE_LIGHT_AREA;
    light.cone = vec2f(0.0, 1.0);
    light.axis = normal;
    var node = emitter_load(0u);
    var probability = 1.0;
    var rest = numbers.z;
    for (var k = 0u; k < EMITTER_DEPTH && node.color == 0u; k += 1u) {
        let left = emitter_load(node.next);
        let right = emitter_load(node.next + 1u);
        let of_left = emitter_weight(left.center - position, left.square, left.power, normal);
        let of_right = emitter_weight(right.center - position, right.square, right.power, normal);
        let sum = of_left + of_right;
        if sum <= 0.0 {
            return light;
        }
        let part = of_left / sum;
        // Rounding may bring the rest to 1: a part that gives nothing is never drawn.
        if rest < part || part >= 1.0 || of_right <= 0.0 {
            rest = rest / part;
            probability *= part;
            node = left;
        } else {
            rest = (rest - part) / (1.0 - part);
            probability *= 1.0 - part;
            node = right;
        }
    }
    if node.color == 0u {
        return light;
    }
    let triangle = bvh_triangles[node.next];
    let edge = sqrt(numbers.x);
    let u = edge * (1.0 - numbers.y);
    let v = edge * numbers.y;
    let geometric = cross(triangle.edge_1, triangle.edge_2);
    light.position = triangle.corner + triangle.edge_1 * u + triangle.edge_2 * v;
    light.axis = geometric / max(sqrt(dot(geometric, geometric)), 1.0e-20);
    light.color = emitter_color(node.color) * (node.power / (probability * 3.1415927));
    light.radius = sqrt(node.area * EMITTER_NEAR);
    return light;
}

// Fractions of the emission of a triangle that are red, green and blue.
fn emitter_color(color: u32) -> vec3f {
    let red = f32(color & 4095u) / 4095.0;
    let green = f32(color >> 12u & 4095u) / 4095.0;
    return vec3f(red, green, max(1.0 - red - green, 0.0));
}
