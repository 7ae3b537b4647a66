//! `shaders/wgsl/render` against `downpour-render`, a file per shader.

mod glow;
mod project;
mod specimen;
mod streak;
mod tiles;

use crate::{FunctionCase, KernelCase};

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    [project::functions(), specimen::functions(), streak::functions(), tiles::functions()].concat()
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    glow::kernels()
        .into_iter()
        .chain(project::kernels())
        .chain(specimen::kernels())
        .chain(streak::kernels())
        .chain(tiles::kernels())
        .collect()
}
