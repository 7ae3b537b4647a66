//! `wgsl/render/puddle_flow.wgsl`: running water. Twin: `downpour_trace::scene::puddle_flow`.

use super::puddle_water::PUDDLE_WATER_CONSTANTS;
use super::scene::DATA;
use super::table::PUDDLE;
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PUDDLE_FLOW_CONSTANTS, &PUDDLE_FLOW];

shared_constants! {
    /// Numbers of running water.
    PUDDLE_FLOW_CONSTANTS at "render/puddle_flow constants" {
        /// Row of the flow among those of its puddle.
        PUDDLE_FLOW_ROW: u32 = 7;
        /// Time for which a pattern of ripples moves with the water, s: about the life of waves as short as those of the rain.
        PUDDLE_FLOW_PERIOD: f32 = 0.8;
        /// Speed from which on all ripples move, m/s.
        PUDDLE_FLOW_SLOW: f32 = 0.04;
    }
}

/// Running water. Twin: `downpour_trace::scene::puddle_flow`.
pub static PUDDLE_FLOW: Module = Module {
    path: "render/puddle_flow.wgsl",
    wgsl: include_str!("../../wgsl/render/puddle_flow.wgsl"),
    uses: &[&PUDDLE_FLOW_CONSTANTS, &PUDDLE_WATER_CONSTANTS, &DATA, &PUDDLE],
};
