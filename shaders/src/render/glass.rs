//! `wgsl/render/glass_picture*.wgsl`: pictures through wet glass. Twins: `downpour_render::glass`.

use super::camera::CAMERA;
use crate::common::PACKING;
use crate::drop::optics::OPTICS;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&GLASS_PICTURE_CONSTANTS, &WATER, &LIGHT, &BLADE, &GLASS_PICTURE];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&GLASS_PICTURE_KERNEL];

shared_constants! {
    /// Numbers of the pane and of its picture.
    GLASS_PICTURE_CONSTANTS at "render/glass_picture constants" {
        /// Levels of the picture behind the pane: for 16384 pixels.
        GLASS_PICTURE_LEVELS: u32 = 15;
        /// Turns of regula falsi until a ray has left a drop.
        GLASS_PICTURE_TURNS: u32 = 5;
        /// Refractive index of window glass (soda lime).
        GLASS_PICTURE_INDEX: f32 = 1.52;
        /// Distance, m, beyond which all is equally far.
        GLASS_PICTURE_FAR: f32 = 1.0e6;
        /// Blur of what a pane mirrors of the eye's side, radians: the interior is out of focus.
        GLASS_PICTURE_MIRROR: f32 = 0.1;
        /// Distance of neighboring positions of a lens with one sample, in its radius: the root of pi.
        GLASS_PICTURE_APART: f32 = 1.7724539;
        /// Height of a paraboloid of radius 1 whose integral is 1: 2 / pi.
        GLASS_PICTURE_LIGHT_PEAK: f32 = 0.63661975;
        /// Radius over which a lamp's image is spread, in what neighboring rays see apart: smooth for any positions of rays.
        GLASS_PICTURE_LIGHT_WIDTH: f32 = 1.5;
        /// Wipers that a picture shows, at most.
        GLASS_PICTURE_BLADES: u32 = 8;
        /// Rows of directions of a blade while the shutter is open, two to a row.
        GLASS_PICTURE_BLADE_ROWS: u32 = 5;
        /// Half the width of a blade's lip, m.
        GLASS_PICTURE_LIP: f32 = 0.003;
        /// Half the width of its holder in the middle, and at its ends, m.
        GLASS_PICTURE_HOLDER: f32 = 0.006;
        /// At its ends.
        GLASS_PICTURE_HOLDER_END: f32 = 0.00425;
        /// Half the width of an arm at its pivot, m.
        GLASS_PICTURE_ARM: f32 = 0.0075;
        /// At the blade.
        GLASS_PICTURE_ARM_END: f32 = 0.004;
        /// Diffuse reflectance of rubber with carbon black.
        GLASS_PICTURE_RUBBER: f32 = 0.04;
        /// Diffuse reflectance of metal in black paint.
        GLASS_PICTURE_METAL: f32 = 0.05;
        /// Angle over which the light of a diffuse surface is averaged, radians.
        GLASS_PICTURE_DIFFUSE: f32 = 1.0;
        /// Step of the moments of samples in an exposure: the root of 2 less 1, which no other sequence of the samples has.
        GLASS_PICTURE_MOMENT: f32 = 0.41421357;
        /// Focus on what is behind the pane.
        GLASS_PICTURE_SCENE: u32 = 0;
        /// Focus on the pane.
        GLASS_PICTURE_GLASS: u32 = 1;
        /// Fresnel's equations.
        GLASS_PICTURE_EXACT: u32 = 0;
        /// The reflectance of Tatarchuk and Isidoro 2006.
        GLASS_PICTURE_TATARCHUK: u32 = 1;
    }
}

/// Drops on a pane as surfaces. Twin: `downpour_render::glass::water`.
pub static WATER: Module = Module {
    path: "render/glass_picture_water.wgsl",
    wgsl: include_str!("../../wgsl/render/glass_picture_water.wgsl"),
    uses: &[&GLASS_PICTURE_CONSTANTS],
};

/// Lamps in drops on a pane. Twin: `downpour_render::glass::light`.
pub static LIGHT: Module = Module {
    path: "render/glass_picture_light.wgsl",
    wgsl: include_str!("../../wgsl/render/glass_picture_light.wgsl"),
    uses: &[&GLASS_PICTURE_CONSTANTS],
};

/// Blades of wipers. Twin: `downpour_render::glass::blade`.
pub static BLADE: Module = Module {
    path: "render/glass_picture_blade.wgsl",
    wgsl: include_str!("../../wgsl/render/glass_picture_blade.wgsl"),
    uses: &[&GLASS_PICTURE_CONSTANTS],
};

/// A picture through a pane. Twin: `downpour_render::glass::picture`.
pub static GLASS_PICTURE: Module = Module {
    path: "render/glass_picture.wgsl",
    wgsl: include_str!("../../wgsl/render/glass_picture.wgsl"),
    uses: &[&CAMERA, &WATER, &LIGHT, &BLADE, &OPTICS, &PACKING],
};

/// One invocation per pixel.
pub static GLASS_PICTURE_KERNEL: Kernel =
    Kernel { entry: "main_glass_picture", module: &GLASS_PICTURE, workgroup: [8, 8, 1] };
