//! `wgsl/render/medium*.wgsl`: drops that a picture does not draw one by one. Twins: `downpour_render::rain::medium`.

use super::drop_light::DROP_GLINT;
use super::path::PATH_LATTICE;
use super::scene::{DATA, SCENE, SCENE_CONSTANTS, SPACING};
use super::table::LIGHT;
use crate::common::RNG;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &MEDIUM_CONSTANTS,
    &MEDIUM,
    &MEDIUM_STREAKS,
    &MEDIUM_OPEN,
    &MEDIUM_SPREAD,
    &MEDIUM_PHASE,
    &MEDIUM_LIGHT,
    &MEDIUM_FILTER,
    &MEDIUM_SMOOTH,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &MEDIUM_OPEN_KERNEL,
    &MEDIUM_LIGHT_KERNEL,
    &MEDIUM_FILTER_KERNEL,
    &MEDIUM_SMOOTH_PARTS_KERNEL,
    &MEDIUM_SMOOTH_KERNEL,
];

shared_constants! {
    /// Numbers of the unresolved rain.
    MEDIUM_CONSTANTS at "render/medium constants" {
        /// Quarters of the table of optical depths.
        MEDIUM_QUARTERS: u32 = 8;
        /// Distance of the table's first entry, m.
        MEDIUM_NEAR: f32 = 0.25;
        /// Farther than anything, m.
        MEDIUM_FAR: f32 = 1.0e9;
        /// Region: drops are simulated everywhere.
        MEDIUM_EVERYWHERE: u32 = 0;
        /// Region: a box along the axes.
        MEDIUM_BOX: u32 = 1;
        /// Region: a sphere.
        MEDIUM_SPHERE: u32 = 2;
        /// Region: an upright cylinder.
        MEDIUM_CYLINDER: u32 = 3;
        /// No lamp lights the drops.
        MEDIUM_DARK: u32 = 0;
        /// All lamps and the sun do.
        MEDIUM_LAMPS: u32 = 1;
        /// Spots alone do.
        MEDIUM_SPOTS: u32 = 2;
        /// Slices of distance of the grid of open air: two entries of the table each.
        MEDIUM_SLICES: u32 = 16;
        /// Cells of that grid in a workgroup, with a row of `MEDIUM_SLICES` invocations each.
        MEDIUM_CELLS: u32 = 4;
        /// Columns of that grid.
        MEDIUM_COLUMNS: u32 = 48;
        /// The sky is as it is seen through the rain beyond this distance, m.
        MEDIUM_SKY_REACH: f32 = 50.0;
        /// Beyond this distance, m, is the sky.
        MEDIUM_SKY: f32 = 1.0e29;
        /// Sunlight in fog is followed up to this distance, m.
        MEDIUM_FOG_REACH: f32 = 1e5;
        /// Lamps light drops up to this distance, m.
        MEDIUM_LAMP_REACH: f32 = 1000.0;
        /// Intervals of the scattering angle.
        MEDIUM_ANGLES: u32 = 256;
        /// Parts of a ray for each lamp, at most: a slice each, cut where the direction to the lamp turns by more than
        /// `MEDIUM_TURN`.
        MEDIUM_PARTS: u32 = 32;
        /// Angle, radians: 13 parts of half a turn.
        MEDIUM_TURN: f32 = 0.25;
        /// Number of the lattice of a pixel's ray to a lamp.
        MEDIUM_LATTICE: u32 = 4096;
        /// Least weight of the pixels around a pixel that look for light for it, of 1.
        MEDIUM_SPREAD_MIN: f32 = 0.5;
        /// Distance from a lamp, in cells of such pixels, from which they do so.
        MEDIUM_SPREAD_CELLS: f32 = 2.5;
        /// Dimension of the random numbers of the grid.
        MEDIUM_RANDOM_DIMENSION: u32 = 4110;
        /// Dimension of the random numbers of streaks, of the first shell.
        MEDIUM_STREAKS_DIMENSION: u32 = 4140;
        /// Number of drops from which it is not Poisson's law that is drawn from.
        MEDIUM_STREAKS_MANY: f32 = 12.0;
        /// The most drops of a shell over a pixel, below that number.
        MEDIUM_STREAKS_MAX: u32 = 48;
        /// Least chance of a number of drops.
        MEDIUM_STREAKS_CHANCE: f32 = 1e-8;
        /// Least part of a shell before the scene.
        MEDIUM_STREAKS_PART: f32 = 0.05;
        /// Sine of the angle to the axis of motion below which there are no streaks.
        MEDIUM_STREAKS_SINE: f32 = 0.1;
    }
}

/// Optical depth along a ray. Twin: `downpour_render::rain::medium`.
pub static MEDIUM: Module = Module {
    path: "render/medium.wgsl",
    wgsl: include_str!("../../wgsl/render/medium.wgsl"),
    uses: &[&MEDIUM_CONSTANTS],
};

/// Streaks of the drops. Twin: `downpour_render::rain::medium::streaks`.
pub static MEDIUM_STREAKS: Module = Module {
    path: "render/medium_streaks.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_streaks.wgsl"),
    uses: &[&MEDIUM_CONSTANTS, &MEDIUM, &RNG],
};

/// Regions of the air that are open to the rain. Twin: `downpour_render::rain::medium::open`.
pub static MEDIUM_OPEN: Module = Module {
    path: "render/medium_open.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_open.wgsl"),
    uses: &[&MEDIUM_CONSTANTS, &MEDIUM, &RNG, &SCENE],
};

/// Light before pixels that do not look for it. Twin: `downpour_render::rain::medium::spread`.
pub static MEDIUM_SPREAD: Module = Module {
    path: "render/medium_spread.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_spread.wgsl"),
    uses: &[&MEDIUM_CONSTANTS, &SCENE_CONSTANTS, &MEDIUM, &LIGHT, &DATA],
};

/// Phase functions of drops and fog. Twin: `downpour_render::rain::medium::phase`.
pub static MEDIUM_PHASE: Module = Module {
    path: "render/medium_phase.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_phase.wgsl"),
    uses: &[&MEDIUM_CONSTANTS],
};

/// Light of lamps. Twin: `downpour_render::rain::medium::light`.
pub static MEDIUM_LIGHT: Module = Module {
    path: "render/medium_light.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_light.wgsl"),
    uses: &[
        &MEDIUM_CONSTANTS,
        &MEDIUM,
        &MEDIUM_OPEN,
        &MEDIUM_SPREAD,
        &MEDIUM_PHASE,
        &DROP_GLINT,
        &PATH_LATTICE,
        &LIGHT,
        &SCENE,
        &SPACING,
    ],
};

/// Means over neighbors. Twin: `downpour_render::rain::medium::filter`.
pub static MEDIUM_FILTER: Module = Module {
    path: "render/medium_filter.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_filter.wgsl"),
    uses: &[&MEDIUM_CONSTANTS, &MEDIUM, &MEDIUM_SPREAD, &LIGHT, &SCENE_CONSTANTS, &SPACING],
};

/// Means of means, in fog. Twin: `downpour_render::rain::medium::smooth`.
pub static MEDIUM_SMOOTH: Module = Module {
    path: "render/medium_smooth.wgsl",
    wgsl: include_str!("../../wgsl/render/medium_smooth.wgsl"),
    uses: &[&MEDIUM_FILTER, &MEDIUM_SPREAD, &LIGHT, &SCENE_CONSTANTS, &DATA],
};

/// One invocation per cell and slice of the grid.
pub static MEDIUM_OPEN_KERNEL: Kernel =
    Kernel { entry: "main_medium_open", module: &MEDIUM_OPEN, workgroup: [MEDIUM_SLICES, MEDIUM_CELLS, 1] };

/// One invocation per pixel.
pub static MEDIUM_LIGHT_KERNEL: Kernel =
    Kernel { entry: "main_medium_light", module: &MEDIUM_LIGHT, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static MEDIUM_FILTER_KERNEL: Kernel =
    Kernel { entry: "main_medium_filter", module: &MEDIUM_FILTER, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static MEDIUM_SMOOTH_PARTS_KERNEL: Kernel =
    Kernel { entry: "main_medium_smooth_parts", module: &MEDIUM_SMOOTH, workgroup: [8, 8, 1] };

/// One invocation per pixel.
pub static MEDIUM_SMOOTH_KERNEL: Kernel =
    Kernel { entry: "main_medium_smooth", module: &MEDIUM_SMOOTH, workgroup: [8, 8, 1] };
