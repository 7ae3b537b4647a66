//! `wgsl/wind`: wind primitives and the wind field. The Rust twins are in `downpour-wind`.

use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] = &[&WIND_CONSTANTS, &PRIMITIVE, &TURBULENCE, &FIELD, &FIELD_SPREAD];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&FIELD_KERNEL, &FIELD_SPREAD_CLEAR_KERNEL, &FIELD_SPREAD_KERNEL];

shared_constants! {
    /// Types of the primitives, and factors of their formulas. The type of a line form includes its core: plain for
    /// Rosenhead's, plus 8 for Rankine's, plus 16 for Lamb and Oseen's.
    WIND_CONSTANTS at "wind/constants" {
        /// Type: uniform wind.
        WIND_PRIMITIVE_UNIFORM: u32 = 0;
        /// Type: out of a line.
        WIND_PRIMITIVE_LINE_SOURCE: u32 = 1;
        /// Type: into a line.
        WIND_PRIMITIVE_LINE_SINK: u32 = 2;
        /// Type: around a line.
        WIND_PRIMITIVE_LINE_VORTEX: u32 = 3;
        /// Type: out of a point.
        WIND_PRIMITIVE_POINT_SOURCE: u32 = 4;
        /// Type: into a point.
        WIND_PRIMITIVE_POINT_SINK: u32 = 5;
        /// Type: around an axis, fading in all directions from a point.
        WIND_PRIMITIVE_POINT_VORTEX: u32 = 6;
        /// Type: along a line of finite length, from its base to its top.
        WIND_PRIMITIVE_UPDRAFT: u32 = 7;
        /// Added to the type of a line form with Rankine's core.
        WIND_PRIMITIVE_RANKINE: u32 = 8;
        /// Added to the type of a line form with the core of Lamb and Oseen.
        WIND_PRIMITIVE_LAMB_OSEEN: u32 = 16;
        /// Fraction of the squared core radius below which 1 - exp(-x) is summed as a series.
        WIND_PRIMITIVE_SERIES: f32 = 0.25;
        /// 1 / (2 pi).
        WIND_PRIMITIVE_LINE: f32 = 0.15915494;
        /// 1 / (4 pi).
        WIND_PRIMITIVE_POINT: f32 = 0.07957747;
    }
}

/// Velocity of a primitive at a position. Twin: `downpour_wind::primitive`.
pub static PRIMITIVE: Module = Module {
    path: "wind/primitive.wgsl",
    wgsl: include_str!("../wgsl/wind/primitive.wgsl"),
    uses: &[&WIND_CONSTANTS],
};

/// Waves of turbulence. Twin: `downpour_wind::turbulence`.
pub static TURBULENCE: Module =
    Module { path: "wind/turbulence.wgsl", wgsl: include_str!("../wgsl/wind/turbulence.wgsl"), uses: &[] };

/// Wind in the cells of a box. Twin: `downpour_wind::field`.
pub static FIELD: Module = Module {
    path: "wind/field.wgsl",
    wgsl: include_str!("../wgsl/wind/field.wgsl"),
    uses: &[&PRIMITIVE, &TURBULENCE],
};

/// One invocation per cell.
pub static FIELD_KERNEL: Kernel = Kernel { entry: "main_wind_field", module: &FIELD, workgroup: [4, 4, 4] };

/// Spread of the wind about a position. Twin: `downpour_wind::field_spread`.
pub static FIELD_SPREAD: Module = Module {
    path: "wind/field_spread.wgsl",
    wgsl: include_str!("../wgsl/wind/field_spread.wgsl"),
    uses: &[&FIELD],
};

/// One workgroup.
pub static FIELD_SPREAD_CLEAR_KERNEL: Kernel =
    Kernel { entry: "main_wind_field_spread_clear", module: &FIELD_SPREAD, workgroup: [8, 1, 1] };

/// One invocation per cell about the position.
pub static FIELD_SPREAD_KERNEL: Kernel =
    Kernel { entry: "main_wind_field_spread", module: &FIELD_SPREAD, workgroup: [4, 4, 4] };
