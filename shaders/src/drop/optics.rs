//! `wgsl/drop/optics.wgsl`. Twin: `downpour_drop::optics`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[];
