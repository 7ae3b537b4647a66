//! `wgsl/render/{impostor,impostor_draw,impostor_blur}.wgsl`: reflections on wet surfaces by impostors. Twin:
//! `downpour_trace::impostor`.

use super::camera::CAMERA;
use super::scene::DATA;
use crate::common::PACKING;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&IMPOSTOR_CONSTANTS, &IMPOSTOR, &IMPOSTOR_DRAW, &IMPOSTOR_BLUR];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&IMPOSTOR_DRAW_KERNEL, &IMPOSTOR_BLUR_KERNEL];

shared_constants! {
    /// Numbers of mirrored billboards.
    IMPOSTOR_CONSTANTS at "render/impostor constants" {
        /// Texels along an edge of the map of what is around.
        IMPOSTOR_PROBE: u32 = 32;
        /// Angle by which a billboard is stretched toward the viewer, radians: twice the slope of a wet road's grains.
        IMPOSTOR_STRETCH: f32 = 0.12;
        /// Part of a surface's relief that warps what is mirrored.
        IMPOSTOR_WARP: f32 = 0.15;
        /// Minimum distance of a billboard along the view direction, m.
        IMPOSTOR_NEAREST: f32 = 0.1;
        /// Minimum cosine to the view direction of what an uneven surface mirrors; beyond it, the surface counts as level.
        IMPOSTOR_ASIDE: f32 = 0.05;
        /// Largest radiance of a texel: a half's.
        IMPOSTOR_MAX: f32 = 6.0e4;
    }
}

/// Lookup in the buffer. Twin: `downpour_trace::impostor`.
pub static IMPOSTOR: Module = Module {
    path: "render/impostor.wgsl",
    wgsl: include_str!("../../wgsl/render/impostor.wgsl"),
    uses: &[&IMPOSTOR_CONSTANTS, &DATA, &CAMERA],
};

/// Drawing it. Twin: `downpour_trace::impostor::draw`.
pub static IMPOSTOR_DRAW: Module = Module {
    path: "render/impostor_draw.wgsl",
    wgsl: include_str!("../../wgsl/render/impostor_draw.wgsl"),
    uses: &[&IMPOSTOR_CONSTANTS, &IMPOSTOR, &DATA, &CAMERA, &PACKING],
};

/// Blurring it. Twin: `downpour_trace::impostor::blur`.
pub static IMPOSTOR_BLUR: Module = Module {
    path: "render/impostor_blur.wgsl",
    wgsl: include_str!("../../wgsl/render/impostor_blur.wgsl"),
    uses: &[&IMPOSTOR, &DATA],
};

/// One invocation per texel.
pub static IMPOSTOR_DRAW_KERNEL: Kernel =
    Kernel { entry: "main_impostor_draw", module: &IMPOSTOR_DRAW, workgroup: [8, 8, 1] };

/// One invocation per texel.
pub static IMPOSTOR_BLUR_KERNEL: Kernel =
    Kernel { entry: "main_impostor_blur", module: &IMPOSTOR_BLUR, workgroup: [8, 8, 1] };
