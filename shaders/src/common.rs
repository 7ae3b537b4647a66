//! `wgsl/common`: functions that every subsystem may use. The Rust twins are in `downpour-math`.

use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &COLOR,
    &EQUIRECT_CONSTANTS,
    &EQUIRECT,
    &INVOCATION,
    &OCTANT_TABLES,
    &OCTANT,
    &OPS,
    &PACKING_CONSTANTS,
    &PACKING,
    &PYRAMID,
    &RNG_CONSTANTS,
    &RNG,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&PYRAMID_KERNEL];

/// Tests and small functions on scalars. Twin: `downpour_math::ops`.
pub static OPS: Module =
    Module { path: "common/ops.wgsl", wgsl: include_str!("../wgsl/common/ops.wgsl"), uses: &[] };

/// Colors of linear BT.709. Twin: `downpour_math::color`.
pub static COLOR: Module =
    Module { path: "common/color.wgsl", wgsl: include_str!("../wgsl/common/color.wgsl"), uses: &[] };

/// Equirectangular maps. Twin: `downpour_math::equirect`.
pub static EQUIRECT: Module = Module {
    path: "common/equirect.wgsl",
    wgsl: include_str!("../wgsl/common/equirect.wgsl"),
    uses: &[&EQUIRECT_CONSTANTS],
};

/// Angle of the first octant from its tangent. Twin: `downpour_math::octant`.
pub static OCTANT: Module = Module {
    path: "common/octant.wgsl",
    wgsl: include_str!("../wgsl/common/octant.wgsl"),
    uses: &[&OCTANT_TABLES],
};

/// Invocations of several rows of workgroups. Twin: `downpour_gpu::invocation_index`.
pub static INVOCATION: Module = Module {
    path: "common/invocation.wgsl",
    wgsl: include_str!("../wgsl/common/invocation.wgsl"),
    uses: &[],
};

/// Counter-based random numbers. Twin: `downpour_math::rng`.
pub static RNG: Module = Module {
    path: "common/rng.wgsl",
    wgsl: include_str!("../wgsl/common/rng.wgsl"),
    uses: &[&RNG_CONSTANTS],
};

/// Mip pyramid. Twin: `downpour_math::pyramid`.
pub static PYRAMID: Module =
    Module { path: "common/pyramid.wgsl", wgsl: include_str!("../wgsl/common/pyramid.wgsl"), uses: &[] };

/// One invocation per texel of the level that is made.
pub static PYRAMID_KERNEL: Kernel = Kernel { entry: "main_pyramid", module: &PYRAMID, workgroup: [8, 8, 1] };

/// Unit vectors in two numbers. Twin: `downpour_math::packing`.
pub static PACKING: Module = Module {
    path: "common/packing.wgsl",
    wgsl: include_str!("../wgsl/common/packing.wgsl"),
    uses: &[&PACKING_CONSTANTS],
};

shared_constants! {
    /// Constants of the random number generator.
    RNG_CONSTANTS at "common/rng constants" {
        /// Multiplier of the 32-bit linear congruential step (Jarzynski & Olano 2020, after PCG).
        RNG_PCG_MULTIPLIER: u32 = 1664525;
        /// Increment of the same step.
        RNG_PCG_INCREMENT: u32 = 1013904223;
        /// 2^-24: spacing of the uniform numbers.
        RNG_UNIT_STEP: f32 = 5.9604645e-8;
    }
}

shared_constants! {
    /// Constants of equirectangular maps.
    EQUIRECT_CONSTANTS at "common/equirect constants" {
        /// A direction of length 1 whose level part is at most this long is that of a pole.
        EQUIRECT_POLE: f32 = 1.0e-6;
    }
}

shared_tables! {
    /// Tables of angles.
    OCTANT_TABLES at "common/octant tables" {
        /// atan(t) / (2 pi t) as a polynomial of t^2, for t in [0, 1]: interpolation at Chebyshev's points, within
        /// 1.6e-9 turns.
        OCTANT_TURN: [f32; 9] = [
            0.15915494, -0.053051176, 0.031818053, -0.022596497, 0.016899662, -0.011867953, 0.006706411,
            -0.0025037061, 0.0004402677
        ];
    }
}

shared_constants! {
    /// Constants of the packed unit vectors.
    PACKING_CONSTANTS at "common/packing constants" {
        /// Below this sum of absolute components a vector has no direction.
        PACKING_MIN_NORM: f32 = 1.0e-30;
    }
}
