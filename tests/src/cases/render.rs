//! `shaders/wgsl/render` against `downpour-render`, a file per shader.

mod specimen;

use crate::{FunctionCase, KernelCase};

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    specimen::functions()
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    specimen::kernels()
}
