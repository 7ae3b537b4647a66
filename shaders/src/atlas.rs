//! `wgsl/atlas`: streak atlases. The Rust twins are in `downpour-atlas`.

use crate::common::RNG;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&ATLAS_CONSTANTS, &ATLAS, &ATLAS_DATA, &ATLAS_LOOKUP, &ATLAS_QUERY];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&ATLAS_QUERY_KERNEL];

shared_constants! {
    /// Constants of the streak atlas.
    ATLAS_CONSTANTS at "atlas/constants" {
        /// A particle's streak is picked by the directions of light and viewer.
        ATLAS_BY_ANGLE: u32 = 0;
        /// A particle's streak is any of them.
        ATLAS_RANDOM: u32 = 1;
        /// No triangle: the rim of the map.
        ATLAS_NONE: u32 = 4294967295;
        /// The most triangles that a walk goes through.
        ATLAS_STEPS: u32 = 64;
        /// Dimension of the random numbers.
        ATLAS_DIMENSION: u32 = 5200;
        /// Columns of a grid of amounts, and its rows.
        ATLAS_GRID: u32 = 41;
        /// Grids of a diameter and an oscillation, over elevations of the viewer: equal steps of their sine.
        ATLAS_RISES: u32 = 25;
        /// Sine of the highest elevation of a grid; the lowest has the same below 0.
        ATLAS_RISE_LIMIT: f32 = 0.96;
        /// The diameter that smaller ones count as, in meters.
        ATLAS_MIN_DIAMETER: f32 = 1.0e-6;
        /// The axis is taken to point to the viewer where the square of its part across is below this.
        ATLAS_TINY: f32 = 1.0e-8;
    }
}

/// Directions of light among those of an atlas. Twin: `downpour_atlas::lookup`.
pub static ATLAS: Module = Module {
    path: "atlas/atlas.wgsl",
    wgsl: include_str!("../wgsl/atlas/atlas.wgsl"),
    uses: &[&ATLAS_CONSTANTS, &RNG],
};

/// The buffers of an atlas as bindings 0 to 3. A kernel with other bindings declares the same four names in a module
/// of its own, and gives it to a module of the text of [`ATLAS_LOOKUP`].
pub static ATLAS_DATA: Module =
    Module { path: "atlas/data.wgsl", wgsl: include_str!("../wgsl/atlas/data.wgsl"), uses: &[&ATLAS] };

/// Radiances of streaks. Twin: `downpour_atlas::lookup`.
pub static ATLAS_LOOKUP: Module = Module {
    path: "atlas/lookup.wgsl",
    wgsl: include_str!("../wgsl/atlas/lookup.wgsl"),
    uses: &[&ATLAS_CONSTANTS, &ATLAS, &ATLAS_DATA],
};

/// A list of points of streaks.
pub static ATLAS_QUERY: Module = Module {
    path: "atlas/query.wgsl",
    wgsl: include_str!("../wgsl/atlas/query.wgsl"),
    uses: &[&ATLAS_LOOKUP],
};

/// One invocation per point.
pub static ATLAS_QUERY_KERNEL: Kernel =
    Kernel { entry: "main_atlas_query", module: &ATLAS_QUERY, workgroup: [64, 1, 1] };
