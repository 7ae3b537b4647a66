// The nearest hit of a ray among the triangles of a bounding volume hierarchy.
// Twin: downpour_mask::bvh.

struct MaskBvhNode {
    low: vec3f,
    // Second child of an inner node (the first stands right behind it), or first triangle of a leaf.
    link: u32,
    high: vec3f,
    // Triangles of a leaf; 0 for an inner node.
    count: u32,
}

struct MaskBvhTriangle {
    corner: vec3f,
    // Index of the triangle in the mesh.
    index: u32,
    edge_1: vec3f,
    edge_2: vec3f,
}

struct MaskBvhHit {
    // Negative: nothing was hit.
    distance: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

@group(0) @binding(1) var<storage, read> mask_bvh_nodes: array<MaskBvhNode>;
@group(0) @binding(2) var<storage, read> mask_bvh_triangles: array<MaskBvhTriangle>;

// A number beyond every distance.
const MASK_BVH_FAR: f32 = 3.0e38;

// Whether the ray touches the box of a node before `limit`.
fn mask_bvh_touches(node: MaskBvhNode, origin: vec3f, inverse: vec3f, limit: f32) -> bool {
    let a = (node.low - origin) * inverse;
    let b = (node.high - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), max(near.z, 0.0));
    let leave = min(min(far.x, far.y), min(far.z, limit));
    // Rounding may put the two past each other by a few units in the last place.
    return enter <= leave * 1.000001 + 1.0e-7;
}

// Distance and the weights of the second and third corner where the ray meets the triangle's plane; distance -1
// where that is outside the triangle.
fn mask_bvh_triangle(triangle: MaskBvhTriangle, origin: vec3f, direction: vec3f) -> vec3f {
    let p = cross(direction, triangle.edge_2);
    let determinant = dot(triangle.edge_1, p);
    if determinant == 0.0 {
        return vec3f(-1.0, 0.0, 0.0);
    }
    let inverse = 1.0 / determinant;
    let from_corner = origin - triangle.corner;
    let u = dot(from_corner, p) * inverse;
    let q = cross(from_corner, triangle.edge_1);
    let v = dot(direction, q) * inverse;
    let slack = MASK_BVH_EDGE_SLACK;
    if u >= -slack && v >= -slack && u + v <= 1.0 + slack {
        return vec3f(dot(triangle.edge_2, q) * inverse, u, v);
    }
    return vec3f(-1.0, 0.0, 0.0);
}

// The inverse of a direction, without infinities: a ray along an axis gets a very steep slope instead.
fn mask_bvh_inverse(direction: vec3f) -> vec3f {
    let steep = select(vec3f(1.0e-20), direction, abs(direction) > vec3f(1.0e-20));
    return vec3f(1.0) / steep;
}

// The nearest hit farther than `nearest` along the ray.
fn mask_bvh_hit(origin: vec3f, direction: vec3f, nearest: f32) -> MaskBvhHit {
    let inverse = mask_bvh_inverse(direction);
    var best = MaskBvhHit(-1.0, 0u, 0.0, 0.0);
    var limit = MASK_BVH_FAR;
    var stack: array<u32, MASK_BVH_STACK>;
    stack[0] = 0u;
    var depth = 1u;
    // Each node is visited once at most, so this ends; a mesh of 65 535 nodes on one ray does not occur.
    while depth > 0u {
        depth -= 1u;
        let at = stack[depth];
        let node = mask_bvh_nodes[at];
        if !mask_bvh_touches(node, origin, inverse, limit) {
            continue;
        }
        if node.count == 0u {
            stack[depth] = node.link;
            stack[depth + 1u] = at + 1u;
            depth += 2u;
            continue;
        }
        for (var k = 0u; k < node.count; k += 1u) {
            let triangle = mask_bvh_triangles[node.link + k];
            let hit = mask_bvh_triangle(triangle, origin, direction);
            if hit.x > nearest && hit.x < limit {
                limit = hit.x;
                best = MaskBvhHit(hit.x, triangle.index, hit.y, hit.z);
            }
        }
    }
    return best;
}
