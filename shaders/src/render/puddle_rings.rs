//! `wgsl/render/puddle_rings.wgsl`: rings of single drops on water. Twin: `downpour_trace::scene::puddle_rings`.

use super::puddle_water::PUDDLE_WATER_CONSTANTS;
use super::scene::DATA;
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PUDDLE_RINGS_CONSTANTS, &PUDDLE_RINGS];

shared_constants! {
    /// Numbers of rings on water.
    PUDDLE_RINGS_CONSTANTS at "render/puddle_rings constants" {
        /// Rows in the scene's table that say where rings are.
        PUDDLE_RINGS_ROWS: u32 = 3;
        /// Nodes of sizes of drops, steps of time, and steps of distance of the table of slopes.
        PUDDLE_RINGS_SIZES: u32 = 5;
        /// Steps of time.
        PUDDLE_RINGS_TIMES: u32 = 216;
        /// Steps of distance, an even number.
        PUDDLE_RINGS_DISTANCES: u32 = 208;
        /// Step of time, s.
        PUDDLE_RINGS_TIME: f32 = 0.003;
        /// Step of distance, m.
        PUDDLE_RINGS_DISTANCE: f32 = 0.00125;
        /// Time after an impact at which its ring has faded, s.
        PUDDLE_RINGS_LIFE: f32 = 0.64;
        /// Edge of the cells in which rings are looked for, m: no ring is wider.
        PUDDLE_RINGS_CELL: f32 = 0.25;
        /// Radius of a ring that begins, m.
        PUDDLE_RINGS_CRATER: f32 = 0.06;
        /// Speed of a ring's outermost waves, m/s.
        PUDDLE_RINGS_SPEED: f32 = 0.5;
        /// Units of slope in which rings are added.
        PUDDLE_RINGS_UNITS: f32 = 1048576.0;
        /// Footprint up to which rings are shown whole, m.
        PUDDLE_RINGS_FINE: f32 = 0.004;
        /// Footprint from which on they are not shown, m.
        PUDDLE_RINGS_COARSE: f32 = 0.014;
    }
}

/// Rings of single drops on water. Twin: `downpour_trace::scene::puddle_rings`.
pub static PUDDLE_RINGS: Module = Module {
    path: "render/puddle_rings.wgsl",
    wgsl: include_str!("../../wgsl/render/puddle_rings.wgsl"),
    uses: &[&PUDDLE_RINGS_CONSTANTS, &PUDDLE_WATER_CONSTANTS, &DATA],
};
