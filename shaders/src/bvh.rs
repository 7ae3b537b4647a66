//! `wgsl/bvh`: intersection of rays with triangles. The Rust twins are in `downpour-bvh`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&BVH_CONSTANTS, &BVH];

shared_constants! {
    /// Constants of the traversal.
    BVH_CONSTANTS at "bvh/constants" {
        /// Size of the traversal stack: maximum depth of a tree.
        BVH_STACK: u32 = 48;
        /// Larger than every distance.
        BVH_FAR: f32 = 3.0e38;
        /// Barycentric slack of a triangle: a ray through a shared edge must not slip between two of them.
        BVH_EDGE_SLACK: f32 = 1.0e-6;
    }
}

/// The nearest hit of a ray. Twin: `downpour_bvh`.
pub static BVH: Module =
    Module { path: "bvh/bvh.wgsl", wgsl: include_str!("../wgsl/bvh/bvh.wgsl"), uses: &[&BVH_CONSTANTS] };
