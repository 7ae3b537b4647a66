//! Crowns of splashes before a picture. Twin: `downpour_sim::impacts`.

use super::field::{EYE_DROP, FIELD_CONSTANTS};
use crate::bvh::BVH;
use crate::common::{INVOCATION, RNG};
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&SPLASH_CONSTANTS, &IMPACT, &SPLASH, &SPLASH_FIND];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&SPLASH_FIND_KERNEL];

shared_constants! {
    /// Laws of splashes (`downpour_drop::splash`), and what of them is drawn at random.
    SPLASH_CONSTANTS at "sim/splash_constants" {
        /// Root of the Weber number above which a drop splashes on a film.
        SPLASH_THRESHOLD: f32 = 20.0;
        /// Time at which the crown of a drop far above the threshold is highest, in drop diameters over the drop's speed.
        SPLASH_RISE_TIMES: f32 = 12.0;
        /// Fraction of its duration in which a crown rises.
        SPLASH_RISE_SHARE: f32 = 0.125;
        /// Largest height of the wall of a crown, in its radius.
        SPLASH_WALL: f32 = 0.42;
        /// Largest height of the fingers above it.
        SPLASH_FINGERS: f32 = 0.34;
        /// Dimension of the random number of a crown's size.
        SPLASH_SIZE: u32 = 8204;
        /// Smallest size of a crown, relative to the law.
        SPLASH_MIN_SIZE: f32 = 0.75;
        /// Largest size of a crown, relative to the law.
        SPLASH_MAX_SIZE: f32 = 1.25;
        /// Difference between the id of a drop and that of its splash: the lower half.
        SPLASH_LOW: u32 = 4089235721;
        /// The upper half.
        SPLASH_HIGH: u32 = 1779033703;
        /// Least vertical component of the normal of a surface on which crowns stand: that of a wall, to the digits of its vertices.
        SPLASH_LEVEL: f32 = -0.02;
        /// Longest duration of a crown, s.
        SPLASH_MAX_S: f32 = 0.055;
        /// Time around a hit in which the same hit is found again, s.
        SPLASH_AGAIN: f32 = 2.0e-5;
    }
}

/// Surfaces that drops hit. Twin: `downpour_sim::impacts::splash_frame`.
pub static IMPACT: Module =
    Module { path: "sim/impact.wgsl", wgsl: include_str!("../../wgsl/sim/impact.wgsl"), uses: &[&BVH] };

/// Crowns of splashes. Twin: `downpour_sim::impacts::splash_frame`.
pub static SPLASH: Module = Module {
    path: "sim/splash.wgsl",
    wgsl: include_str!("../../wgsl/sim/splash.wgsl"),
    uses: &[&FIELD_CONSTANTS, &SPLASH_CONSTANTS, &EYE_DROP, &RNG],
};

/// Search for the crowns of a slice of time. Twin: `downpour_sim::impacts::splash_frame`.
pub static SPLASH_FIND: Module = Module {
    path: "sim/splash_find.wgsl",
    wgsl: include_str!("../../wgsl/sim/splash_find.wgsl"),
    uses: &[&SPLASH, &INVOCATION, &BVH, &IMPACT],
};

/// One invocation per drop of a slice of time.
pub static SPLASH_FIND_KERNEL: Kernel =
    Kernel { entry: "main_splash_find", module: &SPLASH_FIND, workgroup: [64, 1, 1] };
