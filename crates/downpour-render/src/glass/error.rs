//! Errors of a pane before a camera.

use downpour_lattice::glass::GlassError;

use crate::RenderError;

/// Error of a pane of glass.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PaneError {
    /// The options of the lattice are invalid.
    #[error("glass: {0}")]
    Glass(#[from] GlassError),
    /// The camera is invalid.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The GPU that holds the lattice failed.
    #[cfg(feature = "wgpu")]
    #[error(transparent)]
    Gpu(#[from] downpour_gpu::GpuError),
    /// The camera does not look through the pane.
    #[error(
        "glass: a pane tilted by {tilt_deg:.1} degrees is seen edge on or from outside by a camera that looks {pitch_deg:.1} \
         degrees up; allowed: a tilt and a pitch that add up to 2 to 178 degrees"
    )]
    EdgeOn {
        /// Tilt of the pane, degrees from the horizontal.
        tilt_deg: f64,
        /// Pitch of the camera, degrees.
        pitch_deg: f64,
    },
}
