//! `wgsl/render/puddle_water.wgsl`: puddles as rays meet them. Twin: `downpour_trace::scene::water`.

use super::puddle_flow::PUDDLE_FLOW;
use super::puddle_rings::PUDDLE_RINGS;
use super::scene::DATA;
use super::table::PUDDLE;
use crate::Module;
use crate::common::RNG;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PUDDLE_WATER_CONSTANTS, &PUDDLE_WATER];

shared_constants! {
    /// Numbers of puddles in pictures.
    PUDDLE_WATER_CONSTANTS at "render/puddle_water constants" {
        /// Rows of a puddle in the scene's table.
        PUDDLE_WATER_ROWS: u32 = 8;
        /// Most puddles of a scene.
        PUDDLE_WATER_MAX_COUNT: u32 = 16;
        /// Says that there is no water.
        PUDDLE_WATER_NONE: u32 = 4294967295;
        /// Number that stands for the material of water where pixels are compared.
        PUDDLE_WATER_MATERIAL: u32 = 4294967294;
        /// Refractive index of water.
        PUDDLE_WATER_INDEX: f32 = 1.333;
        /// Reflectance of water at normal incidence.
        PUDDLE_WATER_NORMAL: f32 = 0.020373;
        /// Fraction of diffuse light that the surface reflects on its way into the water: the mean of Fresnel's equations over
        /// the hemisphere, cosine-weighted.
        PUDDLE_WATER_OUTSIDE: f32 = 0.0664058;
        /// Fraction of diffuse light that the surface reflects back into the water: 1 - (1 - outside) / index^2.
        PUDDLE_WATER_INSIDE: f32 = 0.4745906;
        /// Depth below which there is no water, m.
        PUDDLE_WATER_MIN_DEPTH: f32 = 0.0002;
        /// Largest distance of a ray's hit over or under the mapped ground, m.
        PUDDLE_WATER_SLACK: f32 = 0.01;
        /// Least rise of a direction over the horizon that leaves a puddle.
        PUDDLE_WATER_GRAZING: f32 = 0.002;
        /// Width at distance 1 of a mirrored ray, beyond that of the ray that was mirrored.
        PUDDLE_WATER_CONE: f32 = 0.002;
        /// Way of the light of lamps and sky down to the ground, in depths.
        PUDDLE_WATER_DOWN: f32 = 1.2;
        /// Rays that a sample of rippled water mirrors, at least.
        PUDDLE_WATER_RAYS: u32 = 4;
        /// Variance of the slope from which water is rippled.
        PUDDLE_WATER_RIPPLED: f32 = 0.000001;
        /// Step of the mesh of triangles over which pieces of the ripples are mixed, m.
        PUDDLE_WATER_MESH: f32 = 0.35;
        /// Dimension of the random numbers of the pieces' positions.
        PUDDLE_WATER_DIMENSION: u32 = 4200;
    }
}

/// Puddles as rays meet them. Twin: `downpour_trace::scene::water`.
pub static PUDDLE_WATER: Module = Module {
    path: "render/puddle_water.wgsl",
    wgsl: include_str!("../../wgsl/render/puddle_water.wgsl"),
    uses: &[&PUDDLE_WATER_CONSTANTS, &DATA, &PUDDLE, &PUDDLE_FLOW, &PUDDLE_RINGS, &RNG],
};
