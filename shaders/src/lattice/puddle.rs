//! Ripples of puddles.

use crate::common::OPS;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&PUDDLE_CONSTANTS, &PUDDLE, &PUDDLE_STATE, &PUDDLE_STEP, &PUDDLE_SEED, &PUDDLE_NORMAL];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&STEP_KERNEL, &DIRECT_KERNEL, &SEED_KERNEL, &NORMAL_KERNEL, &SLOPES_KERNEL];

shared_constants! {
    /// Links between cells, limits and shapes.
    PUDDLE_CONSTANTS at "lattice/puddle constants" {
        /// The neighbor toward lower x is linked.
        PUDDLE_LINK_WEST: u32 = 1;
        /// The neighbor toward higher x.
        PUDDLE_LINK_EAST: u32 = 2;
        /// The neighbor toward lower y.
        PUDDLE_LINK_NORTH: u32 = 4;
        /// The neighbor toward higher y.
        PUDDLE_LINK_SOUTH: u32 = 8;
        /// The neighbor toward lower x and y.
        PUDDLE_LINK_NORTH_WEST: u32 = 16;
        /// The neighbor toward higher x and lower y.
        PUDDLE_LINK_NORTH_EAST: u32 = 32;
        /// The neighbor toward lower x and higher y.
        PUDDLE_LINK_SOUTH_WEST: u32 = 64;
        /// The neighbor toward higher x and y.
        PUDDLE_LINK_SOUTH_EAST: u32 = 128;
        /// Smaller numbers, in m or m/s, become 0: denormal numbers are slow on some machines.
        PUDDLE_MIN: f32 = 1.0e-20;
        /// Scale of numbers in 16 bits: a power of two.
        PUDDLE_HALF_SCALE: f32 = 1024.0;
        /// Cells along an edge of a workgroup's tile.
        PUDDLE_STEP_TILE: u32 = 64;
        /// Cells along an edge of the squares by which seeds are sorted.
        PUDDLE_SEED_SQUARE: u32 = 64;
        /// A seed that is a crater.
        PUDDLE_SEED_CRATER: u32 = 0;
        /// A seed that is a bump.
        PUDDLE_SEED_BUMP: u32 = 1;
        /// 2 / sqrt(3).
        PUDDLE_SEED_HEIGHT: f32 = 1.1547005;
        /// sqrt(3).
        PUDDLE_SEED_TURN: f32 = 1.7320508;
        /// pi / (3 sqrt(3)).
        PUDDLE_SEED_SHIFT: f32 = 0.6045998;
    }
}

/// A cell and its neighbors. Twin: `downpour_lattice::puddle::lattice`.
pub static PUDDLE: Module = Module {
    path: "lattice/puddle.wgsl",
    wgsl: include_str!("../../wgsl/lattice/puddle.wgsl"),
    uses: &[&PUDDLE_CONSTANTS, &OPS],
};

/// The state in memory. Twin: `downpour_lattice::puddle::lattice`.
pub static PUDDLE_STATE: Module = Module {
    path: "lattice/puddle_state.wgsl",
    wgsl: include_str!("../../wgsl/lattice/puddle_state.wgsl"),
    uses: &[&PUDDLE],
};

/// Several time steps of a tile. Twin: `downpour_lattice::puddle::sweep`.
pub static PUDDLE_STEP: Module = Module {
    path: "lattice/puddle_step.wgsl",
    wgsl: include_str!("../../wgsl/lattice/puddle_step.wgsl"),
    uses: &[&PUDDLE_STATE],
};

/// Craters of impacts and footprints of moving objects. Twin: `downpour_lattice::puddle::seed`.
pub static PUDDLE_SEED: Module = Module {
    path: "lattice/puddle_seed.wgsl",
    wgsl: include_str!("../../wgsl/lattice/puddle_seed.wgsl"),
    uses: &[&PUDDLE_STATE],
};

/// Normals by Sobel sums. Twin: `downpour_lattice::puddle::normal`.
pub static PUDDLE_NORMAL: Module = Module {
    path: "lattice/puddle_normal.wgsl",
    wgsl: include_str!("../../wgsl/lattice/puddle_normal.wgsl"),
    uses: &[&PUDDLE_STATE],
};

/// One workgroup per tile; an invocation has four quads above each other.
pub static STEP_KERNEL: Kernel =
    Kernel { entry: "main_puddle_step", module: &PUDDLE_STEP, workgroup: [16, 16, 1] };

/// One step of degree 1; one invocation per quad.
pub static DIRECT_KERNEL: Kernel =
    Kernel { entry: "main_lattice_puddle_step_direct", module: &PUDDLE_STEP, workgroup: [32, 8, 1] };

/// One invocation per quad.
pub static SEED_KERNEL: Kernel =
    Kernel { entry: "main_puddle_seed", module: &PUDDLE_SEED, workgroup: [16, 16, 1] };

/// One invocation per quad.
pub static NORMAL_KERNEL: Kernel =
    Kernel { entry: "main_puddle_normal", module: &PUDDLE_NORMAL, workgroup: [16, 16, 1] };

/// One invocation per quad.
pub static SLOPES_KERNEL: Kernel =
    Kernel { entry: "main_puddle_normal_slopes", module: &PUDDLE_NORMAL, workgroup: [16, 16, 1] };
