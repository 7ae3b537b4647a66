//! `wgsl/render/refine.wgsl`: means of pictures. Twin: `downpour_render::refine`.

use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&REFINE];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&REFINE_KERNEL];

/// Means of pictures. Twin: `downpour_render::refine`.
pub static REFINE: Module =
    Module { path: "render/refine.wgsl", wgsl: include_str!("../../wgsl/render/refine.wgsl"), uses: &[] };

/// A picture more in a mean: one invocation per pixel.
pub static REFINE_KERNEL: Kernel = Kernel { entry: "main_refine", module: &REFINE, workgroup: [8, 8, 1] };
