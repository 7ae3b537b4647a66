//! Collision map of the surfaces along the fall direction.

use crate::bvh::BVH;
use crate::common::PACKING;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&COLLISION_CONSTANTS, &COLLISION, &COLLISION_MAP];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&COLLISION_MAP_KERNEL];

shared_constants! {
    /// Constants of the collision map and of its queries.
    COLLISION_CONSTANTS at "sim/collision/constants" {
        /// Number of surfaces of a texel.
        COLLISION_LAYERS: u32 = 4;
        /// Depth that marks an absent surface, m.
        COLLISION_NONE: f32 = 1.0e30;
        /// Bit of a packed surface: the space below it, up to the next surface, is solid.
        COLLISION_SOLID: u32 = 65536;
        /// Maximum deviation of a surface from the depth at the center of its texel, in texel edges.
        COLLISION_STEEP: f32 = 4.0;
        /// Depth in texel edges, plus the increase by the slope over one, up to which a drop inside a solid that
        /// crossed a texel's border has hit the top surface; deeper, it has hit a wall.
        COLLISION_SHALLOW: f32 = 0.25;
        /// Distance below a surface, m, within which a drop starts on it.
        COLLISION_CLEARANCE: f32 = 0.001;
        /// Maximum number of texels that a segment is followed through.
        COLLISION_COLUMNS: u32 = 32;
        /// Value for the number of surfaces above in the previous texel if there was none.
        COLLISION_START: u32 = 8;
        /// Maximum coordinate in texels.
        COLLISION_EDGE: f32 = 1.0e7;
        /// No hit.
        COLLISION_OPEN: u32 = 0;
        /// Hit of a surface.
        COLLISION_SURFACE: u32 = 1;
        /// Hit of the side of a solid.
        COLLISION_WALL: u32 = 2;
        /// Number of nearest hits of a ray that are kept while a texel is made.
        COLLISION_MAP_HITS: u32 = 16;
        /// Number of surfaces within which a horizontal ray has to leave a solid: one, and two for obstacles in
        /// between.
        COLLISION_MAP_LEAVES: u32 = 3;
        /// Fraction of the space between two surfaces at which the rays start that test for enclosure. Not the middle,
        /// where meshes have edges.
        COLLISION_MAP_BETWEEN: f32 = 0.4637;
        /// A surface faces the rain.
        COLLISION_MAP_FRONT: u32 = 1;
        /// A surface faces away from the rain.
        COLLISION_MAP_BACK: u32 = 2;
    }
}

/// Collision of a moving drop with the surfaces of a map. The map is bound at 8 (uniform) and 9 (texels).
/// Twin: `downpour_sim::collision`.
pub static COLLISION: Module = Module {
    path: "sim/collision.wgsl",
    wgsl: include_str!("../../wgsl/sim/collision.wgsl"),
    uses: &[&COLLISION_CONSTANTS, &PACKING],
};

/// Construction of a map from a hierarchy of triangles, by rays. Twin: `downpour_sim::collision`.
pub static COLLISION_MAP: Module = Module {
    path: "sim/collision_map.wgsl",
    wgsl: include_str!("../../wgsl/sim/collision_map.wgsl"),
    uses: &[&COLLISION, &BVH],
};

/// One invocation per texel.
pub static COLLISION_MAP_KERNEL: Kernel =
    Kernel { entry: "main_collision_map", module: &COLLISION_MAP, workgroup: [8, 8, 1] };
