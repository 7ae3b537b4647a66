//! The registry of cases, a file per subsystem.

mod atlas;
mod bounce;
mod bvh;
mod collision;
mod common;
mod drip;
mod drop;
mod drop_light;
mod field;
mod glass;
mod glass_picture;
mod glazing;
mod host;
mod impostor;
mod mask;
mod pane_shadow;
mod puddle;
mod puddle_water;
mod rain;
mod render;
mod running_light;
mod scene;
mod step;
mod temporal;
mod wet;
mod wind;

use crate::{FunctionCase, KernelCase, mean_errors};

/// All function-level cases.
#[must_use]
pub fn functions() -> Vec<FunctionCase> {
    [
        atlas::functions(),
        bounce::functions(),
        drip::functions(),
        bvh::functions(),
        collision::functions(),
        common::functions(),
        drop::functions(),
        drop_light::functions(),
        field::functions(),
        glass::functions(),
        glass_picture::functions(),
        glazing::functions(),
        impostor::functions(),
        host::functions(),
        mask::functions(),
        puddle::functions(),
        puddle_water::functions(),
        rain::functions(),
        rain::spray::functions(),
        render::functions(),
        running_light::functions(),
        scene::functions(),
        temporal::functions(),
        step::functions(),
        wet::functions(),
        wind::functions(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// All kernel-level cases.
#[must_use]
pub fn kernels() -> Vec<KernelCase> {
    let mut cases: Vec<KernelCase> = [
        atlas::kernels(),
        bounce::kernels(),
        drip::kernels(),
        collision::kernels(),
        common::kernels(),
        drop_light::kernels(),
        field::kernels(),
        glass::kernels(),
        glass_picture::kernels(),
        glazing::kernels(),
        impostor::kernels(),
        host::kernels(),
        mask::kernels(),
        puddle::kernels(),
        pane_shadow::kernels(),
        puddle_water::kernels(),
        rain::kernels(),
        rain::spray::kernels(),
        render::kernels(),
        running_light::kernels(),
        scene::kernels(),
        temporal::kernels(),
        step::kernels(),
        wet::kernels(),
        wind::kernels(),
    ]
    .into_iter()
    .flatten()
    .collect();
    mean_errors::limit(&mut cases);
    cases
}

/// Functions without a case, each with the reason.
pub const ALLOWED: &[(&str, &str)] = &[
    (
        "main_host_blend_vertex",
        "a vertex shader that returns host_blend_corner: the frames of downpour's test `rain` hold it",
    ),
    (
        "main_host_blend_fragment",
        "a fragment shader that reads a pixel of the rain: the frames of downpour's test `rain` hold it",
    ),
];
