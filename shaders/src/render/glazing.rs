//! `wgsl/render/glazing.wgsl`: rain on panes of the scene. Twin: `downpour_trace::glazing`.

use super::path::PATH_CONSTANTS;
use super::puddle_water::PUDDLE_WATER;
use super::scatter::SCATTER;
use super::scene::{DATA, SURFACE};
use super::wet::WET;
use crate::Module;
use crate::common::RNG;
use crate::drop::optics::OPTICS;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&GLAZING_CONSTANTS, &GLAZING];

shared_constants! {
    /// Numbers of the water on panes.
    GLAZING_CONSTANTS at "render/glazing constants" {
        /// Rows of a pane in the table.
        GLAZING_ROWS: u32 = 4;
        /// Width of a lane, down which water runs, m.
        GLAZING_LANE: f32 = 0.03;
        /// Way of a track to each side of the middle of its lane, over the lane's width.
        GLAZING_SWAY: f32 = 0.4;
        /// Way down a pane in which a track turns, m.
        GLAZING_TURN: f32 = 0.05;
        /// Volume of a run when it leaves the pane, m^3.
        GLAZING_RUN_M3: f32 = 6.0e-8;
        /// Speed of a run, m/s.
        GLAZING_SPEED: f32 = 0.25;
        /// Runs down a track before the next track.
        GLAZING_RUNS: u32 = 12;
        /// Tracks that are told from glass that has not been swept since long.
        GLAZING_TRACKS: u32 = 4;
        /// Half width of what a run sweeps, over the largest radius of a drop that stays.
        GLAZING_SWEEP: f32 = 1.2;
        /// Part of the time between two runs by which one is late, at most.
        GLAZING_LATE: f32 = 0.8;
        /// Height below the upper edge at which the lowest tracks begin, over the pane's.
        GLAZING_START: f32 = 0.9;
        /// Edge of the smallest cells of drops, m.
        GLAZING_FINE: f32 = 0.0022;
        /// Ratio of the cells of neighboring sizes.
        GLAZING_COARSER: f32 = 2.2;
        /// Sizes of cells.
        GLAZING_LEVELS: u32 = 3;
        /// Fraction of the cells that have a drop.
        GLAZING_PRESENT: f32 = 0.7;
        /// Largest radius of the drop of a cell, over the cell's edge.
        GLAZING_MAX_RADIUS: f32 = 0.37;
        /// Length of the largest drops that stay over their width.
        GLAZING_MAX_STRETCH: f32 = 1.3;
        /// Part of the rain on a cell that its drop takes up.
        GLAZING_SHARE: f32 = 0.4;
        /// Sine of the angle at which water meets glass: 45 degrees.
        GLAZING_SINE: f32 = 0.70710677;
        /// Its cosine.
        GLAZING_COSINE: f32 = 0.70710677;
        /// Volume of a cap of that angle over the cube of the radius of its edge.
        GLAZING_VOLUME: f32 = 0.6878;
        /// Least radius of a drop, m.
        GLAZING_MIN_RADIUS: f32 = 0.0001;
        /// Radius of the largest heads of runs, over the largest radius of a drop that stays.
        GLAZING_HEAD: f32 = 1.15;
        /// Part by which the smallest heads are smaller.
        GLAZING_SMALLER: f32 = 0.5;
        /// Length of what follows the head over its width.
        GLAZING_TAIL: f32 = 2.4;
        /// Flux of rain, over that of level ground, below which a pane is dry.
        GLAZING_MIN_FLUX: f32 = 0.001;
        /// Rate at which a drop fades with the width of a pixel over its radius: from 2 on, and all at 6.
        GLAZING_FADE: f32 = 0.25;
        /// First dimension of the random numbers of panes.
        GLAZING_DIMENSION: u32 = 4320;
    }
}

/// Rain on panes of the scene. Twin: `downpour_trace::glazing`.
pub static GLAZING: Module = Module {
    path: "render/glazing.wgsl",
    wgsl: include_str!("../../wgsl/render/glazing.wgsl"),
    uses: &[
        &GLAZING_CONSTANTS,
        &DATA,
        &RNG,
        &SURFACE,
        &PUDDLE_WATER,
        &OPTICS,
        &WET,
        &SCATTER,
        &PATH_CONSTANTS,
    ],
};
