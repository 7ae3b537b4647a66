//! Drops of points that drip. Twin: `downpour_sim::drips`.

use super::field::{EYE_DROP, FIELD, FIELD_CONSTANTS};
use super::splash::{SPLASH, SPLASH_CONSTANTS};
use crate::common::{INVOCATION, RNG};
use crate::drop::fall_speed::FALL_SPEED;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&DRIP_CONSTANTS, &DRIP, &DRIP_SPLASH];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&DRIP_FIND_KERNEL, &DRIP_SPLASH_KERNEL];

shared_constants! {
    /// Constants of points that drip.
    DRIP_CONSTANTS at "sim/drip_constants" {
        /// Invocations that share the drops of a point.
        DRIP_LANES: u32 = 32;
        /// Part of a drop's diameter by which its center hangs below the edge.
        DRIP_HANGS: f32 = 0.4;
        /// Jitter of the time of a drop, in intervals: half of it before, half after.
        DRIP_JITTER: f32 = 0.3;
        /// Margin around all drops of a point, m.
        DRIP_MARGIN: f32 = 0.02;
        /// Drops of a point that are farther from those of a picture are as good as infinitely far.
        DRIP_FAR: u32 = 0x40000000;
        /// Dimension of the random numbers of a drop; those of its id have the next one.
        DRIP_DROP: u32 = 8329;
    }
}

/// Drops of points that drip, before an eye. Twin: `downpour_sim::drips`.
pub static DRIP: Module = Module {
    path: "sim/drip.wgsl",
    wgsl: include_str!("../../wgsl/sim/drip.wgsl"),
    uses: &[&FIELD_CONSTANTS, &DRIP_CONSTANTS, &EYE_DROP, &FIELD, &FALL_SPEED, &INVOCATION, &RNG],
};

/// Crowns of drops that have dripped, before an eye. Twin: `downpour_sim::drips`.
pub static DRIP_SPLASH: Module = Module {
    path: "sim/drip_splash.wgsl",
    wgsl: include_str!("../../wgsl/sim/drip_splash.wgsl"),
    uses: &[&SPLASH_CONSTANTS, &DRIP, &SPLASH],
};

/// `DRIP_LANES` invocations per point.
pub static DRIP_FIND_KERNEL: Kernel =
    Kernel { entry: "main_drip_find", module: &DRIP, workgroup: [64, 1, 1] };

/// One invocation per point.
pub static DRIP_SPLASH_KERNEL: Kernel =
    Kernel { entry: "main_drip_splash", module: &DRIP_SPLASH, workgroup: [64, 1, 1] };
