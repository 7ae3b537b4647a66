//! `wgsl/drop/optics.wgsl`. Twin: `downpour_drop::optics`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&OPTICS_CONSTANTS, &OPTICS];

/// Refraction, reflection and Fresnel's equations. Twin: `downpour_drop::optics`.
pub static OPTICS: Module = Module {
    path: "drop/optics.wgsl",
    wgsl: include_str!("../../wgsl/drop/optics.wgsl"),
    uses: &[&OPTICS_CONSTANTS],
};

shared_constants! {
    /// Numbers of the optics of an interface.
    OPTICS_CONSTANTS at "drop/optics constants" {
        /// Keeps a division away from 0/0 where an interface without contrast is seen at grazing incidence.
        OPTICS_SMALLEST: f32 = 1.0e-30;
        /// Tatarchuk & Isidoro 2006: the share that their reflectance has at normal incidence.
        OPTICS_TATARCHUK_BASE: f32 = 0.05;
        /// Tatarchuk & Isidoro 2006: what is added towards grazing incidence.
        OPTICS_TATARCHUK_RISE: f32 = 0.95;
    }
}
