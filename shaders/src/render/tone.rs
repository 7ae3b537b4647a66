//! `wgsl/render/tone.wgsl`: tone curves, and the picture to look at. Twin: `downpour_render::tone`.

use super::rain::COMPOSE;
use crate::common::COLOR;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&TONE_CONSTANTS, &TONE];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&TONE_KERNEL];

shared_constants! {
    /// Numbers of the tone curves.
    TONE_CONSTANTS at "render/tone constants" {
        /// Largest channel, less the toe, that stays as it is.
        TONE_START: f32 = 0.76;
        /// Strength with which the curve of Khronos makes bright colors pale.
        TONE_DESATURATION: f32 = 0.15;
        /// Stops over the shoulder at which a color is half white.
        TONE_HALF_WHITE_STOPS: f32 = 6.0;
        /// Largest channel; radiance beyond it is white in any case.
        TONE_MAX_CHANNEL: f32 = 1.0e12;
        /// Largest channel of a bright side from which on its edges are filtered: white.
        TONE_EDGE_WHITE: f32 = 1.0;
        /// Largest channel of a bright side whose edges are filtered altogether.
        TONE_EDGE_BRIGHT: f32 = 4.0;
        /// Largest channel of a pixel that clips altogether.
        TONE_EDGE_CLIPPED: f32 = 2.0;
        /// Difference from the dark side, over that side, that is an edge altogether; a quarter of it may be texture.
        TONE_EDGE_CONTRAST: f32 = 1.0;
        /// Sum of channels that is added to the dark side where differences are divided by it.
        TONE_EDGE_FLOOR: f32 = 0.06;
        /// Coverage that is an edge altogether even if the pixel does not clip; a quarter of it may be texture.
        TONE_EDGE_COVERAGE: f32 = 0.015625;
        /// Rise of the dark side over the pixel behind it from which on it is a slope altogether; a quarter of it may be texture.
        TONE_EDGE_SLOPE: f32 = 2.0;
        /// Sum of channels that is added to the pixel behind the dark side where that rise is divided by it.
        TONE_EDGE_SLOPE_FLOOR: f32 = 0.5;
        /// The neutral curve of Khronos.
        TONE_KHRONOS: u32 = 0;
        /// The curve that keeps hues.
        TONE_KEEPS_HUE: u32 = 1;
    }
}

/// Tone curves and pixels. Twin: `downpour_render::tone`.
pub static TONE: Module = Module {
    path: "render/tone.wgsl",
    wgsl: include_str!("../../wgsl/render/tone.wgsl"),
    uses: &[&TONE_CONSTANTS, &COLOR, &COMPOSE],
};

/// A picture to look at: one invocation per pixel.
pub static TONE_KERNEL: Kernel = Kernel { entry: "main_tone", module: &TONE, workgroup: [8, 8, 1] };
