//! GPU versions, behind the feature `wgpu`.

pub mod collision;
mod drips;
mod error;
mod field;
mod list;
mod simulation;
mod step_list;

pub use collision::{CollisionMapOnGpu, GpuCollisionMap};
pub use drips::{DripPipeline, DripSearch, DripsOnGpu};
pub use error::GpuSimError;
pub use field::{FieldOnGpu, FieldPass, FieldPipeline, FieldSearch, HolesOnGpu, ObstaclesOnGpu};
pub use list::DropListOnGpu;
pub use simulation::{GpuSimulation, GpuStepInput};
pub use step_list::{StepListPass, StepPicture};
