//! `wgsl/render/layers.wgsl`: rainfall as layers of a texture. Twin: `downpour_render::rain::layers`.

use super::camera::CAMERA;
use super::rain::{DROPS_CAPTURE, DROPS_FRAME};
use crate::drop::optics::OPTICS;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&LAYERS_CONSTANTS, &LAYERS];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&LAYERS_KERNEL];

shared_constants! {
    /// Numbers of the layers.
    LAYERS_CONSTANTS at "render/layers constants" {
        /// Cells along an edge of the texture of places.
        LAYERS_PLACES: u32 = 64;
        /// Texels along an edge of the texture of streaks, which is one meter.
        LAYERS_SIZE: u32 = 256;
        /// Levels of the texture of streaks.
        LAYERS_LEVELS: u32 = 9;
        /// Cells across the fall at distance 1.
        LAYERS_COLUMNS: f32 = 24.0;
        /// Distance of the nearest layer, m.
        LAYERS_NEAREST: f32 = 1.0;
        /// Lamps that have highlights, at most.
        LAYERS_LAMPS: u32 = 16;
        /// Refractive index of the drops.
        LAYERS_INDEX: f32 = 1.333;
        /// Width of what is seen in a streak, rad.
        LAYERS_WIDTH: f32 = 0.1;
    }
}

/// Rainfall as layers of a texture. Twin: `downpour_render::rain::layers`.
pub static LAYERS: Module = Module {
    path: "render/layers.wgsl",
    wgsl: include_str!("../../wgsl/render/layers.wgsl"),
    uses: &[&LAYERS_CONSTANTS, &OPTICS, &CAMERA, &DROPS_FRAME, &DROPS_CAPTURE],
};

/// One invocation per pixel.
pub static LAYERS_KERNEL: Kernel = Kernel { entry: "main_layers", module: &LAYERS, workgroup: [8, 8, 1] };
