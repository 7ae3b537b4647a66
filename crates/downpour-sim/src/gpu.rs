//! GPU versions, behind the feature `wgpu`.

pub mod collision;
mod error;
mod simulation;

pub use collision::GpuCollisionMap;
pub use error::GpuSimError;
pub use simulation::{GpuSimulation, GpuStepInput};
