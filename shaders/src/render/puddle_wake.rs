//! `wgsl/render/puddle_wake.wgsl`: waves of what moves through puddles. Twin: `downpour_trace::scene::puddle_wake`.

use super::puddle_water::PUDDLE_WATER_CONSTANTS;
use super::scene::DATA;
use super::table::PUDDLE;
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PUDDLE_WAKE_CONSTANTS, &PUDDLE_WAKE];

shared_constants! {
    /// Numbers of waves of what moves through puddles.
    PUDDLE_WAKE_CONSTANTS at "render/puddle_wake constants" {
        /// Row of the lattice among those of its puddle.
        PUDDLE_WAKE_ROW: u32 = 6;
        /// Footprint up to which waves are shown whole, cells.
        PUDDLE_WAKE_FINE: f32 = 1.5;
        /// Footprint from which on they are a variance only, cells.
        PUDDLE_WAKE_COARSE: f32 = 6.0;
    }
}

/// Waves of what moves through puddles. Twin: `downpour_trace::scene::puddle_wake`.
pub static PUDDLE_WAKE: Module = Module {
    path: "render/puddle_wake.wgsl",
    wgsl: include_str!("../../wgsl/render/puddle_wake.wgsl"),
    uses: &[&PUDDLE_WAKE_CONSTANTS, &PUDDLE_WATER_CONSTANTS, &DATA, &PUDDLE],
};
