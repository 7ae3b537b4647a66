//! Positions of the drops of a rain.
//!
//! - [`field`]: rain in closed form, in still air or in a uniform wind: at any position and time the same drops from
//!   the same seed, without those that obstacles have stopped ([`shelter`]);
//! - [`impacts`]: positions and times of its impacts, and the droplets that rebound;
//! - [`drips`]: water that runs to edges and drips from them;
//! - [`simulation`]: rain step by step in a volume that follows the camera: any wind, bounces, impacts; on a GPU as
//!   well (`gpu`, feature `wgpu`);
//! - [`collision`]: collision map of the surfaces that its drops hit;
//! - [`motion`], [`volume`], [`step`], [`enter`]: parts of a step; [`step_list`]: the drops of a state that a picture shows, [`step_splash`]:
//!   the splashes of impacts before it;
//! - [`view`]: drops that a camera can resolve; [`resolved`]: limits of the list of drops for a picture.
//!
//! Units are SI; rates are in mm/h where the name says so. Axes are those of glTF: right-handed, +Y up.

pub mod collision;
mod disdrometer;
mod drift;
pub mod drips;
pub mod enter;
mod error;
mod facets;
mod falling;
pub mod field;
mod fill;
mod frustum;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod impacts;
mod inflow;
pub mod motion;
mod options;
mod plan;
mod poisson;
mod population;
mod recent;
mod region;
pub mod resolved;
pub mod shelter;
pub mod simulation;
pub mod step;
pub mod step_list;
pub mod step_splash;
pub mod view;
pub mod volume;

pub use error::SimError;

/// Compiles the examples of the README as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
