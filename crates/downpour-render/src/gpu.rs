//! Pictures on a GPU: the same rays and the same drops as on the CPU, from the same buffers.

mod picture;
mod rain;
mod scene;

pub use picture::{GpuPictureError, PictureRenderer};
pub use rain::{RainOnGpu, RainPass, RainPipeline};
pub use scene::{SceneOnGpu, ScenePass, ScenePipeline};
