//! Errors of a weather that is to be a picture.

use downpour_render::RenderError;

/// Error of a frame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameSceneError {
    /// The picture is invalid.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The scene exceeds a limit of the renderer.
    #[error("{quantity}: {found}; allowed: at most {max} ({advice})")]
    OverLimit {
        /// Name of the quantity of which there is too much.
        quantity: &'static str,
        /// Amount that was found.
        found: u64,
        /// Maximum allowed.
        max: u64,
        /// Advice on what the user may do about it.
        advice: &'static str,
    },
    /// A moving eye is too far from where it began: positions there have too few digits.
    #[error(
        "camera: {distance_m} m from where the scene was set; allowed: a way within 1 km of its beginning"
    )]
    TooFar {
        /// Largest distance along an axis.
        distance_m: f64,
    },
    /// The machine has not the memory that the scene needs.
    #[error(
        "the scene: {mebibytes} MiB of memory are needed; allowed: what this machine has (fewer copies need less)"
    )]
    Memory {
        /// Memory that would be needed, in MiB.
        mebibytes: u64,
    },
}
