//! `wgsl/render/{reduce,drops}.wgsl`: drops before a scene. Twins: `downpour_render::rain`.

use crate::common::PACKING;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&RAIN_CONSTANTS, &REDUCE, &DROPS];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&REDUCE_KERNEL, &DROPS_KERNEL];

shared_constants! {
    /// Numbers of the masks in a buffer.
    RAIN_CONSTANTS at "render/rain constants" {
        /// Words of a texel of a mask: two directions, and two shares.
        DROPS_TEXEL_WORDS: u32 = 3;
        /// Masks of a diameter, from below (-90 degrees) to above (90 degrees).
        DROPS_ELEVATIONS: u32 = 7;
        /// Edge of a tile of the picture, pixels.
        DROPS_TILE: u32 = 8;
        /// Samples along an edge of the mask of a drop below a pixel.
        DROPS_SMALL_GRID: u32 = 3;
        /// Form of refraction: the direction of the refracted light is looked up.
        DROPS_DIRECTION: u32 = 0;
        /// Form of refraction: the place in the captured picture is shifted (Rousseau 2006).
        DROPS_SHIFT: u32 = 1;
        /// Below this transmittance the rest of the drops is not seen.
        DROPS_OPAQUE: f32 = 1.0e-3;
        /// Quarters of the table of optical depths of drops that are not drawn.
        DROPS_VEIL_QUARTERS: u32 = 8;
        /// Distance of the table's first entry, m.
        DROPS_VEIL_NEAR: f32 = 0.25;
        /// Width of what such drops show of their surroundings, radians.
        DROPS_VEIL_SPREAD: f32 = 1.0;
        /// Beyond this distance, m, is the sky.
        DROPS_SKY: f32 = 1.0e29;
        /// Twice the inverse of water's refractive index: the middle of a sphere bends by 2 - 2 / n per radius.
        DROPS_STRAIGHT: f32 = 1.5;
    }
}

/// Coarser levels of a square map. Twin: `downpour_render::rain::reduce`.
pub static REDUCE: Module =
    Module { path: "render/reduce.wgsl", wgsl: include_str!("../../wgsl/render/reduce.wgsl"), uses: &[] };

/// Drops through their masks. Twin: `downpour_render::rain::drops`.
pub static DROPS: Module = Module {
    path: "render/drops.wgsl",
    wgsl: include_str!("../../wgsl/render/drops.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING],
};

/// One invocation per texel of the level that is made.
pub static REDUCE_KERNEL: Kernel = Kernel { entry: "main_reduce", module: &REDUCE, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static DROPS_KERNEL: Kernel = Kernel { entry: "main_drops", module: &DROPS, workgroup: [8, 8, 1] };
