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
    /// Constants of the optics of an interface.
    OPTICS_CONSTANTS at "drop/optics constants" {
        /// Keeps a division from 0/0 at grazing incidence on an interface without contrast.
        OPTICS_MIN: f32 = 1.0e-30;
        /// Tatarchuk & Isidoro 2006: reflectance at normal incidence.
        OPTICS_TATARCHUK_BASE: f32 = 0.05;
        /// Tatarchuk & Isidoro 2006: increase of the reflectance toward grazing incidence.
        OPTICS_TATARCHUK_RISE: f32 = 0.95;
    }
}
