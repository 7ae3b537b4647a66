//! `wgsl/lattice/glass*`: drops on a pane. The Rust twins are in `downpour_lattice::glass`.

use crate::common::RNG;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &GLASS_CONSTANTS,
    &SIZE,
    &MOTION,
    &BLADE,
    &RIDGE,
    &FRAME,
    &TABLE,
    &CLAIM,
    &DECIDE,
    &TRANSFER,
    &SETTLE,
    &NEXT,
    &HEIGHT,
    &SMOOTH,
    &NORMAL,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[
    &CLAIM_KERNEL,
    &DECIDE_KERNEL,
    &TRANSFER_KERNEL,
    &SETTLE_KERNEL,
    &NEXT_KERNEL,
    &HEIGHT_KERNEL,
    &SMOOTH_KERNEL,
    &NORMAL_KERNEL,
];

shared_constants! {
    /// Units and flags of the lattice of drops.
    GLASS_CONSTANTS at "lattice/glass constants" {
        /// Maximum mass of a cell, in units of a nanoliter: a drop of 7.9 mm.
        GLASS_MAX_MASS: u32 = 262144;
        /// Number of classes of mass, including one above the last for interpolation.
        GLASS_CLASSES: u32 = 130;
        /// Masses of landing drops, in groups of four.
        GLASS_LANDING_QUADS: u32 = 1024;
        /// A velocity of one cell in one tick; unit vectors have this length too.
        GLASS_CELL: i32 = 16384;
        /// Distance to a diagonal cell.
        GLASS_DIAGONAL: i32 = 23170;
        /// Distance ahead of a blade to which it pushes water, in half cells.
        GLASS_BLADE_AHEAD: i32 = 4;
        /// Flag of a surface: water cannot move there.
        GLASS_OBSTACLE: u32 = 65536;
        /// Attraction by another drop: as glass of this wetness.
        GLASS_WATER_PULL: u32 = 510;
        /// Mask of the bits of a word that hold the index of a cell.
        GLASS_INDEX: u32 = 16777215;
        /// Flag of a target: a larger drop takes this one.
        GLASS_TAKEN: u32 = 1073741824;
        /// Flag of a target: the water is part of a ridge and stays, but for what flows along it.
        GLASS_STAYS: u32 = 536870912;
        /// Flag of the progress of a cell: its water is part of a ridge that a blade has pushed together.
        GLASS_RIDGE: u32 = 1073741824;
        /// Class in the keys of ridges, above all classes of mass.
        GLASS_RIDGE_CLASS: u32 = 192;
        /// Class in the keys of water that a blade pushes, above that of ridges.
        GLASS_RIDGE_PUSHED: u32 = 255;
        /// Half-width of the thinnest ridge that does not break up, in cells / 256.
        GLASS_RIDGE_MIN: u32 = 96;
        /// Fraction of its water that a ridge exchanges with the cell on each side in a tick, in units of 1/256.
        GLASS_RIDGE_LEVEL: i32 = 40;
        /// Largest fraction by which gravity changes that.
        GLASS_RIDGE_FALL: u32 = 120;
        /// Target beyond the edge of the pane.
        GLASS_OUT: u32 = 4294967295;
        /// Speed at which a running drop is stretched by 1/256 of its radius.
        GLASS_HEIGHT_STRETCH: u32 = 32;
        /// Word of the totals: the tick of the call.
        GLASS_TOTAL_TICK: u32 = 0;
        /// Words of the totals, low and high: mass that has landed.
        GLASS_TOTAL_LANDED: u32 = 2;
        /// Mass that has left over the edge.
        GLASS_TOTAL_EDGE: u32 = 4;
        /// Mass that has dried.
        GLASS_TOTAL_EVAPORATED: u32 = 6;
        /// Mass that blades have pushed off the pane.
        GLASS_TOTAL_WIPED: u32 = 8;
        /// Mass above the maximum of a cell.
        GLASS_TOTAL_SPILLED: u32 = 10;
        /// Number of times that a cell exceeded the maximum mass.
        GLASS_TOTAL_SATURATED: u32 = 12;
    }
}

/// Classes of mass. Twin: `downpour_lattice::glass::size`.
pub static SIZE: Module = Module {
    path: "lattice/glass_size.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_size.wgsl"),
    uses: &[&GLASS_CONSTANTS],
};

/// Forces, friction and choice of direction. Twin: `downpour_lattice::glass::motion`.
pub static MOTION: Module = Module {
    path: "lattice/glass_motion.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_motion.wgsl"),
    uses: &[&SIZE],
};

/// Blades of wipers. Twin: `downpour_lattice::glass::blade`.
pub static BLADE: Module = Module {
    path: "lattice/glass_blade.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_blade.wgsl"),
    uses: &[&GLASS_CONSTANTS],
};

/// Ridges of water. Twin: `downpour_lattice::glass::ridge`.
pub static RIDGE: Module = Module {
    path: "lattice/glass_ridge.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_ridge.wgsl"),
    uses: &[&GLASS_CONSTANTS],
};

/// Parameters of a call. Twin: `downpour_lattice::glass::frame`.
pub static FRAME: Module = Module {
    path: "lattice/glass_frame.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_frame.wgsl"),
    uses: &[],
};

/// Properties of drops computed by the host.
pub static TABLE: Module = Module {
    path: "lattice/glass_table.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_table.wgsl"),
    uses: &[&SIZE],
};

/// Claim of cells by drops. Twin: `downpour_lattice::glass::claim`.
pub static CLAIM: Module = Module {
    path: "lattice/glass_claim.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_claim.wgsl"),
    uses: &[&FRAME, &TABLE, &RIDGE, &MOTION],
};

/// Decision of drops. Twin: `downpour_lattice::glass::decide`.
pub static DECIDE: Module = Module {
    path: "lattice/glass_decide.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_decide.wgsl"),
    uses: &[&FRAME, &TABLE, &MOTION, &RIDGE, &RNG],
};

/// Transfer of water. Twin: `downpour_lattice::glass::transfer`.
pub static TRANSFER: Module = Module {
    path: "lattice/glass_transfer.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_transfer.wgsl"),
    uses: &[&FRAME, &TABLE, &BLADE, &MOTION, &RIDGE, &RNG],
};

/// Settling of water. Twin: `downpour_lattice::glass::settle`.
pub static SETTLE: Module = Module {
    path: "lattice/glass_settle.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_settle.wgsl"),
    uses: &[&FRAME, &MOTION, &RIDGE],
};

/// Number of the tick.
pub static NEXT: Module = Module {
    path: "lattice/glass_next.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_next.wgsl"),
    uses: &[&GLASS_CONSTANTS],
};

/// Heights. Twin: `downpour_lattice::glass::height`.
pub static HEIGHT: Module = Module {
    path: "lattice/glass_height.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_height.wgsl"),
    uses: &[&FRAME, &TABLE, &MOTION, &RIDGE],
};

/// Smoothing of heights. Twin: `downpour_lattice::glass::smooth`.
pub static SMOOTH: Module = Module {
    path: "lattice/glass_smooth.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_smooth.wgsl"),
    uses: &[&FRAME],
};

/// Normals. Twin: `downpour_lattice::glass::normal`.
pub static NORMAL: Module = Module {
    path: "lattice/glass_normal.wgsl",
    wgsl: include_str!("../../wgsl/lattice/glass_normal.wgsl"),
    uses: &[&FRAME],
};

/// One invocation per cell.
pub static CLAIM_KERNEL: Kernel =
    Kernel { entry: "main_glass_claim", module: &CLAIM, workgroup: [16, 16, 1] };
/// One invocation per cell.
pub static DECIDE_KERNEL: Kernel =
    Kernel { entry: "main_glass_decide", module: &DECIDE, workgroup: [16, 16, 1] };
/// One invocation per cell.
pub static TRANSFER_KERNEL: Kernel =
    Kernel { entry: "main_glass_transfer", module: &TRANSFER, workgroup: [16, 16, 1] };
/// One invocation per cell.
pub static SETTLE_KERNEL: Kernel =
    Kernel { entry: "main_glass_settle", module: &SETTLE, workgroup: [16, 16, 1] };
/// One invocation.
pub static NEXT_KERNEL: Kernel = Kernel { entry: "main_glass_next", module: &NEXT, workgroup: [1, 1, 1] };
/// One invocation per cell.
pub static HEIGHT_KERNEL: Kernel =
    Kernel { entry: "main_glass_height", module: &HEIGHT, workgroup: [16, 16, 1] };
/// One invocation per cell.
pub static SMOOTH_KERNEL: Kernel =
    Kernel { entry: "main_glass_smooth", module: &SMOOTH, workgroup: [16, 16, 1] };
/// One invocation per cell.
pub static NORMAL_KERNEL: Kernel =
    Kernel { entry: "main_glass_normal", module: &NORMAL, workgroup: [16, 16, 1] };
