//! The registry of cases, a file per subsystem.

mod common;
mod drop;
mod mask;
mod rain;
mod render;
mod scene;
mod wind;

use crate::{FunctionCase, KernelCase};

/// All function-level cases.
#[must_use]
pub fn functions() -> Vec<FunctionCase> {
    [
        common::functions(),
        drop::functions(),
        mask::functions(),
        rain::functions(),
        render::functions(),
        scene::functions(),
        wind::functions(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// All kernel-level cases.
#[must_use]
pub fn kernels() -> Vec<KernelCase> {
    [mask::kernels(), rain::kernels(), render::kernels(), scene::kernels(), wind::kernels()]
        .into_iter()
        .flatten()
        .collect()
}

/// Functions without a case of their own, each with the reason.
pub const ALLOWED: &[(&str, &str)] = &[];
