//! Rain on a pane of glass before the camera, and the picture through it.
//!
//! 1. [`WetPane`]: the pane of a weather, whose lattice ([`downpour_lattice::glass`]) is kept and stepped from picture to picture;
//! 2. [`GlassPicture`]: its drops as smooth surfaces, sorted into bins, with what a picture asks of pane and lens;
//! 3. [`GlassPicture::through`] (or [`gpu::GlassRenderer`](crate::gpu::GlassRenderer)): the picture through it, ray by ray.
//!
//! Lamps and the sun are points that no picture shows; drops show them as bright spots: [`light`].
//!
//! Light of lamps and the sun that falls in through the pane has the shadows of its drops: [`PaneShade`], for whoever
//! traces the scene.
//!
//! The lattice says where the water is; its cells are as large as small drops, so that surfaces are not read from its
//! heights but made of its drops: [`water`].
//!
//! Source: Tatarchuk & Isidoro 2006, section 5, has normals from the mass, a refracted picture and a Fresnel term. Here rays
//! follow Snell's law, so that a drop shows the far scene upside down, and its rim is dark where light is totally reflected.

#[cfg(not(feature = "parity"))]
pub(crate) mod blade;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod blade;
mod drops;
mod error;
mod frame;
mod lattice;
#[cfg(not(feature = "parity"))]
pub(crate) mod light;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod light;
mod meet;
mod pane;
mod picture;
mod radiance;
mod ridge;
mod shade;
#[cfg(not(feature = "parity"))]
pub(crate) mod water;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod water;

pub use blade::GlassPictureBlade;
pub use error::PaneError;
pub use frame::{GlassPicture, GlassPictureFrame};
pub use lattice::PaneLattice;
pub use light::GlassPictureLight;
pub use meet::glass_picture_spline;
pub use pane::{WetPane, pane_plane};
pub use shade::{PaneShade, PaneShadows, RenderPane};
pub use water::GlassPictureDrop;
