//! Errors of the renderer.

use crate::shower::ShowerError;
use downpour_drop::DropError;
use downpour_lattice::glass::GlassError;
use downpour_mask::MaskError;
use downpour_render::RenderError;
use downpour_render::glass::PaneError;
use downpour_scene::SceneError;
use downpour_trace::frame_scene::FrameSceneError;
use downpour_trace::puddle::PuddleError;

/// Reason why there is no frame. Messages are one line: the file or the quantity, what was found, what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RendererError {
    /// A file cannot be read, or its contents are wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene of a frame cannot be built.
    #[error(transparent)]
    FrameScene(#[from] FrameSceneError),
    /// The rain's settings are out of range.
    #[error(transparent)]
    Shower(#[from] ShowerError),
    /// The pane of glass cannot be built or drawn.
    #[error(transparent)]
    Pane(#[from] PaneError),
    /// The settings of the water on the pane are out of range.
    #[error(transparent)]
    Glass(#[from] GlassError),
    /// The settings of the puddles are out of range.
    #[error(transparent)]
    Puddle(#[from] PuddleError),
    /// The refraction masks of the drops cannot be made.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The frame cannot be drawn or packed into a file.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A quantity of the drops is out of range.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// The extension of a file name is not one of those allowed.
    #[error("{path}; allowed: {allowed}")]
    Name {
        /// The file, with what it is for.
        path: String,
        /// Allowed names.
        allowed: &'static str,
    },
    /// The time of a frame is not a number or out of range.
    #[error("time is {found} s; allowed: -1e6 to 1e6 s")]
    Time {
        /// The time, s.
        found: f64,
    },
    /// The weather takes streaks from an atlas, and [`RendererOptions::atlas`](super::RendererOptions::atlas) is `None`.
    #[error(
        "streaks.color is \"atlas\" or \"atlas-random\", and there is no streak atlas; allowed: with a streak atlas in the options"
    )]
    NoAtlas,
    /// A GPU was asked for, and the library was built without the feature `wgpu`.
    #[error("no GPU support; allowed: the feature `wgpu`, or the CPU")]
    NoGpuSupport,
    /// A file cannot be written.
    #[error("{path}: {reason}")]
    Write {
        /// The file.
        path: String,
        /// Message of the system.
        reason: String,
    },
    /// The GPU failed: no adapter, a lost device, too little memory, a limit.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] downpour_gpu::GpuError),
    /// The GPU failed while it drew a frame, or the frame is too large for it.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Picture(#[from] downpour_trace::gpu::GpuPictureError),
}

impl RendererError {
    /// Error of the GPU, if it was the GPU.
    #[cfg(feature = "wgpu")]
    #[must_use]
    pub fn gpu(&self) -> Option<&downpour_gpu::GpuError> {
        use downpour_trace::gpu::GpuPictureError;
        match self {
            Self::Gpu(error)
            | Self::Picture(GpuPictureError::Gpu(error))
            | Self::Shower(ShowerError::Gpu(error))
            | Self::Pane(PaneError::Gpu(error))
            | Self::Puddle(PuddleError::Gpu(error)) => Some(error),
            _ => None,
        }
    }

    /// True if something was too large for the GPU.
    #[must_use]
    pub fn is_too_much_for_gpu(&self) -> bool {
        #[cfg(feature = "wgpu")]
        {
            use downpour_gpu::GpuError;
            matches!(self.gpu(), Some(GpuError::OverLimit { .. } | GpuError::OutOfMemory { .. }))
        }
        #[cfg(not(feature = "wgpu"))]
        false
    }
}
