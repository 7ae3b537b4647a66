//! `wgsl/render/{reduce,drops*,streak*}.wgsl`: drops before a scene. Twins: `downpour_render::rain`.

use super::drop_light::DROP_GLINT;
use super::medium::MEDIUM;
use crate::common::PACKING;
use crate::drop::oscillation::OSCILLATION;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[
    &RAIN_CONSTANTS,
    &REDUCE,
    &DROPS_FRAME,
    &DROPS_CAPTURE,
    &DROPS_MASK,
    &DROPS_SHADE,
    &STREAK,
    &STREAK_LOOKUP,
    &STREAK_TABLE,
    &DROPS_ATLAS,
    &DROPS,
];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&REDUCE_KERNEL, &STREAK_TABLE_KERNEL, &DROPS_KERNEL];

shared_constants! {
    /// Numbers of the masks in a buffer.
    RAIN_CONSTANTS at "render/rain constants" {
        /// Words of a texel of a mask: two directions, and two shares.
        DROPS_TEXEL_WORDS: u32 = 3;
        /// Masks of a diameter, from below (-90 degrees) to above (90 degrees).
        DROPS_ELEVATIONS: u32 = 7;
        /// Edge of a tile of the picture, pixels.
        DROPS_TILE: u32 = 8;
        /// Samples along an edge of the mask of a drop below a pixel.
        DROPS_SMALL_GRID: u32 = 3;
        /// Form of refraction: the direction of the refracted light is looked up.
        DROPS_DIRECTION: u32 = 0;
        /// Form of refraction: the place in the captured picture is shifted (Rousseau 2006).
        DROPS_SHIFT: u32 = 1;
        /// Below this transmittance the rest of the drops is not seen.
        DROPS_OPAQUE: f32 = 1.0e-3;
        /// Twice the inverse of water's refractive index: the middle of a sphere bends by 2 - 2 / n per radius.
        DROPS_STRAIGHT: f32 = 1.5;
        /// A drop that does not move on the picture.
        DROPS_STILL: u32 = 0;
        /// A streak whose light is looked up.
        DROPS_TABLE: u32 = 1;
        /// A streak whose light is averaged by a loop.
        DROPS_LOOP: u32 = 2;
        /// Streaks show what drops refract and reflect.
        STREAK_REFRACTED: u32 = 0;
        /// Streaks have one colour, the mean of the surroundings.
        STREAK_WHITE: u32 = 1;
        /// Rays of the streak radiance table along an edge of the picture.
        STREAK_RAYS: u32 = 25;
        /// Places across the motion.
        STREAK_ACROSS: u32 = 96;
        /// Places across a drop as far apart as what they show is smoothed: for points and chords alike.
        STREAK_FINE: u32 = 36;
        /// Running sums along a chord.
        STREAK_SUMS: u32 = 4;
        /// Samples along a chord of the table: closer than what they show is smoothed; a multiple of the sums.
        STREAK_TAPS: u32 = 48;
        /// Samples along an edge of the square round a drop, for its mean; a multiple of the sums.
        STREAK_MEAN_GRID: u32 = 12;
        /// The mean of a class of drops is wanted.
        STREAK_MEAN: u32 = 1;
        /// Its chords are wanted, too.
        STREAK_CHORDS: u32 = 2;
        /// The brightest entry: halves end at 65 504.
        STREAK_BRIGHTEST: f32 = 65000.0;
        /// Step of the lattice of a pixel's samples.
        STREAK_LATTICE: u32 = 3;
        /// The least width of a glint, in radii.
        DROPS_GLINT: f32 = 0.03;
        /// Half the square root of 2 pi: a normal distribution along a line, of unit mean over a disc.
        DROPS_LINE: f32 = 1.2533141;
        /// Place of Gauss's two points: 1 / sqrt(3).
        STREAK_GAUSS: f32 = 0.57735026;
        /// Words before the texels of an atlas.
        DROPS_ATLAS_HEAD: u32 = 4;
        /// Samples of a streak's length in a pixel, where it has no width.
        DROPS_ATLAS_TAPS: u32 = 4;
        /// 2 / pi: radians to quarters of a turn.
        STREAK_PER_QUARTER: f32 = 0.63661975;
    }
}

/// Coarser levels of a square map. Twin: `downpour_render::rain::reduce`.
pub static REDUCE: Module =
    Module { path: "render/reduce.wgsl", wgsl: include_str!("../../wgsl/render/reduce.wgsl"), uses: &[] };

/// The picture as the drops' kernels know it. Twin: `downpour_render::rain::drops_frame`.
pub static DROPS_FRAME: Module = Module {
    path: "render/drops_frame.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_frame.wgsl"),
    uses: &[&RAIN_CONSTANTS],
};

/// The capture between its texels. Twin: `downpour_render::rain::drops_capture`.
pub static DROPS_CAPTURE: Module = Module {
    path: "render/drops_capture.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_capture.wgsl"),
    uses: &[&RAIN_CONSTANTS, &DROPS_FRAME],
};

/// The masks between their texels. Twin: `downpour_render::rain::drops_mask`.
pub static DROPS_MASK: Module = Module {
    path: "render/drops_mask.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_mask.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING, &DROPS_FRAME],
};

/// What a ray sees through a drop. Twin: `downpour_render::rain::drops_shade`.
pub static DROPS_SHADE: Module = Module {
    path: "render/drops_shade.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_shade.wgsl"),
    uses: &[&RAIN_CONSTANTS, &PACKING, &DROPS_FRAME, &DROPS_CAPTURE, &DROPS_MASK],
};

/// Where a ray passes a drop that moves. Twin: `downpour_render::rain::streak`.
pub static STREAK: Module = Module {
    path: "render/streak.wgsl",
    wgsl: include_str!("../../wgsl/render/streak.wgsl"),
    uses: &[&RAIN_CONSTANTS, &OSCILLATION],
};

/// The streak radiance table. Twin: `downpour_render::rain::streak_lookup`.
pub static STREAK_LOOKUP: Module = Module {
    path: "render/streak_lookup.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_lookup.wgsl"),
    uses: &[&RAIN_CONSTANTS],
};

/// How it is made. Twin: `downpour_render::rain::streak_table`.
pub static STREAK_TABLE: Module = Module {
    path: "render/streak_table.wgsl",
    wgsl: include_str!("../../wgsl/render/streak_table.wgsl"),
    uses: &[&RAIN_CONSTANTS, &DROPS_FRAME, &DROPS_MASK, &DROPS_SHADE],
};

/// The streaks of an atlas between their texels. Twin: `downpour_render::rain::drops_atlas`.
pub static DROPS_ATLAS: Module = Module {
    path: "render/drops_atlas.wgsl",
    wgsl: include_str!("../../wgsl/render/drops_atlas.wgsl"),
    uses: &[&RAIN_CONSTANTS, &DROPS_FRAME, &DROPS_MASK],
};

/// Drops through their masks. Twin: `downpour_render::rain::drops`.
pub static DROPS: Module = Module {
    path: "render/drops.wgsl",
    wgsl: include_str!("../../wgsl/render/drops.wgsl"),
    uses: &[
        &RAIN_CONSTANTS,
        &PACKING,
        &DROPS_FRAME,
        &DROPS_CAPTURE,
        &DROPS_MASK,
        &DROPS_SHADE,
        &STREAK,
        &STREAK_LOOKUP,
        &DROPS_ATLAS,
        &DROP_GLINT,
        &MEDIUM,
    ],
};

/// One invocation per texel of the level that is made.
pub static REDUCE_KERNEL: Kernel = Kernel { entry: "main_reduce", module: &REDUCE, workgroup: [8, 8, 1] };

/// One invocation per ray, place across the motion, and shape.
pub static STREAK_TABLE_KERNEL: Kernel =
    Kernel { entry: "main_streak_table", module: &STREAK_TABLE, workgroup: [64, 1, 1] };

/// One invocation per pixel.
pub static DROPS_KERNEL: Kernel = Kernel { entry: "main_drops", module: &DROPS, workgroup: [8, 8, 1] };
