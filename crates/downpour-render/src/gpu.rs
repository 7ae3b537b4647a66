//! Pictures on a GPU: the same rays and the same drops as on the CPU, from the same buffers.

mod added_light;
mod drop_light;
mod drops;
mod glass;
mod glow;
mod host;
mod kept_light;
mod layers;
mod medium;
mod plate;
mod project;
mod rain;
mod refine;
mod spray;
#[cfg(not(feature = "parity"))]
pub(crate) mod tiles;
#[cfg(feature = "parity")]
#[doc(hidden)]
pub mod tiles;
mod tone;

pub use added_light::{AddedLightPass, AddedLightPipeline};
pub use drop_light::{DropLightOnGpu, DropLightPass, DropLightPipeline};
pub use glass::{BehindGlass, EnvironmentMap, GlassRenderer};
pub use glow::{GlowPass, GlowPipeline};
pub use host::{HostPass, HostPipeline, HostTextures};
pub use kept_light::KeptLight;
pub use medium::{MediumPass, MediumPipeline};
pub use plate::{LightingOnGpu, PlateOnGpu};
pub use project::{FallingOnGpu, ProjectPass, ProjectPipeline};
pub use rain::{RainOnGpu, RainPass, RainPipeline};
pub use refine::{RefinePass, RefinePipeline};
pub use tone::{TonePass, TonePipeline, TonedLayers};
