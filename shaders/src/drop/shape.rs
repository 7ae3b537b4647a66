//! `wgsl/drop/shape.wgsl`. Twin: `downpour_drop::shape`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[];
