//! Under construction.

pub mod bvh;
mod closed_mesh;
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

pub use closed_mesh::{ClosedMesh, MOST_TRIANGLES};
pub use drop::{LOST, trace_drop, trace_drop_f64, trace_drop_scalar};
pub use error::MaskError;
pub use mask::{Mask, MaskOptions, MaskTexel, SIZES};
pub use model::{TracedModel, trace_model};
pub use view::View;
