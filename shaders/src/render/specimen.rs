//! `wgsl/render/specimen.wgsl`. Twin: `downpour_render::specimen`.

use crate::drop::optics;
use crate::mask;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&SPECIMEN_CONSTANTS, &SPECIMEN_TABLES, &SPECIMEN];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&SPECIMEN_KERNEL];

shared_constants! {
    /// Constants of the specimen.
    SPECIMEN_CONSTANTS at "render/specimen constants" {
        /// Internal reflections that are followed, total ones included. What is left then leaves with the last light
        /// that left: below 1 % of all light in any view, below 0.04 % in level views up to 6 mm.
        SPECIMEN_REFLECTIONS: u32 = 256;
        /// Share of the light below which what is left inside is not followed any further. A sky holds a sun of 10^5
        /// times its mean: this share of it would still be seen above 10^-4.
        SPECIMEN_LEAST: f32 = 0.0001;
        /// More than any share: all light leaves.
        SPECIMEN_ALL: f32 = 2.0;
        /// Steps to the point of a ray that is nearest to the drop.
        SPECIMEN_NEAREST_STEPS: u32 = 5;
        /// Below this, a vector has no direction.
        SPECIMEN_TINY: f32 = 1.0e-30;
        /// Largest number of samples along an edge of a pixel. One invocation makes the square of it, each with at
        /// most 175 passes of a loop (5 + 4 to the entry, 33 times 1 + 4 inside, itself): below the 65 535 at which
        /// a driver may stop.
        SPECIMEN_SAMPLES: u32 = 16;
    }
}

shared_tables! {
    /// Tables of the specimen.
    SPECIMEN_TABLES at "render/specimen tables" {
        /// atan(t) / (2 pi t) as a polynomial of t^2, for t in [0, 1]: interpolation at Chebyshev's points, within
        /// 1.6e-9 turns.
        SPECIMEN_TURN: [f32; 9] = [
            0.15915494, -0.053051176, 0.031818053, -0.022596497, 0.016899662, -0.011867953, 0.006706411,
            -0.0025037061, 0.0004402677
        ];
    }
}

/// One drop in front of a sky. Twin: `downpour_render::specimen`.
pub static SPECIMEN: Module = Module {
    path: "render/specimen.wgsl",
    wgsl: include_str!("../../wgsl/render/specimen.wgsl"),
    uses: &[&SPECIMEN_CONSTANTS, &SPECIMEN_TABLES, &mask::MASK_CONSTANTS, &mask::TRACE, &optics::OPTICS],
};

/// One invocation per pixel of a band of rows.
pub static SPECIMEN_KERNEL: Kernel =
    Kernel { entry: "main_specimen", module: &SPECIMEN, workgroup: [8, 8, 1] };
