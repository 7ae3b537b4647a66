// Surfaces that shine, as lights: a place on one of them is drawn for all, by what each may give.
// A tree of spheres is in the words behind the texels, 8 for each node: center and square of the radius; power, first of two
// children or triangle, 1 for a triangle, and its area times its opacity.
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
    is_leaf: bool,
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
        render_texels[first + 6u] == 1u, bitcast<f32>(render_texels[first + 7u]),
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
    for (var k = 0u; k < EMITTER_DEPTH && !node.is_leaf; k += 1u) {
        let left = emitter_load(node.next);
        let right = emitter_load(node.next + 1u);
        let of_left = emitter_weight(left.center - position, left.square, left.power, normal);
        let of_right = emitter_weight(right.center - position, right.square, right.power, normal);
        let sum = of_left + of_right;
        if sum <= 0.0 {
            return light;
        }
        let part = of_left / sum;
        if rest < part {
            rest = rest / part;
            probability *= part;
            node = left;
        } else {
            rest = (rest - part) / (1.0 - part);
            probability *= 1.0 - part;
            node = right;
        }
    }
    if !node.is_leaf {
        return light;
    }
    let triangle = bvh_triangles[node.next];
    let edge = sqrt(numbers.x);
    let hit = SurfaceHit(0.0, node.next, edge * (1.0 - numbers.y), edge * numbers.y);
    let geometric = surface_edges(hit);
    light.position = triangle.corner + triangle.edge_1 * hit.u + triangle.edge_2 * hit.v;
    light.axis = geometric / max(sqrt(dot(geometric, geometric)), 1.0e-20);
    // The mean of an eighth of the triangle's edges.
    let emission = surface_emission(hit, emitter_spread(hit));
    light.color = emission * (node.area / (probability * 3.1415927));
    light.radius = sqrt(node.area * EMITTER_NEAR);
    return light;
}

// Logarithm to base 2 of an eighth of the width of a triangle in units of texture coordinates.
fn emitter_spread(hit: SurfaceHit) -> f32 {
    let first = hit.triangle * 3u;
    let a = render_corners[first].uv.xy;
    let b = render_corners[first + 1u].uv.xy - a;
    let c = render_corners[first + 2u].uv.xy - a;
    return 0.5 * log2(max(abs(b.x * c.y - b.y * c.x), 1.0e-20)) - 3.0;
}
