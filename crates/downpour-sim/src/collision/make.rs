//! Construction of the texels of a map by one ray along the fall direction each.
//!
//! Surfaces may have holes ([`Holes`]). The kernel of the same name does not support them: maps with holes are made
//! here.

use downpour_bvh::{
    BvhNode, BvhTriangle, Hit, bvh_enter, bvh_inverse, bvh_is_before, bvh_leaf, bvh_order, bvh_triangle,
};
use downpour_shaders::bvh::{BVH_FAR, BVH_LEAF, BVH_STACK};
use downpour_shaders::sim::collision::{
    COLLISION_LAYERS, COLLISION_MAP_BACK, COLLISION_MAP_BETWEEN, COLLISION_MAP_FRONT, COLLISION_MAP_HITS,
    COLLISION_MAP_LEAVES, COLLISION_NONE, COLLISION_SOLID,
};
use glam::{UVec2, Vec2, Vec3};

use super::surface::collision_pack;
use super::{CollisionFrame, CollisionTexel};
use crate::shelter::Holes;

/// Maximum number of hits kept.
const HITS: usize = COLLISION_MAP_HITS as usize;
/// Number of surfaces of a texel.
const LAYERS: usize = COLLISION_LAYERS as usize;

/// Hits of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionMapHits {
    /// Depths of the nearest hits, ascending.
    pub depths: [f32; HITS],
    /// Their indices in the list of triangles.
    pub slots: [u32; HITS],
    /// Number of hits.
    pub count: usize,
    /// Depth of the deepest one that faces the ray, -1 for none.
    pub deepest: f32,
    /// Its index in the list of triangles.
    pub deepest_slot: u32,
}

/// Normal of a triangle's front, with the length of twice its area.
fn front(triangle: &BvhTriangle) -> Vec3 {
    Vec3::from(triangle.edge_1).cross(triangle.edge_2.into())
}

/// True if a triangle faces a ray.
#[must_use]
pub fn collision_map_faces(triangle: &BvhTriangle, direction: Vec3) -> bool {
    front(triangle).dot(direction) < 0.0
}

/// Normal of a triangle in the frame of the map, facing the rain.
#[must_use]
pub fn collision_map_normal(map: &CollisionFrame, triangle: &BvhTriangle) -> Vec3 {
    let normal = front(triangle);
    let turned =
        Vec3::new(normal.dot(map.across.into()), normal.dot(map.along.into()), -normal.dot(map.fall.into()));
    turned * if turned.z < 0.0 { -1.0 } else { 1.0 }
}

/// State of the space between two surfaces: open (0), solid (1), or unknown (2). The arguments are the faces that the
/// surfaces show to the rain, `COLLISION_MAP_FRONT` or `COLLISION_MAP_BACK`, or both for several at one depth; 0 is
/// none.
#[must_use]
pub fn collision_map_between(above: u32, below: u32) -> u32 {
    if below == 0 {
        return u32::from(above == COLLISION_MAP_FRONT);
    }
    if above == COLLISION_MAP_FRONT && below == COLLISION_MAP_BACK { 1 } else { 2 }
}

/// Finds the first `keep` surfaces on a ray. Only if there are that many, the deepest one is searched for as well.
#[must_use]
pub fn collision_map_walk(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    holes: Option<&dyn Holes>,
    origin: Vec3,
    direction: Vec3,
    keep: u32,
) -> CollisionMapHits {
    let (from, towards) = (origin.to_array(), direction.to_array());
    let inverse = bvh_inverse(towards);
    let keep = keep as usize;
    let mut hits =
        CollisionMapHits { depths: [0.0; HITS], slots: [0; HITS], count: 0, deepest: -1.0, deepest_slot: 0 };
    let mut limit = BVH_FAR;
    let mut stack = [(0u32, 0.0f32); BVH_STACK as usize];
    let mut depth = 1;
    while depth > 0 {
        depth -= 1;
        let (child, enter) = stack[depth];
        if !bvh_is_before(enter, limit) {
            continue;
        }
        if child < BVH_LEAF {
            // The nearest child first: its triangles may make the others unnecessary.
            let node = &nodes[child as usize];
            let order = bvh_order(bvh_enter(node, from, inverse, 0.0, limit), node.child);
            for k in (0..4).rev().filter(|&k| order.enters[k] < BVH_FAR) {
                stack[depth] = (order.child[k], order.enters[k]);
                depth += 1;
            }
            continue;
        }
        for slot in bvh_leaf(child) {
            let triangle = &triangles[slot];
            let [distance, u, v] = bvh_triangle(triangle, from, towards);
            if !(distance > 0.0 && distance < limit) {
                continue;
            }
            if holes.is_some_and(|holes| holes.is_hole(&Hit { distance, triangle: triangle.index, u, v })) {
                continue;
            }
            if distance > hits.deepest && collision_map_faces(triangle, direction) {
                hits.deepest = distance;
                hits.deepest_slot = slot as u32;
            }
            // Insertion sort from the far end, which drops out if the list is full.
            let mut k = hits.count;
            if k == keep {
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
            hits.slots[k] = slot as u32;
            if hits.count == keep && keep < HITS {
                limit = hits.depths[keep - 1];
            }
        }
    }
    hits
}

/// True if a position is enclosed: two of three horizontal rays soon leave more surfaces than they enter.
#[must_use]
pub fn collision_map_enclosed(
    map: &CollisionFrame,
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    holes: Option<&dyn Holes>,
    at: Vec3,
) -> bool {
    let mut votes = 0;
    for turn in 0..3 {
        let axis = Vec3::from(if turn == 1 { map.along } else { map.across });
        let direction = axis * if turn == 2 { -1.0 } else { 1.0 };
        let hits = collision_map_walk(nodes, triangles, holes, at, direction, COLLISION_MAP_LEAVES);
        let (mut left, mut leaves) = (0, false);
        for &slot in &hits.slots[..hits.count] {
            left += if collision_map_faces(&triangles[slot as usize], direction) { -1 } else { 1 };
            leaves |= left > 0;
        }
        votes += u32::from(leaves);
        // The first two may be enough.
        if turn == 1 && votes != 1 {
            break;
        }
    }
    votes >= 2
}

/// Adds a surface to a texel, deeper than the existing ones. `stored` is the number of surfaces added before; if the
/// texel is full, its last slot holds the deepest top of a solid, which is the ground.
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
        // The state of the space in between is lost.
        added.surfaces[last - 1] &= !COLLISION_SOLID;
    }
    added
}

/// Computes the surfaces of a texel.
#[must_use]
pub fn collision_map_texel(
    map: &CollisionFrame,
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    holes: Option<&dyn Holes>,
    cell: UVec2,
) -> CollisionTexel {
    let mut texel = CollisionTexel::OPEN;
    if map.triangles == 0 {
        return texel;
    }
    let fall = Vec3::from(map.fall);
    let position = (cell.as_vec2() + 0.5) * Vec2::from(map.edge);
    let origin = Vec3::from(map.low)
        + Vec3::from(map.anchor)
        + Vec3::from(map.across) * position.x
        + Vec3::from(map.along) * position.y;
    let hits = collision_map_walk(nodes, triangles, holes, origin, fall, COLLISION_MAP_HITS);
    let mut stored = 0;
    let mut next = 0;
    // The surface whose other side is not yet known.
    let (mut depth, mut surface, mut faces, mut above) = (-COLLISION_NONE, 0, 0, false);
    loop {
        // The next surface: all hits at one depth.
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
                collision_map_enclosed(map, nodes, triangles, holes, origin + fall * middle)
            } else {
                between == 1
            };
            // Surfaces inside a solid stop nothing.
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
