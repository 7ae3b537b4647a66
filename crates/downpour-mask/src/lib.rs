//! Refraction masks: refraction and reflection of light by a raindrop, per texel.
//!
//! - [`trace_drop`]: mask of a drop of revolution from any elevation, exact through both interfaces
//!   ([`trace`]), with the coverage of each texel ([`silhouette`]); [`trace_drop_scalar`] is the twin of the GPU
//!   kernel, [`trace_drop_f64`] the reference for both;
//! - [`trace_model`]: the same for any closed mesh ([`ClosedMesh`]) through a hierarchy of boxes ([`downpour_bvh`]);
//! - [`wobble`]: a ray through a drop that oscillates;
//! - `gpu` (feature `wgpu`): both on a GPU;
//! - [`mod@file`]: OpenEXR, KTX2, PNG.
//!
//! Lengths inside a mask are in units of the drop's volume-equivalent radius; directions are in the frame of the
//! view: x right, y up, z toward the viewer.

mod closed_mesh;
mod crown;
mod drop;
mod error;
pub mod file;
#[cfg(feature = "wgpu")]
pub mod gpu;
mod mask;
mod model;
pub mod silhouette;
pub mod trace;
mod view;
pub mod wobble;

pub use closed_mesh::{ClosedMesh, MAX_TRIANGLES};
pub use drop::{LOST, trace_drop, trace_drop_f64, trace_drop_scalar};
pub use error::MaskError;
pub use mask::{Mask, MaskOptions, MaskTexel, SIZES};
pub use model::{TracedModel, trace_model, trace_model_views};
pub use view::View;

/// The examples of the README, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
