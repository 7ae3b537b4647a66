//! `shaders/wgsl/sim`: collision.

use crate::{FunctionCase, KernelCase};

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    Vec::new()
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    Vec::new()
}
