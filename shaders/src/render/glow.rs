//! `wgsl/render/glow.wgsl`: glow around bright light. Twin: `downpour_render::glow`.

use super::medium::MEDIUM_CONSTANTS;
use super::rain::COMPOSE;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&GLOW_CONSTANTS, &GLOW];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &GLOW_TAKE_KERNEL,
    &GLOW_DOWN_KERNEL,
    &GLOW_UP_KERNEL,
    &GLOW_COARSE_KERNEL,
    &GLOW_KAWASE_KERNEL,
    &GLOW_ADD_KERNEL,
];

shared_constants! {
    /// Numbers of the glow.
    GLOW_CONSTANTS at "render/glow constants" {
        /// Largest radiance that is taken.
        GLOW_BRIGHTEST: f32 = 1.0e12;
        /// Steps between coarse levels, at most: down and up twelve of them.
        GLOW_COARSE_STEPS: u32 = 24;
    }
}

/// Levels of the spread light. Twin: `downpour_render::glow`.
pub static GLOW: Module = Module {
    path: "render/glow.wgsl",
    wgsl: include_str!("../../wgsl/render/glow.wgsl"),
    uses: &[&GLOW_CONSTANTS, &MEDIUM_CONSTANTS, &COMPOSE],
};

const fn kernel(entry: &'static str) -> Kernel {
    Kernel { entry, module: &GLOW, workgroup: [8, 8, 1] }
}

/// Light that is taken: one invocation per pixel.
pub static GLOW_TAKE_KERNEL: Kernel = kernel("main_glow_take");

/// A coarser level: one invocation per texel of it.
pub static GLOW_DOWN_KERNEL: Kernel = kernel("main_glow_down");

/// A level with the coarser ones: one invocation per texel.
pub static GLOW_UP_KERNEL: Kernel = kernel("main_glow_up");

/// Several steps down and up between coarse levels: one workgroup.
pub static GLOW_COARSE_KERNEL: Kernel =
    Kernel { entry: "main_glow_coarse", module: &GLOW, workgroup: [256, 1, 1] };

/// A pass of Kawase's filter: one invocation per pixel.
pub static GLOW_KAWASE_KERNEL: Kernel = kernel("main_glow_kawase");

/// Light that comes less light that was taken: one invocation per pixel.
pub static GLOW_ADD_KERNEL: Kernel = kernel("main_glow_add");
