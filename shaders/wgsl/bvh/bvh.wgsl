// The nearest hit of a ray among the triangles of a bounding volume hierarchy.
// Twin: downpour_bvh.

struct BvhNode {
    low: vec3f,
    // Index of the first child of an inner node (the second is right after it), or of the first triangle of a leaf.
    link: u32,
    high: vec3f,
    // Number of triangles of a leaf; 0 for an inner node.
    count: u32,
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

// Distance, `nearest` at least, at which the ray is in the box of a node, if it is below `limit`; BVH_FAR otherwise.
fn bvh_enter(node: BvhNode, origin: vec3f, inverse: vec3f, nearest: f32, limit: f32) -> f32 {
    let a = (node.low - origin) * inverse;
    let b = (node.high - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), max(near.z, nearest));
    let leave = min(min(far.x, far.y), min(far.z, limit));
    return select(BVH_FAR, enter, bvh_is_before(enter, leave));
}

// True if a ray enters a box before a distance: rounding may swap the two by a few units in the last place.
fn bvh_is_before(enter: f32, distance: f32) -> bool {
    return enter <= distance * 1.000001 + 1.0e-7;
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

// Nodes that are still to be visited, and where the ray enters them. Of the invocation: a variable of the function would be filled with
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
    var link = bvh_nodes[0].link;
    var count = bvh_nodes[0].count;
    if bvh_enter(bvh_nodes[0], origin, inverse, nearest, limit) >= BVH_FAR {
        return best;
    }
    // Each node is visited once at most, so this ends.
    loop {
        if count == 0u {
            // The nearer child first: its triangles may hide the other.
            let left = bvh_nodes[link];
            let right = bvh_nodes[link + 1u];
            let to_left = bvh_enter(left, origin, inverse, nearest, limit);
            let to_right = bvh_enter(right, origin, inverse, nearest, limit);
            let swap = to_right < to_left;
            if min(to_left, to_right) < BVH_FAR {
                if max(to_left, to_right) < BVH_FAR {
                    bvh_stack[depth] = link + select(1u, 0u, swap);
                    bvh_enters[depth] = max(to_left, to_right);
                    depth += 1u;
                }
                link = select(left.link, right.link, swap);
                count = select(left.count, right.count, swap);
                continue;
            }
        } else {
            for (var k = 0u; k < count; k += 1u) {
                let triangle = bvh_triangles[link + k];
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
        // The next stacked node that is nearer than the current hit.
        var found = false;
        while depth > 0u && !found {
            depth -= 1u;
            found = bvh_is_before(bvh_enters[depth], limit);
        }
        if !found {
            break;
        }
        link = bvh_nodes[bvh_stack[depth]].link;
        count = bvh_nodes[bvh_stack[depth]].count;
    }
    return best;
}
