// The nearest hit of a ray among the triangles of a bounding volume hierarchy.
// Twin: downpour_bvh.

// The boxes of up to four children.
struct BvhNode {
    low_x: vec4f,
    low_y: vec4f,
    low_z: vec4f,
    high_x: vec4f,
    high_y: vec4f,
    high_z: vec4f,
    // Index of a node, below BVH_LEAF; or index of a leaf's first triangle, and from BVH_LEAF_SHIFT on the number of its triangles; or
    // BVH_NO_CHILD.
    child: vec4u,
}

struct BvhTriangle {
    corner: vec3f,
    // Index of the triangle in the mesh.
    index: u32,
    edge_1: vec3f,
    // 0 if nothing passes through; else a ray may, as through a leaf's holes or a pane of glass.
    lets_through: u32,
    edge_2: vec3f,
}

struct BvhHit {
    // Negative for a miss.
    distance: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

@group(0) @binding(1) var<storage, read> bvh_nodes: array<BvhNode>;
@group(0) @binding(2) var<storage, read> bvh_triangles: array<BvhTriangle>;

// Children of a node in the order in which a ray enters them, and the distances at which it does.
struct BvhOrder {
    enters: vec4f,
    child: vec4u,
}

// Distances, `nearest` at least, at which the ray is in the boxes of the children of a node, where they are below `limit`; BVH_FAR for
// other children.
fn bvh_enter(node: BvhNode, origin: vec3f, inverse: vec3f, nearest: f32, limit: f32) -> vec4f {
    let low_x = (node.low_x - origin.x) * inverse.x;
    let high_x = (node.high_x - origin.x) * inverse.x;
    let low_y = (node.low_y - origin.y) * inverse.y;
    let high_y = (node.high_y - origin.y) * inverse.y;
    let low_z = (node.low_z - origin.z) * inverse.z;
    let high_z = (node.high_z - origin.z) * inverse.z;
    let near = max(max(min(low_x, high_x), min(low_y, high_y)), max(min(low_z, high_z), vec4f(nearest)));
    let far = min(min(max(low_x, high_x), max(low_y, high_y)), min(max(low_z, high_z), vec4f(limit)));
    // As bvh_is_before.
    let met = near <= far * BVH_REACH + BVH_REACH_SLACK;
    return select(vec4f(BVH_FAR), near, met & (node.child != vec4u(BVH_NO_CHILD)));
}

// Orders children of a node by the distances at which a ray enters them.
fn bvh_order(enters: vec4f, child: vec4u) -> BvhOrder {
    // A network of five comparisons: of two pairs, of their nearer and of their farther ones, and of those in the middle.
    let first = enters.xz > enters.yw;
    let a = vec4f(select(enters.xz, enters.yw, first), select(enters.yw, enters.xz, first));
    let b = vec4u(select(child.xz, child.yw, first), select(child.yw, child.xz, first));
    let second = a.xz > a.yw;
    let c = vec4f(select(a.xz, a.yw, second), select(a.yw, a.xz, second));
    let d = vec4u(select(b.xz, b.yw, second), select(b.yw, b.xz, second));
    let last = c.y > c.z;
    let e = select(c.yz, c.zy, last);
    let f = select(d.yz, d.zy, last);
    return BvhOrder(vec4f(c.x, e, c.w), vec4u(d.x, f, d.w));
}

// True if a ray enters a box before a distance: rounding may swap the two by a few units in the last place.
fn bvh_is_before(enter: f32, distance: f32) -> bool {
    return enter <= distance * BVH_REACH + BVH_REACH_SLACK;
}

// Distance, and barycentric weights of the second and third corner, of the ray's intersection with the plane of
// the triangle; distance -1 if that is outside the triangle.
fn bvh_triangle(triangle: BvhTriangle, origin: vec3f, direction: vec3f) -> vec3f {
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
    let slack = BVH_EDGE_SLACK;
    if u >= -slack && v >= -slack && u + v <= 1.0 + slack {
        return vec3f(dot(triangle.edge_2, q) * inverse, u, v);
    }
    return vec3f(-1.0, 0.0, 0.0);
}

// Inverse of a direction, without infinities: a zero component is replaced by a tiny one.
fn bvh_inverse(direction: vec3f) -> vec3f {
    let steep = select(vec3f(1.0e-20), direction, abs(direction) > vec3f(1.0e-20));
    return vec3f(1.0) / steep;
}

// The triangles of a child that is a leaf: the index of the first, and the index after the last.
fn bvh_leaf(child: u32) -> vec2u {
    let first = child % BVH_LEAF;
    return vec2u(first, first + (child >> BVH_LEAF_SHIFT));
}

// Children that are still to be visited, and where the ray enters them. Of the invocation: a variable of the function would be filled with
// zeros for each ray.
var<private> bvh_stack: array<u32, BVH_STACK>;
var<private> bvh_enters: array<f32, BVH_STACK>;

// Nearest hit along the ray that is farther than `nearest` and nearer than `farthest`.
fn bvh_hit(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32) -> BvhHit {
    return bvh_walk(origin, direction, nearest, farthest, false);
}

// What is in the way of a ray between two distances: any hit of a triangle through which nothing passes, or the nearest hit of all if
// its triangle lets rays through; what is behind the latter may be left out.
fn bvh_blocker(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32) -> BvhHit {
    return bvh_walk(origin, direction, nearest, farthest, true);
}

// The nearest hit between two distances or, if `any`, the first that is found of a triangle through which nothing passes.
fn bvh_walk(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32, any: bool) -> BvhHit {
    let inverse = bvh_inverse(direction);
    var best = BvhHit(-1.0, 0u, 0.0, 0.0);
    var limit = farthest;
    var depth = 0u;
    var child = 0u;
    // Each node is visited once at most, so this ends.
    loop {
        if child < BVH_LEAF {
            let node = bvh_nodes[child];
            // The nearest child first: its triangles may hide the others.
            let order = bvh_order(bvh_enter(node, origin, inverse, nearest, limit), node.child);
            if order.enters.w < BVH_FAR {
                bvh_stack[depth] = order.child.w;
                bvh_enters[depth] = order.enters.w;
                depth += 1u;
            }
            if order.enters.z < BVH_FAR {
                bvh_stack[depth] = order.child.z;
                bvh_enters[depth] = order.enters.z;
                depth += 1u;
            }
            if order.enters.y < BVH_FAR {
                bvh_stack[depth] = order.child.y;
                bvh_enters[depth] = order.enters.y;
                depth += 1u;
            }
            if order.enters.x < BVH_FAR {
                child = order.child.x;
                continue;
            }
        } else {
            let of_leaf = bvh_leaf(child);
            for (var k = of_leaf.x; k < of_leaf.y; k += 1u) {
                let triangle = bvh_triangles[k];
                let hit = bvh_triangle(triangle, origin, direction);
                if hit.x > nearest && hit.x < limit {
                    limit = hit.x;
                    best = BvhHit(hit.x, triangle.index, hit.y, hit.z);
                    if any && triangle.lets_through == 0u {
                        // The walk ends as one that has seen all: lanes that leave it in another way are waited for.
                        depth = 0u;
                        break;
                    }
                }
            }
        }
        // The next stacked child that is nearer than the current hit.
        var found = false;
        while depth > 0u && !found {
            depth -= 1u;
            found = bvh_is_before(bvh_enters[depth], limit);
        }
        if !found {
            break;
        }
        child = bvh_stack[depth];
    }
    return best;
}
