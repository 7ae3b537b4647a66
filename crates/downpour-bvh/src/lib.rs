//! A bounding volume hierarchy over triangles, and the nearest hit of a ray.
//!
//! [`Bvh::new`] builds it from the triangles' corners; [`bvh_hit`] finds what a ray meets first, [`bvh_blocker`] whether it meets
//! anything, as shadows ask. The two children of a node are neighbors in memory, so that a ray meets both with one access; leaves
//! refer to a reordered list of triangles. The build depends on the triangles only: the same mesh gives the same tree.
//!
//! Twin of the walk in `shaders/wgsl/bvh/bvh.wgsl`.

mod bounds;
mod build;

use bounds::Bounds;
use downpour_math::vector::{cross, dot, sub};
use downpour_shaders::bvh::{BVH_FAR, BVH_STACK};
use glam::Vec3A;

/// Barycentric slack: a ray through a shared edge must not slip between the two triangles.
const EDGE_SLACK: f32 = downpour_shaders::bvh::BVH_EDGE_SLACK;

/// A node. An inner node has its children at `link`, which is even, and right after it; a leaf has `count` triangles
/// from index `link` on. The same layout as `BvhNode` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BvhNode {
    /// Lower corner of the bounding box.
    pub low: [f32; 3],
    /// Index of the first child, or of the first triangle.
    pub link: u32,
    /// Upper corner of the bounding box.
    pub high: [f32; 3],
    /// Number of triangles; 0 for an inner node.
    pub count: u32,
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
    /// Nodes, the root first; node 1 is empty, so that pairs of children begin at multiples of 64 bytes.
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

/// What is in the way of a ray between two distances, in the arrays of a [`Bvh`]: any hit of a triangle through which nothing passes, or
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
    // Nodes to be visited, and where the ray enters them.
    let mut stack = [(0u32, 0.0f32); BVH_STACK as usize];
    let mut depth = 0;
    let mut node = &nodes[0];
    if bvh_enter(node, origin, inverse, nearest, limit) >= BVH_FAR {
        return None;
    }
    loop {
        if node.count == 0 {
            // The nearer child first: its triangles may hide the other.
            let (left, right) = (node.link, node.link + 1);
            let to_left = bvh_enter(&nodes[left as usize], origin, inverse, nearest, limit);
            let to_right = bvh_enter(&nodes[right as usize], origin, inverse, nearest, limit);
            let (near, far, to_near, to_far) = if to_right < to_left {
                (right, left, to_right, to_left)
            } else {
                (left, right, to_left, to_right)
            };
            if to_near < BVH_FAR {
                if to_far < BVH_FAR {
                    stack[depth] = (far, to_far);
                    depth += 1;
                }
                node = &nodes[near as usize];
                continue;
            }
        } else {
            for triangle in &triangles[node.link as usize..(node.link + node.count) as usize] {
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
        // The next stacked node that is nearer than the current hit.
        loop {
            if depth == 0 {
                return best;
            }
            depth -= 1;
            let (far, enter) = stack[depth];
            if bvh_is_before(enter, limit) {
                node = &nodes[far as usize];
                break;
            }
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
    while let Some(index) = stack.pop() {
        let Some(node) = nodes.get(index) else { continue };
        let bounds = Bounds { low: node.low, high: node.high };
        let Some(common) = bounds.common(&whole) else { continue };
        if found.common(&common) == Some(common) {
            continue;
        }
        if node.count == 0 && wanted.is_none() && common == bounds {
            found = found.union(bounds);
            continue;
        }
        if node.count == 0 {
            stack.extend([node.link as usize, node.link as usize + 1]);
            continue;
        }
        for triangle in &triangles[node.link as usize..(node.link + node.count) as usize] {
            let [a, b, c] = triangle.corners();
            let bounds = Bounds::NONE.with(a).with(b).with(c);
            if let Some(common) = bounds.common(&whole)
                && wanted.is_none_or(|wanted| wanted(triangle))
            {
                found = found.union(common);
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

/// Distance, `nearest` at least, at which the ray is in the box of `node`, if it is below `limit`; `BVH_FAR` otherwise.
#[inline(always)]
#[must_use]
pub fn bvh_enter(node: &BvhNode, origin: [f32; 3], inverse: [f32; 3], nearest: f32, limit: f32) -> f32 {
    // SIMD vectors: this test dominates the time of a picture.
    let (origin, inverse) = (Vec3A::from(origin), Vec3A::from(inverse));
    let a = (Vec3A::from(node.low) - origin) * inverse;
    let b = (Vec3A::from(node.high) - origin) * inverse;
    // No number here is NaN, so plain comparisons are enough.
    let greater = |a: f32, b: f32| if a > b { a } else { b };
    let less = |a: f32, b: f32| if a < b { a } else { b };
    let (near, far) = (a.min(b), a.max(b));
    let enter = greater(greater(near.x, near.y), greater(near.z, nearest));
    let leave = less(less(far.x, far.y), less(far.z, limit));
    if bvh_is_before(enter, leave) { enter } else { BVH_FAR }
}

/// True if a ray enters a box before a distance: rounding may swap the two by a few units in the last place.
#[inline(always)]
#[must_use]
pub fn bvh_is_before(enter: f32, distance: f32) -> bool {
    enter <= distance * 1.000_001 + 1.0e-7
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

    /// Depth of a tree.
    fn depth(bvh: &Bvh) -> usize {
        let mut deepest = 0;
        let mut stack = vec![(0, 0)];
        while let Some((at, depth)) = stack.pop() {
            let node = &bvh.nodes[at as usize];
            deepest = deepest.max(depth);
            if node.count == 0 && node.link > 0 {
                stack.extend([(node.link, depth + 1), (node.link + 1, depth + 1)]);
            }
        }
        deepest
    }

    /// Triangles one within another, each larger than the last, make a chain; the walk's stack has room for all of it.
    #[test]
    fn a_chain_is_no_deeper_than_the_stack() {
        let sizes = std::iter::successors(Some(1.0f32), |size| Some(size * 1.08)).take(700);
        let triangle = |size: f32| [[-size, 0.0, -size], [size, 0.1 * size, -size], [0.0, -0.1 * size, size]];
        let corners: Vec<[[f32; 3]; 3]> = sizes.map(triangle).collect();
        let bvh = Bvh::new(&corners);
        assert!(depth(&bvh) + 2 <= BVH_STACK as usize, "{} levels", depth(&bvh));
        for ray in rays(300, -100.0, 100.0) {
            let expected = brute_force(&bvh, ray, 1.0e-4).first().map(|hit| hit.0);
            let found = bvh.hit(ray.0, ray.1, 1.0e-4);
            assert_eq!(found.map(|h| h.distance), expected, "{ray:?}");
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
        for node in bvh.nodes.iter().filter(|n| n.count > 0) {
            for t in &bvh.triangles[node.link as usize..(node.link + node.count) as usize] {
                seen[t.index as usize] += 1;
                for p in corners[t.index as usize] {
                    assert!((0..3).all(|k| node.low[k] <= p[k] && p[k] <= node.high[k]));
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
    }

    /// Children are pairs, each in the box of its parent, and all nodes but the root and node 1 are a child once.
    #[test]
    fn children_are_neighbors() {
        let bvh = Bvh::new(&soup(1000));
        let mut parents = vec![0; bvh.nodes.len()];
        for node in [&bvh.nodes[0]].into_iter().chain(&bvh.nodes[2..]).filter(|node| node.count == 0) {
            assert_eq!(node.link % 2, 0);
            let pair = node.link as usize..node.link as usize + 2;
            for (parents, child) in parents[pair.clone()].iter_mut().zip(&bvh.nodes[pair]) {
                *parents += 1;
                assert!((0..3).all(|k| node.low[k] <= child.low[k] && child.high[k] <= node.high[k]));
            }
        }
        assert_eq!(parents[..2], [0, 0]);
        assert!(parents[2..].iter().all(|&n| n == 1));
        assert_eq!(Bvh::new(&soup(3)).nodes.len(), 1);
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
        let largest = bvh.nodes.iter().map(|n| n.count).max();
        assert!(largest <= Some(LEAF as u32), "a leaf of {largest:?} triangles");
    }

    #[test]
    fn equal_triangles_do_not_recurse_for_ever() {
        let one = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let bvh = Bvh::new(&vec![one; 1000]);
        assert!(bvh.hit([0.2, 0.2, 1.0], [0.0, 0.0, -1.0], 0.0).is_some());
    }
}
