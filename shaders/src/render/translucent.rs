//! `wgsl/render/translucent.wgsl`: surfaces that transmit light diffusely, as leaves do. Twin: `downpour_trace::translucent`.

use super::scene::{SKY, SURFACE};
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&TRANSLUCENT];

/// Surfaces that transmit light diffusely. Twin: `downpour_trace::translucent`.
pub static TRANSLUCENT: Module = Module {
    path: "render/translucent.wgsl",
    wgsl: include_str!("../../wgsl/render/translucent.wgsl"),
    uses: &[&SKY, &SURFACE],
};
