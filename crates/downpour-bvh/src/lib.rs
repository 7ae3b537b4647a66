//! A bounding volume hierarchy over triangles, and the nearest hit of a ray.
//!
//! The hierarchy is built by the surface area heuristic with 16 bins per axis (I. Wald, "On fast construction of
//! SAH-based bounding volume hierarchies", 2007). The two children of a node are neighbors in memory, so that a ray
//! meets both with one access; leaves refer to a reordered list of triangles. The build depends on the triangles only, so
//! the same mesh gives the same tree.
//!
//! Twin of the traversal in `shaders/wgsl/bvh/bvh.wgsl`.

use downpour_math::vector::{cross, dot, sub};
use downpour_shaders::bvh::{BVH_FAR, BVH_STACK};
use glam::Vec3A;

/// Triangle count up to which a node stays a leaf.
const LEAF: usize = 4;
/// Depth from which nodes are split into halves.
const HEURISTIC_DEPTH: usize = 24;
/// Number of bins per axis.
const BINS: usize = 16;
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
    /// Padding of the WGSL layout.
    pub padding_1: u32,
    /// Third corner minus the first.
    pub edge_2: [f32; 3],
    /// Padding of the WGSL layout.
    pub padding_2: u32,
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

#[derive(Clone, Copy, PartialEq)]
struct Bounds {
    low: [f32; 3],
    high: [f32; 3],
}

impl Bounds {
    const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn with(self, point: [f32; 3]) -> Self {
        Self {
            low: std::array::from_fn(|k| self.low[k].min(point[k])),
            high: std::array::from_fn(|k| self.high[k].max(point[k])),
        }
    }

    fn union(self, other: Self) -> Self {
        self.with(other.low).with(other.high)
    }

    /// What two boxes share, which may be flat.
    fn common(self, other: &Self) -> Option<Self> {
        let low: [f32; 3] = std::array::from_fn(|k| self.low[k].max(other.low[k]));
        let high: [f32; 3] = std::array::from_fn(|k| self.high[k].min(other.high[k]));
        (0..3).all(|k| low[k] <= high[k]).then_some(Self { low, high })
    }

    /// Half of the surface area; 0 for an empty box.
    fn area(self) -> f32 {
        let [x, y, z] = std::array::from_fn(|k| (self.high[k] - self.low[k]).max(0.0));
        x * y + y * z + z * x
    }
}

/// A triangle during the build.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    middle: [f32; 3],
    index: u32,
}

impl Bvh {
    /// Builds the hierarchy over triangles given by their corners.
    #[must_use]
    pub fn new(corners: &[[[f32; 3]; 3]]) -> Self {
        let mut items: Vec<Item> = (0u32..)
            .zip(corners)
            .map(|(index, triangle)| {
                let bounds = triangle.iter().fold(Bounds::NONE, |b, &p| b.with(p));
                let middle = std::array::from_fn(|k| 0.5 * (bounds.low[k] + bounds.high[k]));
                Item { bounds, middle, index }
            })
            .collect();
        let mut nodes = Vec::with_capacity(2 * items.len() / LEAF + 2);
        nodes.push(EMPTY);
        build(&mut items, 0, 0, 0, &mut nodes);
        let triangles = items
            .iter()
            .map(|item| {
                let [a, b, c] = corners[item.index as usize];
                BvhTriangle {
                    corner: a,
                    index: item.index,
                    edge_1: sub(b, a),
                    padding_1: 0,
                    edge_2: sub(c, a),
                    padding_2: 0,
                }
            })
            .collect();
        Self { nodes, triangles }
    }

    /// Nearest hit along the ray that is farther than `nearest`.
    #[must_use]
    pub fn hit(&self, origin: [f32; 3], direction: [f32; 3], nearest: f32) -> Option<Hit> {
        bvh_nearest(&self.nodes, &self.triangles, origin, direction, nearest, BVH_FAR)
    }
}

/// Nearest hit along the ray that is farther than `nearest` and nearer than `farthest`, in the arrays of a [`Bvh`].
#[must_use]
pub fn bvh_nearest(
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

/// A node that holds nothing.
const EMPTY: BvhNode = BvhNode { low: [0.0; 3], link: 0, high: [0.0; 3], count: 0 };

/// Makes node `at` the root of the subtree over `items`, which start at index `first` of the whole list.
fn build(items: &mut [Item], first: usize, at: usize, depth: usize, nodes: &mut Vec<BvhNode>) {
    let bounds = items.iter().fold(Bounds::NONE, |b, item| b.union(item.bounds));
    nodes[at] = BvhNode { low: bounds.low, link: first as u32, high: bounds.high, count: items.len() as u32 };
    // The stack of the traversal holds one node per level.
    let deepest = depth + 2 >= BVH_STACK as usize;
    let cut = match () {
        () if items.len() <= LEAF || deepest => None,
        // Deep in the tree, halving ends sooner than splits that take off one triangle at a time.
        () if depth >= HEURISTIC_DEPTH => halve(items),
        () => split(items).or_else(|| halve(items)),
    };
    let Some(split) = cut else { return };
    let child = nodes.len().next_multiple_of(2);
    nodes.resize(child + 2, EMPTY);
    (nodes[at].count, nodes[at].link) = (0, child as u32);
    let (left, right) = items.split_at_mut(split);
    build(left, first, child, depth + 1, nodes);
    build(right, first + split, child + 1, depth + 1, nodes);
}

/// Reorders `items` and returns the split index.
fn split(items: &mut [Item]) -> Option<usize> {
    let middles = items.iter().fold(Bounds::NONE, |b, item| b.with(item.middle));
    let mut best = (f32::INFINITY, 0, 0);
    for axis in 0..3 {
        let extent = middles.high[axis] - middles.low[axis];
        if extent <= 0.0 {
            continue;
        }
        let mut bins = [(Bounds::NONE, 0usize); BINS];
        for item in items.iter() {
            let bin = &mut bins[bin_of(item, axis, middles.low[axis], extent)];
            *bin = (bin.0.union(item.bounds), bin.1 + 1);
        }
        for cut in 1..BINS {
            let side = |bins: &[(Bounds, usize)]| {
                let (bounds, n) =
                    bins.iter().fold((Bounds::NONE, 0), |(b, n), bin| (b.union(bin.0), n + bin.1));
                (bounds.area() * n as f32, n)
            };
            let ((left, in_left), (right, in_right)) = (side(&bins[..cut]), side(&bins[cut..]));
            // A split with an empty side is not allowed, however cheap.
            if in_left > 0 && in_right > 0 && left + right < best.0 {
                best = (left + right, axis, cut);
            }
        }
    }
    let (cost, axis, cut) = best;
    if cost.is_infinite() {
        return None;
    }
    let extent = middles.high[axis] - middles.low[axis];
    // A stable order keeps the tree independent of the sort algorithm.
    items.sort_by_key(|item| bin_of(item, axis, middles.low[axis], extent) >= cut);
    let split = items.partition_point(|item| bin_of(item, axis, middles.low[axis], extent) < cut);
    (split > 0 && split < items.len()).then_some(split)
}

/// Sorts `items` along their longest axis and splits them in half; `None` if all are at one point.
fn halve(items: &mut [Item]) -> Option<usize> {
    let middles = items.iter().fold(Bounds::NONE, |b, item| b.with(item.middle));
    let extent = |axis: usize| middles.high[axis] - middles.low[axis];
    let axis = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b)))?;
    if extent(axis) <= 0.0 {
        return None;
    }
    // Ties are broken by the index, so that the order does not depend on the sort algorithm.
    items.sort_by(|a, b| a.middle[axis].total_cmp(&b.middle[axis]).then(a.index.cmp(&b.index)));
    Some(items.len() / 2)
}

fn bin_of(item: &Item, axis: usize, low: f32, extent: f32) -> usize {
    (((item.middle[axis] - low) / extent * BINS as f32) as usize).min(BINS - 1)
}

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

#[cfg(test)]
mod tests {
    use super::*;
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

    /// The tree finds the same hit as a loop over all triangles.
    #[test]
    fn nearest_hit_is_that_of_brute_force() {
        let corners = soup(800);
        let bvh = Bvh::new(&corners);
        let mut hits = 0;
        for i in 0..3000 {
            let a = rng_draw([5, 6], i, 0, 0).map(rng_unit);
            let b = rng_draw([5, 6], i, 1, 0).map(rng_unit);
            let origin = std::array::from_fn(|k| a[k] * 6.0 - 1.0);
            let mut direction: [f32; 3] = std::array::from_fn(|k| b[k] - 0.5);
            if i % 3 == 0 {
                // Rays along an axis divide by zero.
                direction[(i % 2) as usize] = 0.0;
            }
            let brute = bvh
                .triangles
                .iter()
                .map(|t| (bvh_triangle(t, origin, direction), t.index))
                .filter(|(h, _)| h[0] > 1.0e-4)
                .min_by(|x, y| x.0[0].total_cmp(&y.0[0]));
            let found = bvh.hit(origin, direction, 1.0e-4);
            assert_eq!(found.map(|h| h.distance), brute.map(|(h, _)| h[0]), "ray {i}");
            hits += u32::from(found.is_some());
        }
        assert!(hits > 300, "only {hits} rays hit anything");
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
