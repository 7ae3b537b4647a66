//! `wgsl/render/translucent.wgsl`: surfaces that transmit light diffusely, as leaves do. Twin: `downpour_trace::translucent`.

use super::scene::{SKY, SURFACE};
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&TRANSLUCENT_CONSTANTS, &TRANSLUCENT];

shared_constants! {
    /// Numbers of surfaces that transmit light diffusely.
    TRANSLUCENT_CONSTANTS at "render/translucent constants" {
        /// Makes the number that draws a side of those of a ray: one that no other draw of the ray has.
        TRANSLUCENT_SIDE: f32 = 311.0;
    }
}

/// Surfaces that transmit light diffusely. Twin: `downpour_trace::translucent`.
pub static TRANSLUCENT: Module = Module {
    path: "render/translucent.wgsl",
    wgsl: include_str!("../../wgsl/render/translucent.wgsl"),
    uses: &[&TRANSLUCENT_CONSTANTS, &SKY, &SURFACE],
};
