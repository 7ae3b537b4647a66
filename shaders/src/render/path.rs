//! `wgsl/render/path.wgsl`: what a ray of the camera sees. Twin: `downpour_trace::path`.

use super::glazing::GLAZING;
use super::impostor::IMPOSTOR;
use super::puddle_wake::PUDDLE_WAKE;
use super::puddle_water::PUDDLE_WATER;
use super::scatter::SCATTER;
use super::scene::{DATA, SCENE, SKY, SURFACE};
use super::table::PUDDLE;
use super::translucent::TRANSLUCENT;
use super::wet::WET;
use crate::Module;
use crate::common::RNG;
use crate::drop::optics::OPTICS;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&PATH_CONSTANTS, &PATH_LATTICE, &PATH];

shared_constants! {
    /// Numbers of the rays of the camera.
    PATH_CONSTANTS at "render/path constants" {
        /// Dimension of the random numbers of a pixel's rays.
        PATH_DIMENSION: u32 = 4100;
        /// Generators of the lattice of the rays' numbers: coprime with the points of the filter's window.
        PATH_LATTICE_SCATTER: u32 = 19;
        /// See [`PATH_LATTICE_SCATTER`].
        PATH_LATTICE_SECOND: u32 = 30;
        /// See [`PATH_LATTICE_SCATTER`].
        PATH_LATTICE_THIRD: u32 = 37;
        /// Largest distance of a ray's numbers from the lattice's point: about the distance of neighboring points.
        PATH_JITTER: f32 = 0.14;
        /// Distance of the lattice's points along one axis: one over the pixels of the filter's window.
        PATH_BETWEEN: f32 = 0.020408163;
        /// Rays that follow each other, at most.
        PATH_BOUNCES: u32 = 16;
        /// Cosine of the angle between facets up to which a surface is the same.
        PATH_SAME_FACET: f32 = 0.97;
        /// Distance from the other facet's plane up to which a surface is the same, per distance from the eye.
        PATH_SAME_PLANE: f32 = 0.005;
        /// Roughness below which gloss is that of a mirror: its lobe is narrower than some pixels.
        PATH_SHARP: f32 = 0.1;
        /// Alphas that neighboring pixels' mirror images are apart from which gloss is that of a mirror.
        PATH_APART: f32 = 1.5;
        /// Directions among which the one of a ray of the diffuse base is drawn.
        PATH_CANDIDATES: u32 = 8;
        /// Minimum weight of a direction in that draw, as a multiple of the mean of the sky.
        PATH_FLOOR: f32 = 1.0;
        /// Roughness from which one ray serves the diffuse base and the gloss, by chance.
        PATH_MIXED: f32 = 0.35;
        /// Specular weight from which rays are traced for it.
        PATH_MIN_GLOSS: f32 = 0.005;
        /// Smallest factor by which light toward the viewer is divided, to be told apart.
        PATH_MIN_FACTOR: f32 = 0.001;
        /// Gloss and roughness from which, and below which, each sample of a pixel sees for itself what is mirrored.
        PATH_PLAIN_GLOSS: f32 = 0.03;
        /// See [`PATH_PLAIN_GLOSS`].
        PATH_CURVED: f32 = 0.3;
        /// Part of all rays that one is of a gloss of which no means over neighbors are taken: there are some per pixel.
        PATH_CURVED_FRACTION: f32 = 0.25;
        /// The inner part of such a gloss that rays are drawn from.
        PATH_CURVED_PART: f32 = 0.8;
        /// Facets of rippled water of which the reflectance is the mean.
        PATH_WATER_FACETS: u32 = 16;
        /// Ways a ray leaves what it has met. First: from the surface that the ray of the camera has met, whose
        /// light it looks for.
        PATH_FIRST: u32 = 0;
        /// Through it.
        PATH_STRAIGHT: u32 = 1;
        /// Mirrored by a metal in a mirror.
        PATH_MIRROR: u32 = 2;
        /// From what a mirror shows.
        PATH_SHOWN: u32 = 3;
        /// As chance has it.
        PATH_ONWARD: u32 = 4;
        /// Path roughness from which surfaces are shaded in simplified form: as diffuse, with one lamp for all.
        PATH_SECONDARY_ROUGHNESS: f32 = 0.25;
        /// Minimum occlusion of a material that is taken back from light of lamps.
        PATH_OCCLUSION: f32 = 0.05;
        /// Makes other numbers of those of a ray.
        PATH_OTHER: f32 = 61.0;
        /// Lamps that are drawn for all where a mirror shows a surface.
        PATH_MIRROR_LAMPS: u32 = 4;
        /// Part of all rays that one is which has met a surface.
        PATH_LATER_FRACTION: f32 = 0.01;
        /// Fraction of light let through from which a surface is seen through.
        PATH_OPEN: f32 = 0.02;
        /// Fraction of the hemisphere that surfaces occupy, for a surface that a path of surfaces has led to.
        PATH_ENCLOSED: f32 = 0.9;
    }
}

/// Random numbers of a pixel's rays. Twin: `downpour_trace::path::lattice`.
pub static PATH_LATTICE: Module = Module {
    path: "render/path_lattice.wgsl",
    wgsl: include_str!("../../wgsl/render/path_lattice.wgsl"),
    uses: &[&PATH_CONSTANTS, &DATA, &RNG],
};

/// Path of a ray of the camera. Twin: `downpour_trace::path`.
pub static PATH: Module = Module {
    path: "render/path.wgsl",
    wgsl: include_str!("../../wgsl/render/path.wgsl"),
    uses: &[
        &PATH_CONSTANTS,
        &PATH_LATTICE,
        &SCENE,
        &SCATTER,
        &SKY,
        &SURFACE,
        &PUDDLE,
        &PUDDLE_WAKE,
        &PUDDLE_WATER,
        &OPTICS,
        &WET,
        &GLAZING,
        &IMPOSTOR,
        &TRANSLUCENT,
    ],
};
