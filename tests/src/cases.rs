//! The registry of cases, a file per subsystem.

mod common;
mod drop;
mod mask;

use crate::{FunctionCase, KernelCase};

/// All function-level cases.
#[must_use]
pub fn functions() -> Vec<FunctionCase> {
    [common::functions(), drop::functions(), mask::functions()].into_iter().flatten().collect()
}

/// All kernel-level cases.
#[must_use]
pub fn kernels() -> Vec<KernelCase> {
    mask::kernels()
}

/// Functions without a case of their own, each with the reason.
pub const ALLOWED: &[(&str, &str)] = &[];
