//! `wgsl/render/{light,material,puddle,pane}.wgsl`: what the rows of a scene's table mean. Twins: `downpour_render::light`,
//! `downpour_render::glass::shade` (the pane), `downpour_trace::{material, puddle::rows}`.

use super::pane_shadow::PANE_SHADOW_CONSTANTS;
use super::puddle_water::PUDDLE_WATER_CONSTANTS;
use super::scene::{DATA, SCENE_CONSTANTS};
use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&LIGHT, &MATERIAL, &PUDDLE, &PANE];

/// Lamps and the sun. Twin: `downpour_render::light`.
pub static LIGHT: Module = Module {
    path: "render/light.wgsl",
    wgsl: include_str!("../../wgsl/render/light.wgsl"),
    uses: &[&SCENE_CONSTANTS, &PANE_SHADOW_CONSTANTS, &DATA],
};

/// Materials and texture slots. Twin: `downpour_trace::material`.
pub static MATERIAL: Module = Module {
    path: "render/material.wgsl",
    wgsl: include_str!("../../wgsl/render/material.wgsl"),
    uses: &[&SCENE_CONSTANTS, &DATA],
};

/// Puddles and their ripples. Twin: `downpour_trace::puddle::rows`.
pub static PUDDLE: Module = Module {
    path: "render/puddle.wgsl",
    wgsl: include_str!("../../wgsl/render/puddle.wgsl"),
    uses: &[&PUDDLE_WATER_CONSTANTS, &DATA],
};

/// The pane that throws shadows. Twin: `downpour_render::glass::shade`.
pub static PANE: Module = Module {
    path: "render/pane.wgsl",
    wgsl: include_str!("../../wgsl/render/pane.wgsl"),
    uses: &[&PANE_SHADOW_CONSTANTS, &DATA],
};
