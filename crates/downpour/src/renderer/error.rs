//! Errors of the renderer.

use crate::shower::ShowerError;
use downpour_drop::DropError;
use downpour_lattice::glass::GlassError;
use downpour_mask::MaskError;
use downpour_render::RenderError;
use downpour_render::glass::PaneError;
use downpour_scene::SceneError;
use downpour_trace::puddle::PuddleError;
use downpour_trace::stage::StageError;

/// Reason why there is no frame. Messages are one line: the file or the quantity, what was found, what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RendererError {
    /// A file cannot be read, or what is in it cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene cannot be set.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// The rain cannot be.
    #[error(transparent)]
    Shower(#[from] ShowerError),
    /// The pane cannot be.
    #[error(transparent)]
    Pane(#[from] PaneError),
    /// The water on the pane cannot be.
    #[error(transparent)]
    Glass(#[from] GlassError),
    /// The puddles cannot be.
    #[error(transparent)]
    Puddle(#[from] PuddleError),
    /// The masks of the drops cannot be.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// The picture cannot be.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The drops cannot be.
    #[error(transparent)]
    Drop(#[from] DropError),
    /// A file whose name does not say what is in it.
    #[error("{path}; allowed: {allowed}")]
    Name {
        /// The file, with what it is for.
        path: String,
        /// Allowed names.
        allowed: &'static str,
    },
    /// A time that frames do not have.
    #[error("time is {found} s; allowed: -1e6 to 1e6 s")]
    Time {
        /// The time, s.
        found: f64,
    },
    /// The weather takes streaks from an atlas, and none was given.
    #[error(
        "streaks.color is \"atlas\" or \"atlas-random\", and there is no streak atlas; allowed: with a streak atlas in the options"
    )]
    NoAtlas,
    /// A GPU was asked for, of a library without the feature `wgpu`.
    #[error("no GPU support; allowed: the feature `wgpu`, or the CPU")]
    NoGpuSupport,
    /// A frame cannot be written.
    #[error("{path}: {reason}")]
    Write {
        /// The file.
        path: String,
        /// Message of the system.
        reason: String,
    },
    /// The GPU did not do it.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] downpour_gpu::GpuError),
    /// A frame cannot be drawn by the GPU.
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
            | Self::Pane(PaneError::Gpu(error)) => Some(error),
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
