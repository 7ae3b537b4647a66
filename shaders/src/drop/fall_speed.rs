//! `wgsl/drop/fall_speed.wgsl`. Twin: `downpour_drop::fall_speed`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[];
