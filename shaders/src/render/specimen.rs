//! `wgsl/render/specimen.wgsl` and its streak. Twin: `downpour_specimen`.

use crate::common::{OCTANT, RNG};
use crate::drop::{optics, oscillation, shape};
use crate::mask;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&SPECIMEN_CONSTANTS, &SPECIMEN, &SPECIMEN_STREAK_CONSTANTS, &SPECIMEN_WOBBLE, &SPECIMEN_STREAK];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&SPECIMEN_KERNEL, &SPECIMEN_STREAK_KERNEL];

shared_constants! {
    /// Constants of the specimen.
    SPECIMEN_CONSTANTS at "render/specimen constants" {
        /// Internal reflections that are followed, total ones included. What is left then leaves with the last light
        /// that left: below 1 % of all light in any view, below 0.04 % in level views up to 6 mm.
        SPECIMEN_REFLECTIONS: u32 = 256;
        /// Fraction of the light below which what is left inside is not followed any further. A sky holds a sun of 10^5
        /// times its mean: this fraction of it would still be seen above 10^-4.
        SPECIMEN_MIN_FRACTION: f32 = 0.0001;
        /// More than any fraction: all light leaves.
        SPECIMEN_ALL: f32 = 2.0;
        /// Steps to the point of a ray that is nearest to the drop.
        SPECIMEN_NEAREST_STEPS: u32 = 5;
        /// Below this, a vector has no direction.
        SPECIMEN_TINY: f32 = 1.0e-30;
        /// Largest number of samples along an edge of a pixel. One invocation makes the square of it, each with at
        /// most 175 passes of a loop (5 + 4 to the entry, 33 times 1 + 4 inside, itself): below the 65 535 at which
        /// a driver may stop.
        SPECIMEN_SAMPLES: u32 = 16;
        /// Step from line to line of the shift of samples: the golden ratio in units of 2^-32.
        SPECIMEN_LATTICE: u32 = 2654435769;
        /// Lamps before the sky, at most. The shader has a line for each.
        SPECIMEN_LAMPS: u32 = 8;
    }
}

/// One drop in front of a sky. Twin: `downpour_specimen`.
pub static SPECIMEN: Module = Module {
    path: "render/specimen.wgsl",
    wgsl: include_str!("../../wgsl/render/specimen.wgsl"),
    uses: &[&SPECIMEN_CONSTANTS, &OCTANT, &mask::MASK_CONSTANTS, &mask::TRACE, &optics::OPTICS, &RNG],
};

/// One invocation per pixel of a band of rows.
pub static SPECIMEN_KERNEL: Kernel =
    Kernel { entry: "main_specimen", module: &SPECIMEN, workgroup: [8, 8, 1] };

shared_constants! {
    /// Constants of a drop that falls and oscillates.
    SPECIMEN_STREAK_CONSTANTS at "render/specimen_streak constants" {
        /// Parts in which a line is walked through the drop: a fifth of its width or less.
        SPECIMEN_WOBBLE_PARTS: u32 = 5;
        /// One part.
        SPECIMEN_WOBBLE_PART: f32 = 0.2;
        /// Steps to an extremum of the gauge between two positions where it turns.
        SPECIMEN_WOBBLE_TURNS: u32 = 4;
        /// Steps from a bracket to the surface, one more without a look.
        SPECIMEN_WOBBLE_STEPS: u32 = 4;
        /// Least curvature of the parabola of a step: below, it is a step on the tangent.
        SPECIMEN_WOBBLE_FLAT: f32 = 0.001;
        /// Largest distance by which a step may leave its bracket and is put back to its end; beyond, it is put
        /// in the middle.
        SPECIMEN_WOBBLE_SLACK: f32 = 0.0001;
        /// Internal reflections that are followed in a streak.
        SPECIMEN_STREAK_REFLECTIONS: u32 = 128;
        /// Instants per sample of the picture, at most.
        SPECIMEN_STREAK_INSTANTS: u32 = 4096;
        /// Traces of one invocation. Each passes a loop at most 2861 times: 1 + 130 crossings of 5 parts, 4 turns in
        /// every second of them, 4 steps and itself; a driver may stop at 65 535.
        SPECIMEN_STREAK_TRACES: u32 = 16;
        /// The dimension of the random numbers of a streak.
        SPECIMEN_STREAK_DIMENSION: u32 = 4207;
    }
}

/// A ray through a drop that oscillates. Twin: `downpour_specimen::wobble`.
pub static SPECIMEN_WOBBLE: Module = Module {
    path: "render/specimen_wobble.wgsl",
    wgsl: include_str!("../../wgsl/render/specimen_wobble.wgsl"),
    uses: &[
        &SPECIMEN_STREAK_CONSTANTS,
        &SPECIMEN,
        &mask::MASK_CONSTANTS,
        &mask::TRACE,
        &mask::WOBBLE,
        &optics::OPTICS,
        &shape::SHAPE,
    ],
};

/// The mean of a drop over an exposure. Twin: `downpour_specimen::streak`.
pub static SPECIMEN_STREAK: Module = Module {
    path: "render/specimen_streak.wgsl",
    wgsl: include_str!("../../wgsl/render/specimen_streak.wgsl"),
    uses: &[&SPECIMEN_STREAK_CONSTANTS, &SPECIMEN, &SPECIMEN_WOBBLE, &oscillation::OSCILLATION, &RNG],
};

/// One invocation per pixel of a band of rows, for some of its traces.
pub static SPECIMEN_STREAK_KERNEL: Kernel =
    Kernel { entry: "main_specimen_streak", module: &SPECIMEN_STREAK, workgroup: [8, 8, 1] };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_invocation_comes_to_the_limit_of_loops() {
        let crossing = SPECIMEN_WOBBLE_PARTS
            + SPECIMEN_WOBBLE_PARTS.div_ceil(2) * SPECIMEN_WOBBLE_TURNS
            + SPECIMEN_WOBBLE_STEPS
            + 1;
        let trace = (SPECIMEN_STREAK_REFLECTIONS + 2) * crossing + 1;
        assert!(SPECIMEN_STREAK_TRACES * trace + 3 < 65_535, "{trace}");
        assert_eq!(SPECIMEN_WOBBLE_PART * SPECIMEN_WOBBLE_PARTS as f32, 1.0);
    }
}
