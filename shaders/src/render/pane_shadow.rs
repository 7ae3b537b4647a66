//! `wgsl/render/pane_shadow.wgsl`: light of lamps that falls through a wet pane. Twin: `downpour_trace::pane_shadow`.

use super::glass::GLASS_PICTURE_CONSTANTS;
use super::scene::DATA;
use super::table::PANE;
use crate::Module;
use crate::drop::optics::OPTICS;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PANE_SHADOW_CONSTANTS, &PANE_SHADOW];

shared_constants! {
    /// Numbers of the shadows of a pane.
    PANE_SHADOW_CONSTANTS at "render/pane_shadow constants" {
        /// Rows before those of the levels.
        PANE_SHADOW_LEVELS: u32 = 6;
        /// The largest number of a texel of gathered light.
        PANE_SHADOW_PEAK: f32 = 8.0;
        /// Form: drops are lenses, whose light is wide behind their focus.
        PANE_SHADOW_LENS: u32 = 0;
        /// Form: the middle of a shadow is bright at any distance (Tatarchuk & Isidoro 2006).
        PANE_SHADOW_TATARCHUK: u32 = 1;
        /// Half the angle of the sun.
        PANE_SHADOW_SUN: f32 = 4.65e-3;
    }
}

/// Light of lamps that falls through a wet pane. Twin: `downpour_trace::pane_shadow`.
pub static PANE_SHADOW: Module = Module {
    path: "render/pane_shadow.wgsl",
    wgsl: include_str!("../../wgsl/render/pane_shadow.wgsl"),
    uses: &[&PANE_SHADOW_CONSTANTS, &GLASS_PICTURE_CONSTANTS, &DATA, &PANE, &OPTICS],
};
