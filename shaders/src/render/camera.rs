//! `wgsl/render/camera.wgsl`: a camera with its picture. Twin: `downpour_render::camera`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&CAMERA];

/// A camera with its picture. Twin: `downpour_render::camera`.
pub static CAMERA: Module =
    Module { path: "render/camera.wgsl", wgsl: include_str!("../../wgsl/render/camera.wgsl"), uses: &[] };
