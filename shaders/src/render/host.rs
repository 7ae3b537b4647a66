//! `wgsl/render/host_*.wgsl`: the textures of a host application as a plate, and rain over them. Twin: `downpour_render::host`.

use super::camera::CAMERA;
use super::scene::SCENE_CONSTANTS;
use crate::common::{EQUIRECT, PACKING};
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&HOST_CONSTANTS, &HOST_RADIANCE, &HOST_PLATE, &HOST_ENVIRONMENT, &HOST_BLEND];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&HOST_PLATE_KERNEL, &HOST_ENVIRONMENT_KERNEL];

shared_constants! {
    /// Numbers of the plates of host applications.
    HOST_CONSTANTS at "render/host constants" {
        /// Levels of the picture: for 16384 pixels.
        HOST_LEVELS: u32 = 15;
        /// Inverse depth, 1/m, below which nothing stands: 1000 km.
        HOST_FARTHEST: f32 = 1.0e-6;
        /// Largest radiance: the largest number of half precision.
        HOST_BRIGHTEST: f32 = 65504.0;
        /// Least cosine of a direction with the view direction for its position on the picture.
        HOST_MIN_DEPTH: f32 = 0.02;
        /// Square root of the solid angle of the sphere.
        HOST_SPHERE: f32 = 3.5449077;
        /// Width of the blur beyond the picture's borders, in heights of the picture.
        HOST_BLUR: f32 = 0.25;
        /// Inverse of the width over which a sky map takes over beyond the picture's borders, in halves of the picture.
        HOST_BORDER: f32 = 10.0;
        /// Samples along an edge of a texel of the map.
        HOST_SKY_TAPS: u32 = 4;
    }
}

/// The radiance of a color.
pub static HOST_RADIANCE: Module = Module {
    path: "render/host_radiance.wgsl",
    wgsl: include_str!("../../wgsl/render/host_radiance.wgsl"),
    uses: &[&HOST_CONSTANTS],
};

/// Color and depth textures as radiance and distance.
pub static HOST_PLATE: Module = Module {
    path: "render/host_plate.wgsl",
    wgsl: include_str!("../../wgsl/render/host_plate.wgsl"),
    uses: &[&SCENE_CONSTANTS, &CAMERA, &HOST_RADIANCE],
};

/// The environment map of a picture and a sky map.
pub static HOST_ENVIRONMENT: Module = Module {
    path: "render/host_environment.wgsl",
    wgsl: include_str!("../../wgsl/render/host_environment.wgsl"),
    uses: &[&HOST_CONSTANTS, &EQUIRECT, &PACKING, &CAMERA, &HOST_RADIANCE],
};

/// Rain over a color texture: a vertex and a fragment shader.
pub static HOST_BLEND: Module = Module {
    path: "render/host_blend.wgsl",
    wgsl: include_str!("../../wgsl/render/host_blend.wgsl"),
    uses: &[],
};

/// One invocation per pixel.
pub static HOST_PLATE_KERNEL: Kernel =
    Kernel { entry: "main_host_plate", module: &HOST_PLATE, workgroup: [8, 8, 1] };

/// One invocation per texel of the map.
pub static HOST_ENVIRONMENT_KERNEL: Kernel =
    Kernel { entry: "main_host_environment", module: &HOST_ENVIRONMENT, workgroup: [8, 8, 1] };
