//! What stops drops: a map of the surfaces along the fall direction.

use crate::bvh::BVH;
use crate::common::PACKING;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&COLLISION_CONSTANTS, &COLLISION, &COLLISION_MAP];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&COLLISION_MAP_KERNEL];

shared_constants! {
    /// What a map of surfaces keeps, and how a drop is compared with it.
    COLLISION_CONSTANTS at "sim/collision/constants" {
        /// Surfaces of a texel.
        COLLISION_LAYERS: u32 = 4;
        /// Depth of a surface that is not there, m.
        COLLISION_NONE: f32 = 1.0e30;
        /// Bit of a packed surface: what is below it, up to the next surface, is solid.
        COLLISION_SOLID: u32 = 65536;
        /// A surface leaves the depth at the centre of its texel by so many texel edges, at most.
        COLLISION_STEEP: f32 = 4.0;
        /// Inside something solid, a drop that came over a texel's border has hit the top surface if it is no deeper than
        /// so many texel edges and what the slope adds over one; deeper, it has hit a wall.
        COLLISION_SHALLOW: f32 = 0.25;
        /// A drop that starts less than this below a surface starts on it, m.
        COLLISION_CLEARANCE: f32 = 0.001;
        /// Texels that a segment is followed through.
        COLLISION_COLUMNS: u32 = 32;
        /// In place of the number of surfaces above in the texel before: there was none.
        COLLISION_START: u32 = 8;
        /// Largest coordinate in texels that is told apart.
        COLLISION_EDGE: f32 = 1.0e7;
        /// Nothing was hit.
        COLLISION_OPEN: u32 = 0;
        /// A surface was hit.
        COLLISION_SURFACE: u32 = 1;
        /// The side of something solid was hit.
        COLLISION_WALL: u32 = 2;
        /// Nearest hits of a ray that are kept while a texel is made.
        COLLISION_MAP_HITS: u32 = 16;
        /// Surfaces of a ray sideways within which it has to leave something: one, and two for what stands in between.
        COLLISION_MAP_LEAVES: u32 = 3;
        /// Where between two surfaces the rays start that ask whether the space is enclosed. Not the middle, where meshes have
        /// edges.
        COLLISION_MAP_BETWEEN: f32 = 0.4637;
        /// A surface faces the rain.
        COLLISION_MAP_FRONT: u32 = 1;
        /// A surface faces away from the rain.
        COLLISION_MAP_BACK: u32 = 2;
    }
}

/// Where a moving drop meets the surfaces of a map. The map is bound at 8 (uniform) and 9 (texels).
/// Twin: `downpour_sim::collision`.
pub static COLLISION: Module = Module {
    path: "sim/collision.wgsl",
    wgsl: include_str!("../../wgsl/sim/collision.wgsl"),
    uses: &[&COLLISION_CONSTANTS, &PACKING],
};

/// Makes a map from a hierarchy of triangles, by rays. Twin: `downpour_sim::collision`.
pub static COLLISION_MAP: Module = Module {
    path: "sim/collision_map.wgsl",
    wgsl: include_str!("../../wgsl/sim/collision_map.wgsl"),
    uses: &[&COLLISION, &BVH],
};

/// One invocation per texel.
pub static COLLISION_MAP_KERNEL: Kernel =
    Kernel { entry: "main_collision_map", module: &COLLISION_MAP, workgroup: [8, 8, 1] };
