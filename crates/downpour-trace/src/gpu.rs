//! Scenes on a GPU: the same rays as on the CPU, from the same buffers.

mod falling;
mod impostor;
mod picture;
mod plate;
mod ripples;
mod running_light;
mod scene;
mod temporal;

pub use falling::{FieldDrops, FoundDrops, PictureDrops};
pub use impostor::{ImpostorPass, ImpostorPipeline};
pub use picture::{
    DisplayPicture, DisplayReadback, GpuPictureError, PictureOnGpu, PictureReadback, PictureRenderer,
    PictureUse,
};
pub use plate::ScenePlate;
pub use ripples::RipplesOnGpu;
pub use running_light::{RunningLightPass, RunningLightPipeline, RunningOnGpu};
#[cfg(feature = "parity")]
#[doc(hidden)]
pub use scene::SampleDispatches;
pub use scene::{SceneOnGpu, ScenePass, ScenePipeline};
pub use temporal::{LightOnGpu, TemporalPass, TemporalPipeline};
