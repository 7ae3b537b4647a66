//! Ripples of puddles.

use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[];
