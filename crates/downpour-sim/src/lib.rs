//! Where the drops of a rain are.
//!
//! - [`field`]: rain in closed form, in still air or in a wind that is the same everywhere: any place, any time, the same
//!   drops from the same seed, but for those that something has stopped ([`shelter`]);
//! - [`impacts`]: where and when its drops meet what stands there, and the droplets that come back;
//! - [`simulation`]: rain step by step in a volume that follows the camera: any wind, bounces, impacts; on a GPU as well
//!   (`gpu`, feature `wgpu`);
//! - [`collision`]: what stops its drops: a map of the surfaces that the rain meets;
//! - [`motion`], [`volume`], [`step`], [`enter`]: what a step is made of;
//! - [`view`]: what a camera can resolve; [`resolved`]: which drops a list for a picture holds.
//!
//! Units are SI; rates are in mm/h where the name says so. Axes are those of glTF: right-handed, +Y up.

pub mod collision;
mod disdrometer;
mod drift;
pub mod enter;
mod error;
mod falling;
pub mod field;
mod fill;
mod frustum;
#[cfg(feature = "wgpu")]
pub mod gpu;
pub mod impacts;
mod inflow;
mod list;
pub mod motion;
mod options;
mod plan;
mod poisson;
mod population;
mod region;
pub mod resolved;
pub mod shelter;
pub mod simulation;
pub mod step;
pub mod view;
pub mod volume;

pub use error::SimError;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
