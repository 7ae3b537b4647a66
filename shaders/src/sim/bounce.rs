//! Droplets that rebound before a picture. Twin: `downpour_sim::impacts`.

use super::field::{
    DRIFT, EYE_DROP, FIELD, FIELD_CONSTANTS, SHELTER, SHELTER_AMONG_HOLES, SHELTER_HIT, SHELTER_HIT_HOLES,
};
use super::splash::IMPACT;
use super::step::{MOTION, STEP_CONSTANTS};
use crate::bvh::BVH;
use crate::common::{INVOCATION, RNG};
use crate::drop::fall_speed::FALL_SPEED;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&BOUNCE_CONSTANTS, &BOUNCE, &BOUNCE_FIND, &BOUNCE_HIT, &BOUNCE_HIT_AMONG_HOLES];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &BOUNCE_CLEAR_KERNEL,
    &BOUNCE_FIND_KERNEL,
    &BOUNCE_HIT_KERNEL,
    &BOUNCE_HIT_AMONG_HOLES_KERNEL,
    &BOUNCE_LIST_KERNEL,
];

shared_constants! {
    /// Constants of droplets that rebound.
    BOUNCE_CONSTANTS at "sim/bounce_constants" {
        /// Interval at which the path of a drop is divided where it may hit something, s.
        BOUNCE_SLICE: f32 = 0.0625;
        /// Invocations that share the chains of a column.
        BOUNCE_LANES: u32 = 64;
        /// Interval at which the path of a droplet is divided, s.
        BOUNCE_STEP: f32 = 0.016666668;
        /// Least relaxation time of a droplet, s.
        BOUNCE_MIN_RELAXATION: f32 = 1.0e-9;
        /// Dimension of the random numbers of rebounds.
        BOUNCE_CHANCE: u32 = 8203;
        /// Difference between the id of a drop and that of its droplet: the lower half.
        BOUNCE_LOW: u32 = 0x7f4a7c15;
        /// The upper half.
        BOUNCE_HIGH: u32 = 0x9e3779b9;
    }
}

/// Droplets, and the list of them. Twin: `downpour_sim::impacts::bounced`.
pub static BOUNCE: Module = Module {
    path: "sim/bounce.wgsl",
    wgsl: include_str!("../../wgsl/sim/bounce.wgsl"),
    uses: &[&FIELD_CONSTANTS, &BOUNCE_CONSTANTS, &EYE_DROP, &DRIFT, &FALL_SPEED, &INVOCATION],
};

/// Parts of paths of drops whose droplets a picture may show. Twin: `downpour_sim::impacts`.
pub static BOUNCE_FIND: Module = Module {
    path: "sim/bounce_find.wgsl",
    wgsl: include_str!("../../wgsl/sim/bounce_find.wgsl"),
    uses: &[&FIELD_CONSTANTS, &BOUNCE_CONSTANTS, &EYE_DROP, &FALL_SPEED, &INVOCATION, &RNG, &FIELD, &BOUNCE],
};

/// Droplets of these parts. Twin: `downpour_sim::impacts::bounced`.
pub static BOUNCE_HIT: Module = Module {
    path: "sim/bounce_hit.wgsl",
    wgsl: include_str!("../../wgsl/sim/bounce_hit.wgsl"),
    uses: &[
        &FIELD_CONSTANTS,
        &BOUNCE_CONSTANTS,
        &STEP_CONSTANTS,
        &EYE_DROP,
        &INVOCATION,
        &MOTION,
        &BVH,
        &IMPACT,
        &SHELTER_HIT,
        &SHELTER,
        &BOUNCE,
    ],
};

/// The same among triangles with holes.
pub static BOUNCE_HIT_AMONG_HOLES: Module = Module {
    uses: &[
        &FIELD_CONSTANTS,
        &BOUNCE_CONSTANTS,
        &STEP_CONSTANTS,
        &EYE_DROP,
        &INVOCATION,
        &MOTION,
        &BVH,
        &IMPACT,
        &SHELTER_HIT_HOLES,
        &SHELTER_AMONG_HOLES,
        &BOUNCE,
    ],
    ..BOUNCE_HIT
};

/// One invocation.
pub static BOUNCE_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_bounce_clear", module: &BOUNCE, workgroup: [1, 1, 1] };

/// `BOUNCE_LANES` invocations per column.
pub static BOUNCE_FIND_KERNEL: Kernel =
    Kernel { entry: "main_bounce_find", module: &BOUNCE_FIND, workgroup: [64, 1, 1] };

/// One invocation per part of a path.
pub static BOUNCE_HIT_KERNEL: Kernel =
    Kernel { entry: "main_bounce_hit", module: &BOUNCE_HIT, workgroup: [64, 1, 1] };

/// One invocation per part of a path.
pub static BOUNCE_HIT_AMONG_HOLES_KERNEL: Kernel =
    Kernel { entry: "main_bounce_hit", module: &BOUNCE_HIT_AMONG_HOLES, workgroup: [64, 1, 1] };

/// One invocation per part of a path.
pub static BOUNCE_LIST_KERNEL: Kernel =
    Kernel { entry: "main_bounce_list", module: &BOUNCE, workgroup: [64, 1, 1] };
