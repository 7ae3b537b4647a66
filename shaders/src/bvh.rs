//! `wgsl/bvh`: intersection of rays with triangles. The Rust twins are in `downpour-bvh`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&BVH_CONSTANTS, &BVH];

shared_constants! {
    /// Constants of the traversal.
    BVH_CONSTANTS at "bvh/constants" {
        /// Size of the traversal stack: three times the levels of nodes of a tree, and one more.
        BVH_STACK: u32 = 64;
        /// A child from this on is a leaf, or none.
        BVH_LEAF: u32 = 268435456;
        /// First bit of the number of triangles of a leaf; the bits below are the index of its first triangle.
        BVH_LEAF_SHIFT: u32 = 28;
        /// No child.
        BVH_NO_CHILD: u32 = 4294967295;
        /// Larger than every distance.
        BVH_FAR: f32 = 3.0e38;
        /// Factor of a distance, and what is added to it, up to which a box counts as entered before it: rounding may swap the two by a few units
        /// in the last place.
        BVH_REACH: f32 = 1.000001;
        /// See [`BVH_REACH`].
        BVH_REACH_SLACK: f32 = 1.0e-7;
        /// Barycentric slack of a triangle: a ray through a shared edge must not slip between two of them.
        BVH_EDGE_SLACK: f32 = 1.0e-6;
    }
}

/// The nearest hit of a ray. Twin: `downpour_bvh`.
pub static BVH: Module =
    Module { path: "bvh/bvh.wgsl", wgsl: include_str!("../wgsl/bvh/bvh.wgsl"), uses: &[&BVH_CONSTANTS] };
