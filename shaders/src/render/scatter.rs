//! `wgsl/render/scatter.wgsl`: rays that look for the light of a surface. Twin: `downpour_trace::scatter`.

use super::brdf::BRDF;
use super::scene::SURFACE;
use super::wet::WET;
use crate::Module;
use crate::common::PACKING;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&SCATTER_CONSTANTS, &SCATTER];

shared_constants! {
    /// Numbers of rays that look for light.
    SCATTER_CONSTANTS at "render/scatter constants" {
        /// Square of a cone's width over its solid angle over pi.
        SCATTER_DISK: f32 = 4.0;
        /// Width at distance 1 of the widest ray.
        SCATTER_MAX_WIDTH: f32 = 1.5;
        /// Alpha of the sharpest lobe that rays are drawn from.
        SCATTER_MIN_ALPHA: f32 = 0.001;
        /// Keeps a quotient finite.
        SCATTER_MIN_DIVISOR: f32 = 1.0e-6;
    }
}

/// Rays that look for the light of a surface. Twin: `downpour_trace::scatter`.
pub static SCATTER: Module = Module {
    path: "render/scatter.wgsl",
    wgsl: include_str!("../../wgsl/render/scatter.wgsl"),
    uses: &[&SCATTER_CONSTANTS, &BRDF, &SURFACE, &WET, &PACKING],
};
