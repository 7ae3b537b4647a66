//! `wgsl/render/{drop_glint,drop_light}.wgsl`: light of lamps and sun on drops. Twins:
//! `downpour_render::rain::{glint, light}`.

use super::scene::SCENE;
use super::table::LIGHT;
use crate::atlas::{ATLAS, ATLAS_CONSTANTS};
use crate::common::OCTANT;
use crate::{Kernel, Module};

/// Every module of this file.
pub const MODULES: &[&Module] =
    &[&DROP_LIGHT_CONSTANTS, &DROP_GLINT, &DROP_LIGHT_TABLE, &DROP_ATLAS, &DROP_LIGHT];

/// Every kernel of this file.
pub const KERNELS: &[&Kernel] = &[&DROP_LIGHT_KERNEL];

shared_constants! {
    /// Numbers of the light on drops.
    DROP_LIGHT_CONSTANTS at "render/drop light constants" {
        /// Form: geometric optics of a sphere.
        DROP_LIGHT_TRACED: u32 = 0;
        /// Form: the formula of Rousseau 2006, section 6.
        DROP_LIGHT_ROUSSEAU: u32 = 1;
        /// Form: the cones of Im & Sung 2022, section III.C.
        DROP_LIGHT_IM_SUNG: u32 = 2;
        /// Form: no light.
        DROP_LIGHT_NONE: u32 = 3;
        /// Form: the streaks of an atlas.
        DROP_LIGHT_ATLAS: u32 = 4;
        /// Form for the profiles of streaks: lamp by lamp, the others in the mean of a sphere.
        DROP_LIGHT_LAMPS_TRACED: u32 = 5;
        /// The same in the form of Rousseau 2006.
        DROP_LIGHT_LAMPS_ROUSSEAU: u32 = 6;
        /// Term of the formula of Rousseau 2006, a bit: light that is reflected outside (`A_2`).
        DROP_LIGHT_EXTERNAL: u32 = 1;
        /// Term of the formula of Rousseau 2006, a bit: light that is reflected inside (`A_3`).
        DROP_LIGHT_INTERNAL: u32 = 2;
        /// Chord from the middle to the edge of the sun's disk: lamps that have no size count as wide.
        DROP_LIGHT_REACH: f32 = 0.00465;
        /// Entries of a row of the table: equal intervals of the scattering angle.
        DROP_LIGHT_ENTRIES: u32 = 256;
        /// Light paths that are distinguished; row 0 of the table is their sum.
        DROP_LIGHT_PATHS: u32 = 6;
        /// Glints that are kept of a drop, at most.
        DROP_LIGHT_GLINTS: u32 = 16;
        /// Lamps of a dispatch.
        DROP_LIGHT_LAMPS: u32 = 64;
        /// Rings of equal area for the mean over a drop's disk.
        DROP_LIGHT_RINGS: u32 = 4;
        /// Positions along a ring.
        DROP_LIGHT_POINTS: u32 = 8;
        /// Steps of a packed coordinate from the middle of the disk to its rim.
        DROP_GLINT_STEPS: f32 = 511.0;
        /// Steps of a packed coordinate, both signs.
        DROP_GLINT_RANGE: f32 = 1024.0;
        /// Bits of these steps.
        DROP_GLINT_MASK: u32 = 1023;
        /// Steps of the square root of a packed width.
        DROP_GLINT_WIDTHS: f32 = 511.0;
        /// Bits of these steps.
        DROP_GLINT_WIDTH_MASK: u32 = 511;
        /// Bits of every packed glint: of an ordinary positive number, which no device rounds to another.
        DROP_GLINT_NUMBER: u32 = 0x20000000;
        /// Below this, a vector has no direction.
        DROP_GLINT_TINY: f32 = 1.0e-30;
        /// Rows of a drop's light that hold a streak of an atlas.
        DROP_ATLAS_ROWS: u32 = 3;
        /// Row of an atlas: numbers of diameters, oscillations, elevations and directions.
        DROP_ATLAS_COUNTS: u32 = 0;
        /// Row of an atlas: by angle or at random, the first row of the amounts, and whether all elevations have the same directions.
        DROP_ATLAS_PICK: u32 = 1;
        /// Row of an atlas: the seed, in four parts of 16 bits.
        DROP_ATLAS_SEED: u32 = 2;
        /// First of four rows of an atlas: gaps between diameters.
        DROP_ATLAS_SIZES: u32 = 3;
        /// First of four rows of an atlas: gaps between elevations.
        DROP_ATLAS_RISES: u32 = 7;
        /// First of three rows of an atlas: first triangles of the elevations.
        DROP_ATLAS_FIRST: u32 = 11;
        /// First row of an atlas' triangles, three each.
        DROP_ATLAS_TRIANGLES: u32 = 14;
        /// Below this squared distance from the axis a direction has no side.
        DROP_GLINT_AXIS: f32 = 1.0e-12;
    }
}

/// Points where light leaves a drop; needs no buffers. Twin: `downpour_render::rain::glint`.
pub static DROP_GLINT: Module = Module {
    path: "render/drop_glint.wgsl",
    wgsl: include_str!("../../wgsl/render/drop_glint.wgsl"),
    uses: &[&DROP_LIGHT_CONSTANTS, &OCTANT],
};

/// Scattering of light by drops. Host: `downpour_render::rain::light::DropLightTable`.
pub static DROP_LIGHT_TABLE: Module = Module {
    path: "render/drop_light_table.wgsl",
    wgsl: include_str!("../../wgsl/render/drop_light_table.wgsl"),
    uses: &[],
};

/// Streaks of an atlas that a drop shows. Twin: `downpour_render::rain::light::atlas`.
pub static DROP_ATLAS: Module = Module {
    path: "render/drop_atlas.wgsl",
    wgsl: include_str!("../../wgsl/render/drop_atlas.wgsl"),
    uses: &[&DROP_LIGHT_CONSTANTS, &DROP_LIGHT_TABLE, &ATLAS_CONSTANTS, &ATLAS],
};

/// Light of all lamps on drops. Twin: `downpour_render::rain::light`.
pub static DROP_LIGHT: Module = Module {
    path: "render/drop_light.wgsl",
    wgsl: include_str!("../../wgsl/render/drop_light.wgsl"),
    uses: &[&DROP_LIGHT_CONSTANTS, &DROP_GLINT, &DROP_LIGHT_TABLE, &ATLAS, &DROP_ATLAS, &LIGHT, &SCENE],
};

/// One invocation per drop.
pub static DROP_LIGHT_KERNEL: Kernel =
    Kernel { entry: "main_drop_light", module: &DROP_LIGHT, workgroup: [64, 1, 1] };
