//! The registry of cases, a file per subsystem.

mod atlas;
mod bvh;
mod collision;
mod common;
mod drop;
mod drop_light;
mod glass;
mod glass_picture;
mod mask;
mod pane_shadow;
mod puddle;
mod puddle_water;
mod rain;
mod render;
mod scene;
mod step;
mod wind;

use crate::{FunctionCase, KernelCase};

/// All function-level cases.
#[must_use]
pub fn functions() -> Vec<FunctionCase> {
    [
        atlas::functions(),
        bvh::functions(),
        collision::functions(),
        common::functions(),
        drop::functions(),
        drop_light::functions(),
        glass::functions(),
        glass_picture::functions(),
        mask::functions(),
        puddle::functions(),
        puddle_water::functions(),
        rain::functions(),
        render::functions(),
        scene::functions(),
        step::functions(),
        wind::functions(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// All kernel-level cases.
#[must_use]
pub fn kernels() -> Vec<KernelCase> {
    [
        atlas::kernels(),
        collision::kernels(),
        common::kernels(),
        drop_light::kernels(),
        glass::kernels(),
        glass_picture::kernels(),
        mask::kernels(),
        puddle::kernels(),
        pane_shadow::kernels(),
        puddle_water::kernels(),
        rain::kernels(),
        render::kernels(),
        scene::kernels(),
        step::kernels(),
        wind::kernels(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Functions without a case, each with the reason.
pub const ALLOWED: &[(&str, &str)] = &[];
