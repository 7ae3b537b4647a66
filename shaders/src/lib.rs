//! Every WGSL file of Downpour, as data.
//!
//! A WGSL file is a [`Module`]: its text, and Rust references to the modules whose functions it calls.
//! A [`Kernel`] names an entry point of a module. [`compose`] concatenates a module with everything that it
//! uses, each once, dependencies first; that text is what a pipeline is created from. There is no
//! preprocessor and no build script: permutations are WGSL `override` constants or another module.
//!
//! Names live in one flat namespace and carry the stem of their file (`rng_pcg4d` is in `common/rng.wgsl`);
//! an entry point is `main_<stem>`. Every function has a Rust twin of the same name, and the crate
//! `downpour-tests` fails when one is not compared with it.
//!
//! Constants that both languages need are declared once, by [`shared_constants!`], in the Rust file of their
//! subsystem.
//!
//! ```
//! use downpour_shaders::{common, compose};
//! let text = compose(&[&common::RNG]);
//! assert!(text.contains("fn rng_pcg4d"));
//! assert!(text.contains("const RNG_PCG_MULTIPLIER"));
//! ```

#[macro_use]
mod shared_constants;
mod module;

pub mod atlas;
pub mod bvh;
pub mod common;
pub mod drop;
pub mod lattice;
pub mod mask;
pub mod render;
pub mod sim;
pub mod wind;

pub use module::{Kernel, Module, compose};

/// Every module of the crate, for the tests that enumerate them.
pub fn modules() -> impl Iterator<Item = &'static Module> {
    [
        atlas::MODULES,
        bvh::MODULES,
        common::MODULES,
        drop::distribution::MODULES,
        drop::fall_speed::MODULES,
        drop::optics::MODULES,
        drop::oscillation::MODULES,
        drop::shape::MODULES,
        lattice::glass::MODULES,
        lattice::puddle::MODULES,
        mask::MODULES,
        render::brdf::MODULES,
        render::camera::MODULES,
        render::drop_light::MODULES,
        render::glass::MODULES,
        render::glazing::MODULES,
        render::glow::MODULES,
        render::layers::MODULES,
        render::refine::MODULES,
        render::tone::MODULES,
        render::host::MODULES,
        render::impostor::MODULES,
        render::medium::MODULES,
        render::pane_shadow::MODULES,
        render::puddle_flow::MODULES,
        render::puddle_rings::MODULES,
        render::puddle_wake::MODULES,
        render::puddle_water::MODULES,
        render::rain::MODULES,
        render::scene::MODULES,
        render::specimen::MODULES,
        render::spray::MODULES,
        render::table::MODULES,
        render::translucent::MODULES,
        render::wet::MODULES,
        sim::collision::MODULES,
        sim::enter::MODULES,
        sim::step_list::MODULES,
        sim::field::MODULES,
        sim::splash::MODULES,
        sim::bounce::MODULES,
        sim::drip::MODULES,
        sim::step::MODULES,
        wind::MODULES,
    ]
    .into_iter()
    .flatten()
    .copied()
}

/// Every kernel of the crate, for the tests that create a pipeline from each.
pub fn kernels() -> impl Iterator<Item = &'static Kernel> {
    [
        atlas::KERNELS,
        common::KERNELS,
        lattice::glass::KERNELS,
        lattice::puddle::KERNELS,
        mask::KERNELS,
        render::drop_light::KERNELS,
        render::glass::KERNELS,
        render::glow::KERNELS,
        render::layers::KERNELS,
        render::refine::KERNELS,
        render::tone::KERNELS,
        render::host::KERNELS,
        render::impostor::KERNELS,
        render::medium::KERNELS,
        render::rain::KERNELS,
        render::scene::KERNELS,
        render::specimen::KERNELS,
        render::spray::KERNELS,
        sim::collision::KERNELS,
        sim::enter::KERNELS,
        sim::step_list::KERNELS,
        sim::field::KERNELS,
        sim::splash::KERNELS,
        sim::bounce::KERNELS,
        sim::drip::KERNELS,
        sim::step::KERNELS,
        wind::KERNELS,
    ]
    .into_iter()
    .flatten()
    .copied()
}

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
