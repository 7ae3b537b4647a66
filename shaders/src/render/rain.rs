//! `wgsl/render/{capture,reduce,drops}.wgsl`: drops before a scene. Twins: `downpour_render::rain`.

use super::scene::SCENE;
use crate::common::PACKING;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&RAIN_CONSTANTS, &CAPTURE, &REDUCE, &DROPS];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&CAPTURE_KERNEL, &REDUCE_KERNEL, &DROPS_KERNEL];

shared_constants! {
    /// Numbers of the capture and of the masks in a buffer.
    RAIN_CONSTANTS at "render/rain constants" {
        /// Four over pi: the area of the capture's square, for the scene's irradiance over pi.
        CAPTURE_AREA_OVER_PI: f32 = 1.2732395;
        /// Words of a texel of a mask: two directions, and two shares.
        DROPS_TEXEL_WORDS: u32 = 3;
        /// Masks of a diameter, from below (-90 degrees) to above (90 degrees).
        DROPS_ELEVATIONS: u32 = 7;
        /// Edge of a tile of the picture, pixels.
        DROPS_TILE: u32 = 8;
        /// Samples along an edge of the mask of a drop below a pixel.
        DROPS_SMALL_GRID: u32 = 4;
        /// Form of refraction: the direction of the refracted light is looked up.
        DROPS_DIRECTION: u32 = 0;
        /// Form of refraction: the place in the captured picture is shifted (Rousseau 2006).
        DROPS_SHIFT: u32 = 1;
        /// Below this transmittance the rest of the drops is not seen.
        DROPS_OPAQUE: f32 = 1.0e-3;
        /// Twice the inverse of water's refractive index: the middle of a sphere bends by 2 - 2 / n per radius.
        DROPS_STRAIGHT: f32 = 1.5;
    }
}

/// The surroundings of the eye. Twin: `downpour_render::rain::capture`.
pub static CAPTURE: Module = Module {
    path: "render/capture.wgsl",
    wgsl: include_str!("../../wgsl/render/capture.wgsl"),
    uses: &[&RAIN_CONSTANTS, &SCENE, &PACKING],
};

/// Coarser levels of a square map. Twin: `downpour_render::rain::reduce`.
pub static REDUCE: Module =
    Module { path: "render/reduce.wgsl", wgsl: include_str!("../../wgsl/render/reduce.wgsl"), uses: &[] };

/// Drops through their masks. Twin: `downpour_render::rain::drops`.
pub static DROPS: Module = Module {
    path: "render/drops.wgsl",
    wgsl: include_str!("../../wgsl/render/drops.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING],
};

/// One invocation per texel of the capture.
pub static CAPTURE_KERNEL: Kernel = Kernel { entry: "main_capture", module: &CAPTURE, workgroup: [8, 8, 1] };

/// One invocation per texel of the level that is made.
pub static REDUCE_KERNEL: Kernel = Kernel { entry: "main_reduce", module: &REDUCE, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static DROPS_KERNEL: Kernel = Kernel { entry: "main_drops", module: &DROPS, workgroup: [8, 8, 1] };
