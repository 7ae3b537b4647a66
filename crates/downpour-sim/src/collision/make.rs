//! Makes the texels of a map: a ray along the fall direction each.

use downpour_bvh::{BvhNode, BvhTriangle, bvh_enter, bvh_inverse, bvh_triangle};
use downpour_shaders::bvh::{BVH_FAR, BVH_STACK};
use downpour_shaders::sim::collision::{
    COLLISION_LAYERS, COLLISION_MAP_BACK, COLLISION_MAP_BETWEEN, COLLISION_MAP_FRONT, COLLISION_MAP_HITS,
    COLLISION_NONE, COLLISION_SOLID,
};
use glam::{UVec2, Vec2, Vec3};

use super::surface::collision_pack;
use super::{CollisionFrame, CollisionTexel};

/// Hits that are kept.
const HITS: usize = COLLISION_MAP_HITS as usize;
/// Surfaces of a texel.
const LAYERS: usize = COLLISION_LAYERS as usize;

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionMapHits {
    /// The nearest, ascending.
    pub depths: [f32; HITS],
    /// Their places in the list of triangles.
    pub slots: [u32; HITS],
    /// How many.
    pub count: usize,
    /// All surfaces met from behind less those met from the front.
    pub left: i32,
    /// The deepest one that faces the ray, -1 for none.
    pub deepest: f32,
    /// Its place in the list of triangles.
    pub deepest_slot: u32,
}

/// The normal of a triangle's front, with the length of twice its area.
fn front(triangle: &BvhTriangle) -> Vec3 {
    Vec3::from(triangle.edge_1).cross(triangle.edge_2.into())
}

/// Whether a triangle faces a ray.
#[must_use]
pub fn collision_map_faces(triangle: &BvhTriangle, direction: Vec3) -> bool {
    front(triangle).dot(direction) < 0.0
}

/// The normal of a triangle in the frame of the map, turned to the rain.
#[must_use]
pub fn collision_map_normal(map: &CollisionFrame, triangle: &BvhTriangle) -> Vec3 {
    let normal = front(triangle);
    let turned =
        Vec3::new(normal.dot(map.across.into()), normal.dot(map.along.into()), -normal.dot(map.fall.into()));
    turned * if turned.z < 0.0 { -1.0 } else { 1.0 }
}

/// Whether the space between two surfaces is open (0), solid (1), or has to be asked about (2). The surfaces are the faces that
/// they show to the rain, `COLLISION_MAP_FRONT` or `COLLISION_MAP_BACK` or both where several are in one place; 0 is none.
#[must_use]
pub fn collision_map_between(above: u32, below: u32) -> u32 {
    if below == 0 {
        return u32::from(above == COLLISION_MAP_FRONT);
    }
    if above == COLLISION_MAP_FRONT && below == COLLISION_MAP_BACK { 1 } else { 2 }
}

/// Everything on a ray.
#[must_use]
pub fn collision_map_walk(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    origin: Vec3,
    direction: Vec3,
) -> CollisionMapHits {
    let (from, towards) = (origin.to_array(), direction.to_array());
    let inverse = bvh_inverse(towards);
    let mut hits = CollisionMapHits {
        depths: [0.0; HITS],
        slots: [0; HITS],
        count: 0,
        left: 0,
        deepest: -1.0,
        deepest_slot: 0,
    };
    let mut stack = [0u32; BVH_STACK as usize];
    let mut depth = 1;
    while depth > 0 {
        depth -= 1;
        let at = stack[depth];
        let node = &nodes[at as usize];
        if bvh_enter(node, from, inverse, BVH_FAR) >= BVH_FAR {
            continue;
        }
        if node.count == 0 {
            stack[depth] = node.link;
            stack[depth + 1] = at + 1;
            depth += 2;
            continue;
        }
        for slot in node.link..node.link + node.count {
            let triangle = &triangles[slot as usize];
            let [distance, ..] = bvh_triangle(triangle, from, towards);
            if !(distance > 0.0 && distance < BVH_FAR) {
                continue;
            }
            let faces = collision_map_faces(triangle, direction);
            hits.left += if faces { -1 } else { 1 };
            if faces && distance > hits.deepest {
                hits.deepest = distance;
                hits.deepest_slot = slot;
            }
            // Insertion from the far end, which falls off when there is no room.
            let mut k = hits.count;
            if k == HITS {
                k -= 1;
                if distance >= hits.depths[k] {
                    continue;
                }
            } else {
                hits.count += 1;
            }
            while k > 0 && hits.depths[k - 1] > distance {
                hits.depths[k] = hits.depths[k - 1];
                hits.slots[k] = hits.slots[k - 1];
                k -= 1;
            }
            hits.depths[k] = distance;
            hits.slots[k] = slot;
        }
    }
    hits
}

/// Whether a place is within something closed: three of four rays sideways leave more surfaces than they enter.
#[must_use]
pub fn collision_map_enclosed(
    map: &CollisionFrame,
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    at: Vec3,
) -> bool {
    let mut votes = 0;
    for k in 0..4 {
        let axis = Vec3::from(if k >= 2 { map.along } else { map.across });
        let hits = collision_map_walk(nodes, triangles, at, axis * if k & 1 == 1 { -1.0 } else { 1.0 });
        votes += u32::from(hits.left > 0);
        // Two that say no decide it.
        if votes + 2 <= k + 1 {
            return false;
        }
    }
    true
}

/// A texel with one more surface, deeper than those that it has. `stored` is how many were added before; when there is no room,
/// the last place is for the deepest top of something solid, which is the ground.
#[must_use]
pub fn collision_map_add(
    texel: &CollisionTexel,
    stored: u32,
    depth: f32,
    surface: u32,
    above: bool,
    below: bool,
) -> CollisionTexel {
    let mut added = *texel;
    let last = LAYERS - 1;
    if stored as usize <= last {
        added.depths[stored as usize] = depth;
        added.surfaces[stored as usize] = surface | if below { COLLISION_SOLID } else { 0 };
    } else if below && !above {
        added.depths[last] = depth;
        added.surfaces[last] = surface | COLLISION_SOLID;
        // What was between is forgotten.
        added.surfaces[last - 1] &= !COLLISION_SOLID;
    }
    added
}

/// The surfaces of a texel.
#[must_use]
pub fn collision_map_texel(
    map: &CollisionFrame,
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    cell: UVec2,
) -> CollisionTexel {
    let mut texel = CollisionTexel::OPEN;
    if map.triangles == 0 {
        return texel;
    }
    let fall = Vec3::from(map.fall);
    let place = (cell.as_vec2() + 0.5) * Vec2::from(map.edge);
    let origin = Vec3::from(map.low)
        + Vec3::from(map.anchor)
        + Vec3::from(map.across) * place.x
        + Vec3::from(map.along) * place.y;
    let hits = collision_map_walk(nodes, triangles, origin, fall);
    let mut stored = 0;
    let mut next = 0;
    // The surface whose other side is still to be found.
    let (mut depth, mut surface, mut faces, mut above) = (-COLLISION_NONE, 0, 0, false);
    loop {
        // The next surface: all hits that are in one place.
        let first = next;
        let (mut next_depth, mut slot, mut next_faces) = (hits.deepest, hits.deepest_slot, 0);
        if first < hits.count {
            next_depth = hits.depths[first];
            slot = hits.slots[first];
        } else if first == HITS && hits.deepest > depth + map.merge {
            // Beyond what the list holds.
            next_faces = COLLISION_MAP_FRONT;
            next += 1;
        }
        while next < hits.count && hits.depths[next] <= next_depth + map.merge {
            let faced = collision_map_faces(&triangles[hits.slots[next] as usize], fall);
            next_faces |= if faced { COLLISION_MAP_FRONT } else { COLLISION_MAP_BACK };
            next += 1;
        }
        if first > 0 {
            let between = collision_map_between(faces, next_faces);
            let below = if between == 2 {
                let middle = depth + (next_depth - depth) * COLLISION_MAP_BETWEEN;
                collision_map_enclosed(map, nodes, triangles, origin + fall * middle)
            } else {
                between == 1
            };
            // What is inside something solid stops nothing.
            if !(above && below) {
                texel = collision_map_add(&texel, stored, depth, surface, above, below);
                stored += 1;
            }
            above = below;
        }
        if next_faces == 0 {
            return texel;
        }
        depth = next_depth;
        faces = next_faces;
        surface = collision_pack(collision_map_normal(map, &triangles[slot as usize]), false);
    }
}
