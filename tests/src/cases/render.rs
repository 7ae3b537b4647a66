//! `shaders/wgsl/render` against `downpour-render`, a file per shader.

mod drops_sum;
mod glow;
mod project;
mod refine;
mod specimen;
mod streak;
mod tiles;
mod tone;

use crate::{FunctionCase, KernelCase};

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    [
        drops_sum::functions(),
        project::functions(),
        refine::functions(),
        specimen::functions(),
        streak::functions(),
        tiles::functions(),
        tone::functions(),
    ]
    .concat()
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    glow::kernels()
        .into_iter()
        .chain(project::kernels())
        .chain(refine::kernels())
        .chain(specimen::kernels())
        .chain(streak::kernels())
        .chain(tiles::kernels())
        .chain(tone::kernels())
        .collect()
}
