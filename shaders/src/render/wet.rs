//! `wgsl/render/wet.wgsl`: surfaces that rain has made wet. Twin: `downpour_trace::wet`.

use super::puddle_water::PUDDLE_WATER;
use super::scene::{DATA, SURFACE};
use crate::Module;
use crate::common::RNG;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&WET_CONSTANTS, &WET];

shared_constants! {
    /// Numbers of wet surfaces.
    WET_CONSTANTS at "render/wet constants" {
        /// Rows of the table before those of the coat's reflectance.
        WET_HEAD_ROWS: u32 = 3;
        /// Steps of the roughness in the table of the coat's reflectance.
        WET_COAT_STEPS: u32 = 16;
        /// Cosines per roughness, two in a row: the squares of even steps.
        WET_COAT_COSINES: u32 = 32;
        /// Rows per roughness: cosines, then the mean.
        WET_COAT_ROWS: u32 = 17;
        /// Storage of a smooth surface, as a fraction of a porous one's.
        WET_SMOOTH_STORAGE: f32 = 0.25;
        /// Wetness up to which the pores of a porous surface fill; beyond it there is a film.
        WET_PORES: f32 = 0.4;
        /// Fraction of a porous surface that stands out of a full film: the tops of its grains.
        WET_GRAINS: f32 = 0.15;
        /// Fraction of the film that its unevenness adds or takes away, per height of the relief.
        WET_PATCH: f32 = 0.4;
        /// Alpha of a film on a smooth surface.
        WET_SMOOTH_ALPHA: f32 = 0.03;
        /// Alpha of a film on a porous surface, without the relief.
        WET_POROUS_ALPHA: f32 = 0.05;
        /// Octaves of the relief of a film.
        WET_OCTAVES: u32 = 3;
        /// Edge of a cell of its finest octave, m.
        WET_FINE: f32 = 0.003;
        /// Ratio of the cells of neighboring octaves.
        WET_COARSER: f32 = 3.2;
        /// Height of an octave over the edge of its cell.
        WET_STEEP: f32 = 0.04;
        /// Mean square of the slope of an octave of height 1: of two components of the noise's gradient.
        WET_SQUARE: f32 = 0.883;
        /// Edge of a cell of the unevenness of the edge of what is wet, m.
        WET_EDGE: f32 = 0.02;
        /// Tangent of the largest angle of the rain's directions from the mean one. At 3 m under a roof the edge is 0.1 m wide.
        WET_SPREAD: f32 = 0.016;
        /// Dimension of the random numbers of wet surfaces.
        WET_DIMENSION: u32 = 4300;
        /// Footprint in which no relief is resolved, m.
        WET_FAR: f32 = 1000.0;
        /// Wetness below which a surface is dry.
        WET_MIN: f32 = 0.001;
        /// Reflectances at normal incidence between which a surface goes from a dielectric to a metal.
        WET_DIELECTRIC: f32 = 0.1;
        /// See [`WET_DIELECTRIC`].
        WET_METAL: f32 = 0.4;
    }
}

/// Surfaces that rain has made wet. Twin: `downpour_trace::wet`.
pub static WET: Module = Module {
    path: "render/wet.wgsl",
    wgsl: include_str!("../../wgsl/render/wet.wgsl"),
    uses: &[&WET_CONSTANTS, &DATA, &RNG, &SURFACE, &PUDDLE_WATER],
};
