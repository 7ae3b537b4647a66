//! A bounding volume hierarchy over triangles, and the nearest hit of a ray.
//!
//! [`Bvh::new`] builds it from the triangles' corners; [`bvh_hit`] finds what a ray meets first, [`bvh_blocker`] whether it meets
//! anything, as shadows ask. A node has the boxes of up to four children, which a ray is tested against at once; leaves refer to a
//! reordered list of triangles. The build depends on the triangles only: the same mesh gives the same tree.
//!
//! Twin of the walk in `shaders/wgsl/bvh/bvh.wgsl`.

mod bounds;
mod build;

use std::ops::Range;

use bounds::Bounds;
use downpour_math::vector::{cross, dot, sub};
use downpour_shaders::bvh::{
    BVH_FAR, BVH_LEAF, BVH_LEAF_SHIFT, BVH_NO_CHILD, BVH_REACH, BVH_REACH_SLACK, BVH_STACK,
};
use glam::{BVec4, Vec4};

/// Barycentric slack: a ray through a shared edge must not slip between the two triangles.
const EDGE_SLACK: f32 = downpour_shaders::bvh::BVH_EDGE_SLACK;

/// A node: the boxes of its children. The same layout as `BvhNode` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BvhNode {
    /// Lower corners of the children's bounding boxes.
    pub low_x: [f32; 4],
    /// See [`BvhNode::low_x`].
    pub low_y: [f32; 4],
    /// See [`BvhNode::low_x`].
    pub low_z: [f32; 4],
    /// Upper corners of the children's bounding boxes.
    pub high_x: [f32; 4],
    /// See [`BvhNode::high_x`].
    pub high_y: [f32; 4],
    /// See [`BvhNode::high_x`].
    pub high_z: [f32; 4],
    /// Children: the index of a node, below `BVH_LEAF`; or the index of a leaf's first triangle, with the number of its triangles in the
    /// bits from `BVH_LEAF_SHIFT` on; or `BVH_NO_CHILD`.
    pub child: [u32; 4],
}

/// Corner and edges of a triangle, as the intersection test needs them. The same layout as `BvhTriangle` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BvhTriangle {
    /// First corner.
    pub corner: [f32; 3],
    /// Index of the triangle in the mesh.
    pub index: u32,
    /// Second corner minus the first.
    pub edge_1: [f32; 3],
    /// 0 if nothing passes through; else a ray may, as through a leaf's holes or a pane of glass, and whoever casts it looks closer.
    pub lets_through: u32,
    /// Third corner minus the first.
    pub edge_2: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding: u32,
}

impl BvhTriangle {
    /// The three corners.
    #[must_use]
    pub fn corners(&self) -> [[f32; 3]; 3] {
        let to = |edge: [f32; 3]| std::array::from_fn(|k| self.corner[k] + edge[k]);
        [self.corner, to(self.edge_1), to(self.edge_2)]
    }
}

/// Intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in units of the length of its direction.
    pub distance: f32,
    /// Index of the triangle in the mesh.
    pub triangle: u32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
}

/// Bounding volume hierarchy over triangles.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Nodes, the root first, each before its children.
    pub nodes: Vec<BvhNode>,
    /// Triangles in the order of the leaves.
    pub triangles: Vec<BvhTriangle>,
}

impl Bvh {
    /// Nearest hit along the ray that is farther than `nearest`.
    #[must_use]
    pub fn hit(&self, origin: [f32; 3], direction: [f32; 3], nearest: f32) -> Option<Hit> {
        bvh_hit(&self.nodes, &self.triangles, origin, direction, nearest, BVH_FAR)
    }
}

/// Nearest hit along the ray that is farther than `nearest` and nearer than `farthest`, in the arrays of a [`Bvh`].
#[must_use]
pub fn bvh_hit(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    origin: [f32; 3],
    direction: [f32; 3],
    nearest: f32,
    farthest: f32,
) -> Option<Hit> {
    bvh_walk::<false>(nodes, triangles, origin, direction, nearest, farthest)
}

/// A hit in the way of a ray between two distances, in the arrays of a [`Bvh`]: any of a triangle through which nothing passes, or
/// the nearest hit of all if its triangle [lets rays through](BvhTriangle::lets_through); what is behind the latter may be left out.
#[must_use]
pub fn bvh_blocker(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    origin: [f32; 3],
    direction: [f32; 3],
    nearest: f32,
    farthest: f32,
) -> Option<Hit> {
    bvh_walk::<true>(nodes, triangles, origin, direction, nearest, farthest)
}

/// The nearest hit between two distances or, if `ANY`, the first that is found of a triangle through which nothing passes.
fn bvh_walk<const ANY: bool>(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    origin: [f32; 3],
    direction: [f32; 3],
    nearest: f32,
    farthest: f32,
) -> Option<Hit> {
    let inverse = bvh_inverse(direction);
    let mut best: Option<Hit> = None;
    let mut limit = farthest;
    // Children to be visited, and where the ray enters them.
    let mut stack = [(0u32, 0.0f32); BVH_STACK as usize];
    let mut depth = 0;
    let mut child = 0;
    loop {
        if child < BVH_LEAF {
            let node = &nodes[child as usize];
            let enters = bvh_enter(node, origin, inverse, nearest, limit);
            // The nearest child first: its triangles may hide the others.
            let order = bvh_order(enters, node.child);
            for k in (1..4).rev() {
                if order.enters[k] < BVH_FAR {
                    stack[depth] = (order.child[k], order.enters[k]);
                    depth += 1;
                }
            }
            if order.enters[0] < BVH_FAR {
                child = order.child[0];
                continue;
            }
        } else {
            for triangle in &triangles[bvh_leaf(child)] {
                let [distance, u, v] = bvh_triangle(triangle, origin, direction);
                if distance > nearest && distance < limit {
                    limit = distance;
                    best = Some(Hit { distance, triangle: triangle.index, u, v });
                    if ANY && triangle.lets_through == 0 {
                        return best;
                    }
                }
            }
        }
        // The next stacked child that is nearer than the current hit.
        loop {
            if depth == 0 {
                return best;
            }
            depth -= 1;
            let (far, enter) = stack[depth];
            if bvh_is_before(enter, limit) {
                child = far;
                break;
            }
        }
    }
}

/// The triangles of a child that is a leaf.
#[inline(always)]
#[must_use]
pub fn bvh_leaf(child: u32) -> Range<usize> {
    let first = (child % BVH_LEAF) as usize;
    first..first + (child >> BVH_LEAF_SHIFT) as usize
}

/// Children of a node in the order in which a ray enters them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhOrder {
    /// Distances at which the ray enters them, the nearest first.
    pub enters: [f32; 4],
    /// The children.
    pub child: [u32; 4],
}

/// Orders children of a node by the distances at which a ray enters them.
#[inline(always)]
#[must_use]
pub fn bvh_order(enters: [f32; 4], child: [u32; 4]) -> BvhOrder {
    let mut order = BvhOrder { enters, child };
    // A network of five comparisons.
    for [a, b] in [[0, 1], [2, 3], [0, 2], [1, 3], [1, 2]] {
        if order.enters[a] > order.enters[b] {
            order.enters.swap(a, b);
            order.child.swap(a, b);
        }
    }
    order
}

/// Corners, the lower first, of the box around all triangles; `None` without any.
#[must_use]
pub fn bvh_bounds(nodes: &[BvhNode]) -> Option<[[f32; 3]; 2]> {
    let root = nodes.first().filter(|root| root.child[0] != BVH_NO_CHILD)?;
    let Bounds { low, high } = root.whole();
    Some([low, high])
}

impl BvhNode {
    /// A node without children.
    const EMPTY: Self = Self {
        low_x: [0.0; 4],
        low_y: [0.0; 4],
        low_z: [0.0; 4],
        high_x: [0.0; 4],
        high_y: [0.0; 4],
        high_z: [0.0; 4],
        child: [BVH_NO_CHILD; 4],
    };

    /// The box around all children.
    fn whole(&self) -> Bounds {
        let children = (0..4).filter(|&k| self.child[k] != BVH_NO_CHILD);
        children.fold(Bounds::NONE, |all, k| all.union(self.bounds(k)))
    }

    /// The box of a child.
    fn bounds(&self, k: usize) -> Bounds {
        Bounds {
            low: [self.low_x[k], self.low_y[k], self.low_z[k]],
            high: [self.high_x[k], self.high_y[k], self.high_z[k]],
        }
    }
}

/// Corners, the lower first, of a box that holds all that lies in the box between `low` and `high` of those triangles that are `wanted`
/// (`None`: of all), and itself lies in it; `None` if that is nothing.
#[must_use]
pub fn bvh_bounds_within(
    nodes: &[BvhNode],
    triangles: &[BvhTriangle],
    low: [f32; 3],
    high: [f32; 3],
    wanted: Option<&dyn Fn(&BvhTriangle) -> bool>,
) -> Option<[[f32; 3]; 2]> {
    let whole = Bounds { low, high };
    let mut found = Bounds::NONE;
    let mut stack = vec![0];
    while let Some(node) = stack.pop().and_then(|index: u32| nodes.get(index as usize)) {
        for (k, &child) in node.child.iter().enumerate().filter(|child| *child.1 != BVH_NO_CHILD) {
            let bounds = node.bounds(k);
            let Some(common) = bounds.common(&whole) else { continue };
            if found.common(&common) == Some(common) {
                continue;
            }
            if child < BVH_LEAF && wanted.is_none() && common == bounds {
                found = found.union(bounds);
                continue;
            }
            if child < BVH_LEAF {
                stack.push(child);
                continue;
            }
            for triangle in &triangles[bvh_leaf(child)] {
                let [a, b, c] = triangle.corners();
                let bounds = Bounds::NONE.with(a).with(b).with(c);
                if let Some(common) = bounds.common(&whole)
                    && wanted.is_none_or(|wanted| wanted(triangle))
                {
                    found = found.union(common);
                }
            }
        }
    }
    found.low[0].is_finite().then_some([found.low, found.high])
}

/// Inverse of a direction, without infinities: a zero component is replaced by a tiny one.
#[must_use]
pub fn bvh_inverse(direction: [f32; 3]) -> [f32; 3] {
    direction.map(|d| 1.0 / if d.abs() > 1.0e-20 { d } else { 1.0e-20 })
}

/// Distances, `nearest` at least, at which the ray is in the boxes of the children of `node`, where they are below `limit`; `BVH_FAR`
/// for other children.
#[inline(always)]
#[must_use]
pub fn bvh_enter(node: &BvhNode, origin: [f32; 3], inverse: [f32; 3], nearest: f32, limit: f32) -> [f32; 4] {
    // SIMD vectors: this test dominates the time of a picture.
    let along = |axis: usize, low: [f32; 4], high: [f32; 4]| {
        let a = (Vec4::from(low) - origin[axis]) * inverse[axis];
        let b = (Vec4::from(high) - origin[axis]) * inverse[axis];
        (a.min(b), a.max(b))
    };
    let (near_x, far_x) = along(0, node.low_x, node.high_x);
    let (near_y, far_y) = along(1, node.low_y, node.high_y);
    let (near_z, far_z) = along(2, node.low_z, node.high_z);
    let enter = near_x.max(near_y).max(near_z.max(Vec4::splat(nearest)));
    let leave = far_x.min(far_y).min(far_z.min(Vec4::splat(limit)));
    let is_child = BVec4::from_array(node.child.map(|child| child != BVH_NO_CHILD));
    let met = enter.cmple(leave * BVH_REACH + BVH_REACH_SLACK);
    std::array::from_fn(|k| if met.test(k) && is_child.test(k) { enter[k] } else { BVH_FAR })
}

/// True if a ray enters a box before a distance: rounding may swap the two by a few units in the last place.
#[inline(always)]
#[must_use]
pub fn bvh_is_before(enter: f32, distance: f32) -> bool {
    enter <= distance * BVH_REACH + BVH_REACH_SLACK
}

/// Distance, and barycentric weights of the second and third corner, of the ray's intersection with the plane of
/// the triangle; distance -1 if that is outside the triangle (T. Moller, B. Trumbore, "Fast, minimum storage
/// ray-triangle intersection", 1997).
#[must_use]
pub fn bvh_triangle(triangle: &BvhTriangle, origin: [f32; 3], direction: [f32; 3]) -> [f32; 3] {
    let p = cross(direction, triangle.edge_2);
    let determinant = dot(triangle.edge_1, p);
    let inverse = 1.0 / determinant;
    let from = sub(origin, triangle.corner);
    let u = dot(from, p) * inverse;
    let q = cross(from, triangle.edge_1);
    let v = dot(direction, q) * inverse;
    let inside = determinant != 0.0 && u >= -EDGE_SLACK && v >= -EDGE_SLACK && u + v <= 1.0 + EDGE_SLACK;
    if inside { [dot(triangle.edge_2, q) * inverse, u, v] } else { [-1.0, 0.0, 0.0] }
}

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::LEAF;
    use downpour_math::rng::{rng_draw, rng_unit};

    fn soup(n: u32) -> Vec<[[f32; 3]; 3]> {
        (0..n)
            .map(|i| {
                let position = rng_draw([1, 2], i, 0, 0).map(rng_unit);
                std::array::from_fn(|corner| {
                    let offset = rng_draw([3, 4], i, corner as u32, 0).map(rng_unit);
                    std::array::from_fn(|k| position[k] * 4.0 + 0.5 * offset[k])
                })
            })
            .collect()
    }

    /// All children of all nodes, and their boxes.
    fn children(bvh: &Bvh) -> impl Iterator<Item = (Bounds, u32)> {
        let of = |node: &BvhNode| (0..4).map(|k| (node.bounds(k), node.child[k])).collect::<Vec<_>>();
        bvh.nodes.iter().flat_map(of).filter(|(_, child)| *child != BVH_NO_CHILD)
    }

    /// Rays through a box: in all directions, some along an axis, for which the walk divides by zero.
    fn rays(n: u32, low: f32, high: f32) -> impl Iterator<Item = ([f32; 3], [f32; 3])> {
        (0..n).map(move |i| {
            let [a, b] = [0, 1].map(|k| rng_draw([5, 6], i, k, 0).map(rng_unit));
            let origin = std::array::from_fn(|k| low + (high - low) * a[k]);
            let mut direction: [f32; 3] = std::array::from_fn(|k| b[k] - 0.5);
            if i % 3 == 0 {
                direction[(i % 2) as usize] = 0.0;
            }
            (origin, direction)
        })
    }

    /// Distances and triangles of all hits beyond one, the nearest first.
    fn brute_force(
        bvh: &Bvh,
        (origin, direction): ([f32; 3], [f32; 3]),
        nearest: f32,
    ) -> Vec<(f32, BvhTriangle)> {
        let of = |t: &BvhTriangle| (bvh_triangle(t, origin, direction)[0], *t);
        let mut all: Vec<_> = bvh.triangles.iter().map(of).filter(|hit| hit.0 > nearest).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// The tree finds the same hit as a loop over all triangles.
    #[test]
    fn nearest_hit_is_that_of_brute_force() {
        let bvh = Bvh::new(&soup(800));
        let mut hits = 0;
        for ray in rays(3000, -1.0, 5.0) {
            let expected = brute_force(&bvh, ray, 1.0e-4).first().map(|hit| hit.0);
            let found = bvh.hit(ray.0, ray.1, 1.0e-4);
            assert_eq!(found.map(|h| h.distance), expected, "{ray:?}");
            hits += u32::from(found.is_some());
        }
        assert!(hits > 300, "only {hits} rays hit anything");
    }

    /// What blocks a ray is found where there is something: any triangle through which nothing passes, or what is nearest.
    #[test]
    fn a_blocker_is_one_of_all_hits() {
        let mut bvh = Bvh::new(&soup(800));
        for triangle in &mut bvh.triangles {
            triangle.lets_through = u32::from(triangle.index % 2 == 0);
        }
        let (mut solid, mut open, mut nearer) = (0, 0, 0);
        for ray in rays(9000, -1.0, 5.0) {
            let farthest = 8.0;
            let found = bvh_blocker(&bvh.nodes, &bvh.triangles, ray.0, ray.1, 1.0e-4, farthest);
            let mut all = brute_force(&bvh, ray, 1.0e-4);
            all.retain(|hit| hit.0 < farthest);
            let solids: Vec<_> = all.iter().filter(|hit| hit.1.lets_through == 0).collect();
            match found {
                None => assert!(all.is_empty(), "{ray:?}"),
                Some(hit) => {
                    let is_hit =
                        |one: &&(f32, BvhTriangle)| one.1.index == hit.triangle && one.0 == hit.distance;
                    let is_solid = solids.iter().any(&is_hit);
                    assert!(is_solid || is_hit(&&all[0]), "{ray:?}: {hit:?}");
                    solid += u32::from(is_solid);
                    open += u32::from(!is_solid);
                    nearer += u32::from(hit.distance > all[0].0);
                }
            }
        }
        assert!(
            solid > 300 && open > 300 && nearer > 10,
            "{solid} solid, {open} open, {nearer} not the nearest"
        );
    }

    /// Levels of nodes of a tree.
    fn levels(bvh: &Bvh) -> usize {
        let mut deepest = 0;
        let mut stack = vec![(0, 1)];
        while let Some((at, level)) = stack.pop() {
            deepest = deepest.max(level);
            let inner = bvh.nodes[at as usize].child.into_iter().filter(|&child| child < BVH_LEAF);
            stack.extend(inner.map(|child| (child, level + 1)));
        }
        deepest
    }

    /// Triangles one within another, each larger than the last: a tree that is a chain.
    fn chain() -> Vec<[[f32; 3]; 3]> {
        let sizes = std::iter::successors(Some(1.0f32), |size| Some(size * 1.08)).take(700);
        sizes.map(|size| [[-size, 0.0, -size], [size, 0.1 * size, -size], [0.0, -0.1 * size, size]]).collect()
    }

    /// The walk's stack has room for all of a chain.
    #[test]
    fn a_chain_is_no_deeper_than_the_stack() {
        let bvh = Bvh::new(&chain());
        // Each level leaves three children on the stack, and a walk may begin with the root on it.
        assert!(3 * levels(&bvh) < BVH_STACK as usize, "{} levels", levels(&bvh));
        assert!(levels(&bvh) > 10, "{} levels are no chain", levels(&bvh));
        for ray in rays(300, -100.0, 100.0) {
            let expected = brute_force(&bvh, ray, 1.0e-4).first().map(|hit| hit.0);
            let found = bvh.hit(ray.0, ray.1, 1.0e-4);
            assert_eq!(found.map(|h| h.distance), expected, "{ray:?}");
        }
    }

    /// Two hierarchies below one root are as good as one over all their triangles, and have their triangles one behind the other; so is one
    /// beside none, and one of a chain that is as deep as may be.
    #[test]
    fn joined_hierarchies_are_met_as_one() {
        let corners = soup(600);
        let chain = chain();
        for (first, second) in [
            corners.split_at(450),
            corners.split_at(0),
            corners.split_at(600),
            (&corners, &chain),
            (&chain, &corners),
        ] {
            let [a, b] = [first, second].map(Bvh::new);
            let joined = a.joined(&b);
            let all = [first, second].concat();
            let (count, nodes) = (first.len(), a.nodes.len());
            assert_eq!(joined.triangles.len(), all.len());
            // What is of the first stays as it is, but for where its nodes' children are.
            assert!(joined.triangles[..count] == a.triangles[..]);
            assert!(
                joined.nodes[1..1 + nodes]
                    .iter()
                    .zip(&a.nodes)
                    .all(|(x, y)| x.low_x == y.low_x && x.high_z == y.high_z)
            );
            assert!(joined.triangles[count..].iter().all(|t| all[t.index as usize][0] == t.corner));
            for ray in rays(400, -2.0, 6.0) {
                let expected = brute_force(&joined, ray, 1.0e-4).first().map(|hit| hit.0);
                assert_eq!(joined.hit(ray.0, ray.1, 1.0e-4).map(|hit| hit.distance), expected, "{ray:?}");
            }
        }
    }

    /// Corners that are huge or no numbers do no harm, and what is beside them is found.
    #[test]
    fn strange_corners_do_no_harm() {
        let mut corners = soup(400);
        for (i, strange) in
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0e30, f32::MAX].into_iter().enumerate()
        {
            corners[7 * i][i % 3][i % 2] = strange;
        }
        for all in [&corners[..], &corners[..36], &corners[..1]] {
            let bvh = Bvh::new(all);
            assert_eq!(bvh.triangles.len(), all.len());
            let beside =
                |hit: &&(f32, BvhTriangle)| hit.1.corners().as_flattened().iter().all(|c| c.abs() < 100.0);
            for ray in rays(500, -1.0, 5.0) {
                let expected = brute_force(&bvh, ray, 1.0e-4).iter().find(beside).map(|hit| hit.0);
                let found = bvh.hit(ray.0, ray.1, 1.0e-4).map(|hit| hit.distance);
                assert!(
                    expected.is_none() || found <= expected && found.is_some(),
                    "{ray:?}: {found:?} {expected:?}"
                );
            }
        }
    }

    #[test]
    fn every_triangle_is_in_one_leaf_and_in_its_boxes() {
        let corners = soup(1000);
        let bvh = Bvh::new(&corners);
        let mut seen = vec![0; corners.len()];
        for (bounds, child) in children(&bvh).filter(|(_, child)| *child >= BVH_LEAF) {
            for t in &bvh.triangles[bvh_leaf(child)] {
                seen[t.index as usize] += 1;
                for p in corners[t.index as usize] {
                    assert!((0..3).all(|k| bounds.low[k] <= p[k] && p[k] <= bounds.high[k]));
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
    }

    /// All nodes but the root are a child once, of a node before them, whose box is that of their children.
    #[test]
    fn nodes_are_in_the_boxes_of_their_parents() {
        let bvh = Bvh::new(&soup(1000));
        let mut parents = vec![0; bvh.nodes.len()];
        for (at, node) in bvh.nodes.iter().enumerate() {
            for (k, &child) in node.child.iter().enumerate().filter(|child| *child.1 < BVH_LEAF) {
                assert!(child as usize > at);
                parents[child as usize] += 1;
                assert!(node.bounds(k) == bvh.nodes[child as usize].whole());
            }
        }
        assert_eq!(parents[0], 0);
        assert!(parents[1..].iter().all(|&n| n == 1));
        let filled = children(&bvh).count() as f64 / (4 * bvh.nodes.len()) as f64;
        assert!(filled > 0.7, "{filled} of all places for children are filled");
        assert_eq!(Bvh::new(&soup(3)).nodes.len(), 1);
        let all = soup(1000).into_iter().flatten().fold(Bounds::NONE, Bounds::with);
        assert_eq!(bvh_bounds(&bvh.nodes), Some([all.low, all.high]));
        assert_eq!(bvh_bounds(&Bvh::new(&[]).nodes), None);
    }

    /// The bounds of what lies in a box hold the parts of all triangles in it, and are not larger than those of their own bounds.
    #[test]
    fn bounds_within_a_box_hold_what_is_in_it() {
        let bvh = Bvh::new(&soup(800));
        let mut empty = 0;
        for i in 0..400 {
            let a = rng_draw([7, 8], i, 0, 0).map(rng_unit);
            let b = rng_draw([7, 8], i, 1, 0).map(rng_unit);
            let low: [f32; 3] = std::array::from_fn(|k| a[k] * 5.0 - 0.5);
            let high: [f32; 3] = std::array::from_fn(|k| low[k] + b[k] * b[k]);
            let found = bvh_bounds_within(&bvh.nodes, &bvh.triangles, low, high, None);
            let mut expected = Bounds::NONE;
            for corners in bvh.triangles.iter().map(BvhTriangle::corners) {
                let whole: [[f32; 2]; 3] = std::array::from_fn(|k| {
                    let along = corners.map(|corner| corner[k]);
                    let (first, last) =
                        (along.iter().copied().reduce(f32::min), along.iter().copied().reduce(f32::max));
                    [first.unwrap().max(low[k]), last.unwrap().min(high[k])]
                });
                if whole.iter().all(|[low, high]| low <= high) {
                    expected = expected.with(whole.map(|x| x[0])).with(whole.map(|x| x[1]));
                }
            }
            empty += u32::from(found.is_none());
            assert_eq!(found.is_some(), expected.low[0].is_finite(), "box {i}");
            for (found, expected) in found.iter().flatten().zip([expected.low, expected.high]) {
                assert!(
                    (0..3).all(|k| (found[k] - expected[k]).abs() < 1.0e-5),
                    "box {i}: {found:?} {expected:?}"
                );
            }
        }
        assert!((20..380).contains(&empty), "{empty} empty boxes");
        assert_eq!(bvh_bounds_within(&Bvh::new(&[]).nodes, &[], [-1.0; 3], [1.0; 3], None), None);
    }

    /// Large triangles among small ones, as in a scene, do not end in large leaves.
    #[test]
    fn leaves_are_small() {
        let mut corners = soup(3000);
        for (i, triangle) in corners.iter_mut().enumerate().filter(|(i, _)| i % 7 == 0) {
            triangle[0] = [-20.0 + 0.01 * i as f32, -1.0, -20.0];
            triangle[1] = [20.0, -1.0, 0.02 * i as f32];
        }
        let bvh = Bvh::new(&corners);
        let leaves = children(&bvh).filter(|(_, child)| *child >= BVH_LEAF);
        let largest = leaves.map(|(_, child)| bvh_leaf(child).len()).max();
        assert!(largest <= Some(LEAF), "a leaf of {largest:?} triangles");
    }

    #[test]
    fn equal_triangles_do_not_recurse_for_ever() {
        let one = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let bvh = Bvh::new(&vec![one; 1000]);
        assert!(bvh.hit([0.2, 0.2, 1.0], [0.0, 0.0, -1.0], 0.0).is_some());
    }
}
