//! Motion of drops, and the volume that they move in.

use super::collision::COLLISION;
use super::splash::SPLASH_CONSTANTS;
use crate::common::{PACKING, RNG};
use crate::drop::fall_speed::FALL_SPEED;
use crate::wind::FIELD;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&MOTION_CONSTANTS, &MOTION, &VOLUME_CONSTANTS, &VOLUME, &STEP_CONSTANTS, &STEP];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&STEP_KERNEL];

shared_constants! {
    /// Constants of a drop's motion.
    MOTION_CONSTANTS at "sim/motion_constants" {
        /// Diameter per step of its 16 bits, m: 65 535 of them are 9.2 mm.
        MOTION_DIAMETER_STEP: f32 = 1.4e-7;
        /// Entries of the table of terminal speeds per meter of diameter.
        MOTION_TABLE_PER_METER: f32 = 110000.0;
        /// Last entry of that table: that of 9.3 mm.
        MOTION_TABLE_LAST: u32 = 1023;
        /// Minimum relaxation time, s, used for a drop without speed.
        MOTION_MIN_RELAXATION: f32 = 1.0e-6;
    }
}

shared_constants! {
    /// Constants of the volume.
    VOLUME_CONSTANTS at "sim/volume_constants" {
        /// 2 pi.
        VOLUME_TURN: f32 = 6.2831855;
        /// Number of planes of a frustum: right, left, top, bottom, back.
        VOLUME_PLANES: u32 = 5;
        /// Index of the ball as a limit.
        VOLUME_BALL: u32 = 5;
        /// Index for a position within all limits.
        VOLUME_INSIDE: u32 = 6;
        /// Radius of a drop relative to its diameter, including its oscillation.
        VOLUME_RADIUS: f32 = 0.6;
    }
}

shared_constants! {
    /// Constants of the step.
    STEP_CONSTANTS at "sim/step_constants" {
        /// Mask of the bits of a drop's word that hold its diameter.
        STEP_DIAMETER: u32 = 0xffff;
        /// Shift of the kind in the word: two bits.
        STEP_KIND: u32 = 16;
        /// Shift of the count in the word.
        STEP_COUNT_SHIFT: u32 = 18;
        /// Maximum count.
        STEP_COUNT: u32 = 0x3fff;
        /// Bits of the count of a drop of a box that number the image of the box along the vertical.
        STEP_IMAGE_Y: u32 = 0xff;
        /// Shift of the image along x in the count; three bits each for x and z.
        STEP_IMAGE_X: u32 = 8;
        /// Shift of the image along z in the count.
        STEP_IMAGE_Z: u32 = 11;
        /// Kind: falls from the sky.
        STEP_FALLING: u32 = 0;
        /// Kind: bounced from a surface.
        STEP_BOUNCED: u32 = 1;
        /// Kind: hidden, below an obstacle.
        STEP_HIDDEN: u32 = 2;
        /// Kind: the slot holds no drop.
        STEP_GONE: u32 = 3;
        /// A periodic box around the eye.
        STEP_VOLUME_BOX: u32 = 0;
        /// The frustum of the picture up to the distance at which a drop is resolved.
        STEP_VOLUME_VIEW: u32 = 1;
        /// The rain area of Im & Sung 2022 with their sampling.
        STEP_VOLUME_AREA: u32 = 2;
        /// A box with new drops at its top, after Tariq.
        STEP_VOLUME_TARIQ: u32 = 3;
        /// A cylinder fixed in the world, after Creus and Patow.
        STEP_VOLUME_CYLINDER: u32 = 4;
        /// Number of tries for a random position.
        STEP_TRIES: u32 = 8;
        /// Dimension of the random numbers of bounces.
        STEP_CHANCE: u32 = 8210;
        /// Dimension of the random numbers of positions at the top.
        STEP_TOP: u32 = 8211;
        /// Dimension of the random numbers of columns of a box.
        STEP_COLUMN: u32 = 8212;
        /// Dimensions of the random numbers of positions in the rain area, one per try.
        STEP_AREA: u32 = 8220;
        /// Number of entries of the table of lags, one per m/s of the terminal speed.
        STEP_LAGS: u32 = 13;
        /// The velocity of drops in a changing wind is approximated by the wind at these multiples of their relaxation
        /// time ago, with these weights: Gauss-Laguerre quadrature of an exponential. This is the first.
        STEP_AGO_1: f32 = 0.58578644;
        /// Weight of the first.
        STEP_WEIGHT_1: f32 = 0.8535534;
        /// The second.
        STEP_AGO_2: f32 = 3.4142136;
        /// Weight of the second.
        STEP_WEIGHT_2: f32 = 0.14644661;
        /// Distance from the surface at which a bounced drop starts, m.
        STEP_CLEAR: f32 = 1.0e-3;
        /// Shift of the kind of impact in an event's word.
        STEP_EVENT_KIND: u32 = 30;
        /// Mask of the bits of that word that number the drop.
        STEP_EVENT_DROP: u32 = 0x3fffffff;
        /// Number of counters of events.
        STEP_COUNTS: u32 = 5;
        /// Spans of time whose impacts are kept, each with a counter.
        STEP_SPANS: u32 = 8;
        /// Number of all counters.
        STEP_COUNTERS: u32 = 13;
        /// pi / 6 in units of the gauge, 1e-13 m^3.
        STEP_GAUGE_PER_CUBE: f32 = 5.2359878e12;
    }
}

/// Motion of a drop in the wind. Twin: `downpour_sim::motion`.
pub static MOTION: Module = Module {
    path: "sim/motion.wgsl",
    wgsl: include_str!("../../wgsl/sim/motion.wgsl"),
    uses: &[&MOTION_CONSTANTS, &FALL_SPEED],
};

/// Volume of the drops. Twin: `downpour_sim::volume`.
pub static VOLUME: Module = Module {
    path: "sim/volume.wgsl",
    wgsl: include_str!("../../wgsl/sim/volume.wgsl"),
    uses: &[&VOLUME_CONSTANTS],
};

/// Step of a drop. Twin: `downpour_sim::step`.
pub static STEP: Module = Module {
    path: "sim/step.wgsl",
    wgsl: include_str!("../../wgsl/sim/step.wgsl"),
    uses: &[&STEP_CONSTANTS, &SPLASH_CONSTANTS, &MOTION, &VOLUME, &COLLISION, &FIELD, &PACKING, &RNG],
};

/// One invocation per drop.
pub static STEP_KERNEL: Kernel = Kernel { entry: "main_step", module: &STEP, workgroup: [256, 1, 1] };
