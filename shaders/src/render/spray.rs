//! `wgsl/render/spray*.wgsl`: spray over what rain hits. Twins: `downpour_render::rain::spray`.

use super::camera::CAMERA;
use super::drop_light::DROP_GLINT;
use super::medium::{MEDIUM, MEDIUM_CONSTANTS, MEDIUM_PHASE};
use super::path::PATH_LATTICE;
use super::rain::{DROPS_FRAME, DROPS_MEDIUM};
use super::scene::{DATA, SCENE, SCENE_CONSTANTS, SPACING, SURFACE};
use super::table::LIGHT;
use crate::bvh::BVH;
use crate::common::RNG;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&SPRAY_CONSTANTS, &SPRAY_FRAME, &SPRAY_MAP, &SPRAY, &SPRAY_LIGHT, &SPRAY_BLEND];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&SPRAY_MAP_KERNEL, &SPRAY_KERNEL, &SPRAY_LIGHT_KERNEL, &SPRAY_BLEND_KERNEL];

shared_constants! {
    /// Numbers of the spray.
    SPRAY_CONSTANTS at "render/spray constants" {
        /// Squares of the map of heights.
        SPRAY_LEVELS: u32 = 6;
        /// Texels along an edge of a square.
        SPRAY_SIZE: u32 = 512;
        /// Texels along an edge of a cell, of which the largest height is known.
        SPRAY_CELL: u32 = 8;
        /// Cells along an edge of a square.
        SPRAY_CELLS: u32 = 64;
        /// Edge of a texel of the smallest square, m.
        SPRAY_EDGE: f32 = 0.025;
        /// Edge of a texel over that of the square before.
        SPRAY_WIDER: f32 = 2.0;
        /// Distance from the border of a cell, in texels, at which a ray is in the next one.
        SPRAY_AHEAD: f32 = 0.002;
        /// Height over a surface beyond which there is no spray, in heights of its decrease: a thousandth is left.
        SPRAY_REACH: f32 = 7.0;
        /// Height where rain hits nothing, m.
        SPRAY_NOTHING: f32 = -1.0e6;
        /// Height over the eye from which the map looks down, m.
        SPRAY_TOP: f32 = 1000.0;
        /// Cells and texels that a ray is followed through, at most.
        SPRAY_TURNS: u32 = 1536;
        /// Farther than any spray, m.
        SPRAY_FAR: f32 = 1e5;
        /// Number of the lattice of a pixel's place and lamp.
        SPRAY_LATTICE: u32 = 4097;
        /// Distance from a lamp within which its light does not grow, m.
        SPRAY_LAMP_MIN: f32 = 0.2;
        /// Relative difference of distances from which on spray is not alike.
        SPRAY_ALIKE: f32 = 0.2;
    }
}

/// Spray of a picture. Twin: `downpour_render::rain::spray`.
pub static SPRAY_FRAME: Module = Module {
    path: "render/spray_frame.wgsl",
    wgsl: include_str!("../../wgsl/render/spray_frame.wgsl"),
    uses: &[&SPRAY_CONSTANTS],
};

/// Heights of what rain hits. Twin: `downpour_render::rain::spray::map`.
pub static SPRAY_MAP: Module = Module {
    path: "render/spray_map.wgsl",
    wgsl: include_str!("../../wgsl/render/spray_map.wgsl"),
    uses: &[&SPRAY_CONSTANTS, &SPRAY_FRAME, &DATA, &SURFACE, &BVH],
};

/// Optical depth of spray along a ray. Twin: `downpour_render::rain::spray`.
pub static SPRAY: Module = Module {
    path: "render/spray.wgsl",
    wgsl: include_str!("../../wgsl/render/spray.wgsl"),
    uses: &[&SPRAY_CONSTANTS, &SPRAY_FRAME, &DATA, &CAMERA, &MEDIUM],
};

/// Light of lamps on spray. Twin: `downpour_render::rain::spray::light`.
pub static SPRAY_LIGHT: Module = Module {
    path: "render/spray_light.wgsl",
    wgsl: include_str!("../../wgsl/render/spray_light.wgsl"),
    uses: &[
        &SPRAY_CONSTANTS,
        &MEDIUM_CONSTANTS,
        &SCENE_CONSTANTS,
        &MEDIUM,
        &MEDIUM_PHASE,
        &DATA,
        &CAMERA,
        &DROP_GLINT,
        &PATH_LATTICE,
        &LIGHT,
        &SCENE,
        &SPACING,
        &RNG,
    ],
};

/// Spray behind rain. Twin: `downpour_render::rain::spray::blend`.
pub static SPRAY_BLEND: Module = Module {
    path: "render/spray_blend.wgsl",
    wgsl: include_str!("../../wgsl/render/spray_blend.wgsl"),
    uses: &[&SPRAY_CONSTANTS, &SPRAY_FRAME, &SCENE_CONSTANTS, &DROPS_FRAME, &DROPS_MEDIUM, &LIGHT, &SPACING],
};

/// A workgroup per cell of each square.
pub static SPRAY_MAP_KERNEL: Kernel =
    Kernel { entry: "main_spray_map", module: &SPRAY_MAP, workgroup: [SPRAY_CELL, SPRAY_CELL, 1] };

/// One invocation per pixel.
pub static SPRAY_KERNEL: Kernel = Kernel { entry: "main_spray", module: &SPRAY, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static SPRAY_LIGHT_KERNEL: Kernel =
    Kernel { entry: "main_spray_light", module: &SPRAY_LIGHT, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static SPRAY_BLEND_KERNEL: Kernel =
    Kernel { entry: "main_spray_blend", module: &SPRAY_BLEND, workgroup: [8, 8, 1] };
