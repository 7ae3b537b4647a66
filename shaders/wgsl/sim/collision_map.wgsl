// Construction of the collision map by one ray along the fall direction per texel.
//
// Space below a surface that faces the rain and above one that faces away is solid, and so is the space below the last
// surface if that faces the rain. Between other surfaces, horizontal rays decide if the space is enclosed: a house that
// stands in the ground without a bottom is, the space between a leaf and the ground is not.
// Twin: downpour_sim::collision.

// Hits of a ray.
struct CollisionMapHits {
    // Depths of the nearest hits, ascending.
    depths: array<f32, COLLISION_MAP_HITS>,
    // Their indices in the list of triangles.
    slots: array<u32, COLLISION_MAP_HITS>,
    count: u32,
    // Depth of the deepest one that faces the ray, -1 for none, and its index in the list.
    deepest: f32,
    deepest_slot: u32,
}

@group(0) @binding(0) var<uniform> collision_map_frame: CollisionMap;
@group(0) @binding(3) var<storage, read_write> collision_map_texels: array<CollisionTexel>;

// True if a triangle faces a ray.
fn collision_map_faces(triangle: BvhTriangle, direction: vec3f) -> bool {
    return dot(cross(triangle.edge_1, triangle.edge_2), direction) < 0.0;
}

// Normal of a triangle in the frame of the map, facing the rain.
fn collision_map_normal(map: CollisionMap, triangle: BvhTriangle) -> vec3f {
    let normal = cross(triangle.edge_1, triangle.edge_2);
    let turned = vec3f(dot(normal, map.across), dot(normal, map.along), -dot(normal, map.fall));
    return turned * select(1.0, -1.0, turned.z < 0.0);
}

// State of the space between two surfaces: open (0), solid (1), or unknown (2). The arguments are the faces that the
// surfaces show to the rain, COLLISION_MAP_FRONT or COLLISION_MAP_BACK, or both for several at one depth; 0 is none.
fn collision_map_between(above: u32, below: u32) -> u32 {
    if below == 0u {
        return select(0u, 1u, above == COLLISION_MAP_FRONT);
    }
    return select(2u, 1u, above == COLLISION_MAP_FRONT && below == COLLISION_MAP_BACK);
}

// Finds the first `keep` surfaces on a ray. Only if there are that many, the deepest one is searched for as well.
fn collision_map_walk(origin: vec3f, direction: vec3f, keep: u32) -> CollisionMapHits {
    let inverse = bvh_inverse(direction);
    var hits: CollisionMapHits;
    hits.deepest = -1.0;
    var limit = BVH_FAR;
    var depth = 1u;
    bvh_stack[0] = 0u;
    bvh_enters[0] = 0.0;
    // Each node is visited once at most, so this ends.
    while depth > 0u {
        depth -= 1u;
        let child = bvh_stack[depth];
        if !bvh_is_before(bvh_enters[depth], limit) {
            continue;
        }
        if child < BVH_LEAF {
            // The nearest child first: its triangles may make the others unnecessary.
            let node = bvh_nodes[child];
            let order = bvh_order(bvh_enter(node, origin, inverse, 0.0, limit), node.child);
            for (var k = 4u; k > 0u; k -= 1u) {
                if order.enters[k - 1u] < BVH_FAR {
                    bvh_stack[depth] = order.child[k - 1u];
                    bvh_enters[depth] = order.enters[k - 1u];
                    depth += 1u;
                }
            }
            continue;
        }
        let of_leaf = bvh_leaf(child);
        for (var slot = of_leaf.x; slot < of_leaf.y; slot += 1u) {
            let triangle = bvh_triangles[slot];
            let distance = bvh_triangle(triangle, origin, direction).x;
            if !(distance > 0.0 && distance < limit) {
                continue;
            }
            if distance > hits.deepest && collision_map_faces(triangle, direction) {
                hits.deepest = distance;
                hits.deepest_slot = slot;
            }
            // Insertion sort from the far end, which drops out if the list is full.
            var k = hits.count;
            if k == keep {
                k -= 1u;
                if distance >= hits.depths[k] {
                    continue;
                }
            } else {
                hits.count += 1u;
            }
            while k > 0u && hits.depths[k - 1u] > distance {
                hits.depths[k] = hits.depths[k - 1u];
                hits.slots[k] = hits.slots[k - 1u];
                k -= 1u;
            }
            hits.depths[k] = distance;
            hits.slots[k] = slot;
            if hits.count == keep && keep < COLLISION_MAP_HITS {
                limit = hits.depths[keep - 1u];
            }
        }
    }
    return hits;
}

// True if a position is enclosed: two of three horizontal rays soon leave more surfaces than they enter.
fn collision_map_enclosed(map: CollisionMap, at: vec3f) -> bool {
    var votes = 0u;
    for (var turn = 0u; turn < 3u; turn += 1u) {
        let axis = select(map.across, map.along, turn == 1u);
        let direction = axis * select(1.0, -1.0, turn == 2u);
        let hits = collision_map_walk(at, direction, COLLISION_MAP_LEAVES);
        var left = 0;
        var leaves = 0u;
        for (var k = 0u; k < hits.count; k += 1u) {
            left += select(1, -1, collision_map_faces(bvh_triangles[hits.slots[k]], direction));
            leaves |= select(0u, 1u, left > 0);
        }
        votes += leaves;
        // The first two may be enough.
        if turn == 1u && votes != 1u {
            break;
        }
    }
    return votes >= 2u;
}

// Adds a surface to a texel, deeper than the existing ones. `stored` is the number of surfaces added before; if the
// texel is full, its last slot holds the deepest top of a solid, which is the ground.
fn collision_map_add(
    texel: CollisionTexel,
    stored: u32,
    depth: f32,
    surface: u32,
    above: bool,
    below: bool,
) -> CollisionTexel {
    var added = texel;
    let last = COLLISION_LAYERS - 1u;
    if stored <= last {
        added.depths[stored] = depth;
        added.surfaces[stored] = surface | select(0u, COLLISION_SOLID, below);
    } else if below && !above {
        added.depths[last] = depth;
        added.surfaces[last] = surface | COLLISION_SOLID;
        // The state of the space in between is lost.
        added.surfaces[last - 1u] &= ~COLLISION_SOLID;
    }
    return added;
}

// Computes the surfaces of a texel.
fn collision_map_texel(map: CollisionMap, cell: vec2u) -> CollisionTexel {
    var texel = CollisionTexel(vec4f(COLLISION_NONE), vec4u(0u));
    if map.triangles == 0u {
        return texel;
    }
    let position = (vec2f(cell) + 0.5) * map.edge;
    let origin = map.low + map.anchor + map.across * position.x + map.along * position.y;
    let hits = collision_map_walk(origin, map.fall, COLLISION_MAP_HITS);
    var stored = 0u;
    var next = 0u;
    // The surface whose other side is not yet known.
    var depth = -COLLISION_NONE;
    var surface = 0u;
    var faces = 0u;
    var above = false;
    loop {
        // The next surface: all hits at one depth.
        let first = next;
        var next_depth = hits.deepest;
        var slot = hits.deepest_slot;
        var next_faces = 0u;
        if first < hits.count {
            next_depth = hits.depths[first];
            slot = hits.slots[first];
        } else if first == COLLISION_MAP_HITS && hits.deepest > depth + map.merge {
            // Beyond what the list holds.
            next_faces = COLLISION_MAP_FRONT;
            next += 1u;
        }
        while next < hits.count && hits.depths[next] <= next_depth + map.merge {
            let faced = collision_map_faces(bvh_triangles[hits.slots[next]], map.fall);
            next_faces |= select(COLLISION_MAP_BACK, COLLISION_MAP_FRONT, faced);
            next += 1u;
        }
        if first > 0u {
            let between = collision_map_between(faces, next_faces);
            var below = between == 1u;
            if between == 2u {
                let middle = depth + (next_depth - depth) * COLLISION_MAP_BETWEEN;
                below = collision_map_enclosed(map, origin + map.fall * middle);
            }
            // Surfaces inside a solid stop nothing.
            if !(above && below) {
                texel = collision_map_add(texel, stored, depth, surface, above, below);
                stored += 1u;
            }
            above = below;
        }
        if next_faces == 0u {
            break;
        }
        depth = next_depth;
        faces = next_faces;
        surface = collision_pack(collision_map_normal(map, bvh_triangles[slot]), false);
    }
    return texel;
}

@compute @workgroup_size(8, 8)
fn main_collision_map(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= collision_map_frame.size) {
        return;
    }
    collision_map_texels[id.y * collision_map_frame.size.x + id.x] = collision_map_texel(collision_map_frame, id.xy);
}
