//! `wgsl/drop/distribution.wgsl`. Twin: `downpour_drop::distribution`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[];
