//! Drops on a pane of glass: landing, growth, merging, sliding, trails and wipers.
//!
//! After Tatarchuk & Isidoro 2006, section 5 (a lattice of masses, velocities and traversals, after Kaneda et al.
//! 1999). A drop has its mass in one cell and wets the cells of a disk around it: the base of a spherical cap at the
//! mean of the contact angles. Drops whose disks touch merge, at the position of the larger. A drop begins to slide
//! where the forces along the pane exceed Furmidge's retention ([`GlassContact`]), which the paper leaves to the
//! artist. It then moves to one of the three cells ahead of it (ahead along its velocity, not always below), chosen at
//! random by affinity and wetness, and leaves beads behind. Water that a blade sweeps is a ridge along it ([`ridge`]).
//!
//! Mass is in whole nanoliters, and all forces, velocities and choices are integers: the water that came in is exactly
//! the water that is stored and that went out, and a GPU has the same bits. Only normals are `f32`.
//!
//! The pane: x is right, y is down, z out of it; rows begin at the top. SI units; angles in radians.

mod cells;
mod claim;
mod contact;
mod decide;
mod error;
mod lattice;
mod options;
mod plan;
mod rain;
mod settle;
mod smooth;
mod state;
mod surface;
mod tail;
mod totals;
mod transfer;
mod wiper;

pub mod blade;
pub mod frame;
pub mod height;
pub mod motion;
pub mod normal;
pub mod ridge;
pub mod size;

pub use contact::GlassContact;
pub use error::GlassError;
pub use lattice::Glass;
pub use options::{GlassAir, GlassOptions, GlassRain, GlassTexture, GlassTrail, GlassWetting};
pub use state::GlassState;
pub use totals::GlassTotals;
pub use wiper::{GlassWiper, GlassWiperKey, GlassWiperMotion, GlassWornBand};

/// Parts that the GPU version shares with the CPU version.
#[cfg(feature = "wgpu")]
pub(crate) mod host {
    pub(crate) use super::lattice::{free_cell, poured_units, wetness};
    pub(crate) use super::plan::{Plan, Ticks};
    pub(crate) use super::surface::surface;
}
