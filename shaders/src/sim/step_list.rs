//! Drops of a state of stepped rain that a picture shows.

use super::field::EYE_DROP;
use super::splash::SPLASH;
use super::step::STEP;
use crate::common::INVOCATION;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&STEP_LIST_CONSTANTS, &STEP_LIST, &STEP_SPLASH];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&STEP_LIST_CLEAR_KERNEL, &STEP_LIST_KERNEL, &STEP_SPLASH_KERNEL];

shared_constants! {
    /// Constants of the list.
    STEP_LIST_CONSTANTS at "sim/step_list_constants" {
        /// Turns of the network that spreads the bits of an id.
        STEP_LIST_TURNS: u32 = 4;
        /// Factor of its hash (Steele and Vigna 2021).
        STEP_LIST_MULTIPLIER: u32 = 0x915f77f5;
    }
}

/// Drops that a picture shows. Twin: `downpour_sim::step_list`.
pub static STEP_LIST: Module = Module {
    path: "sim/step_list.wgsl",
    wgsl: include_str!("../../wgsl/sim/step_list.wgsl"),
    uses: &[&STEP_LIST_CONSTANTS, &STEP, &SPLASH, &EYE_DROP, &INVOCATION],
};

/// Crowns of the impacts of the last steps. Twin: `downpour_sim::step_splash`.
pub static STEP_SPLASH: Module = Module {
    path: "sim/step_splash.wgsl",
    wgsl: include_str!("../../wgsl/sim/step_splash.wgsl"),
    uses: &[&STEP_LIST],
};

/// One invocation per place in the list.
pub static STEP_LIST_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_step_list_clear", module: &STEP_LIST, workgroup: [64, 1, 1] };

/// One invocation per drop or slot.
pub static STEP_LIST_KERNEL: Kernel =
    Kernel { entry: "main_step_list", module: &STEP_LIST, workgroup: [64, 1, 1] };

/// One invocation per impact for which there is room.
pub static STEP_SPLASH_KERNEL: Kernel =
    Kernel { entry: "main_step_splash", module: &STEP_SPLASH, workgroup: [64, 1, 1] };
