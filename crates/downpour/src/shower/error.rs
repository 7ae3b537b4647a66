//! Errors of the rain of a weather.

use downpour_drop::DropError;
use downpour_sim::SimError;
use downpour_wind::WindError;

use downpour_render::RenderError;
use downpour_render::glass::PaneError;
use downpour_trace::frame_scene::FrameSceneError;

/// Reason why there is no rain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShowerError {
    /// Closed form in a wind that has none.
    #[error(
        "rain.volume is \"closed-form\" in a wind that differs from place to place; allowed: \"auto\", \"view\", \"box\", \
         or uniform wind and gusts alone"
    )]
    NotUniform,
    /// A drag that has no closed form.
    #[error(
        "rain.drag is \"rousseau-2008\", which has no closed form, and rain.volume is \"closed-form\"; allowed: \
         rain.drag = \"relaxation\", or rain.volume = \"auto\", \"view\" or \"box\""
    )]
    DragByStep,
    /// A rate that changes, of rain that goes step by step.
    #[error(
        "rain.rate_mm_h has keys, and the rain goes step by step: in wind that differs from place to place, or with \
         rain.drag = \"rousseau-2008\"; allowed: a number, or uniform wind and gusts alone with rain.drag = \"relaxation\""
    )]
    RateByStep,
    /// The drops' motion.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The wind.
    #[error(transparent)]
    Wind(#[from] WindError),
    /// The physics of drops.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// The eye.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene between pictures.
    #[error(transparent)]
    FrameScene(#[from] FrameSceneError),
    /// The pane before the eye.
    #[error(transparent)]
    Pane(#[from] PaneError),
    /// The GPU that steps the drops.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] downpour_gpu::GpuError),
    /// The field of the wind on the GPU.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    GpuWind(downpour_wind::gpu::GpuWindError),
}

#[cfg(feature = "wgpu")]
impl From<downpour_sim::gpu::GpuSimError> for ShowerError {
    fn from(error: downpour_sim::gpu::GpuSimError) -> Self {
        match error {
            downpour_sim::gpu::GpuSimError::Sim(error) => Self::Sim(error),
            downpour_sim::gpu::GpuSimError::Gpu(error) => Self::Gpu(error),
        }
    }
}

#[cfg(feature = "wgpu")]
impl From<downpour_wind::gpu::GpuWindError> for ShowerError {
    fn from(error: downpour_wind::gpu::GpuWindError) -> Self {
        use downpour_wind::gpu::GpuWindError;
        match error {
            GpuWindError::Wind(error) => Self::Wind(error),
            GpuWindError::Gpu(error) => Self::Gpu(error),
            other => Self::GpuWind(other),
        }
    }
}
