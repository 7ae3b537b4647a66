//! `wgsl/render/brdf.wgsl`. Twin: `downpour_trace::brdf`.

use super::puddle_water::PUDDLE_WATER_CONSTANTS;
use crate::Module;
use crate::drop::optics::OPTICS;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&BRDF_CONSTANTS, &BRDF];

shared_constants! {
    /// Guards of the microfacet terms.
    BRDF_CONSTANTS at "render/brdf constants" {
        /// Keeps a quotient finite.
        BRDF_MIN_DIVISOR: f32 = 1.0e-7;
        /// The least cosine to the viewer: interpolated normals may face away.
        BRDF_GRAZING: f32 = 1.0e-3;
        /// Reflectance at normal incidence from which a surface reflects all light at grazing incidence.
        BRDF_MIN_REFLECTANCE: f32 = 1.0e-3;
    }
}

/// Reflection at a surface. Twin: `downpour_trace::brdf`.
pub static BRDF: Module = Module {
    path: "render/brdf.wgsl",
    wgsl: include_str!("../../wgsl/render/brdf.wgsl"),
    uses: &[&BRDF_CONSTANTS, &PUDDLE_WATER_CONSTANTS, &OPTICS],
};
