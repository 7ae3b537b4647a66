//! Drops that enter a frustum.

use super::step::STEP;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&ENTER_CONSTANTS, &ENTER];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&ENTER_KERNEL];

shared_constants! {
    /// Constants of entering drops.
    ENTER_CONSTANTS at "sim/enter_constants" {
        /// Number of quantiles of the diameters of a bin.
        ENTER_SIZES: u32 = 9;
        /// Number of words of a region in the tables.
        ENTER_REGION_WORDS: u32 = 12;
        /// Number of steps of a binary search: 2^16 regions.
        ENTER_SEARCH: u32 = 16;
        /// Number of random slots that are tried for a drop.
        ENTER_TRIES: u32 = 64;
        /// Number of slots that are tried after them, one after another.
        ENTER_SCAN: u32 = 4096;
        /// First dimension of the random numbers of candidates: one of each bin and face.
        ENTER_DRAW: u32 = 16384;
        /// First dimension of the random numbers of slots, one per try.
        ENTER_SLOT: u32 = 12288;
        /// 2^-24.
        ENTER_UNIT: f32 = 5.9604645e-8;
    }
}

/// Entry of drops into a frustum. Twin: `downpour_sim::enter`.
pub static ENTER: Module = Module {
    path: "sim/enter.wgsl",
    wgsl: include_str!("../../wgsl/sim/enter.wgsl"),
    uses: &[&ENTER_CONSTANTS, &STEP],
};

/// One invocation per candidate.
pub static ENTER_KERNEL: Kernel = Kernel { entry: "main_enter", module: &ENTER, workgroup: [256, 1, 1] };
