//! Drops on a pane of glass: they land, sit, swell, merge, run, leave trails, and are wiped.
//!
//! After Tatarchuk & Isidoro 2006, section 5 (a lattice of masses, velocities and traversals, after Kaneda et al. 1999). A
//! drop has its mass in one cell and wets the cells of a disc round it: the base of a spherical cap at the mean of the contact
//! angles. Drops whose discs touch become one, at the place of the larger. A drop begins to slide where the forces along the
//! pane exceed Furmidge's retention ([`GlassContact`]), which the paper leaves to the artist; it then moves among the three
//! cells before it (before its velocity, not always below), drawn by affinity and by wet glass, and leaves beads behind.
//!
//! Mass is in whole nanolitres and all forces, velocities and choices are integers: what came in is what is stored and what
//! went out, to the unit, and a GPU has the same bits. Only normals are `f32`.
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
mod surface;
mod totals;
mod transfer;
mod wiper;

pub mod blade;
pub mod frame;
pub mod height;
pub mod motion;
pub mod normal;
pub mod size;

pub use contact::GlassContact;
pub use error::GlassError;
pub use lattice::Glass;
pub use options::{GlassAir, GlassOptions, GlassRain, GlassTexture, GlassTrail, GlassWetting};
pub use totals::GlassTotals;
pub use wiper::{GlassWiper, GlassWiperKey, GlassWiperMotion, GlassWornBand};

/// What the GPU half shares with the CPU half.
#[cfg(feature = "wgpu")]
pub(crate) mod host {
    pub(crate) use super::lattice::{free_cell, poured_units};
    pub(crate) use super::plan::{Plan, Ticks};
    pub(crate) use super::surface::surface;
}
