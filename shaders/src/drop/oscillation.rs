//! `wgsl/drop/oscillation.wgsl`. Twin: `downpour_drop::oscillation`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[];
