//! Rain in closed form. Twin: `downpour_sim::field`.

use crate::bvh::BVH;
use crate::common::{INVOCATION, RNG};
use crate::drop::distribution::DISTRIBUTION;
use crate::render::scene::SURFACE;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &EYE_DROP,
    &FIELD_CONSTANTS,
    &DRIFT,
    &FIELD,
    &SHELTER_HIT,
    &SHELTER,
    &SHELTER_HIT_HOLES,
    &SHELTER_AMONG_HOLES,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] =
    &[&FIELD_CLEAR_KERNEL, &FIELD_FIND_KERNEL, &SHELTER_KERNEL, &SHELTER_AMONG_HOLES_KERNEL];

shared_constants! {
    /// Constants of the closed form.
    FIELD_CONSTANTS at "sim/field_constants" {
        /// Invocations that share the chains of a column.
        FIELD_LANES: u32 = 8;
        /// Dimension of the random numbers of a column's number of chains.
        FIELD_CHAIN_COUNT: u32 = 8200;
        /// Dimension of those of a chain.
        FIELD_CHAIN: u32 = 8201;
        /// Dimension of those of a drop.
        FIELD_PLACE: u32 = 8202;
        /// Dimension of that of a drop of a rain whose rate changes.
        FIELD_THIN: u32 = 8203;
        /// Intervals of diameter of a class in the table of a rain whose rate changes.
        FIELD_KEPT_INTERVALS: u32 = 8;
        /// Mean of a whole portion of a Poisson number.
        FIELD_PORTION_MEAN: u32 = 16;
        /// Thresholds of a portion: beyond, no probability of 64 bits is left.
        FIELD_THRESHOLDS: u32 = 96;
        /// Unit of a diameter, m: 2^-30.
        FIELD_DIAMETER_STEP: f32 = 9.313226e-10;
        /// Unit of a rate of fall, periods per second: 2^-29.
        FIELD_RATE_STEP: f32 = 1.8626451e-9;
        /// Unit of a fraction of a period: 2^-32.
        FIELD_FRACTION_STEP: f32 = 2.3283064e-10;
        /// Intervals of the table of drift.
        FIELD_DRIFT: u32 = 48;
        /// Terminal speed, m/s, at the end of the table of drift.
        FIELD_DRIFT_SPEED: f32 = 12.0;
        /// Sides of the pyramid of a picture, and the plane behind the eye.
        FIELD_SIDES: u32 = 5;
        /// Radius of a drop relative to its diameter, including its oscillation.
        FIELD_RADIUS: f32 = 0.6;
        /// As good as infinite, s.
        FIELD_ALWAYS: f32 = 1.0e30;
        /// In place of the terminal speed of a drop, and below it: a splash.
        FIELD_SPLASH: f32 = -1.0;
        /// Steps of each of the two numbers of the normal of the surface of a splash, from 0 to 1: both together are a whole f32.
        FIELD_NORMAL_STEPS: u32 = 2047;
        /// In place of the terminal speed of a drop: one that drips.
        FIELD_DRIPPED: f32 = -0.5;
        /// In place of the terminal speed of a drop: a droplet that rebounded, or whose speed is not known.
        FIELD_BOUNCED: f32 = 0.0;
        /// Distance from a surface below which a drop counts as on it, m.
        SHELTER_CLEAR: f32 = 1.0e-4;
        /// Interval at which a path is divided, s.
        SHELTER_CUT: f32 = 0.25;
        /// Greatest speed, m/s, at which anything is carried.
        SHELTER_CARRIED: f32 = 60.0;
        /// Holes on the path of a drop: one through more counts as open.
        SHELTER_HOLES: u32 = 64;
    }
}

/// A drop relative to the eye. Twin: `downpour_sim::field::EyeDrop`.
pub static EYE_DROP: Module = Module {
    path: "sim/eye_drop.wgsl",
    wgsl: include_str!("../../wgsl/sim/eye_drop.wgsl"),
    uses: &[&FIELD_CONSTANTS],
};

/// Drift of drops by terminal speed. Twin: `downpour_sim::drift`.
pub static DRIFT: Module = Module {
    path: "sim/drift.wgsl",
    wgsl: include_str!("../../wgsl/sim/drift.wgsl"),
    uses: &[&FIELD_CONSTANTS],
};

/// Drops of a rain before an eye. Twin: `downpour_sim::field`.
pub static FIELD: Module = Module {
    path: "sim/field.wgsl",
    wgsl: include_str!("../../wgsl/sim/field.wgsl"),
    uses: &[&FIELD_CONSTANTS, &EYE_DROP, &DRIFT, &INVOCATION, &RNG, &DISTRIBUTION],
};

/// Hits among triangles. Twin: `downpour_sim::shelter`.
pub static SHELTER_HIT: Module = Module {
    path: "sim/shelter_hit.wgsl",
    wgsl: include_str!("../../wgsl/sim/shelter_hit.wgsl"),
    uses: &[&BVH],
};

/// Hits among triangles with holes. Twin: `downpour_sim::shelter`.
pub static SHELTER_HIT_HOLES: Module = Module {
    path: "sim/holes/shelter_hit.wgsl",
    wgsl: include_str!("../../wgsl/sim/holes/shelter_hit.wgsl"),
    uses: &[&FIELD_CONSTANTS, &BVH, &SURFACE],
};

/// Drops that nothing has stopped. Twin: `downpour_sim::shelter`.
pub static SHELTER: Module = Module {
    path: "sim/shelter.wgsl",
    wgsl: include_str!("../../wgsl/sim/shelter.wgsl"),
    uses: &[&FIELD_CONSTANTS, &EYE_DROP, &DRIFT, &INVOCATION, &BVH, &SHELTER_HIT],
};

/// The same among triangles with holes.
pub static SHELTER_AMONG_HOLES: Module =
    Module { uses: &[&FIELD_CONSTANTS, &EYE_DROP, &DRIFT, &INVOCATION, &BVH, &SHELTER_HIT_HOLES], ..SHELTER };

/// One invocation per place in the list.
pub static FIELD_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_field_clear", module: &FIELD, workgroup: [64, 1, 1] };

/// `FIELD_LANES` invocations per column.
pub static FIELD_FIND_KERNEL: Kernel =
    Kernel { entry: "main_field_find", module: &FIELD, workgroup: [64, 1, 1] };

/// One invocation per place in the list.
pub static SHELTER_KERNEL: Kernel = Kernel { entry: "main_shelter", module: &SHELTER, workgroup: [64, 1, 1] };

/// One invocation per place in the list.
pub static SHELTER_AMONG_HOLES_KERNEL: Kernel =
    Kernel { entry: "main_shelter", module: &SHELTER_AMONG_HOLES, workgroup: [64, 1, 1] };
