//! `shaders/wgsl/drop` against `downpour-drop`.

mod distribution;
mod fall_speed;
mod optics;
mod oscillation;
mod shape;

use crate::FunctionCase;

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    [
        shape::functions(),
        oscillation::functions(),
        fall_speed::functions(),
        optics::functions(),
        distribution::functions(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
