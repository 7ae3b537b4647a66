//! Puddles on the surfaces of a scene (Tatarchuk & Isidoro 2006, section 4).
//!
//! 1. [`PuddleMap`]: where water stands and how deep, painted or found from the scene by filling its hollows ([`fill`]), by the rain
//!    of their catchments or by a part of their depth, on ground whose unevenness may be finer than its model ([`relief`]), and where it
//!    runs, how deep and how fast ([`running`]);
//! 2. [`WetGround`](crate::wet_ground::WetGround): the maps of a weather, and the ripples of the rain on them, from picture
//!    to picture, with the [`Rings`] of single drops near the eye and the [`Wakes`] of what moves through them;
//! 3. [`SceneData::set_puddles`](crate::data::SceneData::set_puddles): both as rows of the scene's table;
//! 4. [`water`](crate::scene::water): what a ray finds of them, on CPU and GPU.

mod bodies;
#[cfg(feature = "wgpu")]
mod craters_ahead;
mod drainage;
mod error;
pub mod fill;
mod flow;
mod map;
pub mod relief;
mod ring_drops;
mod rings;
mod ripples;
mod rows;
pub mod running;
mod wakes;
mod wet_samples;

pub(crate) use bodies::{Region, moving_triangles};
pub use drainage::Drainage;
pub use error::PuddleError;
pub use fill::{FillLimits, Filling};
pub use flow::FlowMap;
pub use map::{Ground, PuddleGround, PuddleMap};
pub(crate) use relief::Relief;
pub use rings::{RainOnWater, RingRows, Rings};
pub use ripples::{Ripples, slope_levels};
pub(crate) use rows::RenderPuddle;
pub use rows::{PuddleLook, PuddleRows};
pub use wakes::{WakeRows, Wakes};
