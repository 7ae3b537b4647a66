//! GPU versions, behind the feature `wgpu`.

pub mod collision;
mod error;
mod field;
mod simulation;

pub use collision::GpuCollisionMap;
pub use error::GpuSimError;
pub use field::{FieldOnGpu, FieldPass, FieldPipeline, FieldSearch, HolesOnGpu, ObstaclesOnGpu};
pub use simulation::{GpuSimulation, GpuStepInput};
